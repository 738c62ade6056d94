"""Locks laid over a head of hair: MakeHuman's short hair is one smooth shell, which looks like a helmet.

A lock is a narrow ribbon that tapers to a point. It starts on the shell, runs along the strands painted
there, lifts off a little and ends in the air, so that outline and highlights break up as those of hair
do. It wears the shell's own picture.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import cKDTree

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SAMPLES: Final = 24000
"""Points that stand for the surface."""

STEPS: Final = 3
"""Pieces of a lock along its length."""

WIDTHS: Final = np.array([0.75, 1.0, 0.65])
"""Of a lock at its cross sections, as shares of the widest; the last one is a point."""

RISE: Final = np.array([-0.4, 0.4, 0.75, 1.0])
"""Height over the shell along the lock, as shares of the lift at its end; the root is sunk."""

DEPTH: Final = 0.012
"""Metres: what lies farther below the outermost surface is inside the hair and grows no locks."""

EDGE: Final = 0.004
"""Metres from the shell at which a lock has left it."""

OVERHANG: Final = 0.012
"""Metres that a lock goes on after it has left the shell."""

TUFTS: Final = 0.25
"""Radians a step by which the locks of a tuft turn aside together, at most."""

AGREED: Final = 0.8
"""Share of the strands around a point that run its way, from which a lock may start there."""

SOLID: Final = 0.9
"""Alpha from which a picture is whole."""


@dataclass(frozen=True)
class Style:
    """How the locks of a head of hair are.

    Attributes:
        count: how many.
        length, width: metres, of the longest and widest.
        lift: metres over the shell at the end, on average.
        roll: degrees by which locks are turned about their length, on average.
        tangle: radians by which they turn aside, on average; combed hair has little.
        floor: metres under the top of the hair below which nothing grows.
        parted: whether hair falls to either side of a line from front to back; else it runs from the
            crown.
    """

    count: int
    length: float = 0.045
    width: float = 0.0045
    lift: float = 0.0025
    roll: float = 20.0
    tangle: float = 0.12
    floor: float = 0.3
    parted: bool = False


@dataclass(frozen=True, eq=False)
class Locks:
    """Geometry to add to an item.

    Attributes:
        vertices: ``(n, 3)``; ``carrier``: ``(n,)`` the item's vertex that each moves with.
        faces: ``(F, 4)`` in numbers of their own, −1 in the fourth column of a triangle.
        uv: ``(n, 2)``, one a vertex.
    """

    vertices: Floats
    carrier: Ints
    faces: Ints
    uv: Floats


@dataclass(frozen=True, eq=False)
class _Surface:
    """Points of the outermost hair: position, normal, way of the strands, place in the picture, and whether
    the strands around them agree on a way."""

    at: Floats
    normal: Floats
    along: Floats
    uv: Floats
    clear: NDArray[np.bool_]


def grow(style: Style, vertices: Floats, faces: Ints, uv: Floats, uv_faces: Ints, pixels: Floats) -> Locks:
    """The locks of one head of hair.

    Args:
        style: how they are.
        vertices: ``(N, 3)`` of the hair on a head in the T-pose, y up, z ahead.
        faces: ``(F, 4)``, −1 in the fourth column of a triangle; ``uv`` and ``uv_faces`` likewise.
        pixels: ``(H, W, 4)`` its picture, 0..255.
    """
    rng = np.random.default_rng(0)
    surface = _surface(rng, style, vertices, faces, uv, uv_faces, pixels)
    roots = np.flatnonzero(surface.clear & (surface.at[:, 1] > vertices[:, 1].max() - style.floor))
    roots = roots[_spread(surface.at[roots], style.count)]
    tree = cKDTree(surface.at)
    count = len(roots)
    # Locks of one tuft run alike: the field is bent a little, more between places than within one.
    bend = rng.normal(0, style.tangle, (count, 1)) + TUFTS * _waves(surface.at[roots])[:, None]
    length = style.length * rng.uniform(0.6, 1.0, count)
    at, out, uvs = surface.at[roots], surface.normal[roots], surface.uv[roots]
    way = surface.along[roots]
    line, normals, places, ways = [at], [out], [uvs], [way]
    left = np.full(count, OVERHANG)
    for _ in range(STEPS):
        way = way + bend * np.cross(out, way)
        step = (length / STEPS)[:, None]
        ahead = at + step * way / np.linalg.norm(way, axis=1, keepdims=True)
        _, near = tree.query(ahead)
        gap = ahead - surface.at[near]
        height = (gap * surface.normal[near]).sum(axis=1, keepdims=True)
        flat = ahead - height * surface.normal[near]
        on = (np.linalg.norm(flat - surface.at[near], axis=1) < EDGE) & (left == OVERHANG)
        # Off the shell a lock goes straight on, for as long as it is allowed to.
        part = np.clip(left / step[:, 0], 0, 1)[:, None]
        left = np.where(on, left, np.clip(left - step[:, 0], 0, None) - 1e-9)
        at = np.where(on[:, None], flat, at + part * (ahead - at))
        out = np.where(on[:, None], surface.normal[near], out)
        uvs = np.where(on[:, None], surface.uv[near], uvs)
        way = np.where(on[:, None], surface.along[near], way)
        for known, new in zip((line, normals, places, ways), (at, out, uvs, way), strict=True):
            known.append(new)
    return _ribbons(rng, style, vertices, *(np.stack(x, axis=1) for x in (line, normals, places, ways)))


def _ribbons(
    rng: np.random.Generator,
    style: Style,
    vertices: Floats,
    line: Floats,
    out: Floats,
    uv: Floats,
    way: Floats,
) -> Locks:
    """Ribbons about middle lines ``(n, STEPS + 1, 3)``."""
    count = len(line)
    lift = style.lift * rng.gamma(2.0, 0.5, count)
    line = line + (RISE * np.clip(lift, 0.0008, 4 * style.lift)[:, None])[..., None] * out
    roll = np.radians(style.roll) * rng.normal(0, 1, (count, 1, 1))
    side = np.cross(out, way)
    side /= np.linalg.norm(side, axis=-1, keepdims=True)
    side = np.cos(roll) * side + np.sin(roll) * out
    half = 0.5 * style.width * rng.uniform(0.5, 1.0, (count, 1, 1)) * WIDTHS[None, :, None]
    rails = np.stack([line[:, :-1] - half * side[:, :-1], line[:, :-1] + half * side[:, :-1]], axis=2)
    points = np.concatenate([rails.reshape(count, -1, 3), line[:, -1:]], axis=1)
    places = np.concatenate([np.repeat(uv[:, :-1], 2, axis=1), uv[:, -1:]], axis=1)
    quads = [[2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2] for k in range(STEPS - 1)]
    one = np.array([*quads, [2 * STEPS - 2, 2 * STEPS - 1, 2 * STEPS, -1]])
    step = points.shape[1] * np.arange(count)[:, None, None]
    faces = np.where(one < 0, -1, one + step)
    # A lock is stiff: it moves with what is under its root.
    carrier = cKDTree(vertices).query(points)[1]
    return Locks(points.reshape(-1, 3), carrier.reshape(-1), faces.reshape(-1, 4), places.reshape(-1, 2))


def _surface(
    rng: np.random.Generator,
    style: Style,
    vertices: Floats,
    faces: Ints,
    uv: Floats,
    uv_faces: Ints,
    pixels: Floats,
) -> _Surface:
    """Points of the outermost solid surface, evenly."""
    corners, uv_corners = _triangles(faces), _triangles(uv_faces)
    triangle, flat = vertices[corners], uv[uv_corners]
    cross = np.cross(triangle[:, 1] - triangle[:, 0], triangle[:, 2] - triangle[:, 0])
    area = np.linalg.norm(cross, axis=1)
    chosen = rng.choice(len(area), SAMPLES, p=area / area.sum())
    share = rng.dirichlet(np.ones(3), SAMPLES)
    at = np.einsum("nk,nkc->nc", share, triangle[chosen])
    place = np.einsum("nk,nkc->nc", share, flat[chosen])
    normal = cross[chosen] / np.clip(area[chosen], 1e-12, None)[:, None]
    middle = _middle(vertices)
    normal *= np.where(((at - middle) * normal).sum(axis=1) < 0, -1.0, 1.0)[:, None]
    grain = _at(_grain(pixels), place, pixels.shape)
    along = np.einsum("nck,nk->nc", _lengthen(triangle, flat)[chosen], grain)
    along -= (along * normal).sum(axis=1, keepdims=True) * normal
    solid = ndimage.minimum_filter(pixels[..., 3], 5) > 255 * SOLID
    good = _at(solid, place, pixels.shape) & _outermost(at, middle) & (np.linalg.norm(along, axis=1) > 1e-9)
    at, normal, along, place = at[good], normal[good], along[good], place[good]
    near = np.asarray(cKDTree(at).query(at, k=24)[1], np.int64)
    normal = _unit(normal[near].mean(axis=1))
    combed, clear = _combed(at, normal, _unit(along), near, _origin(style, vertices, at))
    return _Surface(at, normal, combed, place, clear)


def _triangles(faces: Ints) -> Ints:
    second = faces[faces[:, 3] >= 0]
    return np.concatenate([faces[:, :3], second[:, [0, 2, 3]]])


def _unit(vectors: Floats) -> Floats:
    out: Floats = vectors / np.clip(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12, None)
    return out


def _middle(vertices: Floats) -> Floats:
    """The middle of the head under the hair: hair's top is the head's, its length may be anything."""
    top = vertices[:, 1].max()
    cap = vertices[vertices[:, 1] > top - 0.1]
    return np.array([0.0, top - 0.11, (cap[:, 2].min() + cap[:, 2].max()) / 2])


def _at(picture: NDArray[Any], place: Floats, shape: tuple[int, ...]) -> NDArray[Any]:
    """The pixels at texture coordinates, v up."""
    column = np.clip((place[:, 0] * shape[1]).astype(int), 0, shape[1] - 1)
    row = np.clip(((1 - place[:, 1]) * shape[0]).astype(int), 0, shape[0] - 1)
    out: NDArray[Any] = picture[row, column]
    return out


def _grain(pixels: Floats) -> Floats:
    """``(H, W, 2)`` the way of the strands in (u, v), of either sign: along it a picture changes least."""
    light = pixels[..., :3].mean(axis=2) * (pixels[..., 3] / 255)
    rows, columns = (ndimage.gaussian_filter(light, 1.0, order=order) for order in ((1, 0), (0, 1)))
    a, b, c = (ndimage.gaussian_filter(x, 6.0) for x in (columns * columns, columns * rows, rows * rows))
    angle = 0.5 * np.arctan2(2 * b, a - c) + np.pi / 2  # (column, row) of the smaller eigenvalue
    return np.stack([np.cos(angle), -np.sin(angle)], axis=2)


def _lengthen(triangle: Floats, flat: Floats) -> Floats:
    """``(F, 3, 2)`` what a step in (u, v) is on the surface."""
    edges = (triangle[:, 1:] - triangle[:, :1]).transpose(0, 2, 1)
    steps = (flat[:, 1:] - flat[:, :1]).transpose(0, 2, 1)
    sound = np.abs(np.linalg.det(steps)) > 1e-12
    steps = np.where(sound[:, None, None], steps, np.eye(2))
    return np.where(sound[:, None, None], edges @ np.linalg.inv(steps), 0.0)


def _outermost(at: Floats, middle: Floats) -> NDArray[np.bool_]:
    """What no hair lies over, seen from the middle of the head."""
    offset = at - middle
    radius = np.linalg.norm(offset, axis=1)
    tree = cKDTree(offset / radius[:, None])
    _, near = tree.query(offset / radius[:, None], k=16, distance_upper_bound=0.08)
    farthest = np.append(radius, 0.0)[near].max(axis=1)
    out: NDArray[np.bool_] = radius > farthest - DEPTH
    return out


def _origin(style: Style, vertices: Floats, at: Floats) -> Floats:
    """Where the strands at some points come from: the crown, or the nearest place of the parting."""
    crown = _middle(vertices) + np.array([0.0, 0.11, -0.04])
    origin = np.broadcast_to(crown, at.shape).copy()
    if style.parted:
        origin[:, 2] = at[:, 2]
    return origin


def _combed(
    at: Floats, normal: Floats, along: Floats, near: Ints, origin: Floats
) -> tuple[Floats, NDArray[np.bool_]]:
    """Strands' ways made one with their neighbours', pointing away from where they come from; and where
    the neighbours agree."""
    values, axes = np.linalg.eigh(np.einsum("nki,nkj->nij", along[near], along[near]))
    along = axes[:, :, 2]
    along = along * np.where((along * (at - origin)).sum(axis=1) < 0, -1.0, 1.0)[:, None]
    mean = along[near].mean(axis=1)
    agree = (values[:, 2] > AGREED * near.shape[1]) & (np.linalg.norm(mean, axis=1) > AGREED)
    mean -= (mean * normal).sum(axis=1, keepdims=True) * normal
    return _unit(mean), agree


def _spread(at: Floats, count: int) -> Ints:
    """``count`` points evenly over all: each the farthest of a few from those chosen before."""
    chosen = np.empty(min(count, len(at)), np.int64)
    distance = np.full(len(at), np.inf)
    index = 0
    for k in range(len(chosen)):
        chosen[k] = index
        distance = np.minimum(distance, ((at - at[index]) ** 2).sum(axis=1))
        index = int(distance.argmax())
    return chosen


def _waves(at: Floats) -> Floats:
    """A smooth field in −1..1 over a few centimetres."""
    out: Floats = np.sin(at @ [130.0, 70.0, 90.0]) * np.cos(at @ [-60.0, 110.0, 140.0])
    return out
