"""Draw labels, depth and the scene from aside, as `whacamole preview` does, with pictures as arrays.

Run it: `python examples/06_draw_labels.py DATASET [OUT.png]`
"""

import sys

from PIL import Image

import whacamole
from whacamole.body import BodyModel
from whacamole.viewing.panels import Panels

data = whacamole.open(sys.argv[1])
sequence = data[0]
# The body model that the labels refer to; with SMPL-X it is BodyModel.load("SMPLX_NEUTRAL.npz").
body = BodyModel.embedded()
panels = Panels(sequence, body, ("rgb", "mesh", "joints", "ids", "depth", "aside"), width=240)

picture = panels.frame(len(sequence) // 2)  # all of them, with captions: (H, W, 3) uint8
depth = panels.picture("depth", 0)  # one of them, a PIL image
print(f"{sequence.id}: {', '.join(panels.names)} in {picture.shape[1]}x{picture.shape[0]} pixels")
print(f"depth alone: {depth.size[0]}x{depth.size[1]}")
if len(sys.argv) > 2:
    Image.fromarray(picture).save(sys.argv[2])
