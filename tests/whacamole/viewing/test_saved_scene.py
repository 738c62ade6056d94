"""The saved scene opens from disk in Chromium, alone, and plays forward and back."""

from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import chromium
import tiny_dataset
from whacamole.cli import app
from whacamole.dataset import Dataset
from whacamole.viewing.bodies import actors_of, model_for
from whacamole.viewing.live import serving
from whacamole.viewing.scene3d import GRID, Look, Scene3D
from whacamole.viewing.thinning import thinned_surface

CENTRE = (slice(0, 640), slice(380, 1100))
"""The part of the window that neither caption nor notices cover."""


_BAR = "document.querySelector('.mantine-Slider-root')"
_PLACE = (
    f"(() => {{ const r = {_BAR}.getBoundingClientRect();"
    " return [r.left, r.top + r.height / 2, r.width]; })()"
)
_SHARE = (
    f"(() => {{ const s = {_BAR}.querySelector('[role=slider]');"
    " return s.ariaValueNow / s.ariaValueMax; })()"
)


def _at(tab: chromium.Tab, share: float) -> np.ndarray:
    """Move the time bar, which also pauses, and return what is seen when it has settled."""
    left, middle, width = tab.value(_PLACE)
    for _ in range(50):
        tab.click(left + share * width, middle)
        tab.value("new Promise(done => setTimeout(done, 300))")
        if abs(tab.value(_SHARE) - share) < 0.02:
            break
    else:
        raise AssertionError("the time bar does not stay")
    before = tab.picture()[CENTRE]
    for _ in range(60):
        tab.value("new Promise(done => setTimeout(done, 700))")
        now = tab.picture()[CENTRE]
        if np.array_equal(before, now):
            return now
        before = now
    raise AssertionError("the scene never settles")


@pytest.mark.slow
@chromium.needs_chromium
def test_it_plays_forward_and_back(dataset: Dataset, tmp_path: Path) -> None:
    page = tmp_path / "walk.html"
    done = CliRunner().invoke(
        app, ["view", str(dataset.layout.root), "walk-00", "--save", str(page)], catch_exceptions=False
    )
    assert done.exit_code == 0
    assert page.stat().st_size < 3_000_000
    with chromium.tab(tmp_path / "profile") as tab:
        tab.open(page)
        tab.wait("document.querySelector('.mantine-Slider-root') !== null")
        tab.value("new Promise(done => setTimeout(done, 3000))")
        # The viewer draws coarser while the machine is busy: a round in which that changed tells nothing.
        for _ in range(5):
            first, last, again = (_at(tab, share) for share in (0.05, 0.97, 0.05))
            if np.mean(np.abs(first.astype(int) - again) > 8) < 0.002:
                break
        assert tab.value("document.title") == "walk-00"
        assert "touches the ground" in tab.value("document.querySelector('#about').innerText")
        assert tab.errors == []
        assert tab.requests == []
    assert first.std() > 5  # something is drawn
    # The person leaps six metres in the last frame; back at the first frame all is as it was.
    assert np.mean(np.any(first != last, axis=-1)) > 0.005
    assert np.mean(np.abs(first.astype(int) - again) > 8) < 0.002


def test_a_saved_scene_shows_every_frame_at_its_time(dataset: Dataset, tmp_path: Path) -> None:
    sequence = dataset["duet-00"]
    with serving("127.0.0.1", 0) as server:
        model = model_for(sequence, None)
        look, surface = Look(rounded=True), thinned_surface(model)
        scene = Scene3D(server, sequence, actors_of(sequence, model), surface, look=look)
        recorder = server.get_scene_serializer()
        for frame in range(len(sequence)):
            scene.show(frame)
            recorder.insert_sleep(1 / tiny_dataset.FPS)
        shown = [
            (time, message["updates"]["vertices"])
            for time, message in recorder._messages
            if message["type"] == "SceneNodeUpdateMessage" and message["name"] == "/people/1"
            and "vertices" in message["updates"]
        ]  # fmt: skip
        buffers = recorder._binary_buffers
    assert len({round(time * tiny_dataset.FPS) for time, _ in shown}) == len(sequence)
    actor = scene.actors[0]
    for frame, (time, packed) in enumerate(shown[-len(sequence) :]):
        assert round(time * tiny_dataset.FPS) == frame
        index = next(value for value in packed.values() if isinstance(value, int))
        stored = np.frombuffer(buffers[index], np.float32).reshape(-1, 3)
        wanted = actor.vertices(frame)[scene.surface.vertices]
        assert np.abs(stored - wanted).max() <= GRID / 2 + 1e-6
