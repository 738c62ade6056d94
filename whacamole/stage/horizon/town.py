"""Distant houses: gabled or flat, in rows one behind the other."""

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from render_jobs import Material
from whacamole.stage.shapes import Solid
from whacamole.stage.stage import SetBuilder
from whacamole.stage.textures.distance import distant_front, hazed

__all__ = ["Houses", "lit_windows", "roofs", "town"]

STOREY = 3.0
"""Height of a storey and width of a window's share of the front [m]."""

ROWS = ((98.0, (2, 5)), (124.0, (3, 7)))
"""Of a town: beyond the people's paths [m], and storeys."""

PITCH = 17.0
"""From house to house along a row [m]."""

LOTS = 0.88
"""Share of a row that is built on."""

STREET_LEVEL = -21.0
"""How far below a roof the ground is [m]."""

ROOF_ROWS = (
    (40.0, (-8.0, -3.5)),
    (62.0, (-7.0, -2.0)),
    (90.0, (-6.0, 2.0)),
    (125.0, (-5.0, 6.0)),
    (165.0, (-3.0, 12.0)),
    (215.0, (-2.0, 22.0)),
)
"""Around a roof: beyond the people's paths [m], and the height of the eaves over that roof [m]."""

ROOF_COLORS = ((0.46, 0.27, 0.20), (0.30, 0.30, 0.31), (0.42, 0.39, 0.36))
"""Tiles, slate, gravel."""

FRONTS = 3
"""Kinds of house fronts, and of roofs, in each haze."""

WINDOWS_LIT = 90

# Corners of a house: four at the foot, four at the eaves, the two ends of the ridge.
_WALLS = np.array(
    [[0, 1, 5], [0, 5, 4], [1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4], [3, 4, 7],
     [5, 6, 9], [7, 4, 8]]
)  # fmt: skip
_ROOF = np.array([[4, 5, 9], [4, 9, 8], [6, 7, 8], [6, 8, 9]])


@dataclass(frozen=True, eq=False)
class Houses:
    """Houses, an entry each.

    Attributes:
        place: (N, 3) middle of the underside [m].
        size: (N, 3) length of the front, depth, height of the eaves [m].
        ridge: (N,) height of the ridge over the eaves [m].
        yaw: (N,) turn about z [rad]; the front looks along −y.
    """

    place: NDArray[np.float64]
    size: NDArray[np.float64]
    ridge: NDArray[np.float64]
    yaw: NDArray[np.float64]

    def corners(self) -> NDArray[np.float64]:
        """(N, 10, 3) in the world [m]."""
        x, y = np.array([-1, 1, 1, -1] * 2 + [-1, 1]) / 2.0, np.array([-1, -1, 1, 1] * 2 + [0, 0]) / 2.0
        z = np.array([0.0] * 4 + [1.0] * 6)
        local = np.stack([x, y, z], axis=1) * self.size[:, None]
        local[:, 8:, 2] += self.ridge[:, None]
        return self.to_world(local)

    def to_world(self, local: NDArray[np.float64]) -> NDArray[np.float64]:
        """Bring points (N, K, 3) in the axes of each house into the world."""
        c, s = np.cos(self.yaw)[:, None], np.sin(self.yaw)[:, None]
        turned = [c * local[..., 0] - s * local[..., 1], s * local[..., 0] + c * local[..., 1], local[..., 2]]
        return np.asarray(np.stack(turned, axis=-1) + self.place[:, None])


def town(build: SetBuilder, center: NDArray[np.float64], reach: float, rng: np.random.Generator) -> Houses:
    """Build two rows of houses around a place, the rear ones higher and hazier; return the front row."""
    rows = []
    for index, (beyond, storeys) in enumerate(ROWS):
        place, yaw = _lots(center, reach + beyond, rng)
        height = STOREY * rng.integers(*storeys, len(yaw))
        row = _drawn_houses(place, yaw, 0.0, height, rng)
        _add(build, f"town-{index}", row, 0.15 + 0.2 * index, rng)
        rows.append(row)
    return rows[0]


def roofs(build: SetBuilder, center: NDArray[np.float64], reach: float, rng: np.random.Generator) -> None:
    """Build the town below a roof, hazier row by row."""
    for index, (beyond, eaves) in enumerate(ROOF_ROWS):
        place, yaw = _lots(center, reach + beyond, rng)
        height = rng.uniform(*eaves, len(yaw)) - STREET_LEVEL
        row = _drawn_houses(place, yaw, STREET_LEVEL, height, rng)
        _add(build, f"town-{index}", row, 0.03 + 0.05 * index, rng)
    streets = build.plain("streets", (0.33, 0.33, 0.34), roughness=0.9)
    half = reach + 420.0
    corners = np.array([[-half, -half], [half, -half], [half, half], [-half, half]]) + center
    level = np.column_stack([corners, np.full(4, STREET_LEVEL)]).astype(np.float32)
    build.add("streets", Solid(level, np.array([[0, 1, 2, 3]], np.int32), level[None, :, :2]), streets)


