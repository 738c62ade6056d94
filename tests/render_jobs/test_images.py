"""Image files: what they hold, and that they appear whole."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from render_jobs import PASSES
from render_jobs.budget import frame_bytes
from render_jobs.images import is_complete, label_writer, publish_frame, read_exr, write_exr, write_mask
from render_jobs.optics import flow_at_infinity, pixel_rays
from render_jobs.passes import RenderPass
from render_truth import camera, read_picture


@pytest.mark.parametrize(("largest", "dtype"), [(255, np.uint8), (256, np.uint16), (32767, np.uint16)])
def test_a_mask_is_as_wide_as_the_job_needs(tmp_path: Path, largest: int, dtype: type) -> None:
    ids = np.arange(12).reshape(3, 4) * (largest // 11)
    write_mask(tmp_path / "mask.png", ids, largest)
    back = read_picture(tmp_path / "mask.png")
    np.testing.assert_array_equal(back, ids)
    assert back.dtype == (dtype if dtype is np.uint8 else back.dtype)
    assert (tmp_path / "mask.png").read_bytes()[24] == np.iinfo(dtype).bits, "bit depth in the header"


def test_an_exr_keeps_every_bit_and_infinity(tmp_path: Path) -> None:
    depth = np.array([[1.1, np.inf, 1e-3], [7.0, 123456.7, 0.1]], np.float32)
    write_exr(tmp_path / "depth.exr", PASSES["depth"], depth)
    assert read_exr(tmp_path / "depth.exr")["Z"].tobytes() == depth.tobytes()
    write_exr(tmp_path / "again.exr", PASSES["depth"], depth)
    assert (tmp_path / "again.exr").read_bytes() == (tmp_path / "depth.exr").read_bytes()


def test_a_frame_is_published_whole_or_not_at_all(tmp_path: Path) -> None:
    def fail(path: Path) -> None:
        path.write_bytes(b"half")
        raise OSError("No space left on device")

    depth = label_writer("depth", np.ones((4, 4), np.float32), 1)
    with pytest.raises(OSError, match="No space"):
        publish_frame(tmp_path, 3, {"depth": depth, "mask": fail}, "jpg")
    assert not is_complete(tmp_path, 3, ("depth",), "jpg")
    assert [path.name for path in tmp_path.iterdir()] == [".partial"]
    mask = label_writer("mask", np.ones((4, 4), int), 1)
    publish_frame(tmp_path, 3, {"depth": depth, "mask": mask}, "jpg")
    assert is_complete(tmp_path, 3, ("depth", "mask"), "jpg")
    assert not is_complete(tmp_path, 3, ("depth", "mask", "rgb"), "jpg")


def test_flow_at_infinity_is_that_of_very_distant_points() -> None:
    path = camera(
        [[0, 0, 1], [0.3, 0.1, 1.2]], [[5, 9, 1], [5.5, 9, 1.3]], [80.0, 90.0], [[48.0, 32.0], [50.0, 29.0]]
    )
    (K, K_next), (pose, pose_next) = path.K, path.T_world_camera
    flow = flow_at_infinity(K, K_next, pose, pose_next, path.width, path.height)
    rays = pixel_rays(K, path.width, path.height).reshape(-1, 3)
    distant = rays * 1e9 @ pose[:3, :3].T + pose[:3, 3]
    pixels, depth = path.project(np.stack([distant, distant]))
    assert (depth > 0).all()
    np.testing.assert_allclose(flow.reshape(-1, 2), pixels[1] - pixels[0], atol=1e-5)
    centres = np.stack(np.meshgrid(np.arange(path.width) + 0.5, np.arange(path.height) + 0.5), axis=-1)
    np.testing.assert_allclose(pixels[0].reshape(path.height, path.width, 2), centres, atol=1e-6)


def test_what_ends_up_behind_the_camera_has_no_flow() -> None:
    path = camera([[0, 0, 1], [0, 0, 1]], [[0, 5, 1], [0, -5, 1]], [80.0] * 2, [[48.0, 32.0]] * 2)
    flow = flow_at_infinity(*path.K, *path.T_world_camera, path.width, path.height)
    assert np.isnan(flow).all()


def test_a_pass_that_was_not_measured_is_counted_by_its_values(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(PASSES, "new", RenderPass("new", "Two halves.", "1", "float16", ("A", "B"), "exr"))
    measured = frame_bytes(("rgb", "mask", "depth"), "jpg", 10, 20)
    assert frame_bytes(("rgb", "mask", "depth", "new"), "jpg", 10, 20) == pytest.approx(measured + 800)
