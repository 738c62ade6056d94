"""What stands around the people: the ground, boxes in the way, and the walls of a room."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from camera_rigs.errors import PlanError
from camera_rigs.spherical import Array

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Obstacle:
    """A solid box in the way: a piece of furniture, a column, a wall. Turned by `yaw` about its upright axis.

    Attributes:
        center: centre (3,) [m].
        size: full side lengths (3,) [m] along its own axes.
        yaw: turn about z [rad].
        name: what it is, for findings.
    """

    center: Vector
    size: Vector
    yaw: float = 0.0
    name: str = "obstacle"

    def to_local(self, points: ArrayLike) -> Array:
        """Points (…, 3) of the world in the axes of the box, from its centre."""
        p = np.asarray(points, float) - np.asarray(self.center)
        cos, sin = np.cos(self.yaw), np.sin(self.yaw)
        return np.stack(
            [cos * p[..., 0] + sin * p[..., 1], cos * p[..., 1] - sin * p[..., 0], p[..., 2]], axis=-1
        )

    def distance(self, points: ArrayLike) -> Array:
        """Signed distance (…) [m] of points (…, 3) from the surface, negative inside."""
        gap = np.abs(self.to_local(points)) - 0.5 * np.asarray(self.size)
        outside: Array = np.linalg.norm(np.maximum(gap, 0.0), axis=-1)
        inside: Array = np.minimum(gap.max(axis=-1), 0.0)
        return outside + inside

    def hides(self, eye: ArrayLike, target: ArrayLike) -> Array:
        """Whether the box cuts the straight line from `eye` to `target`, (…) bool for points (…, 3)."""
        start, end = self.to_local(eye), self.to_local(target)
        return segment_cuts_box(start, end, -0.5 * np.asarray(self.size), 0.5 * np.asarray(self.size))


def segment_cuts_box(start: Array, end: Array, box_min: Array, box_max: Array) -> Array:
    """Whether segments (…, 3) pass through axis-aligned boxes (…, 3): the slab test, (…) bool."""
    step = end - start
    step = np.where(np.abs(step) < 1e-12, 1e-12, step)
    one, other = (box_min - start) / step, (box_max - start) / step
    enter = np.minimum(one, other).max(axis=-1)
    leave = np.maximum(one, other).min(axis=-1)
    cuts: Array = (enter <= leave) & (leave >= 0.0) & (enter <= 1.0)
    return cuts


@dataclass(frozen=True)
class World:
    """The surroundings of a take.

    Attributes:
        ground_z: height of the ground [m].
        obstacles: boxes that the camera neither enters nor lets hide the people for long.
        bounds: corners (min, max) of the room that the camera stays in [m]; None outdoors.
    """

    ground_z: float = 0.0
    obstacles: tuple[Obstacle, ...] = ()
    bounds: tuple[Vector, Vector] | None = None

    def __post_init__(self) -> None:
        if self.bounds is not None and not all(lo < hi for lo, hi in zip(*self.bounds, strict=True)):
            raise PlanError(f"room bounds {self.bounds}: each minimum must be below its maximum")
        for obstacle in self.obstacles:
            if min(obstacle.size) <= 0.0:
                raise PlanError(f"{obstacle.name} has size {obstacle.size}: every side must be positive")

    def wall_distance(self, points: ArrayLike) -> Array:
        """Distance (…) [m] of points (…, 3) from the nearest wall, floor excluded; infinite outdoors."""
        points = np.asarray(points, float)
        if self.bounds is None:
            return np.full(points.shape[:-1], np.inf)
        low, high = (np.asarray(corner) for corner in self.bounds)
        sideways = np.minimum(points[..., :2] - low[:2], high[:2] - points[..., :2]).min(axis=-1)
        gap: Array = np.minimum(sideways, high[2] - points[..., 2])
        return gap

    def obstacle_distance(self, points: ArrayLike) -> Array:
        """Signed distance (…) [m] of points (…, 3) from the nearest obstacle; infinite without any."""
        points = np.asarray(points, float)
        nearest = np.full(points.shape[:-1], np.inf)
        for obstacle in self.obstacles:
            nearest = np.minimum(nearest, obstacle.distance(points))
        return nearest

    def hides(self, eye: ArrayLike, target: ArrayLike) -> Array:
        """Whether any obstacle cuts the line from `eye` to `target`, (…) bool for points (…, 3)."""
        eye, target = np.broadcast_arrays(np.asarray(eye, float), np.asarray(target, float))
        hidden = np.zeros(eye.shape[:-1], dtype=bool)
        for obstacle in self.obstacles:
            hidden |= obstacle.hides(eye, target)
        return hidden

    def to_json(self) -> dict[str, Any]:
        """The surroundings as plain numbers, lists and dictionaries."""
        return asdict(self)

    @classmethod
    def from_json(cls, document: Mapping[str, Any]) -> "World":
        """The surroundings of `to_json`."""
        try:
            obstacles = tuple(
                Obstacle(_vector(o["center"]), _vector(o["size"]), float(o["yaw"]), str(o["name"]))
                for o in document["obstacles"]
            )
            bounds = document["bounds"]
            corners = None if bounds is None else (_vector(bounds[0]), _vector(bounds[1]))
            return cls(float(document["ground_z"]), obstacles, corners)
        except (KeyError, TypeError, ValueError) as error:
            raise PlanError(f"world: {error!r}: an entry is missing or of a wrong type") from error


def _vector(values: Any) -> Vector:
    x, y, z = values
    return float(x), float(y), float(z)
