"""Planted faults of the normals: another frame of reference, other frames of the sequence, another form."""

import numpy as np
import pytest

from planted_faults import audit, labels, load
from render_jobs.images import read_exr, write_exr
from render_jobs.passes import PASSES
from whacamole.dataset import SequenceLayout


def _change_normals(sequence: SequenceLayout, spoil) -> None:
    """``spoil(normals (T, H, W, 3), rotations (T, 3, 3) world to camera)`` gives what is stored instead."""
    files = sorted((sequence.folder / "normal").glob("*.exr"))
    stored = np.stack([np.stack([read_exr(file)[axis] for axis in "XYZ"], axis=-1) for file in files])
    for file, normal in zip(
        files, spoil(stored, load(sequence.camera)["T_camera_world"][:, :3, :3]), strict=True
    ):
        write_exr(file, PASSES["normal"], normal.astype(np.float32))


NORMAL_FAULTS = {
    "in the world frame": lambda normal, R: np.einsum("thwi,tij->thwj", normal, R),
    "turned into the camera twice": lambda normal, R: np.einsum("thwj,tij->thwi", normal, R),
    "x flipped": lambda normal, R: normal * [-1, 1, 1],
    "y flipped": lambda normal, R: normal * [1, -1, 1],
    "z flipped": lambda normal, R: normal * [1, 1, -1],
    "x and y exchanged": lambda normal, R: normal[..., [1, 0, 2]],
}


@pytest.mark.parametrize("fault", NORMAL_FAULTS)
def test_normals_in_another_frame(dataset, sequence, fault):
    _change_normals(sequence, NORMAL_FAULTS[fault])
    found = audit(dataset)
    assert labels(found) == {"normal"}
    for track in (1, 2):
        wrong = [f for f in found if f.message.startswith(f"track {track}: share of even pixels")]
        assert sum(f.frames for f in wrong) == 8


@pytest.mark.parametrize(("order", "frame"), [((0, 0, 1, 2, 3, 4, 5, 6), 1), ((0, 1, 2, 4, 3, 5, 6, 7), 3)])
def test_normals_of_other_frames(dataset, sequence, order, frame):
    """A frame late, and two exchanged."""
    _change_normals(sequence, lambda normal, R: normal[list(order)])
    found = audit(dataset)
    assert labels(found) == {"normal"}
    assert "fits better" in " ".join(f.message for f in found)
    assert frame in {f.frame for f in found}


def test_normals_that_are_not_of_unit_length(dataset, sequence):
    """As a picture keeps them: -1 … 1 made 0 … 1."""
    _change_normals(sequence, lambda normal, R: normal / 2 + 0.5)
    assert any("length" in f.message and f.frames == 8 for f in audit(dataset))
