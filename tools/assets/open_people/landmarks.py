"""The 51 face landmarks and the 17 of the face's outline, on this body.

Order and meaning are those of the ``smplx`` package (the 68 points of the face-alignment literature,
outline last). Each point is a vertex: found on the mean shape by what it is (the corner of the lips, the
lowest point of the lower lid), on the left, and mirrored.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from open_people.base_mesh import BODY_VERTICES, BaseMesh
from open_people.covering import skin_normals

Array = NDArray[np.float64]

BROW_AT: Final = (0.03, 0.27, 0.51, 0.75, 0.97)
"""Where along the brow, from its inner end, the five points lie."""

MOUTH_TOP: Final = (0.6, 0.22)
MOUTH_BOTTOM: Final = (0.62, 0.28)
MOUTH_INSIDE: Final = 0.33
MOUTH_INNER_CORNER: Final = 0.85
"""Shares of half the width of the mouth at which its points lie, from the middle."""

OUTLINE_DEG: Final = (2, 14, 26, 38, 50, 61, 72, 82)
"""Directions of the outline's points in the frontal plane, from straight sideways (the ear) down to the
chin's side."""

OUTLINE_CENTRE: Final = (0.0, 0.262)
"""Point of the frontal plane (x, y) from which those directions are taken: between the eyes."""

UNDER_THE_JAW: Final = (-0.8, -0.2)
"""Skin whose normal points further down, or further back, than this (y, z) lies under the jaw, not on its
edge."""

FORWARD: Final = 0.3
"""Towards the chin, of two points equally far out the one in front wins, by this much."""

YAWS: Final = 39
"""The outline is tabled for head turns of up to this many degrees to either side."""


@dataclass(frozen=True, eq=False)
class Face:
    """What the points are found on.

    Attributes:
        mesh: the base mesh.
        vertices: ``(N, 3)`` mean shape in the T-pose.
        masks: folder with the region pictures of the package.
        lower: ``(BODY_VERTICES,)`` which skin vertices move with the jaw.
        head: ``(BODY_VERTICES,)`` which move with the head or the jaw, not with the neck.
        brow: ``(n, 3)`` vertices of an eyebrow item on this shape.
    """

    mesh: BaseMesh
    vertices: Array
    masks: Path
    lower: NDArray[np.bool_]
    head: NDArray[np.bool_]
    brow: Array

    @cached_property
    def skin(self) -> Array:
        """``(BODY_VERTICES, 3)``."""
        return self.vertices[:BODY_VERTICES]

    def region(self, name: str) -> NDArray[np.int64]:
        """Skin vertices that a region picture marks, by its name: lips, eyelids, face, ears."""
        with Image.open(self.masks / f"mpfb_{name}.jpg") as image:
            mask = np.asarray(image.convert("L"))
        chosen = self.mesh.faces_of("body")
        uv = np.zeros((BODY_VERTICES, 2))
        uv[self.mesh.quads[chosen].ravel()] = self.mesh.uv[self.mesh.uv_quads[chosen].ravel()]
        column = np.clip((uv[:, 0] * mask.shape[1]).astype(int), 0, mask.shape[1] - 1)
        row = np.clip(((1 - uv[:, 1]) * mask.shape[0]).astype(int), 0, mask.shape[0] - 1)
        return np.flatnonzero(mask[row, column] > 128)

    @cached_property
    def normals(self) -> Array:
        """``(BODY_VERTICES, 3)`` unit normals."""
        return skin_normals(self.mesh, self.vertices)

    def nearest(self, point: Array, among: NDArray[np.int64]) -> int:
        """The vertex nearest to a point."""
        return int(among[np.argmin(np.linalg.norm(self.skin[among] - point, axis=1))])

    def middle_line(self) -> NDArray[np.int64]:
        """Skin vertices of the face on x = 0, from the top down."""
        line = self.region("face")
        line = line[np.abs(self.skin[line, 0]) < 1e-4]
        return line[np.argsort(-self.skin[line, 1])]


