"""The result of an evaluation: the scores of every sequence and method, saved whole and read back."""

import contextlib
import json
import os
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Self

import numpy as np

from whacamole import __version__
from whacamole.errors import EvaluationError
from whacamole.evaluation.catalogue import METRICS
from whacamole.evaluation.protocol import Protocol
from whacamole.evaluation.scores import COUNTS, SequenceScore

FORMAT = "whacamole-evaluation-1"


@dataclass(eq=False)
class MethodResult:
    """One method on all sequences.

    Attributes:
        name: as tables name it.
        sequences: sequence id → scores.
        failures: sequence id → why it could not be scored, one line each.
        ground_truth_used: truths the method was given, as its files say.
    """

    name: str
    sequences: dict[str, SequenceScore] = field(default_factory=dict)
    failures: dict[str, str] = field(default_factory=dict)
    ground_truth_used: str = ""

    @property
    def counts(self) -> dict[str, int]:
        """Coverage counts, added up over the sequences."""
        return {key: sum(score.counts[key] for score in self.sequences.values()) for key in COUNTS}


@dataclass(eq=False)
class Result:
    """What :func:`whacamole.evaluation.evaluate` returns.

    Attributes:
        protocol: the choices it was made with.
        truth: name of the ground truth.
        split: of it.
        ids: sequences that were to be scored.
        methods: one entry a method, in the order given.
        version: of this package.
    """

    protocol: Protocol
    truth: str
    split: str
    ids: tuple[str, ...]
    methods: tuple[MethodResult, ...]
    version: str = __version__

    @property
    def complete(self) -> bool:
        """Whether every sequence of every method was scored."""
        return not any(method.failures for method in self.methods)

    def method(self, name: str) -> MethodResult:
        """A method by name.

        Raises:
            EvaluationError: no such method.
        """
        for method in self.methods:
            if method.name == name:
                return method
        raise EvaluationError(
            f"no method {name!r} in the result, only {', '.join(m.name for m in self.methods)}"
        )

    def joined(self, other: "Result") -> "Result":
        """Both results side by side.

        Raises:
            EvaluationError: they differ in truth, split or protocol, or name a method alike.
        """
        for what, ours, theirs in (
            ("ground truth", self.truth, other.truth),
            ("split", self.split, other.split),
            ("protocol", self.protocol, other.protocol),
        ):
            if ours != theirs:
                shown = (ours.name, theirs.name) if isinstance(ours, Protocol) else (ours, theirs)  # type: ignore[union-attr]
                raise EvaluationError(
                    f"results of different {what}: {shown[0]} and {shown[1]}; evaluate one again"
                )
        names = {method.name for method in self.methods} & {method.name for method in other.methods}
        if names:
            raise EvaluationError(f"both results have a method {', '.join(sorted(names))}; rename one")
        ids = tuple(sorted({*self.ids, *other.ids}))
        return replace(self, ids=ids, methods=(*self.methods, *other.methods))

    def save(self, path: Path | str) -> Path:
        """Write everything as one ``.npz`` without Python objects; whole or not at all.

        Raises:
            EvaluationError: the place cannot be written to.
        """
        path = Path(path)
        meta = {
            "format": FORMAT,
            "version": self.version,
            "protocol": self.protocol.as_dict(),
            "truth": self.truth,
            "split": self.split,
            "ids": list(self.ids),
            "methods": [_describe(method) for method in self.methods],
        }
        arrays: dict[str, Any] = {"meta": np.array(json.dumps(meta))}
        for number, method in enumerate(self.methods):
            for key, parts in _columns(method):
                arrays[f"{number}|{key}"] = np.concatenate([part.reshape(-1) for part in parts])
        part = path.with_name(f".{path.name}.{os.getpid()}.part")
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with part.open("wb") as stream:
                np.savez_compressed(stream, **arrays)
            part.replace(path)
        except OSError as error:
            with contextlib.suppress(OSError):
                part.unlink()
            raise EvaluationError(
                f"{path}: {error.strerror or error}; choose a place that can be written"
            ) from error
        return path

    @classmethod
    def load(cls, path: Path | str) -> Self:
        """Read what :meth:`save` wrote.

        Raises:
            EvaluationError: the file is missing or is not a saved result.
        """
        path = Path(path)
        try:
            with path.open("rb") as stream, np.load(stream, allow_pickle=False) as archive:
                meta = json.loads(str(archive["meta"]))
                if meta.get("format") != FORMAT:
                    raise EvaluationError(
                        f"{path}: format {meta.get('format')!r}, expected {FORMAT}; evaluate again"
                    )
                methods = tuple(
                    _restore(text, number, archive) for number, text in enumerate(meta["methods"])
                )
        except (OSError, EOFError, ValueError, KeyError, TypeError, zipfile.BadZipFile) as error:
            raise EvaluationError(f"{path}: no saved result ({error}); write one with --save") from error
        return cls(
            protocol=Protocol.from_dict(meta["protocol"]),
            truth=meta["truth"],
            split=meta["split"],
            ids=tuple(meta["ids"]),
            methods=methods,
            version=meta["version"],
        )


