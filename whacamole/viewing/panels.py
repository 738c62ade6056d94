"""The pictures of a frame side by side: chosen layers, each with a caption and a legend where needed."""

from collections.abc import Callable, Iterable, Mapping
from collections.abc import Sequence as Series
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from whacamole.body import BodyModel
from whacamole.dataset import Sequence
from whacamole.errors import DatasetError
from whacamole.labels.overlay import OverlayStyle, overlay_frame
from whacamole.viewing.above import FromAbove
from whacamole.viewing.aside import FromAside
from whacamole.viewing.bodies import actors_of, contact_points
from whacamole.viewing.colouring import (
    DepthScale,
    colour_depth,
    colour_flow,
    colour_mask,
    colour_normal,
    depth_legend,
    flow_legend,
)
from whacamole.viewing.drawing import INK, PAPER, font
from whacamole.viewing.scene3d import GROUND_TOUCH, PERSON_TOUCH

__all__ = ["DEFAULT_LAYERS", "LAYERS", "Panels", "layers_named"]

Rgb = NDArray[np.uint8]

LAYERS: Mapping[str, str] = MappingProxyType(
    {
        "rgb": "the frame as rendered",
        "mesh": "bodies over it, fainter where something hides them",
        "joints": "joints and bones over it: full dots are visible",
        "boxes": "boxes of what is seen of each person",
        "ids": "track ids",
        "contacts": "vertices that touch: red the ground, magenta a person",
        "mask": "masks in the colours of the tracks",
        "depth": "depth with a scale",
        "normal": "normals: red right, green up, blue towards the camera",
        "flow": "flow to the next frame with a wheel of directions",
        "map": "the scene from above",
        "aside": "the scene from aside, with the frame inside the camera",
    }
)
"""What can be asked for."""

OVER = ("mesh", "joints", "boxes", "ids", "contacts")
"""Those that are drawn over the frame, all in one picture."""

DEFAULT_LAYERS = ("rgb", "mesh", "ids", "contacts", "map")
GAP = 6
SAMPLES = 7
"""Frames that scales are taken from."""

HIDDEN_BY = 0.04
"""A contact is left out where the depth shows something so much nearer [m]; clothes lie over the skin."""


def layers_named(text: str, sequence: Sequence) -> tuple[str, ...]:
    """The layers of a comma-separated list.

    Raises:
        DatasetError: a name is none of :data:`LAYERS`, or its pass was not rendered.
    """
    names = tuple(part.strip() for part in text.split(",") if part.strip())
    for name in names:
        if name not in LAYERS:
            raise DatasetError(f"--layers: {name!r} is none of {', '.join(LAYERS)}")
        made = sequence.facts["passes"]
        if name in ("depth", "normal", "flow", "mask") and name not in made:
            raise DatasetError(
                f"--layers {name}: not rendered, only {', '.join(made)}; render with --passes …,{name}"
            )
    if not names:
        raise DatasetError(f"--layers: empty; choose of {', '.join(LAYERS)}")
    return names


