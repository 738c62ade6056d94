"""The scene seen from aside, without a browser: bodies, and the camera with the frame it films."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from whacamole.body import BodyModel
from whacamole.dataset import Sequence
from whacamole.labels.raster import RasterMesh
from whacamole.labels.shading import shade, track_colour
from whacamole.viewing.bodies import actors_of
from whacamole.viewing.drawing import INK, PAPER
from whacamole.viewing.scene3d import SHOT_COLOURS
from whacamole.viewing.viewpoint import Viewpoint

__all__ = ["FromAside"]

Floats = NDArray[np.float64]
Rgb = NDArray[np.uint8]

FINE = 2
"""Drawn so many times larger and averaged down, for smooth edges."""

NEAR = 0.2
"""Lines are cut this far in front of the viewer [m]."""

SCREEN = 0.9
"""How far in front of the camera its frame hangs [m]."""

GRID = (214, 214, 210)


class FromAside:
    """Draws a sequence from a place that sees both people and camera.

    Args:
        sequence: which.
        model: the body model of its labels.
        width, height: of the picture [px].
    """

    def __init__(self, sequence: Sequence, model: BodyModel, width: int, height: int) -> None:
        self._sequence, self._size = sequence, (width, height)
        self._actors = actors_of(sequence, model)
        self._eyes = sequence.camera["T_world_camera"][:, :3, 3]
        people = sequence.people["joints_world"][:, :, 0].reshape(-1, 3)
        self._view = Viewpoint.of(self._eyes, people if len(people) else self._eyes)
        self._K, self._T = self._view.camera(width * FINE, height * FINE)
        self._ground = self._draw_ground()

    def frame(self, frame: int) -> Rgb:
        """The picture (H, W, 3) of a frame."""
        meshes = [
            RasterMesh(self._local(actor.vertices(frame)), actor.model.faces, cull_back=True)
            for actor in self._actors
        ]
        colours = [track_colour(actor.track_id) for actor in self._actors]
        picture = np.asarray(self._ground).copy()
        if meshes:
            drawn = shade(meshes, colours, self._K, picture.shape[1], picture.shape[0])
            picture[drawn.mesh >= 0] = drawn.colour[drawn.mesh >= 0].astype(np.uint8)
        canvas = Image.fromarray(picture)
        self._draw_camera(canvas, frame)
        return np.asarray(canvas.resize(self._size, Image.Resampling.LANCZOS))

    def _local(self, points: NDArray[np.floating[Any]]) -> Floats:
        local: Floats = np.asarray(points, np.float64) @ self._T[:3, :3].T + self._T[:3, 3]
        return local

    def _paper(self, points: Floats) -> list[tuple[float, float]]:
        """Paper coordinates of points (N, 3) of the world in front of the viewer."""
        image = self._local(points) @ self._K.T
        return [(x, y) for x, y in (image[:, :2] / image[:, 2:]).tolist()]

    def _line(
        self, pen: ImageDraw.ImageDraw, points: Floats, colour: tuple[int, int, int], width: int
    ) -> None:
        """A broken line through points (N, 3), cut where it passes behind the viewer."""
        depth = self._local(points)[:, 2]
        for a, b, z_a, z_b in zip(points[:-1], points[1:], depth[:-1], depth[1:], strict=True):
            if max(z_a, z_b) <= NEAR:
                continue
            if z_a < NEAR:
                a = a + (b - a) * (NEAR - z_a) / (z_b - z_a)
            if z_b < NEAR:
                b = b + (a - b) * (NEAR - z_b) / (z_a - z_b)
            pen.line(self._paper(np.stack([a, b])), fill=colour, width=width * FINE)

    def _draw_ground(self) -> Image.Image:
        picture = Image.new("RGB", (self._size[0] * FINE, self._size[1] * FINE), PAPER)
        pen = ImageDraw.Draw(picture)
        half = np.ceil(1.3 * self._view.reach)
        middle = np.round(self._view.middle[:2])
        for axis in (0, 1):
            for value in np.arange(-half, half + 1):
                ends = np.zeros((2, 3))
                ends[:, :2] = middle
                ends[:, axis] += value
                ends[:, 1 - axis] += [-half, half]
                self._line(pen, ends, GRID, 1)
        for actor in self._actors:
            on_ground = actor.pelvis() * [1.0, 1.0, 0.0]
            self._line(pen, on_ground, track_colour(actor.track_id), 1)
        return picture

    def _draw_camera(self, canvas: Image.Image, frame: int) -> None:
        """The camera's way, its keyframes, its pyramid, and the frame it films at the pyramid's base."""
        pen = ImageDraw.Draw(canvas)
        for index, shot in enumerate(self._sequence.shot.get("shots", ())):
            colour = SHOT_COLOURS[index % len(SHOT_COLOURS)]
            self._line(pen, self._eyes[int(shot["start"]) : int(shot["end"]) + 1], colour, 2)
            spots = np.array([key["location"] for key in shot.get("keyframes", ())]).reshape(-1, 3)
            for x, y in self._paper(spots[self._local(spots)[:, 2] > NEAR]):
                pen.ellipse([x - 3 * FINE, y - 3 * FINE, x + 3 * FINE, y + 3 * FINE], fill=colour)
        pose, K = self._sequence.camera["T_world_camera"][frame], self._sequence.camera["K"][frame]
        w, h = self._sequence.size
        corners = np.array([[0, 0, 1], [w, 0, 1], [w, h, 1], [0, h, 1]], np.float64) @ np.linalg.inv(K).T
        tips = SCREEN * corners @ pose[:3, :3].T + pose[:3, 3]
        if (self._local(np.concatenate([tips, pose[None, :3, 3]]))[:, 2] > NEAR).all():
            _hang(canvas, Image.fromarray(self._sequence.rgb(frame)), self._paper(tips))
        for tip in tips:
            self._line(pen, np.stack([pose[:3, 3], tip]), INK, 1)
        self._line(pen, np.concatenate([tips, tips[:1]]), INK, 1)


def _hang(canvas: Image.Image, picture: Image.Image, corners: list[tuple[float, float]]) -> None:
    """Paste a picture so that its corners, from top left clockwise, come to lie on four points."""
    (w, h) = picture.size
    rows, wanted = [], []
    for (x, y), (u, v) in zip(corners, ((0, 0), (w, 0), (w, h), (0, h)), strict=True):
        rows += [[x, y, 1, 0, 0, 0, -u * x, -u * y], [0, 0, 0, x, y, 1, -v * x, -v * y]]
        wanted += [u, v]
    flat = np.linalg.solve(np.array(rows, np.float64), np.array(wanted, np.float64)).tolist()
    warped = picture.transform(canvas.size, Image.Transform.PERSPECTIVE, flat, Image.Resampling.BILINEAR)
    inside = Image.new("L", canvas.size, 0)
    ImageDraw.Draw(inside).polygon(corners, fill=255)
    canvas.paste(warped, (0, 0), inside)
