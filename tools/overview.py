r"""The picture at the top of the README: what a dataset holds, a row a sequence.

::

    mkdir build/three && cp whacamole/assets/motions/{duet_00,duet_01,run,dance_a}.npz build/three
    whacamole render --motions build/three --out build/overview --frames 24 --size 480x270 \
        --passes rgb,mask,depth,normal,flow
    python -m tools.overview build/overview --out docs/images/overview.jpg \
        --sequences duet-00:5,run-00:12,dance_a-00:3

Colour, the labels over it, mask, depth, normals, and the scene from aside with the frame inside the camera.
"""

import argparse
from pathlib import Path

from PIL import Image

import whacamole
from whacamole.body import BodyModel
from whacamole.dataset import Sequence
from whacamole.viewing.panels import Panels

WIDTH, GAP = 380, 4
LAYERS = ("rgb", "mesh", "joints", "ids", "contacts", "mask", "depth", "normal", "aside")


def cells(sequence: Sequence, frame: int, body: BodyModel) -> list[Image.Image]:
    """The pictures of one frame, in the order of the columns."""
    panels = Panels(sequence, body, LAYERS, WIDTH)
    return [panels.picture(name, frame) for name in panels.names]


def sheet(rows: list[list[Image.Image]]) -> Image.Image:
    """All cells side by side."""
    width, height = rows[0][0].size
    size = (len(rows[0]) * (width + GAP) - GAP, len(rows) * (height + GAP) - GAP)
    picture = Image.new("RGB", size, "white")
    for y, row in enumerate(rows):
        for x, cell in enumerate(row):
            picture.paste(cell, (x * (width + GAP), y * (height + GAP)))
    return picture


def main() -> None:
    """Draw the overview of a dataset."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("dataset", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--sequences", required=True, help="ids by commas, optionally id:frame")
    options = parser.parse_args()
    data, body, rows = whacamole.open(options.dataset), BodyModel.embedded(), []
    for entry in options.sequences.split(","):
        name, _, frame = entry.partition(":")
        sequence = data[name]
        rows.append(cells(sequence, int(frame) if frame else len(sequence) // 2, body))
    options.out.parent.mkdir(parents=True, exist_ok=True)
    sheet(rows).save(options.out, quality=86)


if __name__ == "__main__":
    main()
