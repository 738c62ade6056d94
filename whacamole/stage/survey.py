"""Surveying a place of which only the triangles are known: where one can walk, and what is solid."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from camera_rigs import Obstacle

__all__ = ["Ground", "Solids", "survey_ground", "survey_solids", "world_triangles"]

Triangles = NDArray[np.float64]
"""(N, 3, 3) corners [m]."""

REACH = 60.0
"""Only so much of a place around the middle of its floor is surveyed [m]."""

CELL = 0.1
"""Edge of a cell of the ground [m]."""

STEP = 0.05
"""What rises less than this over the floor is the floor [m]."""

TOE, HEAD = 0.1, 2.0
"""What stands between these heights over the floor [m] is in the way of people."""

LEVEL = 0.9
"""Vertical component of the normal from which a surface can be stood on: a slope of 26°."""

VOXEL = 0.25
"""Edge of a cell of the solids [m]."""

AROUND = 12.0
"""Solids are surveyed to this distance beyond the floor [m]: walls may stand outside its edge."""

CEILING = 6.0
"""Up to here solids are of interest to a camera [m]."""

MOST_BOXES = 250
"""Solids are made coarser until no more boxes than this describe them."""

_LARGEST_EDGE = 1.0
_AT_ONCE = 200_000


@dataclass(frozen=True, eq=False)
class Ground:
    """Where one can walk.

    Attributes:
        low: (2,) corner of the first cell [m].
        clearance: (X, Y) distance of each cell's middle from what cannot be walked on [m]; 0 where one
            cannot walk.
    """

    low: NDArray[np.float64]
    clearance: NDArray[np.float64]

    def room(self, places: NDArray[np.float64]) -> NDArray[np.float64]:
        """Distance (…) [m] of places (…, 2) from what cannot be walked on, to a cell; 0 off the ground."""
        index = np.floor((places - self.low) / CELL).astype(np.int64)
        inside = ((index >= 0) & (index < self.clearance.shape)).all(axis=-1)
        index = np.where(inside[..., None], index, 0)
        return np.where(inside, self.clearance[index[..., 0], index[..., 1]], 0.0)

    @property
    def area(self) -> float:
        """Square metres on which one can walk."""
        return float((self.clearance > 0).sum() * CELL**2)


@dataclass(frozen=True, eq=False)
class Solids:
    """What a camera cannot pass, as a grid from the ground up.

    Attributes:
        low: (3,) corner of the first voxel [m].
        solid: (X, Y, Z) voxels that hold a surface, or that no one gets into.
    """

    low: NDArray[np.float64]
    solid: NDArray[np.bool_]

    def boxes(self, low: NDArray[np.float64], high: NDArray[np.float64]) -> tuple[Obstacle, ...]:
        """Boxes that cover all that is solid between the corners ``low`` and ``high`` (2,) [m]."""
        first = np.maximum(np.floor((low - self.low[:2]) / VOXEL).astype(int), 0)
        last = np.maximum(np.ceil((high - self.low[:2]) / VOXEL).astype(int), 0)
        grid = self.solid[first[0] : last[0], first[1] : last[1]]
        corner = self.low + VOXEL * np.array([*first, 0])
        edge = VOXEL
        found = _cover(grid)
        while len(found) > MOST_BOXES and max(grid.shape) > 2:
            grid, edge = _halved(grid), edge * 2
            found = _cover(grid)
        return tuple(
            Obstacle(
                _vector(corner + edge * (np.array(start) + stop) / 2),
                _vector(edge * (np.array(stop) - start)),
                name=f"solid-{index}",
            )
            for index, (start, stop) in enumerate(found)
        )


def survey_ground(floor: Triangles, everything: Triangles) -> Ground:
    """Find the largest connected part of ``floor`` at z = 0 that nothing stands on.

    Args:
        floor: what may be walked on, where it is level and at z = 0.
        everything: all triangles.
    """
    level = floor[_is_level(floor) & (np.abs(floor[..., 2]) <= STEP).all(axis=1)]
    if not len(level):
        return Ground(np.zeros(2), np.zeros((1, 1)))
    low, high = _extent(level)
    shape = tuple(np.ceil((high - low) / CELL).astype(int) + 1)
    walkable = np.zeros(shape, np.bool_)
    blocked = np.zeros(shape, np.bool_)
    for points in _samples(level, low, high, (-STEP, STEP), CELL * 0.7):
        _mark(walkable, ((points[:, :2] - low) / CELL).astype(int))
    for points in _samples(everything, low, high, (TOE, HEAD), CELL * 0.5):
        tall = (points[:, 2] > TOE) & (points[:, 2] < HEAD)
        _mark(blocked, ((points[tall, :2] - low) / CELL).astype(int))
    free = walkable & ~blocked
    label, count = ndimage.label(free)
    if count:
        free &= label == 1 + int(np.argmax(np.bincount(label.ravel())[1:]))
    padded = np.pad(free, 1)
    clearance = ndimage.distance_transform_edt(padded)[1:-1, 1:-1] * CELL - CELL / 2
    return Ground(low, np.maximum(clearance, 0.0))


def survey_solids(everything: Triangles, ground: Ground) -> Solids:
    """Find what is solid: where a surface is, and all that cannot be reached from the ground through air."""
    low = np.array([*(ground.low - AROUND), 0.0])
    high = ground.low + CELL * np.array(ground.clearance.shape) + AROUND
    shape = (*np.ceil((high - low[:2]) / VOXEL).astype(int), int(CEILING / VOXEL))
    surface = np.zeros(shape, np.bool_)
    for points in _samples(everything, low[:2], high, (TOE, CEILING), VOXEL * 0.5):
        raised = (points[:, 2] > TOE) & (points[:, 2] < CEILING)
        _mark(surface, ((points[raised] - low) / VOXEL).astype(int))
    label, _ = ndimage.label(~surface)
    feet = np.argwhere(ground.clearance > VOXEL)
    start = (((feet + 0.5) * CELL + AROUND) / VOXEL).astype(int)
    reached = set(np.unique(label[start[:, 0], start[:, 1], int(1.0 / VOXEL)])) - {0}
    return Solids(low, ~np.isin(label, list(reached)))


def world_triangles(
    vertices: NDArray[np.float32], faces: NDArray[np.int32], placements: NDArray[np.float64] | None
) -> Triangles:
    """Return the triangles of a mesh of triangles, with all its placements."""
    corners = vertices.astype(np.float64)[faces]
    if placements is None:
        return corners
    moved = np.einsum("nij,fcj->nfci", placements[:, :3, :3], corners) + placements[:, None, None, :3, 3]
    return np.asarray(moved.reshape(-1, 3, 3))


def _is_level(triangles: Triangles) -> NDArray[np.bool_]:
    normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    length = np.linalg.norm(normal, axis=1)
    return np.asarray(np.abs(normal[:, 2]) > LEVEL * np.maximum(length, 1e-12))


def _extent(level: Triangles) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The corners (2,) of the floor, cut to ``REACH`` around its middle."""
    flat = level[..., :2].reshape(-1, 2)
    middle = (flat.min(axis=0) + flat.max(axis=0)) / 2
    return np.maximum(flat.min(axis=0), middle - REACH), np.minimum(flat.max(axis=0), middle + REACH)


