"""Builds the motions that the package carries, from the PyPI package ``pybullet`` (zlib licence).

    pip download --no-deps --dest wheel pybullet==3.2.7
    python -m tools.motions.build wheel/pybullet-*.whl

The wheel is only unpacked, never installed or imported. The result goes to ``whacamole/assets/motions``:
files in formats that the package's own readers read, ``LICENSE.txt`` and ``PROVENANCE.md``. The same wheel
gives the same bytes.
"""

from __future__ import annotations

import argparse
import hashlib
import sys
import tempfile
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from tools.motions.chain import chain, mirror
from tools.motions.retarget import Person, retarget
from tools.motions.source import Clip, FloatArray, load
from whacamole.motion.skeleton import SOURCE_REST_PELVIS, TOUCH_RADII, touch_points
from whacamole.motion.skeleton import forward as pose_skeleton

OUT = Path(__file__).parents[2] / "whacamole" / "assets" / "motions"
FOLDER = "pybullet_data/data/motions/"
WORK_FPS, FPS = 60.0, 30.0
LICENCE = "zlib (motion capture of the PyPI package pybullet 3.2.7, altered)"
GRAIN = 1.0 / 8192.0
"""Stored values are rounded to this [rad, m]: 0.007 degrees, 0.12 mm. It halves the files."""


@dataclass(frozen=True)
class Single:
    """One person: the clips played one after the other, without the first ``skip`` seconds."""

    name: str
    about: str
    clips: tuple[str, ...]
    straight: bool = False
    on_feet: bool = True
    skip: float = 0.0


@dataclass(frozen=True)
class Pair:
    """Two people, face to face or side by side.

    ``second`` is None for the mirror image of the first; ``gap`` [m] is the least room between them.
    """

    name: str
    about: str
    first: tuple[str, ...]
    second: tuple[str, ...] | None
    gap: float
    face_to_face: bool = True
    straight: bool = False


PROVENANCE = """\
# Where these motions come from

Real motion capture from the PyPI package `pybullet` 3.2.7, folder `pybullet_data/data/motions`, zlib
licence (`LICENSE.txt`, as it stands in that package). **Altered from the original**: retargeted to the
22 body joints of the SMPL family, feet held still where they rest, cycles repeated or joined, pairs
made of single clips (they were not captured together), resampled to 30 fps. Made by `python -m
tools.motions.build`; do not edit by hand.
"""

FORWARD, LEFT, SHARP_LEFT = "walker/0walk_forward", "walker/turn_left0", "walker/turn_left1"

SINGLES = (
    Single("walk", "six cycles of walking", (FORWARD,) * 6, straight=True),
    Single("walk_turn", "walking, two bends to the left", (FORWARD, SHARP_LEFT, FORWARD, LEFT, FORWARD)),
    Single("run", "six cycles of running", ("humanoid3d_run",) * 6, straight=True),
    Single("dance_a", "dance with turns, four times", ("humanoid3d_dance_a",) * 4),
    Single("dance_b", "dance in place, three times", ("humanoid3d_dance_b",) * 3),
    Single("spin", "pirouettes with a leg swung high", ("humanoid3d_spin",)),
    Single("jump", "three jumps forward", ("humanoid3d_jump",) * 3),
    Single("kick", "a side kick", ("humanoid3d_kick",)),
    Single("punch", "two steps and a punch", ("humanoid3d_punch",)),
    Single("spinkick", "a jumping spin kick, twice", ("humanoid3d_spinkick",) * 2),
    Single("cartwheel", "a cartwheel", ("humanoid3d_cartwheel",), on_feet=False),
    Single("roll", "a forward roll", ("humanoid3d_roll",), on_feet=False, skip=0.2),
    Single("crawl", "crawling, twice", ("humanoid3d_crawl",) * 2, on_feet=False),
    Single("getup_back", "getting up from the back", ("humanoid3d_getup_faceup",), on_feet=False),
    Single("getup_front", "getting up from the front", ("humanoid3d_getup_facedown",), on_feet=False),
)
PAIRS = (
    Pair("duet", "two dancers mirror each other, face to face", ("humanoid3d_dance_b",) * 3, None, 0.0),
    Pair("stroll", "two people walk side by side in step", (FORWARD,) * 5, None, 0.04, False, True),
    Pair("sparring", "one kicks, the other punches", ("humanoid3d_kick",), ("humanoid3d_punch",), 0.10),
)


