"""What a reader is: the one place to look at before adding a format (see docs/motions.md)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

import numpy as np

from whacamole.errors import MotionError
from whacamole.motion.container import Record
from whacamole.motion.data import FloatArray
from whacamole.motion.rate import rational_rate

NUM_BODY, NUM_HAND = 21, 15
MAX_ANGLE = 4 * np.pi
MAX_DISTANCE = 1000.0


@dataclass(frozen=True)
class RawPerson:
    """One person as the file has it: its own rate and axes, T frames, axis-angle [rad].

    ``pose (T,J,3)`` may be the body alone (root, 21 body: J = 22), SMPL-H
    (root, 21 body, 15 + 15 fingers: J = 52) or SMPL-X (root, 21 body, jaw, 2 eyes, 15 + 15 fingers: J =
    55). ``trans (T,3)`` [m] in the sense of ``model`` (``smpl``, ``smplh``, ``smplx``): the pelvis is at
    trans + j0.
    """

    where: str
    model: str
    rate: Fraction
    gender: str
    betas: FloatArray
    pose: FloatArray
    trans: FloatArray
    expression: FloatArray | None = None

    def __post_init__(self) -> None:
        if len(self.pose) != len(self.trans):
            lengths = f"{len(self.pose)} poses but {len(self.trans)} translations"
            raise MotionError(f"{self.where}: {lengths}; cut both to one length")
        if len(self.pose) < 2:
            raise MotionError(f"{self.where}: a motion of {len(self.pose)} frame(s); give at least 2 frames")
        angle, distance = np.abs(self.pose).max(), np.abs(self.trans).max()
        if angle > MAX_ANGLE:
            raise MotionError(f"{self.where}: a rotation of {angle:.3g} rad; give radians, not degrees")
        if distance > MAX_DISTANCE:
            raise MotionError(
                f"{self.where}: a translation of {distance:.3g} m; give metres, not millimetres"
            )


@dataclass(frozen=True)
class PairNames:
    """How the two files of a pair are named: a common stem (which may be empty) and one of two endings."""

    first: str
    second: str

    def halves(self, path: Path) -> tuple[Path, Path] | None:
        """Both files of the pair that ``path`` names a half of, whether or not they exist; else None."""
        for ending in (self.first, self.second):
            if path.stem.endswith(ending):
                name = path.stem.removesuffix(ending)
                return path.with_name(name + self.first + path.suffix), path.with_name(
                    name + self.second + path.suffix
                )
        return None

    def name(self, path: Path) -> str:
        """The common stem of the pair of ``path``, without a separator at its end."""
        ending = self.first if path.stem.endswith(self.first) else self.second
        return path.stem.removesuffix(ending).rstrip("_-. ")


@dataclass(frozen=True)
class Reader:
    """A motion format.

    ``name`` labels datasets; ``up`` is the axis the format's documents or habits name as up (``"+z"``,
    ``"-y"``); ``matches`` tells by names and shapes, never by the file's name; ``frames`` and ``rate`` are
    cheap; ``read`` gives the people. ``pair`` is set where two files hold the two people of one scene,
    ``people`` is the number of people in a file, ``up_stated`` says that documents state the up axis (else
    content decides alone).
    """

    name: str
    title: str
    up: str
    licence: str
    matches: Callable[[Record], bool]
    frames: Callable[[Record], int | None]
    rate: Callable[[Record], Fraction]
    read: Callable[[Record], tuple[RawPerson, ...]]
    pair: PairNames | None = None
    people: int = 1
    up_stated: bool = True


def stored_rate(record: Record, *names: str) -> Fraction:
    """The frame rate stored under the first of ``names`` that is there."""
    for name in names:
        if name in record.keys:
            try:
                return rational_rate(record.number(name))
            except ValueError as error:
                raise record.fail(f"'{name}': {error}; repair the file's rate") from error
    raise record.fail(f"the frame rate is missing; add '{names[0]}' (frames per second)")


def rate_or(record: Record, default: int, *names: str) -> Fraction:
    """The stored rate where the file has one, else the rate ``default`` of the format."""
    return stored_rate(record, *names) if record.keys & set(names) else Fraction(default)


def constant_rate(fps: int) -> Callable[[Record], Fraction]:
    """A rate that the format fixes and no file stores."""
    return lambda _record: Fraction(fps)


def frames_of(key: str) -> Callable[[Record], int | None]:
    """Counts the frames by the first axis of ``key``."""

    def count(record: Record) -> int | None:
        shape = record.shape(key)
        return shape[0] if shape else None

    return count


def gender_of(text: str) -> str:
    """``male``, ``female`` or ``neutral`` from whatever a file says."""
    initial = text.strip().lower()[:1]
    return {"m": "male", "f": "female"}.get(initial, "neutral")


def betas_of(record: Record, key: str = "betas") -> FloatArray:
    """Shape coefficients ``(n,)``: the mean of a file's rows; empty where it has none."""
    if key not in record.keys:
        return np.zeros(0)
    betas = record.array(key)
    return np.atleast_1d(betas) if betas.ndim < 2 else betas.reshape(-1, betas.shape[-1]).mean(axis=0)
