"""Training: what it learns from, that it learns, that it goes on where it was."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from whacamole.baseline.augmentation import NO_AUGMENTATION, Augmentation, batch_rand, plain_batch
from whacamole.baseline.clips import Clip, Performance, clip_of, performances, windows_of
from whacamole.baseline.gaits import gait_rand
from whacamole.baseline.method import canonicalise
from whacamole.baseline.testing import measure
from whacamole.baseline.variants import Variation, mirrored, perform, variation_rand
from whacamole.baseline.velocimeter import FPS
from whacamole.body import BodyModel
from whacamole.errors import BaselineError
from whacamole.motion import embedded_motions

quick = settings(max_examples=10, deadline=None, derandomize=True)


@pytest.fixture(scope="module")
def walk() -> Performance:
    [found] = performances(embedded_motions() / "walk.npz")
    return found


@pytest.fixture(scope="module")
def clip(walk: Performance, body: BodyModel) -> Clip:
    return perform(walk, Variation(np.zeros(10)), body)


def test_without_augmentation_a_batch_is_the_truth(clip: Clip) -> None:
    batch = batch_rand(np.random.default_rng(0), [clip], 3, 32, NO_AUGMENTATION)
    joints = [canonicalise(clip.joints[s : s + 32], clip.orient[s]) for s in range(clip.num_frames - 31)]
    for row, window in enumerate(batch.joints):
        start = int(np.argmin([np.abs(window - j).max() for j in joints]))
        np.testing.assert_allclose(window, joints[start], atol=1e-12)
        moved = np.diff(clip.joints[start : start + 32, 0], axis=0) @ clip.orient[start]
        np.testing.assert_allclose(batch.velocities[row, 1:], moved, atol=1e-12)


def test_a_short_clip_is_filled_up_and_does_not_count_there(clip: Clip) -> None:
    short = Clip(clip.joints[:20], clip.orient[:20], "walk")
    batch = plain_batch([short], 32)
    assert batch.counts[0].tolist() == [0.0] + [1.0] * 19 + [0.0] * 12
    assert (batch.joints[0, 20:] == batch.joints[0, 19]).all()


def test_augmented_velocities_are_those_of_the_bent_and_resized_motion(clip: Clip) -> None:
    """Size and bends change joints and velocities together: bones keep their share, speeds follow the
    size."""
    by = replace(NO_AUGMENTATION, size=0.3)
    plain = batch_rand(np.random.default_rng(5), [clip], 8, 32, NO_AUGMENTATION)
    sized = batch_rand(np.random.default_rng(5), [clip], 8, 32, by)
    factor = np.linalg.norm(sized.joints[:, 0, 4], axis=-1) / np.linalg.norm(plain.joints[:, 0, 4], axis=-1)
    assert np.ptp(factor) > 0.1
    np.testing.assert_allclose(sized.velocities, plain.velocities * factor[:, None, None], atol=1e-9)
    bent = batch_rand(np.random.default_rng(5), [clip], 8, 32, replace(NO_AUGMENTATION, bend=60.0))
    speeds = [np.linalg.norm(b.velocities, axis=-1) for b in (plain, bent)]
    np.testing.assert_allclose(speeds[0], speeds[1], atol=1e-9)
    assert np.abs(bent.velocities[:, 1:].sum(axis=1) - plain.velocities[:, 1:].sum(axis=1)).max() > 0.01


def test_a_mirror_exchanges_left_and_right(clip: Clip) -> None:
    twin = mirrored(clip)
    np.testing.assert_allclose(twin.joints[:, 1], clip.joints[:, 2] * [-1, 1, 1])
    np.testing.assert_allclose(mirrored(twin).joints, clip.joints)
    np.testing.assert_allclose(np.linalg.det(twin.orient), 1.0)
    # The root's own axes still point to the person's left and ahead.
    left = twin.joints[:, 1] - twin.joints[:, 2]
    assert ((twin.orient[..., 0] * left).sum(axis=1) > 0.0).all()


@pytest.mark.parametrize("stride", [0.6, 1.4])
def test_longer_strides_go_further_and_the_standing_foot_still_stands(
    walk: Performance, clip: Clip, body: BodyModel, stride: float
) -> None:
    other = perform(walk, Variation(np.zeros(10), stride=stride), body)
    way, plain = (np.linalg.norm(c.joints[-1, 0, :2] - c.joints[0, 0, :2]) for c in (other, clip))
    assert (way - plain) * (stride - 1.0) > 0.0
    assert abs(way / plain - 1.0) > 0.15

    def slip(c: Clip) -> float:
        """Speed [m/s] of the slower ankle."""
        steps = np.linalg.norm(np.diff(c.joints[:, [5, 6]], axis=0), axis=-1)
        return float(steps.min(axis=1).mean() * FPS)

    assert slip(other) < slip(clip) + 0.12


def test_a_faster_pace_is_shorter_and_faster(walk: Performance, clip: Clip, body: BodyModel) -> None:
    fast = perform(walk, Variation(np.zeros(10), pace=1.25), body)
    assert fast.num_frames == pytest.approx(clip.num_frames / 1.25, abs=2)
    np.testing.assert_allclose(fast.joints[0], clip.joints[0])
    speeds = [np.linalg.norm(np.diff(c.joints[:, 0], axis=0), axis=1).mean() for c in (fast, clip)]
    assert speeds[0] / speeds[1] == pytest.approx(1.25, rel=0.02)


@given(st.integers(0, 10_000))
@quick
def test_made_up_walkers_stand_on_the_foot_that_bears(seed: int) -> None:
    body = BodyModel.embedded()
    clip = gait_rand(np.random.default_rng(seed), body, np.zeros(10))
    pelvis = clip.joints[:, 0]
    assert 0.4 < pelvis[:, 2].mean() < 1.1
    assert np.linalg.norm(np.diff(pelvis, axis=0), axis=1).max() * FPS < 12.0
    same = gait_rand(np.random.default_rng(seed), body, np.zeros(10))
    np.testing.assert_array_equal(clip.joints, same.joints)


def test_windows_cover_a_clip_once(clip: Clip) -> None:
    parts = list(windows_of([clip], 64))
    np.testing.assert_array_equal(np.concatenate([part.joints for part in parts]), clip.joints)


class _Training:
    """A training too small to be good, large enough to be one."""

    def __init__(self, walk: Performance, body: BodyModel, steps: int) -> None:
        from whacamole.baseline.training import TrainingData, TrainingRecipe

        self.body = body
        held_out = [clip_of(walk.params(body, np.zeros(10)), body, "walk")]
        self.data = TrainingData([walk], [], held_out)
        noise = Augmentation(bias=0.0, wander=0.0, jitter=0.0)
        self.recipe = TrainingRecipe(
            steps=steps, batch=4, takes=1, gaits=2, refresh=5, augmentation=noise, rate=3e-3
        )

    def run(self, folder: Path, stop: int | None = None) -> dict[str, np.ndarray]:
        from whacamole.baseline import training

        def watch(progress: training.Progress) -> None:
            if progress.step == stop:
                raise KeyboardInterrupt

        return dict(training.train(self.data, self.recipe, self.body, folder, watch).weights)


@pytest.fixture
def often_saved(monkeypatch: pytest.MonkeyPatch) -> None:
    training = pytest.importorskip("whacamole.baseline.training")
    monkeypatch.setattr(training, "SAVE_EVERY", 4)
    monkeypatch.setattr(training, "MEASURE_EVERY", 4)


@pytest.mark.usefixtures("often_saved")
def test_a_training_that_was_stopped_goes_on_as_if_it_had_not_been(
    walk: Performance, body: BodyModel, tmp_path: Path
) -> None:
    training = _Training(walk, body, 12)
    whole = training.run(tmp_path / "whole")
    with pytest.raises(KeyboardInterrupt):
        training.run(tmp_path / "stopped", stop=7)
    resumed = training.run(tmp_path / "stopped")
    for name, value in whole.items():
        np.testing.assert_array_equal(resumed[name], value, err_msg=name)


@pytest.mark.usefixtures("often_saved")
def test_a_checkpoint_of_another_recipe_is_refused(
    walk: Performance, body: BodyModel, tmp_path: Path
) -> None:
    _Training(walk, body, 4).run(tmp_path)
    with pytest.raises(BaselineError, match="another recipe"):
        _Training(walk, body, 8).run(tmp_path)


@pytest.mark.slow
@pytest.mark.usefixtures("often_saved")
def test_it_learns(walk: Performance, body: BodyModel, tmp_path: Path) -> None:
    from whacamole.baseline.velocimeter import MotionVelocimeter

    early, late = (
        MotionVelocimeter(_Training(walk, body, steps).run(tmp_path / str(steps))) for steps in (4, 160)
    )
    clips = [clip_of(walk.params(body, np.zeros(10)), body, "walk")]
    before, after = measure(early, clips), measure(late, clips)
    assert before is not None
    assert after is not None
    assert after.drift < 0.7 * before.drift


def test_variations_are_drawn_from_one_generator() -> None:
    one, other = (variation_rand(np.random.default_rng(4), 1.0) for _ in range(2))
    assert one.stride == other.stride
    assert variation_rand(np.random.default_rng(4), 0.0).stride == 1.0
