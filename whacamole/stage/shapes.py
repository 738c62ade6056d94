"""The few solids that stages are built of, with UVs in metres so that textures keep their scale."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial.transform import Rotation

__all__ = [
    "Solid",
    "Vector",
    "bevelled_box",
    "box",
    "boxes",
    "cylinder",
    "ground_grid",
    "joined",
    "lathe",
    "moved",
    "prism",
    "strip",
    "tilted",
    "turned",
]


Vector = tuple[float, float, float]


@dataclass(frozen=True)
class Solid:
    """A static surface in world coordinates.

    Attributes:
        vertices: (V, 3) metres, z up.
        faces: (F, 3) or (F, 4) vertex indices, counter-clockwise seen from outside.
        uv: (F, 3|4, 2) metres along the face.
    """

    vertices: NDArray[np.float32]
    faces: NDArray[np.int32]
    uv: NDArray[np.float32]


def turned(solid: Solid, place: Vector, yaw: float) -> Solid:
    """Return a solid that was built about the origin, turned about z by ``yaw`` [rad] and put at a place."""
    vertices = solid.vertices @ _rotation(yaw).T + np.asarray(place)
    return replace(solid, vertices=vertices.astype(np.float32))


def moved(solid: Solid, offset: Vector) -> Solid:
    """Return a solid at another place."""
    return replace(solid, vertices=(solid.vertices + np.asarray(offset)).astype(np.float32))


def tilted(solid: Solid, rotvec: Vector, about: Vector = (0.0, 0.0, 0.0)) -> Solid:
    """Return a solid turned by a rotation vector [rad] about a point."""
    turn = Rotation.from_rotvec(rotvec).as_matrix()
    vertices = (solid.vertices - np.asarray(about)) @ turn.T + np.asarray(about)
    return replace(solid, vertices=vertices.astype(np.float32))


def joined(solids: Sequence[Solid]) -> Solid:
    """Return solids as one; where some are of triangles, all of it is."""
    if len({solid.faces.shape[1] for solid in solids}) > 1:
        solids = [_in_triangles(solid) for solid in solids]
    first = np.cumsum([0, *(len(solid.vertices) for solid in solids[:-1])])
    faces = [solid.faces + start for solid, start in zip(solids, first, strict=True)]
    return Solid(
        np.concatenate([solid.vertices for solid in solids]),
        np.concatenate(faces).astype(np.int32),
        np.concatenate([solid.uv for solid in solids]),
    )


def _in_triangles(solid: Solid) -> Solid:
    if solid.faces.shape[1] == 3:
        return solid
    halves = [[0, 1, 2], [0, 2, 3]]
    return Solid(
        solid.vertices,
        np.concatenate([solid.faces[:, half] for half in halves]),
        np.concatenate([solid.uv[:, half] for half in halves]),
    )


def strip(
    middle: NDArray[np.float64], along: NDArray[np.float64], length: float, width: float, z: float
) -> Solid:
    """Return a level rectangle about ``middle`` (2,), its length [m] along the unit vector ``along`` (2,)."""
    across = np.array([-along[1], along[0]])
    uv = np.array([(0.0, 0.0), (length, 0.0), (length, width), (0.0, width)])
    corners = middle + (uv - [length / 2.0, width / 2.0]) @ np.stack([along, across])
    vertices = np.column_stack([corners, np.full(4, z)])
    return Solid(vertices.astype(np.float32), np.array([[0, 1, 2, 3]], np.int32), uv[None].astype(np.float32))


def _rotation(yaw: float) -> NDArray[np.float64]:
    c, s = np.cos(yaw), np.sin(yaw)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def box(center: Vector, size: Vector, yaw: float = 0.0) -> Solid:
    """Return a box; ``center`` is the middle of its *base*, ``yaw`` turns it about z [rad]."""
    sx, sy, sz = size
    corners = np.array([(x, y, z) for z in (0.0, sz) for y in (-sy / 2, sy / 2) for x in (-sx / 2, sx / 2)])
    extents = [(sx, sz), (sy, sz), (sx, sz), (sy, sz), (sx, sy), (sx, sy)]
    uv = np.array([[(0, 0), (w, 0), (w, h), (0, h)] for w, h in extents])
    vertices = corners @ _rotation(yaw).T + np.asarray(center)
    return Solid(vertices.astype(np.float32), _BOX_FACES, uv.astype(np.float32))


_CORNERS = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], np.bool_)
_BOX_FACES = np.array(
    [[0, 1, 5, 4], [1, 3, 7, 5], [3, 2, 6, 7], [2, 0, 4, 6], [4, 5, 7, 6], [2, 3, 1, 0]], np.int32
)
_BOX_UV_AXES = np.array([(0, 2), (1, 2), (0, 2), (1, 2), (0, 1), (0, 1)])


def boxes(low: ArrayLike, high: ArrayLike, *, backless: bool = False) -> Solid:
    """Return many level boxes as one solid; a texture runs on from one to its neighbour.

    Args:
        low, high: (N, 3) opposite corners [m]; either may be (3,).
        backless: leave out the faces towards +y, which nobody sees of what lies on a wall.
    """
    bottom, top = np.broadcast_arrays(np.atleast_2d(low), np.atleast_2d(high))
    corners = np.where(_CORNERS, top[:, None], bottom[:, None])
    sides = [0, 1, 3, 4, 5] if backless else [0, 1, 2, 3, 4, 5]
    faces = _BOX_FACES[sides]
    uv = np.take_along_axis(corners[:, faces], _BOX_UV_AXES[sides][None, :, None], axis=-1)
    return Solid(
        corners.reshape(-1, 3).astype(np.float32),
        (faces + 8 * np.arange(len(corners))[:, None, None]).reshape(-1, 4).astype(np.int32),
        uv.reshape(-1, 4, 2).astype(np.float32),
    )


def cylinder(center: Vector, radius: float, height: float, sides: int = 24) -> Solid:
    """Return a closed upright cylinder; ``center`` is the middle of its base."""
    angle = np.arange(sides) * (2.0 * np.pi / sides)
    ring = np.stack([radius * np.cos(angle), radius * np.sin(angle), np.zeros(sides)], axis=1)
    vertices = np.concatenate([ring, ring + np.array([0.0, 0.0, height]), [[0.0, 0.0, height]]])
    here = np.arange(sides)
    there, middle = (here + 1) % sides, np.full(sides, 2 * sides)
    lower = np.stack([here, there, there + sides], axis=1)
    upper = np.stack([here, there + sides, here + sides], axis=1)
    lid = np.stack([here + sides, there + sides, middle], axis=1)
    left, right = here * (2.0 * np.pi * radius / sides), (here + 1) * (2.0 * np.pi * radius / sides)
    bottom, top = np.zeros(sides), np.full(sides, height)
    wall_uv = [[(left, bottom), (right, bottom), (right, top)], [(left, bottom), (right, top), (left, top)]]
    uv = [np.stack([np.stack(corner, axis=1) for corner in corners], axis=1) for corners in wall_uv]
    return Solid(
        (vertices + np.asarray(center)).astype(np.float32),
        np.concatenate([lower, upper, lid]).astype(np.int32),
        np.concatenate([*uv, vertices[lid][:, :, :2]]).astype(np.float32),
    )


def prism(outline: Sequence[tuple[float, float]], height: float) -> Solid:
    """Return an upright prism on z = 0 over a convex outline (N ≥ 3, counter-clockwise seen from above)."""
    return _lathe_of(np.asarray(outline, dtype=np.float64), [(1.0, 0.0), (1.0, height)])


def lathe(profile: Sequence[tuple[float, float]], sides: int = 16) -> Solid:
    """Return a round closed solid; ``profile`` is (radius, height) [m] from its underside to its top."""
    angle = np.arange(sides) * (2.0 * np.pi / sides)
    return _lathe_of(np.stack([np.cos(angle), np.sin(angle)], axis=1), profile)


def bevelled_box(size: Vector, bevel: float) -> Solid:
    """Return a box about the middle of its base, ``bevel`` [m] cut off its upright and its upper edges."""
    x, y = size[0] / 2.0, size[1] / 2.0
    cut = [(x - bevel, -y), (x, bevel - y), (x, y - bevel), (x - bevel, y),
           (bevel - x, y), (-x, y - bevel), (-x, bevel - y), (bevel - x, -y)]  # fmt: skip
    lower = np.asarray(cut)
    inner = lower * [(x - bevel) / x, (y - bevel) / y]
    return _stacked([(lower, 0.0), (lower, size[2] - bevel), (inner, size[2])])


def _lathe_of(outline: NDArray[np.float64], profile: Sequence[tuple[float, float]]) -> Solid:
    """Return a closed solid; its sections are an ``outline`` (N, 2) by the profile's (scale, height)."""
    return _stacked([(outline * scale, height) for scale, height in profile])


