"""The lens, and the framing: which distance gives a wanted fraction of the view.

The paper's distance is r = h / (frac · tan(fov/2)) for aspect ≤ 1 and r = h · aspect / (frac · tan(fov/2))
for aspect > 1, where fov is the angle along the longer side of the image. Both say r = h / (frac ·
tan(vfov/2)) with the vertical angle, since tan(vfov/2) = tan(fov/2) / aspect in landscape. A view at
distance r is 2 r tan(vfov/2) high, so h must be **half** the height of the box for the box to fill `frac`
of it. Taken literally, with the whole height, the person fills half of what was asked.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from camera_rigs.errors import PlanError
from camera_rigs.spherical import Array

FULL_FRAME_WIDTH_MM = 36.0
"""Width of a full-frame sensor, against which focal lengths in millimetres are quoted."""


@dataclass(frozen=True)
class Lens:
    """A centred pinhole lens with square pixels.

    Attributes:
        width, height: image size [px].
        focal: focal length [px].
    """

    width: int
    height: int
    focal: float

    def __post_init__(self) -> None:
        if min(self.width, self.height) < 1 or not 0.0 < self.focal < np.inf:
            raise PlanError(
                f"lens {self.width}x{self.height}, focal length {self.focal} px: must be positive"
            )

    @classmethod
    def from_fov(cls, fov: float, width: int, height: int) -> "Lens":
        """A lens from the angle of view `fov` [rad] along the longer side of the image, the paper's way."""
        if not 0.0 < fov < np.pi:
            raise PlanError(f"field of view {np.degrees(fov):g}°: give an angle between 0° and 180°")
        return cls(width, height, float(max(width, height) / (2.0 * np.tan(fov / 2.0))))

    @classmethod
    def from_millimetres(cls, focal_mm: float, width: int, height: int) -> "Lens":
        """A lens from a full-frame focal length [mm]; the 36 mm of the sensor lie along the longer side."""
        return cls(width, height, focal_mm / FULL_FRAME_WIDTH_MM * max(width, height))

    @property
    def aspect(self) -> float:
        """Width over height: above 1 in landscape, below 1 in portrait."""
        return self.width / self.height

    @property
    def fov(self) -> float:
        """Angle of view along the longer side [rad]."""
        return float(2.0 * np.arctan(max(self.width, self.height) / (2.0 * self.focal)))

    @property
    def vertical_fov(self) -> float:
        """Angle of view along the height [rad]."""
        return float(2.0 * np.arctan(self.height / (2.0 * self.focal)))

    def intrinsics(self, focal: ArrayLike | None = None) -> Array:
        """K (3, 3), or (T, 3, 3) for focal lengths (T,) [px]; the principal point is (W/2, H/2)."""
        focal = np.asarray(self.focal if focal is None else focal, float)
        K = np.zeros((*focal.shape, 3, 3))
        K[..., 0, 0] = K[..., 1, 1] = focal
        K[..., 0, 2], K[..., 1, 2], K[..., 2, 2] = self.width / 2.0, self.height / 2.0, 1.0
        return K


def radius_for_fraction(h_bbox: ArrayLike, frac: ArrayLike, fov: ArrayLike, aspect: float) -> Array:
    """The paper's distance [m] at which a box fills `frac` of the height of the view, at eye level.

    Args:
        h_bbox: *half* the height of the box [m] (see the text of the module).
        frac: wanted fraction of the height of the view; above 1 the box is larger than the view.
        fov: angle of view along the longer side of the image [rad].
        aspect: width over height.
    """
    tangent = np.tan(np.asarray(fov, float) / 2.0)
    radius: Array = np.asarray(h_bbox, float) * max(aspect, 1.0) / (np.asarray(frac, float) * tangent)
    return radius


def framing_radius(
    above: ArrayLike, below: ArrayLike, frac: ArrayLike, theta: ArrayLike, focal: ArrayLike, height: float
) -> Array:
    """The distance [m] at which an upright extent fills `frac` of the view, from any polar angle.

    The extent reaches `above` and `below` [m] from the anchor that the camera looks at. Seen from the
    elevation e = π/2 − θ its ends lie at the depths r − above·sin e and r + below·sin e, so that its image
    is f cos e · r (above + below) / ((r − above·sin e)(r + below·sin e)) high. Solved for r this is a
    quadratic; at e = 0 it is the paper's formula.

    Args:
        above, below: extent over and under the anchor [m].
        frac: wanted fraction of the height of the view.
        theta: polar angle of the camera [rad].
        focal: focal length [px].
        height: height of the image [px].
    """
    a, b = np.asarray(above, float), np.asarray(below, float)
    sin_e, cos_e = np.cos(np.asarray(theta, float)), np.sin(np.asarray(theta, float))
    linear = np.asarray(focal, float) * cos_e * (a + b) / (np.asarray(frac, float) * height) - (b - a) * sin_e
    radius: Array = 0.5 * (linear + np.sqrt(linear**2 + 4.0 * a * b * sin_e**2))
    return radius


def achieved_fraction(
    above: ArrayLike, below: ArrayLike, r: ArrayLike, theta: ArrayLike, focal: ArrayLike, height: float
) -> Array:
    """The fraction of the height of the view that the extent fills: `framing_radius` inverted."""
    a, b, r = np.asarray(above, float), np.asarray(below, float), np.asarray(r, float)
    sin_e, cos_e = np.cos(np.asarray(theta, float)), np.sin(np.asarray(theta, float))
    image = np.asarray(focal, float) * cos_e * r * (a + b) / ((r - a * sin_e) * (r + b * sin_e))
    fraction: Array = image / height
    return fraction
