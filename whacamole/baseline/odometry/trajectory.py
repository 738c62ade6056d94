"""A camera trajectory whose unit is nobody's: scale-free by construction."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol, Self

import numpy as np
from numpy.typing import NDArray

from whacamole.baseline.footage import Footage
from whacamole.baseline.rigid import BoolArray, FloatArray, inverse, runs_of
from whacamole.errors import BaselineError

SHORTEST = 2
"""Frames of the shortest trajectory."""

Masker = Callable[[int, NDArray[np.uint8]], BoolArray]
"""From a frame's number and its image (H, W, 3) to what is not the static world (H, W)."""


@dataclass(frozen=True, eq=False)
class Odometry:
    """Camera poses up to a scale, first valid camera = identity. Made by :meth:`from_poses` alone.

    Attributes:
        T_vo: (T, 4, 4) camera to world, positions in units of the root mean square step; identity where lost.
        valid: (T,) false where the camera was lost; those frames are never filled in.
        ground_truth: what true data went into it.
        notes: what the user should know, one line each.
    """

    T_vo: FloatArray
    valid: BoolArray
    ground_truth: tuple[str, ...] = ()
    notes: tuple[str, ...] = field(default=())

    @classmethod
    def from_poses(
        cls,
        T_world_camera: FloatArray,
        valid: BoolArray,
        ground_truth: tuple[str, ...] = (),
        notes: tuple[str, ...] = (),
    ) -> Self:
        """Drop place, heading and unit of a trajectory, and all but its longest run of frames without a gap.

        After a gap the unit may be another, so of several runs one counts. A similarity on the poses changes
        nothing, so no metric scale can come through.

        Args:
            T_world_camera: (T, 4, 4) in any world and any unit; anything where not valid.
            valid: (T,).

        Raises:
            BaselineError: no two frames in a row are valid.
        """
        usable = valid & np.isfinite(T_world_camera).all(axis=(1, 2))
        runs = runs_of(usable, SHORTEST)
        if not runs:
            raise BaselineError(
                "odometry: the camera was lost in every frame; try another --vo or a longer video"
            )
        run = max(runs, key=lambda part: part.stop - part.start)
        T_vo = np.tile(np.eye(4), (len(valid), 1, 1))
        T_vo[run] = inverse(T_world_camera[run.start]) @ T_world_camera[run]
        T_vo[run, :3, 3] /= _unit(T_vo[run, :3, 3])
        kept = np.zeros(len(valid), dtype=bool)
        kept[run] = True
        dropped = int(usable.sum() - kept.sum())
        if dropped:
            notes = (*notes, f"odometry: {dropped} frames outside its longest run were left out")
        return cls(T_vo, kept, ground_truth, notes)


@dataclass(frozen=True, eq=False)
class Scene:
    """What odometry is given.

    Attributes:
        footage: the video.
        K: (T, 3, 3) [px], given or guessed.
        masker: finds the people, ``None`` to mask nobody.
        mask_source: "labels", "detector" or "none".
    """

    footage: Footage
    K: FloatArray
    masker: Masker | None = None
    mask_source: str = "none"

    @property
    def mask_truth(self) -> tuple[str, ...]:
        """What true data the masks are."""
        return ("masks",) if self.mask_source == "labels" else ()


class OdometrySource(Protocol):
    """A way to the camera's trajectory."""

    @property
    def name(self) -> str:
        """As typed."""
        ...

    def track(self, scene: Scene) -> Odometry:
        """The camera's trajectory through the footage.

        Raises:
            BaselineError: it cannot be had.
        """
        ...


def _unit(positions: FloatArray) -> float:
    """Root mean square step; 1 for a camera that does not move."""
    step = float(np.sqrt((np.diff(positions, axis=0) ** 2).sum(axis=-1).mean()))
    return step if step > 0.0 else 1.0