def face_landmarks(face: Face) -> NDArray[np.int64]:
    """``(51,)`` base-mesh vertices."""
    mirror = face.mesh.mirror
    brow, eye = _brow(face), _eye(face)
    bridge, base, wings = _nose(face)
    outer, inner = _mouth(face)
    right_brow, left_brow = [mirror[k] for k in brow[::-1]], brow
    # An eye goes from its outer corner over the upper lid on the right, from its inner corner on the left.
    right_eye = [mirror[k] for k in eye]
    left_eye = [eye[k] for k in (3, 2, 1, 0, 5, 4)]
    nostrils = [mirror[wings[0]], mirror[wings[1]], base, wings[1], wings[0]]
    return np.array(
        [*right_brow, *left_brow, *bridge, *nostrils, *right_eye, *left_eye, *outer, *inner], np.int64
    )


def _brow(face: Face) -> list[int]:
    """Five vertices of the left brow from its inner to its outer end."""
    left = face.brow[face.brow[:, 0] > 0]
    inner, outer = left[:, 0].min(), left[:, 0].max()
    out = []
    for share in BROW_AT:
        x = inner + share * (outer - inner)
        near = left[np.argsort(np.abs(left[:, 0] - x))[:8]]
        out.append(face.nearest(np.array([x, *near[:, 1:].mean(axis=0)]), face.region("face")))
    return out


def _eye(face: Face) -> list[int]:
    """Left eye: outer corner, upper lid twice, inner corner, lower lid twice."""
    upper, lower = (face.vertices[face.mesh.vertex_groups[f"helper-l-eyelashes-{k}"]] for k in (2, 1))
    lids = face.region("eyelids")
    lids = lids[face.skin[lids, 0] > 0]
    both = np.concatenate([upper, lower])
    # The lashes begin at the rim of the lids: nearest to the slit between them.
    inner_x, outer_x = both[:, 0].min(), np.quantile(both[:, 0], 0.8)
    corners = [both[np.argsort(np.abs(both[:, 0] - x))[:4]].mean(axis=0) for x in (outer_x, inner_x)]

    def rim(lashes: Array, share: float, sign: float) -> Array:
        x = outer_x + share * (inner_x - outer_x)
        near = lashes[np.abs(lashes[:, 0] - x) < 0.004]
        return near[np.argmin(sign * near[:, 1])] * [0, 1, 1] + [x, 0, 0]

    points = [
        corners[0], rim(upper, 1 / 3, 1), rim(upper, 2 / 3, 1),
        corners[1], rim(lower, 2 / 3, -1), rim(lower, 1 / 3, -1),
    ]  # fmt: skip
    return [face.nearest(point, lids) for point in points]


def _nose(face: Face) -> tuple[list[int], int, list[int]]:
    """Bridge from the root to the tip (4), the base in the middle, the left wing (outer, inner)."""
    line = face.middle_line()
    at = face.skin[line]
    tip = int(np.argmax(at[:, 2]))
    root_y = face.vertices[face.mesh.vertex_groups["helper-l-eye"]][:, 1].mean() + 0.004
    heights = np.linspace(root_y, at[tip, 1], 4)
    front = at[:, 2] > at[tip, 2] - 0.035
    bridge = [int(line[np.argmin(np.abs(at[:, 1] - y) + ~front)]) for y in heights]
    # Below the tip the profile goes back to the base of the nose, then forward again to the lip.
    lip = face.skin[face.region("lips"), 1].max()
    below = np.flatnonzero((at[:, 1] < at[tip, 1]) & (at[:, 1] > lip + 0.002) & front)
    base = int(line[below[np.argmin(at[below, 2])]])
    wings = []
    eye_gap = face.vertices[face.mesh.vertex_groups["helper-l-eyelashes-1"]][:, 0].min()
    for x, forward, up in ((eye_gap, -0.004, 0.006), (0.5 * eye_gap, 0.004, 0.001)):
        point = face.skin[base] + [x, up, forward]
        wings.append(face.nearest(point, face.region("face")))
    return bridge, base, wings