def lit_windows(build: SetBuilder, houses: Houses, rng: np.random.Generator) -> None:
    """Light a few windows of the fronts."""
    house = rng.integers(len(houses.yaw), size=WINDOWS_LIT)
    cells = (houses.size[house][:, [0, 2]] / STOREY).astype(int)
    column, row = (rng.uniform(0.0, 1.0, (2, WINDOWS_LIT)) * cells.T).astype(int)
    x = (column + 0.5) * STOREY - houses.size[house, 0] / 2.0
    z = (row + 0.5) * STOREY
    y = -houses.size[house, 1] / 2.0 - 0.05
    edge = np.array([[-0.5, -0.7], [0.5, -0.7], [0.5, 0.7], [-0.5, 0.7]])
    corners = np.stack(
        [x[:, None] + edge[:, 0], np.broadcast_to(y[:, None], (WINDOWS_LIT, 4)), z[:, None] + edge[:, 1]],
        axis=-1,
    )
    picked = Houses(houses.place[house], houses.size[house], houses.ridge[house], houses.yaw[house])
    vertices = picked.to_world(corners).reshape(-1, 3).astype(np.float32)
    faces = np.arange(4 * WINDOWS_LIT, dtype=np.int32).reshape(-1, 4)
    uv = np.broadcast_to(edge, (WINDOWS_LIT, 4, 2)).astype(np.float32)
    warm = build.plain("far-windows", (1.0, 0.78, 0.48), glow=0.8)
    build.add("far-windows", Solid(vertices, faces, uv), warm)


def _lots(
    center: NDArray[np.float64], radius: float, rng: np.random.Generator
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Draw places (N, 2) along a circle with gaps between, and the turn (N,) whose front looks inwards."""
    count = int(2.0 * np.pi * radius / PITCH)
    angle = (np.arange(count) + rng.uniform(-0.25, 0.25, count)) * (2.0 * np.pi / count)
    angle, away = angle + rng.uniform(0.0, 2.0 * np.pi), radius + rng.uniform(0.0, 12.0, count)
    place = center + away[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    built = rng.random(count) < LOTS
    yaw = angle - np.pi / 2.0 + rng.uniform(-0.2, 0.2, count)
    return place[built], yaw[built]


def _drawn_houses(
    place: NDArray[np.float64],
    yaw: NDArray[np.float64],
    foot: float,
    height: NDArray[np.float64],
    rng: np.random.Generator,
) -> Houses:
    """Draw houses of whole windows; two in three have a gable, the others are as good as flat."""
    count = len(yaw)
    length, depth = STOREY * rng.integers(3, 7, count), rng.uniform(8.0, 12.0, count)
    ridge = np.where(rng.random(count) < 0.65, rng.uniform(0.25, 0.5, count) * depth, 0.05)
    base = np.column_stack([place, np.full(count, foot)])
    return Houses(base, np.stack([length, depth, height], axis=1), ridge, yaw)


def _add(build: SetBuilder, name: str, houses: Houses, haze: float, rng: np.random.Generator) -> None:
    """Put houses on the set, in a few kinds of walls and roofs."""
    kind, roof_kind = rng.integers(FRONTS, size=(2, len(houses.yaw)))
    corners, corner_uv = houses.corners(), _wall_uv(houses)
    for index in range(FRONTS):
        paint = partial(distant_front, haze=haze)
        wall = build.material(f"{name}.front-{index}", paint, rng, metres=4.0 * STOREY)
        _add_faces(
            build, f"{name}.front-{index}", corners[kind == index], _WALLS, corner_uv[kind == index], wall
        )
        red, green, blue = (float(value) for value in hazed(np.asarray(ROOF_COLORS[index]), haze))
        roof = build.plain(f"{name}.roof-{index}", (red, green, blue), roughness=0.8)
        chosen = corners[roof_kind == index]
        flat = np.broadcast_to(np.zeros((4, 3, 2)), (len(chosen), 4, 3, 2))
        _add_faces(build, f"{name}.roof-{index}", chosen, _ROOF, flat, roof)


def _wall_uv(houses: Houses) -> NDArray[np.float64]:
    """(N, 10, 3, 2) metres along each wall and up it; whole windows from the left corner on."""
    length, depth, height = houses.size.T
    zero, top = np.zeros_like(length), height + houses.ridge
    across, up = [], []
    for side in (length, depth, length, depth):
        across += [np.stack([zero, side, side], 1), np.stack([zero, side, zero], 1)]
        up += [np.stack([zero, zero, height], 1), np.stack([zero, height, height], 1)]
    across += [np.stack([zero, depth, depth / 2.0], 1)] * 2
    up += [np.stack([height, height, top], 1)] * 2
    return np.stack([np.stack(across, 1), np.stack(up, 1)], axis=-1)


def _add_faces(
    build: SetBuilder,
    name: str,
    corners: NDArray[np.float64],
    faces: NDArray[np.int64],
    uv: NDArray[np.float64],
    material: Material,
) -> None:
    """Put the same faces of each house (N, 10, 3) on the set as one mesh; none without houses."""
    if not len(corners):
        return
    every = (faces + 10 * np.arange(len(corners))[:, None, None]).reshape(-1, 3)
    solid = Solid(
        corners.reshape(-1, 3).astype(np.float32),
        every.astype(np.int32),
        uv.reshape(-1, 3, 2).astype(np.float32),
    )
    build.add(name, solid, material)