def main() -> None:
    """Reads the wheel named on the command line, writes all motions, the licence and the provenance."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("wheel", type=Path, help="pybullet-3.2.7-*.whl, downloaded and not installed")
    wheel = parser.parse_args().wheel
    OUT.mkdir(parents=True, exist_ok=True)
    for old in OUT.glob("*.npz"):
        old.unlink()
    rows = []
    with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(wheel) as archive:
        names = [name for name in archive.namelist() if name.startswith(FOLDER)]
        archive.extractall(folder, names)
        licence = next(name for name in archive.namelist() if name.endswith(".dist-info/LICENSE.txt"))
        (OUT / "LICENSE.txt").write_bytes(archive.read(licence))
        source = Path(folder) / FOLDER

        def get(clips: tuple[str, ...], straight: bool) -> Clip:
            return chain([load(source / f"{name}.txt", WORK_FPS) for name in clips], straight=straight)

        for single in SINGLES:
            person = retarget(get(single.clips, single.straight), on_feet=single.on_feet)
            person = _thin(person, round(single.skip * WORK_FPS))
            path = OUT / f"{single.name}.npz"
            _write_amass(path, person)
            rows.append((single.name, single.about, single.clips, [path]))
        for pair in PAIRS:
            people = _pair(pair, get)
            paths = [OUT / f"{pair.name}_{half:02d}.npz" for half in range(2)]
            for path, person in zip(paths, people, strict=True):
                _write_dd100(path, person)
            rows.append((pair.name, pair.about, pair.first + (pair.second or ()), paths))
        digests = {name: _digest(source / f"{name}.txt") for row in rows for name in row[2]}
    _write_provenance(rows, digests)
    sys.stdout.write(f"{sum(p.stat().st_size for p in OUT.iterdir()) / 1e3:.0f} kB in {OUT}\n")


def _thin(person: Person, skip: int = 0) -> Person:
    step = round(WORK_FPS / FPS)
    return Person(person.pose[skip::step], person.pelvis[skip::step], FPS)


def _pair(pair: Pair, get: Callable[[tuple[str, ...], bool], Clip]) -> tuple[Person, Person]:
    """Two people on either side of a plane that neither crosses: nobody walks through anybody."""
    first = get(pair.first, pair.straight)
    axis = 2 if pair.face_to_face else 0
    one = _thin(retarget(first, on_feet=True))
    if pair.second is None:
        other = _thin(retarget(mirror(first), on_feet=True))
        other = _turned(other, np.pi) if pair.face_to_face else other
    else:
        other = _turned(_thin(retarget(get(pair.second, pair.straight), on_feet=True)), np.pi)
    T = min(len(one.pelvis), len(other.pelvis))
    one, other = (Person(p.pose[:T], p.pelvis[:T], p.fps) for p in (one, other))
    shift = np.zeros(3)
    mine, theirs = _extent(one, axis), _extent(other, axis)
    shift[axis] = mine[1] + pair.gap - theirs[0]
    return one, Person(other.pose, other.pelvis + shift, other.fps)


def _extent(person: Person, axis: int) -> tuple[float, float]:
    joints, turns = pose_skeleton(person.pose[:, 0], person.pose[:, 1:], person.pelvis)
    points = touch_points(joints, turns)[..., axis]
    return float((points - TOUCH_RADII).min()), float((points + TOUCH_RADII).max())


def _turned(person: Person, azimuth: float) -> Person:
    return _moved(person, Rotation.from_rotvec([0.0, azimuth, 0.0]))


def _moved(person: Person, turn: Rotation) -> Person:
    pose = person.pose.copy()
    pose[:, 0] = (turn * Rotation.from_rotvec(pose[:, 0])).as_rotvec()
    return Person(pose, turn.apply(person.pelvis), person.fps)


def _arrays(person: Person, angle: float) -> tuple[FloatArray, FloatArray]:
    """SMPL-X pose ``(T,165)`` and translation ``(T,3)``, rounded, in a world turned by ``angle`` about x."""
    turned = _moved(person, Rotation.from_rotvec([angle, 0.0, 0.0]))
    poses = np.zeros((len(turned.pelvis), 55, 3))
    poses[:, :22] = turned.pose
    trans = turned.pelvis - np.array(SOURCE_REST_PELVIS["smplx"])
    return tuple(
        (np.round(values / GRAIN) * GRAIN).astype(np.float32) for values in (poses.reshape(-1, 165), trans)
    )


def _write_amass(path: Path, person: Person) -> None:
    """AMASS SMPL-X: z up."""
    poses, trans = _arrays(person, np.pi / 2)
    np.savez_compressed(
        path,
        poses=poses,
        trans=trans,
        betas=np.zeros(10, dtype=np.float32),
        gender=np.array("neutral"),
        licence=np.array(LICENCE),
        surface_model_type=np.array("smplx"),
        mocap_frame_rate=np.array(FPS),
    )


def _write_dd100(path: Path, person: Person) -> None:
    """The schema of DD100, y down, as plain arrays instead of a pickle."""
    poses, transl = _arrays(person, np.pi)
    np.savez_compressed(
        path,
        poses=poses,
        transl=transl,
        betas=np.zeros((len(poses), 10), dtype=np.float32),
        gender=np.array("neutral"),
        licence=np.array(LICENCE),
    )


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _write_provenance(
    rows: list[tuple[str, str, tuple[str, ...], list[Path]]], digests: dict[str, str]
) -> None:
    lines = [PROVENANCE, "| motion | what | made from | sha256 of the file(s) |", "|---|---|---|---|"]
    for name, about, clips, paths in rows:
        used = ", ".join(f"{clip} × {clips.count(clip)}" for clip in dict.fromkeys(clips))
        sums = ", ".join(f"`{_digest(path)[:16]}`" for path in paths)
        lines.append(f"| {name} | {about} | {used} | {sums} |")
    lines += ["", "| source file | sha256 |", "|---|---|"]
    lines += [f"| `{name}.txt` | `{digest}` |" for name, digest in sorted(digests.items())]
    (OUT / "PROVENANCE.md").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
