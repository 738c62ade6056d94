"""The picture at the top of the README: what a dataset holds, a row a sequence.

::

    whacamole render --out build/overview --frames 3 --people 1-3 --passes rgb,mask,depth,normal
    python -m tools.overview build/overview --out docs/images/overview.jpg --sequences duet-00,walk-00

Colour, the labelled bodies over it, mask, depth and normals of one frame of each sequence.
"""

import argparse
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

import whacamole
from whacamole.body import BodyModel
from whacamole.dataset import Sequence
from whacamole.labels.overlay import overlay_frame

CELL = (400, 225)
GAP = 4
PALETTE = np.array(
    [[24, 24, 28], [66, 133, 244], [234, 134, 46], [52, 168, 83], [187, 85, 190], [214, 69, 65]]
)

Rgb = NDArray[np.uint8]


def cells(sequence: Sequence, frame: int, body: BodyModel) -> list[Rgb]:
    """The pictures (H, W, 3) of one frame, in the order of the columns."""
    rgb, mask, depth = sequence.rgb(frame), sequence.mask(frame), sequence.depth(frame)
    drawn = overlay_frame(rgb, sequence.people, sequence.camera, body, frame, mask=mask)
    near, far = np.quantile(depth[np.isfinite(depth)], [0.02, 0.9])
    tone = np.clip(1.0 - (depth - near) / (far - near), 0.0, 1.0) ** 1.2
    grey = np.repeat((255 * tone[..., None]).astype(np.uint8), 3, axis=2)
    coloured = PALETTE[np.where(mask > 0, (mask.astype(int) - 1) % (len(PALETTE) - 1) + 1, 0)].astype(
        np.uint8
    )
    shown = [rgb, drawn, coloured, grey]
    if "normal" in sequence.facts["passes"]:
        shown.append((127.5 * (sequence.normal(frame) * [1, -1, -1] + 1)).clip(0, 255).astype(np.uint8))
    return shown


def sheet(rows: list[list[Rgb]]) -> Image.Image:
    """All cells side by side."""
    columns = max(len(row) for row in rows)
    size = (columns * (CELL[0] + GAP) - GAP, len(rows) * (CELL[1] + GAP) - GAP)
    picture = Image.new("RGB", size, "white")
    for y, row in enumerate(rows):
        for x, cell in enumerate(row):
            scaled = Image.fromarray(cell).resize(CELL, Image.Resampling.LANCZOS)
            picture.paste(scaled, (x * (CELL[0] + GAP), y * (CELL[1] + GAP)))
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
