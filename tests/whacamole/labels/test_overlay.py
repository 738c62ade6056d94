"""The drawings: in place, in colour, and of the right size."""

import numpy as np
import pytest

from whacamole.labels import (
    FrameImages,
    LabelledPerson,
    OverlayStyle,
    label_sequence,
    overlay_frame,
    preview_strip,
)
from whacamole.labels.shading import PALETTE, track_colour


@pytest.fixture(scope="module")
def labelled(model, standing, level_camera):
    camera = level_camera(3)
    people = [LabelledPerson(2, "a", "neutral", standing(3, seed=4))]
    blank = np.zeros((camera.height, camera.width), dtype=np.uint8)
    return label_sequence(people, model, camera, lambda frame: FrameImages(blank))


def grey(labels, scale=1):
    height, width = int(labels.camera["height"]), int(labels.camera["width"])
    return np.full((height * scale, width * scale, 3), 90, dtype=np.uint8)


@pytest.mark.parametrize("scale", [1, 2])
def test_the_mesh_lies_in_its_box(labelled, model, scale):
    image = grey(labelled, scale)
    drawn = overlay_frame(image, labelled.people, labelled.camera, model, 0, style=OverlayStyle(names=False))
    rows, columns = np.nonzero((drawn != image).any(axis=2))
    box = labelled.people["bbox_xyxy"][0, 0] * scale
    found = [columns.min(), rows.min(), columns.max() + 1, rows.max() + 1]
    np.testing.assert_allclose(found, box, atol=1.0)
    # Track 2's colour leads: more red than green, more green than blue.
    middle = drawn[(drawn != image).any(axis=2)].mean(axis=0)
    assert middle[0] > middle[1] > middle[2]
    assert (image == 90).all()


def test_hidden_bodies_are_fainter(labelled, model):
    image = grey(labelled)
    style = OverlayStyle(names=False)
    shown = np.full(image.shape[:2], 2, dtype=np.uint8)

    def change(mask):
        drawn = overlay_frame(image, labelled.people, labelled.camera, model, 0, mask=mask, style=style)
        return np.abs(drawn.astype(int) - 90).sum()

    assert change(shown) > 2 * change(0 * shown) > 0


def test_joints_and_boxes_are_drawn(labelled, model):
    image = grey(labelled)
    bare = OverlayStyle(mesh=0.0, names=False)
    np.testing.assert_array_equal(
        overlay_frame(image, labelled.people, labelled.camera, model, 0, style=bare), image
    )
    joints = overlay_frame(
        image,
        labelled.people,
        labelled.camera,
        model,
        0,
        style=OverlayStyle(mesh=0.0, names=False, joints=True),
    )
    x, y = np.floor(labelled.people["joints_image"][0, 0, 0]).astype(int)
    assert (joints[y - 3 : y + 4, x - 3 : x + 4] != 90).any()


def test_colours_repeat():
    assert track_colour(1) == PALETTE[0]
    assert track_colour(len(PALETTE) + 1) == PALETTE[0]
    assert len(set(PALETTE)) == len(PALETTE)


def test_preview_has_two_rows_of_frames(labelled, model):
    image = grey(labelled)
    sheet = preview_strip(
        lambda frame: image, labelled.people, labelled.camera, model, columns=4, cell_width=96
    )
    assert sheet.size == (3 * 96 + 2 * 6, 2 * 72 + 6)
    pixels = np.asarray(sheet)
    assert (pixels[:72, :96] == 90).all()
    assert (pixels[78:, :96] != 90).any()