def _stacked(sections: Sequence[tuple[NDArray[np.float64], float]]) -> Solid:
    """Return level sections (N, 2) of one number of corners, lowest first, skinned and closed by lids."""
    corners = len(sections[0][0])
    rings = np.stack([np.column_stack([xy, np.full(corners, z)]) for xy, z in sections])
    vertices = np.concatenate([rings.reshape(-1, 3), rings[[0, -1]].mean(axis=1)])
    here = np.arange(corners)
    there = (here + 1) % corners
    # Metres around the widest section, and up the first corner's line, so that a texture keeps its scale.
    widest = max(rings, key=lambda ring: float(np.ptp(ring[:, 0])))
    around = np.concatenate([[0.0], np.linalg.norm(np.roll(widest, -1, axis=0) - widest, axis=1).cumsum()])
    up = np.concatenate([[0.0], np.linalg.norm(np.diff(rings[:, 0], axis=0), axis=1).cumsum()])
    faces, uv = [], []
    for level in range(len(rings) - 1):
        low, high = level * corners, (level + 1) * corners
        left, right = around[here], around[here + 1]
        bottom, top = np.full(corners, up[level]), np.full(corners, up[level + 1])
        faces += [
            np.stack([low + here, low + there, high + there], axis=1),
            np.stack([low + here, high + there, high + here], axis=1),
        ]
        uv += [
            np.stack(
                [np.stack([left, bottom], 1), np.stack([right, bottom], 1), np.stack([right, top], 1)], axis=1
            ),
            np.stack(
                [np.stack([left, bottom], 1), np.stack([right, top], 1), np.stack([left, top], 1)], axis=1
            ),
        ]
    middle = len(rings) * corners
    last = (len(rings) - 1) * corners
    lids = [
        np.stack([there, here, np.full(corners, middle)], axis=1),
        np.stack([last + here, last + there, np.full(corners, middle + 1)], axis=1),
    ]
    return Solid(
        vertices.astype(np.float32),
        np.concatenate([*faces, *lids]).astype(np.int32),
        np.concatenate([*uv, *(vertices[lid][:, :, :2] for lid in lids)]).astype(np.float32),
    )


def ground_grid(half_size: float, cells: int = 1) -> Solid:
    """Return a square floor at z = 0, ``2 · half_size`` wide, of ``cells`` × ``cells`` faces."""
    line = np.linspace(-half_size, half_size, cells + 1)
    x, y = np.meshgrid(line, line, indexing="xy")
    vertices = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=1)
    first = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    faces = np.stack([first, first + 1, first + cells + 2, first + cells + 1], axis=1)
    return Solid(
        vertices.astype(np.float32), faces.astype(np.int32), vertices[faces][:, :, :2].astype(np.float32)
    )
