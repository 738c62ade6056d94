"""What the camera films: `SubjectTrack`, the anchors, the facing and the boxes of one person or several."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.ndimage import maximum_filter1d

from camera_rigs.errors import PlanError
from camera_rigs.smoothing import heading_of, rate_of_change, smooth
from camera_rigs.spherical import Array

ANCHOR_SMOOTHING = 0.6
"""Standard deviation [s] of the anchor's low-pass: takes out the bounce of a walk and most of the sway of a
dance (0.5 Hz to 17 %), which would swing a camera that travels with it; keeps the way of a walk to 0.4 m in
a turn."""

FACING_SMOOTHING = 0.5
"""Standard deviation [s] of the facing's low-pass: takes out nods and hip swing, leaves turns."""

EXTENT_SMOOTHING = 0.5
"""Standard deviation [s] of the boxes' low-pass: an arm thrown up is no reason to step back."""

OPPOSITE_FACING = 0.5
"""A mean facing shorter than this: the people face each other or turn away; the camera looks across."""

LYING_SHARE = 0.6
"""A person is framed as at least this share of the longest side of the box: who lies is not small."""

FORESIGHT_SECONDS = 3.0
"""How long before and after [s] the crew knows the choreography when it chooses a distance to stand off."""

TRAVEL_SMOOTHING = 1.0
"""Standard deviation [s] of the low-pass of the direction of travel."""

WALKING_SPEED = 0.5
"""Speed [m/s] from which the direction of travel is certain; slower people have less of one."""

MIN_HEIGHT = 0.1
"""Smallest height [m] that is framed, so that no data make the camera fall into its anchor."""


