"""``preview.jpg``: frames of a sequence, and under each the same frame with the labels drawn over it."""

from collections.abc import Callable, Mapping

import numpy as np
from PIL import Image

from whacamole.body import BodyModel
from whacamole.labels.arrays import AnyArray, Integers
from whacamole.labels.overlay import OverlayStyle, Rgb, overlay_frame

_COLUMNS = 5
_CELL_WIDTH = 384
_GAP = 6


def preview_strip(
    image: Callable[[int], Rgb],
    people: Mapping[str, AnyArray],
    camera: Mapping[str, AnyArray],
    model: BodyModel,
    *,
    mask: Callable[[int], Integers] | None = None,
    columns: int = _COLUMNS,
    cell_width: int = _CELL_WIDTH,
    style: OverlayStyle | None = None,
) -> Image.Image:
    """Two rows of frames spread evenly over a sequence: plain above, labels drawn below.

    Args:
        image: gives the picture ``(H, W, 3)`` of a frame.
        people: arrays of ``people.npz``.
        camera: arrays of ``camera.npz``.
        model: the body model that the labels refer to.
        mask: gives the track ids of a frame; hidden parts of bodies are then drawn fainter.
        columns: how many frames, at most.
        cell_width: width of one cell in pixels.
        style: what to draw; by default meshes and track ids.
    """
    count = len(camera["K"])
    frames = np.unique(np.linspace(0, count - 1, min(columns, count)).round().astype(int))
    height = round(cell_width * float(camera["height"]) / float(camera["width"]))
    size = (len(frames) * (cell_width + _GAP) - _GAP, 2 * height + _GAP)
    sheet = Image.new("RGB", size, (24, 24, 24))
    for column, frame in enumerate(frames.tolist()):
        cell = Image.fromarray(image(frame)).resize((cell_width, height), Image.Resampling.LANCZOS)
        shown = mask(frame) if mask else None
        labelled = overlay_frame(np.asarray(cell), people, camera, model, frame, mask=shown, style=style)
        left = column * (cell_width + _GAP)
        sheet.paste(cell, (left, 0))
        sheet.paste(Image.fromarray(labelled), (left, height + _GAP))
    return sheet
