"""The scene from above: where people and camera go, and where they are in a frame."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from whacamole.dataset import Sequence
from whacamole.labels.shading import track_colour
from whacamole.viewing.drawing import INK, PAPER, font
from whacamole.viewing.scene3d import SHOT_COLOURS

__all__ = ["FromAbove"]

Floats = NDArray[np.float64]
Rgb = NDArray[np.uint8]

FINE = 2
"""Drawn so many times larger and averaged down, for smooth lines."""

OVERHEAD = 2.5
"""What begins above this height [m] would hide the scene."""

WEDGE = 1.1
"""Length of the drawn view of the camera [m]."""

BOX, PATH, GRID = (222, 217, 208), (150, 150, 150), (232, 232, 228)


@dataclass(frozen=True)
class _Paper:
    """The map from the ground to the paper: x to the right, y up."""

    middle: Floats
    scale: float
    width: int
    height: int

    def at(self, points: Floats) -> list[tuple[float, float]]:
        """Paper coordinates of points (N, 2 or 3)."""
        flat = (np.asarray(points)[:, :2] - self.middle) * self.scale
        return [(self.width / 2 + x, self.height / 2 - y) for x, y in flat.tolist()]


class FromAbove:
    """Draws a sequence from above.

    Args:
        sequence: which.
        width, height: of the picture [px].
    """

    def __init__(self, sequence: Sequence, width: int, height: int) -> None:
        self._sequence, self._size = sequence, (width, height)
        self._eyes = sequence.camera["T_world_camera"][:, :3, 3]
        self._pelvis = sequence.people["joints_world"][:, :, 0]
        reach = np.concatenate([self._eyes, self._pelvis.reshape(-1, 3)])[:, :2]
        low, high = reach.min(axis=0) - 0.8, reach.max(axis=0) + 0.8
        room = np.array([width, height]) * FINE
        self._paper = _Paper((low + high) / 2, float((room / (high - low)).min()), *room.tolist())
        self._ground = self._draw_ground(low, high)

    def frame(self, frame: int) -> Rgb:
        """The picture (H, W, 3) of a frame."""
        picture = self._ground.copy()
        pen = ImageDraw.Draw(picture)
        self._draw_wedge(pen, frame)
        radius = 0.16 * self._paper.scale
        for number, track_id in enumerate(self._sequence.people["track_id"].tolist()):
            colour = track_colour(track_id)
            joints = self._sequence.people["joints_world"][number, frame]
            (x, y), (left, right) = self._paper.at(joints[:1])[0], self._paper.at(joints[[16, 17]])
            pen.line([left, right], fill=colour, width=max(2, round(radius / 2)))
            pen.ellipse([x - radius, y - radius, x + radius, y + radius], fill=colour, outline=INK)
            text = font(self._size[1] * FINE)
            pen.text((x, y), str(track_id), fill=INK, font=text, anchor="mm")
        return np.asarray(picture.resize(self._size, Image.Resampling.LANCZOS))

    def _draw_wedge(self, pen: ImageDraw.ImageDraw, frame: int) -> None:
        """What the camera sees: its eye and the left and right edges of the picture."""
        pose, K = self._sequence.camera["T_world_camera"][frame], self._sequence.camera["K"][frame]
        width, height = self._sequence.size
        edges = np.array([[0.0, height / 2, 1.0], [width, height / 2, 1.0]]) @ np.linalg.inv(K).T
        tips = WEDGE * edges @ pose[:3, :3].T + pose[:3, 3]
        eye, *corners = self._paper.at(np.concatenate([pose[None, :3, 3], tips]))
        pen.polygon([eye, *corners], fill=(205, 214, 228), outline=INK)
        r = 4 * FINE
        pen.ellipse([eye[0] - r, eye[1] - r, eye[0] + r, eye[1] + r], fill=INK)

    def _draw_ground(self, low: Floats, high: Floats) -> Image.Image:
        paper = self._paper
        picture = Image.new("RGB", (paper.width, paper.height), PAPER)
        pen = ImageDraw.Draw(picture)
        half = np.array([paper.width, paper.height]) / paper.scale / 2
        first, last = np.ceil(paper.middle - half), np.floor(paper.middle + half)
        for axis in (0, 1):
            for value in np.arange(first[axis], last[axis] + 1):
                ends = np.stack([paper.middle - half, paper.middle + half])
                ends[:, axis] = value
                pen.line(paper.at(ends), fill=GRID, width=FINE)
        for box in (self._sequence.shot.get("world") or {}).get("obstacles", ()):
            if box["center"][2] - box["size"][2] / 2 < OVERHEAD:
                pen.polygon(paper.at(_outline(box)), fill=BOX)
        for number, track_id in enumerate(self._sequence.people["track_id"].tolist()):
            pen.line(paper.at(self._pelvis[number]), fill=track_colour(track_id), width=FINE)
        for index, shot in enumerate(self._sequence.shot.get("shots", ())):
            colour = SHOT_COLOURS[index % len(SHOT_COLOURS)]
            part = self._eyes[int(shot["start"]) : int(shot["end"]) + 1]
            pen.line(paper.at(part), fill=colour, width=2 * FINE)
        self._draw_scale(pen)
        return picture

    def _draw_scale(self, pen: ImageDraw.ImageDraw) -> None:
        """A metre."""
        x, y = 8.0 * FINE, self._paper.height - 8.0 * FINE
        pen.line([(x, y), (x + self._paper.scale, y)], fill=INK, width=2 * FINE)
        text = font(self._size[1] * FINE)
        pen.text((x, y - 3 * FINE), "1 m", fill=INK, font=text, anchor="lb")


def _outline(box: dict[str, object]) -> Floats:
    """The corners (4, 2) of a box on the ground."""
    size, centre = np.asarray(box["size"], float), np.asarray(box["center"], float)
    yaw = float(np.asarray(box["yaw"]))
    unit = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]) * size[:2]
    turn = np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
    return np.asarray(unit @ turn + centre[:2])
