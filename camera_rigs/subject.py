"""What the camera films: `SubjectTrack`, the anchors, the facing and the boxes of one person or several."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from camera_rigs.errors import PlanError
from camera_rigs.smoothing import heading_of, smooth
from camera_rigs.spherical import Array

ANCHOR_SMOOTHING = 0.3
"""Standard deviation [s] of the anchor's low-pass: removes the 2 Hz bounce of steps, keeps the path of the walk."""

FACING_SMOOTHING = 0.5
"""Standard deviation [s] of the facing's low-pass: removes nods and hip swing, keeps the turns of a walk."""

EXTENT_SMOOTHING = 0.5
"""Standard deviation [s] of the low-pass of the boxes: an arm thrown up is no reason to step back."""

OPPOSITE_FACING = 0.5
"""A mean facing shorter than this means that the people face apart or together: the camera looks across them."""

LYING_SHARE = 0.6
"""A person is framed as at least this share of the longest side of the box: someone lying is not a small object."""


@dataclass(frozen=True)
class SubjectTrack:
    """One person or several over T frames; world z up, metres. Build it with `from_people`.

    Attributes:
        pelvis: mean of the pelvis joints (T, 3), the anchor of full and long shots.
        neck: mean of the neck joints (T, 3), the anchor of medium shots and close-ups.
        facing: direction (T, 3) in the ground plane; its length, 0 to 1, tells how certain it is.
        box_min, box_max: axis-aligned box around everybody (T, 3).
        people_pelvis, people_neck, people_box_min, people_box_max: the same per person (P, T, 3).
        fps: frames per second.
    """

    pelvis: Array
    neck: Array
    facing: Array
    box_min: Array
    box_max: Array
    people_pelvis: Array
    people_neck: Array
    people_box_min: Array
    people_box_max: Array
    fps: float

    @classmethod
    def from_people(
        cls,
        pelvis: ArrayLike,
        neck: ArrayLike,
        facing: ArrayLike,
        box_min: ArrayLike,
        box_max: ArrayLike,
        fps: float,
    ) -> "SubjectTrack":
        """The subject of P people over T frames.

        Args:
            pelvis, neck: joints (P, T, 3) [m].
            facing: direction each person faces (P, T, 3), of any length and tilt: the part in the ground plane counts,
                so that someone who lies on the back faces nowhere.
            box_min, box_max: axis-aligned box of each person (P, T, 3) [m].
            fps: frames per second.

        Raises:
            PlanError: the arrays differ in shape, are empty or hold values that are not finite.
        """
        names = ("pelvis", "neck", "facing", "box_min", "box_max")
        arrays = [np.asarray(a, float) for a in (pelvis, neck, facing, box_min, box_max)]
        for name, array in zip(names, arrays, strict=True):
            if array.ndim != 3 or array.shape[2] != 3 or array.shape != arrays[0].shape or not array.size:
                raise PlanError(
                    f"{name} has shape {array.shape}: every array must be (people, frames, 3), not empty"
                )
            if not np.isfinite(array).all():
                raise PlanError(f"{name} holds values that are not finite: repair the motion first")
        if not (np.isfinite(fps) and fps > 0.0):
            raise PlanError(f"fps is {fps}: give a positive frame rate")
        p, n, f, lo, hi = arrays
        if (hi < lo).any():
            raise PlanError("box_max lies below box_min: exchange the two")
        return cls(p.mean(0), n.mean(0), _common_facing(p, f), lo.min(0), hi.max(0), p, n, lo, hi, float(fps))

    @property
    def num_frames(self) -> int:
        """Number of frames T."""
        return len(self.pelvis)

    @property
    def num_people(self) -> int:
        """Number of people P."""
        return len(self.people_pelvis)

    @cached_property
    def smooth_pelvis(self) -> Array:
        """The pelvis anchor (T, 3) without bounce."""
        return smooth(self.pelvis, ANCHOR_SMOOTHING, self.fps)

    @cached_property
    def smooth_neck(self) -> Array:
        """The neck anchor (T, 3) without bounce and nod."""
        return smooth(self.neck, ANCHOR_SMOOTHING, self.fps)

    def anchor(self, name: str) -> Array:
        """The smoothed anchor (T, 3) called `name`: "pelvis" or "neck"."""
        return self.smooth_neck if name == "neck" else self.smooth_pelvis

    @cached_property
    def azimuth(self) -> Array:
        """Azimuth φ_facing (T,) [rad] of the smoothed facing, unwrapped, bridged where it is undefined."""
        return heading_of(self.facing[:, :2], FACING_SMOOTHING, self.fps)

    @cached_property
    def height(self) -> Array:
        """The smoothed height (T,) [m] by which the people are framed.

        The height of the box around everybody, or `LYING_SHARE` of the longest side of the largest person's box if
        that is more.
        """
        longest = (self.people_box_max - self.people_box_min).max(axis=(0, 2))
        extent = np.maximum(self.box_max[:, 2] - self.box_min[:, 2], LYING_SHARE * longest)
        return np.maximum(smooth(extent, EXTENT_SMOOTHING, self.fps), 0.1)

    @cached_property
    def span(self) -> Array:
        """The smoothed horizontal diagonal (T,) [m] of the box around everybody."""
        sides = self.box_max[:, :2] - self.box_min[:, :2]
        return np.maximum(smooth(np.hypot(sides[:, 0], sides[:, 1]), EXTENT_SMOOTHING, self.fps), 0.0)

    @cached_property
    def spread(self) -> Array:
        """The smoothed largest horizontal distance (T,) [m] of a neck from the mean neck; 0 for one person."""
        away = np.linalg.norm((self.people_neck - self.neck)[..., :2], axis=-1).max(axis=0)
        return np.maximum(smooth(away, EXTENT_SMOOTHING, self.fps), 0.0)


def _common_facing(pelvis: Array, facing: Array) -> Array:
    """The mean facing (T, 3) in the ground plane; across the group where the facings cancel each other out."""
    flat = facing.copy()
    flat[..., 2] = 0.0
    length = np.linalg.norm(facing, axis=-1, keepdims=True)
    mean: Array = (flat / np.where(length > 0.0, length, 1.0)).mean(axis=0)
    if len(pelvis) == 1:
        return mean
    across = _across(pelvis)
    if np.einsum("ti,ti->", across, mean) < 0.0:
        across = -across
    apart = np.linalg.norm(mean, axis=-1, keepdims=True) < OPPOSITE_FACING
    return np.where(apart, across, mean)


def _across(pelvis: Array) -> Array:
    """Unit direction (T, 3) in the ground plane that sees the people side by side, without sudden reversals."""
    offset = (pelvis - pelvis.mean(axis=0))[..., :2]
    xx, yy = (offset**2).sum(axis=0).T
    xy = (offset[..., 0] * offset[..., 1]).sum(axis=0)
    along = 0.5 * np.arctan2(2.0 * xy, xx - yy)
    across = np.stack([-np.sin(along), np.cos(along), np.zeros_like(along)], axis=-1)
    same = np.einsum("ti,ti->t", across[1:], across[:-1]) >= 0.0
    return across * np.cumprod(np.concatenate([[1.0], np.where(same, 1.0, -1.0)]))[:, None]