@dataclass(frozen=True)
class SubjectTrack:
    """One person or several over T frames; world z up, metres. Build it with `from_people`.

    Attributes:
        pelvis: mean of the pelvis joints (T, 3), the anchor of full and long shots.
        neck: mean of the neck joints (T, 3), the anchor of medium shots and close-ups.
        facing: direction (T, 3) in the ground plane; its length, 0 to 1, tells how certain it is.
        box_min, box_max: axis-aligned box around everybody (T, 3).
        people_pelvis, people_neck, people_facing, people_box_min, people_box_max: per person (P, T, 3).
        fps: frames per second.
    """

    pelvis: Array
    neck: Array
    facing: Array
    box_min: Array
    box_max: Array
    people_pelvis: Array
    people_neck: Array
    people_facing: Array
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
            facing: direction that each person faces (P, T, 3), of any length and tilt. The part in the ground
                plane counts: someone who lies on the back faces nowhere.
            box_min, box_max: axis-aligned box of each person (P, T, 3) [m].
            fps: frames per second.

        Raises:
            PlanError: the arrays differ in shape, are empty or hold values that are not finite.
        """
        names = ("pelvis", "neck", "facing", "box_min", "box_max")
        arrays = [np.asarray(array, float) for array in (pelvis, neck, facing, box_min, box_max)]
        for name, array in zip(names, arrays, strict=True):
            if array.ndim != 3 or array.shape[2] != 3 or array.shape != arrays[0].shape or not array.size:
                raise PlanError(f"{name} has shape {array.shape}: all must be (people, frames, 3), not empty")
            if not np.isfinite(array).all():
                raise PlanError(f"{name} holds values that are not finite: repair the motion first")
        if not 0.0 < fps < np.inf:
            raise PlanError(f"fps is {fps}: give a positive frame rate")
        p, n, f, low, high = arrays
        if (high < low).any():
            raise PlanError("box_max lies below box_min: exchange the two")
        mean = (p.mean(0), n.mean(0), _common_facing(p, f), low.min(0), high.max(0))
        return cls(*mean, p, n, f, low, high, float(fps))

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
        """The smoothed anchor (T, 3) called `name`, "pelvis" or "neck"."""
        return self.smooth_neck if name == "neck" else self.smooth_pelvis

    @cached_property
    def smooth_people_neck(self) -> Array:
        """Everybody's neck (P, T, 3) without bounce and nod."""
        return np.stack([smooth(neck, ANCHOR_SMOOTHING, self.fps) for neck in self.people_neck])

    @cached_property
    def velocity(self) -> Array:
        """Velocity (T, 3) [m/s] of the smoothed pelvis anchor."""
        if self.num_frames < 2:
            return np.zeros_like(self.pelvis)
        velocity: Array = np.gradient(self.smooth_pelvis, axis=0) * self.fps
        return velocity

    @cached_property
    def travel_azimuth(self) -> Array:
        """Azimuth (T,) [rad] of the way that the people go, unwrapped, bridged where they stand."""
        flat = self.velocity[:, :2]
        speed = np.linalg.norm(flat, axis=-1, keepdims=True)
        return heading_of(flat / np.maximum(speed, WALKING_SPEED), TRAVEL_SMOOTHING, self.fps)

    @cached_property
    def azimuth(self) -> Array:
        """Azimuth φ_facing (T,) [rad] of the smoothed facing, unwrapped, bridged where it is undefined."""
        return heading_of(self.facing[:, :2], FACING_SMOOTHING, self.fps)

    @cached_property
    def height(self) -> Array:
        """The smoothed height (T,) [m] by which the people are framed.

        The height of the box around everybody, or `LYING_SHARE` of the longest side of anybody's own box if
        that is more.
        """
        longest = (self.people_box_max - self.people_box_min).max(axis=(0, 2))
        extent = np.maximum(self.box_max[:, 2] - self.box_min[:, 2], LYING_SHARE * longest)
        return np.maximum(smooth(extent, EXTENT_SMOOTHING, self.fps), MIN_HEIGHT)

    def extent(self, anchor: str) -> tuple[Array, Array]:
        """How far (T,) [m] the framed height reaches above and below the anchor, as the box does."""
        return self._extents[anchor]

    @cached_property
    def _extents(self) -> dict[str, tuple[Array, Array]]:
        extents = {}
        size = np.maximum(self.box_max[:, 2] - self.box_min[:, 2], 1e-6)
        for name, joint in (("pelvis", self.pelvis), ("neck", self.neck)):
            over = np.clip((self.box_max[:, 2] - joint[:, 2]) / size, 0.0, 1.0)
            share = np.clip(smooth(over, EXTENT_SMOOTHING, self.fps), 0.0, 1.0)
            extents[name] = (share * self.height, (1.0 - share) * self.height)
        return extents

    @cached_property
    def span(self) -> Array:
        """The horizontal diagonal (T,) [m] of the box around everybody, the widest of the seconds around."""
        sides = self.box_max[:, :2] - self.box_min[:, :2]
        return self._foreseen(np.hypot(sides[:, 0], sides[:, 1]))

    @cached_property
    def spread(self) -> Array:
        """The widest horizontal distance (T,) [m] of a neck from the mean neck in the seconds around."""
        away = np.linalg.norm((self.people_neck - self.neck)[..., :2], axis=-1)
        return self._foreseen(away.max(axis=0))

    def reach(self, anchor: str) -> Array:
        """How far (T,) [m] the people reach sideways from the smoothed anchor in the seconds around."""
        return self._reaches[anchor]

    @cached_property
    def _reaches(self) -> dict[str, Array]:
        reaches = {}
        for name in ("pelvis", "neck"):
            center = self.anchor(name)[:, :2]
            corner = np.maximum(center - self.box_min[:, :2], self.box_max[:, :2] - center)
            reaches[name] = self._foreseen(np.hypot(corner[:, 0], corner[:, 1]))
        return reaches

    def _foreseen(self, signal: Array) -> Array:
        widest: Array = maximum_filter1d(signal, 2 * round(FORESIGHT_SECONDS * self.fps) + 1, mode="nearest")
        return widest

    @cached_property
    def _motion_bounds(self) -> dict[int, float]:
        anchors = (self.smooth_pelvis, self.smooth_neck, *self.smooth_people_neck)
        return {
            order: max(float(rate_of_change(anchor, order, self.fps).max(initial=0.0)) for anchor in anchors)
            for order in (1, 2, 3)
        }

    def motion_bound(self, order: int) -> float:
        """The largest derivative of that order, 1 to 3, of the smoothed anchors over the clip [m/s^order]."""
        return self._motion_bounds[order]

    def rounded(self) -> "SubjectTrack":
        """The same people to the millimetre: what is planned for is what `to_json` stores."""
        return self.from_people(
            self.people_pelvis.round(3),
            self.people_neck.round(3),
            self.people_facing.round(3),
            self.people_box_min.round(3),
            self.people_box_max.round(3),
            self.fps,
        )

    def to_json(self) -> dict[str, Any]:
        """The subject as plain lists, rounded to the millimetre: what a judge of the plan needs later."""
        return {
            "fps": self.fps,
            "pelvis": self.people_pelvis.round(3).tolist(),
            "neck": self.people_neck.round(3).tolist(),
            "facing": self.people_facing.round(3).tolist(),
            "box_min": self.people_box_min.round(3).tolist(),
            "box_max": self.people_box_max.round(3).tolist(),
        }

    @classmethod
    def from_json(cls, document: Mapping[str, Any]) -> "SubjectTrack":
        """The subject of `to_json`."""
        try:
            lists = [document[name] for name in ("pelvis", "neck", "facing", "box_min", "box_max", "fps")]
            return cls.from_people(*lists)
        except (KeyError, TypeError) as error:
            raise PlanError(f"subject: {error} is missing or of a wrong type: write the plan anew") from error


def _common_facing(pelvis: Array, facing: Array) -> Array:
    """The mean facing (T, 3) in the ground plane; across the group where the facings cancel out."""
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
    """Direction (T, 3) in the ground plane that sees the people side by side, without sudden reversals."""
    offset = (pelvis - pelvis.mean(axis=0))[..., :2]
    xx, yy = (offset**2).sum(axis=0).T
    xy = (offset[..., 0] * offset[..., 1]).sum(axis=0)
    along = 0.5 * np.arctan2(2.0 * xy, xx - yy)
    across = np.stack([-np.sin(along), np.cos(along), np.zeros_like(along)], axis=-1)
    same = np.einsum("ti,ti->t", across[1:], across[:-1]) >= 0.0
    sign: Array = np.cumprod(np.concatenate([[1.0], np.where(same, 1.0, -1.0)]))
    steady: Array = across * sign[:, None]
    return steady