def _mouth(face: Face) -> tuple[list[int], list[int]]:
    """Outer (12) and inner (8) contour of the lips, from the right corner over the upper lip."""
    lips = face.region("lips")
    left = lips[face.skin[lips, 0] > -1e-4]
    half = face.skin[left, 0].max()
    corner = int(left[np.argmax(face.skin[left, 0])])
    upper, lower = left[~face.lower[left]], left[face.lower[left]]

    def at(among: NDArray[np.int64], share: float, sign: float, depth: float) -> int:
        """The extreme vertex of a column, of those that stand at the front."""
        x = share * half
        column = among[np.argsort(np.abs(face.skin[among, 0] - x), kind="stable")[:14]]
        column = column[np.abs(face.skin[column, 0] - x) < (0.0035 if share else 1e-4)]
        front = column[face.skin[column, 2] > face.skin[column, 2].max() - depth]
        return int(front[np.argmax(sign * face.skin[front, 1])])

    top = [at(upper, share, 1, 0.02) for share in (*MOUTH_TOP, 0.0)]
    bottom = [at(lower, share, -1, 0.02) for share in (*MOUTH_BOTTOM, 0.0)]
    inside_top = [at(upper, share, -1, 0.004) for share in (MOUTH_INSIDE, 0.0)]
    inside_bottom = [at(lower, share, 1, 0.004) for share in (MOUTH_INSIDE, 0.0)]
    inner_corner = face.nearest(face.skin[corner] * [MOUTH_INNER_CORNER, 1, 1], upper)
    mirror = face.mesh.mirror
    outer = [
        mirror[corner], mirror[top[0]], mirror[top[1]], top[2], top[1], top[0],
        corner, bottom[0], bottom[1], bottom[2], mirror[bottom[1]], mirror[bottom[0]],
    ]  # fmt: skip
    inner = [
        mirror[inner_corner], mirror[inside_top[0]], inside_top[1], inside_top[0],
        inner_corner, inside_bottom[0], inside_bottom[1], mirror[inside_bottom[0]],
    ]  # fmt: skip
    return outer, inner


def face_outline(face: Face) -> NDArray[np.int64]:
    """``(79, 17)`` base-mesh vertices of the outline, right ear to chin to left ear, by head turn.

    Row 0 is the frontal view, rows 1 … 39 a turn of so many degrees to the right, rows 40 … 78 of 1 … 39
    degrees to the left, which is how the ``smplx`` package looks them up. On the side that turns away the
    outline is where the cheek ends against the background; on the other it stays on the jaw.
    """
    region = face.region("face")
    edge = face.head & (face.normals[:, 1:] > UNDER_THE_JAW).all(axis=1)
    edge &= face.skin[:, 1] < face.skin[region, 1].max()
    head = np.setdiff1d(np.flatnonzero(edge & (face.skin[:, 2] > 0.03)), face.region("ears"))
    line = head[np.abs(face.skin[head, 0]) < 1e-4]
    middle = int(line[np.argmax(face.skin[line] @ [0, -1, FORWARD])])
    left = [_outline_point(face, head, angle, 0.0) for angle in OUTLINE_DEG]
    rows = np.zeros((2 * YAWS + 1, 17), np.int64)
    rows[0] = [*(face.mesh.mirror[k] for k in left), middle, *left[::-1]]
    for degrees in range(1, YAWS + 1):
        away = [_outline_point(face, head, angle, float(degrees)) for angle in OUTLINE_DEG]
        rows[YAWS + degrees] = [*rows[0, :9], *away[::-1]]
        rows[degrees] = [*(face.mesh.mirror[k] for k in away), *rows[0, 8:]]
    return rows


def _outline_point(face: Face, head: NDArray[np.int64], angle_deg: float, yaw_deg: float) -> int:
    """The vertex farthest out in one direction, on the left, once the head has turned to the left."""
    yaw, angle = np.deg2rad(yaw_deg), np.deg2rad(angle_deg)
    # Only x changes in the picture; turning left is about +y.
    x = np.cos(yaw) * face.skin[head, 0] + np.sin(yaw) * (face.skin[head, 2] - face.skin[head, 2].mean())
    across, down = x - OUTLINE_CENTRE[0], OUTLINE_CENTRE[1] - face.skin[head, 1]
    direction = np.arctan2(down, across)
    near = np.abs(direction - angle) < np.deg2rad(5)
    distance = np.where(near, np.hypot(across, down) + FORWARD * np.sin(angle) * face.skin[head, 2], -1)
    return int(head[np.argmax(distance)])