class Panels:
    """Draws the frames of a sequence.

    Args:
        sequence: which.
        model: the body model of its labels.
        layers: of :data:`LAYERS`.
        width: of one picture [px].
    """

    def __init__(self, sequence: Sequence, model: BodyModel, layers: Series[str], width: int) -> None:
        self.sequence, self._model = sequence, model
        self._over = [name for name in layers if name in OVER]
        self.names = list(dict.fromkeys("labels" if name in OVER else name for name in layers))
        w, h = sequence.size
        self.cell = (width + width % 2, 2 * round(width * h / w / 2))
        self._actors = actors_of(sequence, model) if "contacts" in self._over else []
        self._draw: dict[str, Callable[[int], Rgb]] = {
            "rgb": sequence.rgb,
            "labels": self._labels,
            "normal": lambda i: colour_normal(sequence.normal(i)),
            "mask": lambda i: colour_mask(sequence.mask(i)),
        }
        self._legends: dict[str, Image.Image] = {}
        self._captions = {"labels": ", ".join(self._over), "map": "from above", "aside": "from aside"}
        self._scales()

    def _scales(self) -> None:
        """One scale for all frames, from a few of them."""
        some = np.unique(np.linspace(0, len(self.sequence) - 1, SAMPLES).round().astype(int)).tolist()
        if "depth" in self.names:
            scale = DepthScale.of([self.sequence.depth(frame) for frame in some])
            self._draw["depth"] = lambda i: colour_depth(self.sequence.depth(i), scale)
            self._legends["depth"] = depth_legend(scale, self.cell[1])
        if "flow" in self.names:
            lengths = [np.linalg.norm(self.sequence.flow(frame), axis=-1).ravel() for frame in some]
            finite = np.concatenate(lengths)
            longest = max(1.0, float(np.quantile(finite[np.isfinite(finite)], 0.99)))
            self._draw["flow"] = lambda i: colour_flow(self.sequence.flow(i), longest)
            self._legends["flow"] = flow_legend(longest, self.cell[1])
        if "map" in self.names:
            self._draw["map"] = FromAbove(self.sequence, *self.cell).frame
        if "aside" in self.names:
            self._draw["aside"] = FromAside(self.sequence, self._model, *self.cell).frame

    def picture(self, name: str, frame: int) -> Image.Image:
        """One picture, of the size of a cell."""
        drawn = Image.fromarray(self._draw[name](frame))
        if drawn.size != self.cell:
            sharp = name in ("mask", "depth", "normal", "flow")
            way = Image.Resampling.NEAREST if sharp else Image.Resampling.LANCZOS
            drawn = drawn.resize(self.cell, way)
        legend = self._legends.get(name)
        if legend is not None:
            drawn.paste(legend, (self.cell[0] - legend.width - 4, self.cell[1] - legend.height - 4))
        return drawn

    def frame(self, frame: int) -> Rgb:
        """All pictures of a frame in a grid, a caption under each, what and when at the bottom."""
        columns = min(len(self.names), 3 if len(self.names) != 4 else 2)
        rows = -(-len(self.names) // columns)
        line = _line(self.cell[1])
        width = columns * (self.cell[0] + GAP) - GAP
        height = rows * (self.cell[1] + line) + line
        sheet = Image.new("RGB", (width + width % 2, height + height % 2), PAPER)
        pen = ImageDraw.Draw(sheet)
        for number, name in enumerate(self.names):
            x, y = number % columns * (self.cell[0] + GAP), number // columns * (self.cell[1] + line)
            sheet.paste(self.picture(name, frame), (x, y))
            _write(pen, (x + 4, y + self.cell[1] + line / 2), self._captions.get(name, name), self.cell[1])
        _write(pen, (4, rows * (self.cell[1] + line) + line / 2), self._when(frame), self.cell[1])
        return np.asarray(sheet)

    def sheet(self, frames: Iterable[int]) -> Image.Image:
        """A row a layer, a column a frame."""
        chosen, line = list(frames), _line(self.cell[1])
        width = len(chosen) * (self.cell[0] + GAP) - GAP
        height = len(self.names) * (self.cell[1] + GAP) + 2 * line
        sheet = Image.new("RGB", (width, height), PAPER)
        pen = ImageDraw.Draw(sheet)
        shots = ", ".join(map(str, self.sequence.facts.get("shots", ())))
        rows = "; ".join(self._captions.get(name, name) for name in self.names)
        _write(pen, (4, line / 2), f"{self.sequence.id}: {shots}. Rows: {rows}", self.cell[1])
        for column, frame in enumerate(chosen):
            x = column * (self.cell[0] + GAP)
            for row, name in enumerate(self.names):
                sheet.paste(self.picture(name, frame), (x, line + row * (self.cell[1] + GAP)))
            _write(pen, (x + 4, height - line / 2), f"frame {frame}", self.cell[1])
        return sheet

    def _when(self, frame: int) -> str:
        fps = float(self.sequence.facts["fps"])
        kinds = [
            str(shot["kind"])
            for shot in self.sequence.shot.get("shots", ())
            if int(shot["start"]) <= frame <= int(shot["end"])
        ]
        return f"{self.sequence.id}   frame {frame}, {frame / fps:.2f} s   {kinds[-1] if kinds else ''}"

    def _labels(self, frame: int) -> Rgb:
        sequence = self.sequence
        base = np.asarray(Image.fromarray(sequence.rgb(frame)).resize(self.cell, Image.Resampling.LANCZOS))
        style = OverlayStyle(
            mesh=0.75 if "mesh" in self._over else 0.0,
            joints="joints" in self._over, boxes="boxes" in self._over, names="ids" in self._over,
        )  # fmt: skip
        drawn = overlay_frame(
            base, sequence.people, sequence.camera, self._model, frame, mask=sequence.mask(frame), style=style
        )
        return self._with_contacts(drawn, frame) if "contacts" in self._over else drawn

    def _with_contacts(self, picture: Rgb, frame: int) -> Rgb:
        """Dots where vertices touch something, those that the depth shows behind other things left out."""
        camera, depth = self.sequence.camera, self.sequence.depth(frame)
        canvas = Image.fromarray(picture)
        pen = ImageDraw.Draw(canvas)
        found = contact_points(self.sequence.contact, [a.vertices(frame) for a in self._actors], frame)
        T, K = camera["T_camera_world"][frame], camera["K"][frame]
        w, h = self.sequence.size
        radius = max(1.0, self.cell[0] / 420)
        for points, colour in ((found.ground, GROUND_TOUCH), (found.person, PERSON_TOUCH)):
            local = points.astype(np.float64) @ T[:3, :3].T + T[:3, 3]
            local = local[local[:, 2] > 0.05]
            image = local @ K.T
            pixel = image[:, :2] / image[:, 2:]
            inside = (pixel >= 0).all(axis=1) & (pixel < [w, h]).all(axis=1)
            pixel, local = pixel[inside], local[inside]
            column, row = pixel.astype(np.intp).T
            seen = local[:, 2] < depth[row, column] + HIDDEN_BY
            for x, y in (pixel[seen] * (np.array(self.cell) / [w, h])).tolist():
                pen.ellipse([x - radius, y - radius, x + radius, y + radius], fill=colour)
        return np.asarray(canvas)


def _line(height: int) -> int:
    """Height of a line of words under pictures of this height, even."""
    return 2 * round(font(height).getbbox("Mg")[3] * 0.7)


def _write(pen: ImageDraw.ImageDraw, place: tuple[float, float], text: str, height: int) -> None:
    pen.text(place, text, fill=INK, font=font(height), anchor="lm")