def _samples(
    triangles: Triangles,
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    heights: tuple[float, float],
    spacing: float,
) -> Iterator[Triangles]:
    """Points (N, 3) on triangles, at most ``spacing`` apart, between the corners and near the heights."""
    bottom, top = np.array([*low, heights[0]]), np.array([*high, heights[1]])
    for part in _small(triangles, bottom, top):
        longest = np.linalg.norm(part - np.roll(part, 1, axis=1), axis=2).max(axis=1)
        steps = np.maximum(np.ceil(longest / spacing), 1).astype(int)
        for count in np.unique(steps):
            chosen = part[steps == count]
            i, j = np.meshgrid(np.arange(count + 1), np.arange(count + 1), indexing="ij")
            keep = i + j <= count
            weights = np.stack([i[keep], j[keep], count - i[keep] - j[keep]], axis=1) / count
            for start in range(0, len(chosen), max(_AT_ONCE // len(weights), 1)):
                block = chosen[start : start + max(_AT_ONCE // len(weights), 1)]
                points = np.einsum("wc,tcx->twx", weights, block).reshape(-1, 3)
                inside = (points[:, :2] >= low).all(axis=1) & (points[:, :2] < high).all(axis=1)
                yield points[inside]


def _small(
    triangles: Triangles, bottom: NDArray[np.float64], top: NDArray[np.float64]
) -> Iterator[Triangles]:
    """Triangles cut at the middles of their edges until these are short, without those outside the box."""
    waiting = [triangles]
    while waiting:
        part = waiting.pop()
        part = part[(part.max(axis=1) >= bottom).all(axis=1) & (part.min(axis=1) <= top).all(axis=1)]
        if len(part) > _AT_ONCE:
            half = len(part) // 2
            waiting += [part[:half], part[half:]]
            continue
        longest = np.linalg.norm(part - np.roll(part, 1, axis=1), axis=2).max(axis=1)
        if (longest <= _LARGEST_EDGE).any():
            yield part[longest <= _LARGEST_EDGE]
        large = part[longest > _LARGEST_EDGE]
        if len(large):
            a, b, c = large[:, 0], large[:, 1], large[:, 2]
            ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
            corners = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
            waiting.append(np.concatenate([np.stack(corner, axis=1) for corner in corners]))


def _mark(grid: NDArray[np.bool_], index: NDArray[np.int64]) -> None:
    index = np.clip(index, 0, np.array(grid.shape) - 1)
    grid[tuple(index.T)] = True


def _halved(grid: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The grid with cells twice as large; one is solid if any of its parts is."""
    even = np.pad(grid, [(0, size % 2) for size in grid.shape])
    x, y, z = (size // 2 for size in even.shape)
    return np.asarray(even.reshape(x, 2, y, 2, z, 2).any(axis=(1, 3, 5)))


Cells = tuple[tuple[int, int, int], tuple[int, int, int]]


def _cover(grid: NDArray[np.bool_]) -> list[Cells]:
    """Boxes (first cell, cell past the last) that hold the solid cells and no other.

    Layer by layer, rows that are alike join to rectangles; rectangles that are alike join to boxes.
    """
    done: list[Cells] = []
    growing: dict[tuple[int, int, int, int], int] = {}
    for z in range(grid.shape[2] + 1):
        layer = _rectangles(grid[:, :, z]) if z < grid.shape[2] else set()
        for place in sorted(set(growing) - layer):
            x0, y0, x1, y1 = place
            done.append(((x0, y0, growing.pop(place)), (x1, y1, z)))
        for place in layer:
            growing.setdefault(place, z)
    return done


def _rectangles(layer: NDArray[np.bool_]) -> set[tuple[int, int, int, int]]:
    found: set[tuple[int, int, int, int]] = set()
    growing: dict[tuple[int, int], int] = {}
    edges = np.diff(np.pad(layer, [(0, 1), (1, 1)]).astype(np.int8), axis=1)
    for x, row in enumerate(edges):
        runs = set(zip(np.flatnonzero(row == 1).tolist(), np.flatnonzero(row == -1).tolist(), strict=True))
        for run in set(growing) - runs:
            found.add((growing.pop(run), run[0], x, run[1]))
        for run in runs:
            growing.setdefault(run, x)
    return found


def _vector(values: NDArray[np.float64]) -> tuple[float, float, float]:
    return float(values[0]), float(values[1]), float(values[2])
