"""What stands around the people: the ground, boxes in the way, and the walls of a room."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
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

    def distance(self, points: ArrayLike) -> Array:
        """Signed distance (…) [m] of points (…, 3) from the surface, negative inside."""
        return Boxes.of([self]).distance(points)[..., 0]

    def hides(self, eye: ArrayLike, target: ArrayLike) -> Array:
        """Whether the box cuts the straight line from `eye` to `target`, (…) bool for points (…, 3)."""
        return Boxes.of([self]).cut(eye, target)[..., 0]


@dataclass(frozen=True)
class Boxes:
    """Obstacles as arrays, so that all of them are asked at once.

    Attributes:
        center: centres (O, 3) [m].
        half: half side lengths (O, 3) [m].
        cos, sin: of the turn about z (O,).
    """

    center: Array
    half: Array
    cos: Array
    sin: Array

    @classmethod
    def of(cls, obstacles: Sequence[Obstacle]) -> "Boxes":
        """The arrays of `obstacles`."""
        yaw = np.array([obstacle.yaw for obstacle in obstacles])
        center = np.array([obstacle.center for obstacle in obstacles], float).reshape(-1, 3)
        size = np.array([obstacle.size for obstacle in obstacles], float).reshape(-1, 3)
        return cls(center, 0.5 * size, np.cos(yaw), np.sin(yaw))

    def to_local(self, points: ArrayLike) -> Array:
        """Points (…, 3) of the world in the axes of each box, from its centre (…, O, 3)."""
        p = np.asarray(points, float)[..., None, :] - self.center
        x = self.cos * p[..., 0] + self.sin * p[..., 1]
        y = self.cos * p[..., 1] - self.sin * p[..., 0]
        return np.stack([x, y, p[..., 2]], axis=-1)

    def distance(self, points: ArrayLike) -> Array:
        """Signed distance (…, O) [m] of points (…, 3) from each surface, negative inside."""
        gap = np.abs(self.to_local(points)) - self.half
        outside: Array = np.linalg.norm(np.maximum(gap, 0.0), axis=-1)
        inside: Array = np.minimum(gap.max(axis=-1), 0.0)
        return outside + inside

    def cut(self, eye: ArrayLike, target: ArrayLike) -> Array:
        """Whether each box cuts the lines from `eye` to `target` (…, 3): the slab test, (…, O) bool."""
        start, end = self.to_local(eye), self.to_local(target)
        step = end - start
        step = np.where(np.abs(step) < 1e-12, 1e-12, step)
        one, other = (-self.half - start) / step, (self.half - start) / step
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

    @cached_property
    def _boxes(self) -> Boxes:
        return Boxes.of(self.obstacles)

    def obstacle_distance(self, points: ArrayLike) -> Array:
        """Signed distance (…) [m] of points (…, 3) from the nearest obstacle; infinite without any."""
        nearest: Array = self._boxes.distance(points).min(axis=-1, initial=np.inf)
        return nearest

    def hides(self, eye: ArrayLike, target: ArrayLike) -> Array:
        """Whether any obstacle cuts the line from `eye` to `target`, (…) bool for points (…, 3)."""
        hidden: Array = self._boxes.cut(eye, target).any(axis=-1)
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
