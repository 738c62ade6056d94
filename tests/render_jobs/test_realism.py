"""Motion blur, depth of field and noise: right by the equations of optics, and never in a label."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from render_jobs import PASSES, Environment, Mesh, Quality, RenderJob, run_job
from render_jobs.colour import linear_image
from render_jobs.noise import with_noise
from render_truth import SQUARE_FACES, camera, moving, read_picture, rendered_frame

ENGINES = [
    pytest.param("cycles", marks=pytest.mark.blender),
    pytest.param("raster", marks=pytest.mark.gl),
]
LABELS = ("mask", "depth", "normal", "flow")
GREY_ON_BLACK = Environment(color=(0.7, 0.7, 0.7), backdrop=(0.0, 0.0, 0.0))


def render(job: RenderJob, folder: Path, engine: str) -> Path:
    job.save(folder)
    run_job(folder, engine=engine, device="cpu", threads=2, timeout=300)
    return folder


def card(half: float, depth: float, step: tuple[float, float, float], frames: int) -> Mesh:
    """A square that faces the camera of these tests, at ``depth`` from it, and moves by ``step`` a frame."""
    corners = np.array([[-half, 0, -half], [half, 0, -half], [half, 0, half], [-half, 0, half]])
    place = np.array([0.0, depth - 4.0, 1.0])
    return Mesh("card", moving(corners + place, step, frames), SQUARE_FACES, track_id=5)


def spread(folder: Path, frame: int) -> NDArray[np.float64]:
    """The second moments (2, 2) [px²] of the light in a picture about its middle."""
    light = linear_image(read_picture(folder / "out" / "rgb" / f"{frame:06d}.png")).mean(axis=2).astype(float)
    y, x = np.indices(light.shape) + 0.5
    weight = light / light.sum()
    offset = np.stack([x - (weight * x).sum(), y - (weight * y).sum()])
    return np.asarray(np.einsum("ihw,jhw,hw->ij", offset, offset, weight))


def labels_of(folder: Path) -> dict[str, bytes]:
    files = sorted(path for name in LABELS for path in (folder / "out" / name).iterdir())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


@pytest.mark.parametrize("engine", ENGINES)
def test_the_picture_is_smeared_along_the_flow_and_the_labels_are_not(tmp_path: Path, engine: str) -> None:
    path = camera([[0.0, -4.0, 1.0]], [0.0, 0.0, 1.0], [100.0], [[48.0, 32.0]])
    sharp = RenderJob(
        path, (card(0.3, 4.0, (0.6, 0.0, 0.3), 1),), passes=tuple(PASSES), image_format="png",
        environment=GREY_ON_BLACK, tone="standard", quality=Quality(name="test", samples=48, denoise="off"),
    )  # fmt: skip
    shutter = 0.8
    still = render(sharp, tmp_path / "sharp", engine)
    blurred = render(replace(sharp, shutter=shutter), tmp_path / "blurred", engine)
    assert labels_of(blurred) == labels_of(still)
    found = rendered_frame(still, 0)
    flow = found.flow[found.mask == 5].mean(axis=0)
    np.testing.assert_allclose(flow, [15.0, -7.5], atol=0.01)  # 25 px/m, image y downwards
    # A smear of length L along d adds L²/12 to the second moment along d, and nothing across.
    expected = np.outer(shutter * flow, shutter * flow) / 12
    np.testing.assert_allclose(spread(blurred, 0) - spread(still, 0), expected, atol=0.6)


@pytest.mark.parametrize("engine", ENGINES)
def test_the_circle_of_confusion_is_that_of_the_thin_lens(tmp_path: Path, engine: str) -> None:
    """Upright image: the f-number goes by the longer side. In frame 1 the focus is pulled to the card."""
    focal, far, near = 100.0, 6.0, 2.0
    path = camera([[0.0, -4.0, 1.0]] * 2, [0.0, 0.0, 1.0], [focal] * 2, [[32.0, 48.0]] * 2, size=(64, 96))
    sharp = RenderJob(
        path, (card(0.06, near, (0.0, 0.0, 0.0), 2),), passes=tuple(PASSES), image_format="png",
        environment=GREY_ON_BLACK, tone="standard", quality=Quality(name="test", samples=128, denoise="off"),
    )  # fmt: skip
    pinhole = render(sharp, tmp_path / "pinhole", engine)
    pulled = np.array([far, far, near, near])
    spreads, radii = [], []
    for f_number in (0.25, 0.6):
        folder = render(
            replace(sharp, f_number=f_number, focus_distance=pulled), tmp_path / f"{f_number}", engine
        )
        assert labels_of(folder) == labels_of(pinhole)
        np.testing.assert_allclose(spread(folder, 1), spread(pinhole, 1), atol=0.03)
        spreads.append(spread(folder, 0))
        aperture = focal * 0.036 / 96 / f_number
        radii.append(aperture * focal * abs(1 / near - 1 / far) / 2)  # 2.5 and 1.04 px
    # A disc of radius r adds r²/4 along every axis. (Two discs are compared, as the edges of the sharp card
    # lie on those of pixels, where sampling takes off some of its spread.)
    expected = (radii[0] ** 2 - radii[1] ** 2) / 4
    np.testing.assert_allclose(spreads[0] - spreads[1], expected * np.eye(2), atol=0.07 * expected)


def test_noise_has_the_strength_asked_for_and_grows_with_the_light() -> None:
    greys = {level: Image.new("RGB", (200, 200), (level,) * 3) for level in (30, 118, 200)}
    noisy = {level: np.asarray(with_noise(grey, 5.0, 7, 0)).astype(float) for level, grey in greys.items()}
    assert noisy[118].std() == pytest.approx(5.0, rel=0.03)
    assert np.corrcoef(noisy[118][..., 0].ravel(), noisy[118][..., 1].ravel())[0, 1] < 0.02
    # In linear light the variance is proportional to the light plus a constant: two levels give both.
    light = {level: float(linear_image(np.array([level], np.uint8))[0]) for level in greys}
    variance = {level: linear_image(pixels.astype(np.uint8)).var() for level, pixels in noisy.items()}
    slope = (variance[200] - variance[118]) / (light[200] - light[118])
    assert variance[30] == pytest.approx(variance[118] - slope * (light[118] - light[30]), rel=0.15)
    assert slope > 0


def test_noise_is_repeatable_and_differs_from_frame_to_frame() -> None:
    grey = Image.new("RGB", (16, 16), (118,) * 3)
    once, again = with_noise(grey, 5.0, 7, 0), with_noise(grey, 5.0, 7, 0)
    assert once.tobytes() == again.tobytes()
    assert once.tobytes() != with_noise(grey, 5.0, 7, 1).tobytes()
    assert with_noise(grey, 0.0, 7, 0).tobytes() == grey.tobytes()
