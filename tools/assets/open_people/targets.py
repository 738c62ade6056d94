"""Morph targets: reading them, and mixing the macro targets as MakeHuman's sliders do."""

from __future__ import annotations

import gzip
import itertools
from collections.abc import Iterator
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

ORIGINS = ("african", "asian", "caucasian")


@dataclass(frozen=True)
class MacroShape:
    """The macro sliders. All run from 0 to 1; the three origins need not sum to 1.

    ``gender`` is 0 for female, 1 for male. ``age`` is 0.5 at 25 years and 1 at 90.
    """

    gender: float = 0.5
    age: float = 0.5
    muscle: float = 0.5
    weight: float = 0.5
    height: float = 0.5
    proportions: float = 0.5
    cup: float = 0.5
    firmness: float = 0.5
    african: float = 1 / 3
    asian: float = 1 / 3
    caucasian: float = 1 / 3

    @classmethod
    def names(cls) -> tuple[str, ...]:
        """The sliders, in order."""
        return tuple(field.name for field in fields(cls))

    def values(self) -> tuple[float, ...]:
        """The slider values, in order."""
        return tuple(getattr(self, name) for name in self.names())


def _ramp(value: float, keys: tuple[str, ...], anchors: tuple[float, ...]) -> dict[str, float]:
    """Weights of the two keys between whose anchors ``value`` lies; keys of weight 0 are left out."""
    value = min(max(value, anchors[0]), anchors[-1])
    upper = min(next(k for k, anchor in enumerate(anchors) if value <= anchor), len(anchors) - 1)
    if upper == 0:
        return {keys[0]: 1.0}
    t = (value - anchors[upper - 1]) / (anchors[upper] - anchors[upper - 1])
    return {key: w for key, w in ((keys[upper - 1], 1 - t), (keys[upper], t)) if w > 0}


HALVES = (0.0, 0.5, 1.0)


def macro_weights(shape: MacroShape) -> dict[str, float]:
    """Weight of every macro target, by path below ``targets`` without the suffix; "" parts are the base
    shape."""
    gender = _ramp(shape.gender, ("female", "male"), (0.0, 1.0))
    age = _ramp(shape.age, ("baby", "child", "young", "old"), (0.0, 0.1875, 0.5, 1.0))
    muscle = _ramp(shape.muscle, ("minmuscle", "averagemuscle", "maxmuscle"), HALVES)
    weight = _ramp(shape.weight, ("minweight", "averageweight", "maxweight"), HALVES)
    height = _ramp(shape.height, ("minheight", "", "maxheight"), HALVES)
    proportions = _ramp(shape.proportions, ("uncommonproportions", "", "idealproportions"), HALVES)
    cup = _ramp(shape.cup, ("mincup", "averagecup", "maxcup"), HALVES)
    firmness = _ramp(shape.firmness, ("minfirmness", "averagefirmness", "maxfirmness"), HALVES)
    origin = np.array([shape.african, shape.asian, shape.caucasian])
    origin = origin / origin.sum()

    out: dict[str, float] = {}
    for (g, gw), (a, aw) in itertools.product(gender.items(), age.items()):
        for name, ow in zip(ORIGINS, origin, strict=True):
            out[f"macrodetails/{name}-{g}-{a}"] = gw * aw * float(ow)
        for (m, mw), (w, ww) in itertools.product(muscle.items(), weight.items()):
            share, stem = gw * aw * mw * ww, f"{g}-{a}-{m}-{w}"
            out[f"macrodetails/universal-{stem}"] = share
            out.update(_scaled(share, f"macrodetails/height/{stem}", height))
            out.update(_scaled(share, f"macrodetails/proportions/{stem}", proportions))
            if g == "female":
                for (c, cw), (f, fw) in itertools.product(cup.items(), firmness.items()):
                    out[f"breast/{stem}-{c}-{f}"] = share * cw * fw
    return out


def _scaled(share: float, stem: str, parts: dict[str, float]) -> Iterator[tuple[str, float]]:
    return ((f"{stem}-{key}", share * w) for key, w in parts.items() if key)


class TargetLibrary:
    """Reads targets below a folder, once each.

    A combination that needs no change of the base shape has no file; such targets count as zero.
    """

    def __init__(self, folder: Path, num_vertices: int) -> None:
        self._folder = folder
        self._num_vertices = num_vertices
        self._read: dict[str, tuple[NDArray[np.int64], NDArray[np.float64]]] = {}

    def sparse(self, name: str) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Vertices that a target moves ``(n,)`` and their displacements ``(n, 3)`` in metres."""
        if name not in self._read:
            self._read[name] = self._load(name)
        return self._read[name]

    def dense(self, name: str) -> NDArray[np.float64]:
        """A target as displacements ``(N, 3)`` in metres."""
        out = np.zeros((self._num_vertices, 3))
        index, delta = self.sparse(name)
        out[index] = delta
        return out

    def morph(self, base: NDArray[np.float64], shape: MacroShape) -> NDArray[np.float64]:
        """The base vertices ``(N, 3)`` with the macro shape put on."""
        out = base.copy()
        for name, weight in macro_weights(shape).items():
            index, delta = self.sparse(name)
            out[index] += weight * delta
        return out

    def _load(self, name: str) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        packed, plain = self._folder / f"{name}.target.gz", self._folder / f"{name}.target"
        if packed.is_file():
            text = gzip.decompress(packed.read_bytes()).decode("utf-8")
        elif plain.is_file():
            text = plain.read_text(encoding="utf-8")
        else:
            return np.zeros(0, np.int64), np.zeros((0, 3))
        rows = [line.split() for line in text.splitlines() if line and not line.startswith("#")]
        rows = [row for row in rows if len(row) == 4]
        index = np.array([int(row[0]) for row in rows], np.int64)
        delta = np.array([[float(x) for x in row[1:]] for row in rows]).reshape(-1, 3)
        return index, delta / 10.0  # decimetres
