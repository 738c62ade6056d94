"""Finding the motions of a folder: each file looked at, pairs put together, what cannot be used named."""

from __future__ import annotations

import hashlib
import os
import re
from collections import Counter
from dataclasses import dataclass, replace
from pathlib import Path

from whacamole.errors import MotionError
from whacamole.motion.container import Record, open_record
from whacamole.motion.data import MotionFile
from whacamole.motion.rate import resampled_length
from whacamole.motion.reader import Reader
from whacamole.motion.readers import READERS

SUFFIXES = (".npz", ".npy", ".pkl", ".pickle")
_MAX_ID = 100
# AMASS keeps a subject's shape beside the motions, without any pose: no motion, and no fault of the folder.
_COMPANION_KEYS = frozenset({"gender", "betas", "num_betas", "surface_model_type"})


@dataclass(frozen=True)
class _Seen:
    """One file looked at: its reader, or the problem that keeps it out."""

    path: Path
    reader: Reader | None = None
    num_frames: int | None = None
    problem: str | None = None


def recognise(record: Record) -> Reader:
    """The reader whose schema ``record`` has. Raises :class:`MotionError` where there is none."""
    for reader in READERS:
        if reader.matches(record):
            return reader
    held = (
        ", ".join(f"{key} {record.shape(key) or ''}".strip() for key in sorted(record.keys)[:6]) or "nothing"
    )
    raise record.fail(f"no known motion format (it holds {held}); convert it to one of docs/motions.md")


def find_motions(path: Path | str) -> list[MotionFile]:
    """All motions of ``path``: one file, or a folder searched recursively for npz, npy and pickle files.

    The two files of a pair make one entry, also when only one of them is named. What cannot be used is
    listed too, with its ``problem``, so that a run can go on and still end by saying what it left out.
    Sorted by id; ids are the paths relative to ``path``, made safe for file systems, and stay the same when
    other motions are added. Links that lead out of the folder are not followed, but named. Only headers are
    read where the format allows it.

    Raises :class:`MotionError` where ``path`` does not exist or holds no candidate at all.
    """
    root = Path(path)
    if not root.exists():
        raise MotionError(f"{root}: no such file or folder; give a motion file or a folder of motions")
    if root.is_dir():
        seen = _walk(root)
        if not seen:
            raise MotionError(
                f"{root}: no motion files ({', '.join(SUFFIXES)}) in this folder; give another folder"
            )
    else:
        seen, root = [_look(root)], root.parent
    return _with_ids(_group(seen), root)


def _walk(root: Path) -> list[_Seen]:
    inside = root.resolve()
    problems: list[OSError] = []
    seen: list[_Seen] = []
    for folder, folders, names in os.walk(root, onerror=problems.append):
        folders[:] = sorted(name for name in folders if not _hidden(name))
        candidates = sorted(name for name in names if _is_candidate(name))
        for path in (Path(folder, name) for name in (*folders, *candidates)):
            if path.is_symlink():
                if not path.resolve().is_relative_to(inside):
                    text = (
                        f"{path}: a link that leads out of the folder; name the folder it points to instead"
                    )
                    seen.append(_Seen(path, problem=text))
            elif not path.is_dir():
                seen.append(_look(path))
    seen += [
        _Seen(Path(error.filename), problem=f"{error.filename}: {error.strerror}; check its rights")
        for error in problems
    ]
    return [entry for entry in seen if entry.reader or entry.problem]


def _hidden(name: str) -> bool:
    return name.startswith(".") or name == "__MACOSX"


def _is_candidate(name: str) -> bool:
    return not _hidden(name) and name.lower().endswith(SUFFIXES)


def _look(path: Path) -> _Seen:
    try:
        record = open_record(path)
        if record.keys and record.keys <= _COMPANION_KEYS:
            return _Seen(path)
        reader = recognise(record)
        frames = reader.frames(record)
        if frames == 1:
            raise record.fail("a motion of 1 frame(s); give at least 2 frames")
        length = None if frames is None else resampled_length(frames, reader.rate(record))
    except MotionError as error:
        return _Seen(path, problem=str(error))
    return _Seen(path, reader, length)


def _group(seen: list[_Seen]) -> list[MotionFile]:
    """One entry a motion. ``id`` is still the path that names the motion, without its suffix."""
    by_path = {entry.path: entry for entry in seen}
    done: set[Path] = set()
    motions = []
    for entry in sorted(seen, key=lambda entry: entry.path.as_posix()):
        if entry.path in done:
            continue
        motion = _pair(entry, by_path) or _single(entry)
        done.update(motion.paths)
        motions.append(motion)
    return motions


def _single(entry: _Seen) -> MotionFile:
    name = entry.reader.name if entry.reader else ""
    people = entry.reader.people if entry.reader else 0
    stem = entry.path.with_suffix("").as_posix()
    problem = entry.problem
    if entry.reader is None and problem is None:
        problem = f"{entry.path}: a body shape without a motion; give a file with poses"
    return MotionFile(stem, (entry.path,), name, entry.num_frames, people, problem)


def _pair(entry: _Seen, by_path: dict[Path, _Seen]) -> MotionFile | None:
    """The pair that ``entry`` is a half of, or None. A half without its partner is a problem."""
    if entry.reader is None or entry.reader.pair is None:
        return None
    names = entry.reader.pair
    paths = names.halves(entry.path)
    if paths is None:
        return None
    stem = (entry.path.parent / names.name(entry.path)).as_posix()
    whole = MotionFile(stem, paths, entry.reader.name, entry.num_frames, 2)
    other = paths[1] if entry.path == paths[0] else paths[0]
    if not other.exists():
        text = f"{entry.path}: half of a pair, {other.name} is missing; put both files into one folder"
        return replace(whole, paths=(entry.path,), problem=text)
    partner = by_path.get(other) or _look(other)
    if partner.problem or partner.reader is not entry.reader:
        text = (
            partner.problem
            or f"{other}: not of the format {entry.reader.name} like its partner; give both alike"
        )
        return replace(whole, problem=text)
    if entry.num_frames is not None and partner.num_frames is not None:
        whole = replace(whole, num_frames=min(entry.num_frames, partner.num_frames))
    return whole


def _with_ids(motions: list[MotionFile], root: Path) -> list[MotionFile]:
    relative = [os.path.relpath(motion.id, root) for motion in motions]
    ids = [_safe(name) for name in relative]
    count = Counter(name.lower() for name in ids)
    named = [
        replace(
            motion, id=_hashed(name, os.path.relpath(motion.path, root)) if count[name.lower()] > 1 else name
        )
        for motion, name in zip(motions, ids, strict=True)
    ]
    return sorted(named, key=lambda motion: motion.id)


def _safe(relative: str) -> str:
    """A file name for ``relative``: folders joined by ``__``, plain ASCII; hashed where that could clash."""
    parts = Path(relative).parts
    clean = [re.sub(r"[^A-Za-z0-9._-]+", "-", part).strip(".-") or "motion" for part in parts]
    name = "__".join(clean)
    faithful = list(parts) == clean and not any("__" in part or part[0] == part[-1] == "_" for part in parts)
    return name if faithful and len(name) <= _MAX_ID else _hashed(name, relative)


def _hashed(name: str, relative: str) -> str:
    digest = hashlib.sha256(Path(relative).as_posix().encode("utf-8", "surrogateescape")).hexdigest()[:8]
    return f"{name[: _MAX_ID - 9]}-{digest}"