def _describe(method: MethodResult) -> dict[str, Any]:
    """All of a method but its numbers."""
    return {
        "name": method.name,
        "failures": method.failures,
        "ground_truth_used": method.ground_truth_used,
        "sequences": [
            {
                "id": score.id,
                "source": score.source,
                "shape": list(score.shape),
                "shots": list(score.shots) if any(score.shots) else [],
                "counts": score.counts,
                "matches": [list(match) for match in score.matches],
                "notes": score.notes,
                "up": list(score.up),
                "values": sorted(score.values),
                "weights": sorted(score.weights),
                "paths": sorted(score.paths),
            }
            for score in method.sequences.values()
        ],
    }


def _columns(method: MethodResult) -> Iterator[tuple[str, list[Any]]]:
    """Arrays of the sequences by name, those of one name together, in the order of the sequences."""
    columns: dict[str, list[Any]] = {}
    for score in method.sequences.values():
        columns.setdefault("frame_index", []).append(score.frame_index)
        columns.setdefault("visible", []).append(score.visible)
        for prefix, arrays in (("value", score.values), ("weight", score.weights), ("path", score.paths)):
            for key in sorted(arrays):
                columns.setdefault(f"{prefix}|{key}", []).append(arrays[key])
    yield from columns.items()


def _restore(text: dict[str, Any], number: int, archive: Mapping[str, Any]) -> MethodResult:
    method = MethodResult(text["name"], {}, dict(text["failures"]), text["ground_truth_used"])
    taken: dict[str, int] = {}
    columns: dict[str, Any] = {}

    def next_of(name: str, shape: tuple[int, ...]) -> Any:
        if name not in columns:
            columns[name] = archive[f"{number}|{name}"]
        start, size = taken.get(name, 0), int(np.prod(shape, dtype=np.int64))
        taken[name] = start + size
        return columns[name][start : start + size].reshape(shape)

    for entry in text["sequences"]:
        P, T = entry["shape"]
        score = SequenceScore(
            id=entry["id"],
            source=entry["source"],
            frame_index=next_of("frame_index", (T,)),
            shots=tuple(entry["shots"]) or ("",) * T,
            visible=next_of("visible", (P, T)),
            counts=entry["counts"],
            matches=[(int(a), int(b), float(d)) for a, b, d in entry["matches"]],
            notes=list(entry["notes"]),
            up=tuple(entry["up"]),
        )
        shapes = {"person_frame": (P, T), "frame": (T,), "person": (P,), "sequence": ()}
        for key in entry["values"]:
            score.values[key] = next_of(f"value|{key}", shapes[METRICS[key].level])
        for key in entry["weights"]:
            score.weights[key] = next_of(f"weight|{key}", (P, T))
        for key in entry["paths"]:
            score.paths[key] = next_of(f"path|{key}", (T, 3))
        method.sequences[score.id] = score
    return method
