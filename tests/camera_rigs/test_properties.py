"""Whatever the people do: no NaN, no flip, no breach, the fraction as asked."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from camera_rigs import SCALES, Lens, SubjectTrack, World, direct
from camera_rigs.scene import Scene
from camera_rigs.spherical import cartesian_to_spherical

SIZES = [(640, 360), (360, 640), (512, 512), (1920, 800), (300, 900)]


@st.composite
def people(draw):
    """One to three people who walk, sway, spin, lean as far as lying, and bob, anywhere in the world."""
    frames = draw(st.sampled_from([1, 2, 3, 5, 10, 24, 45, 60, 90, 150]))
    fps = draw(st.sampled_from([12.0, 24.0, 30.0, 60.0]))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    speed, sway, spin = draw(st.floats(0.0, 5.0)), draw(st.floats(0.0, 0.6)), draw(st.floats(-9.0, 9.0))
    frequency, winding = draw(st.floats(0.1, 1.5)), draw(st.floats(0.0, 1.0))
    lean, stature = draw(st.floats(0.0, np.pi / 2.0)), draw(st.floats(0.5, 2.1))
    noise, away = draw(st.sampled_from([0.0, 0.005, 0.02])), draw(st.sampled_from([0.0, 20.0, 500.0]))
    time = np.arange(frames) / fps
    everybody = []
    for index in range(draw(st.sampled_from([1, 1, 2, 3]))):
        phase = rng.uniform(0.0, 2.0 * np.pi, 6)
        course = phase[0] + winding * np.sin(2.0 * np.pi * 0.15 * time + phase[1])
        pelvis = np.full((frames, 3), away)
        pelvis[:, :2] += np.cumsum(np.column_stack([np.cos(course), np.sin(course)]) * speed / fps, axis=0)
        pelvis[:, :2] += sway * np.sin(2.0 * np.pi * frequency * time[:, None] + phase[2:4])
        pelvis[:, :2] += rng.normal(0.0, 1.2, 2) if index else 0.0
        bob = 0.1 * sway * np.sin(2.0 * np.pi * frequency * time + phase[4])
        pelvis[:, 2] = 0.55 * stature * np.cos(lean) + 0.2 + bob
        pelvis += noise * rng.normal(size=pelvis.shape)
        axis = np.column_stack(
            [np.sin(lean) * np.cos(course), np.sin(lean) * np.sin(course), 0.0 * time + np.cos(lean)]
        )
        turned = phase[5] + spin * time
        level = np.cos(lean) * np.column_stack([np.cos(turned), np.sin(turned), 0.0 * time])
        ends = np.stack([pelvis + 0.45 * stature * axis, pelvis - 0.5 * stature * axis])
        width = np.array([1.0, 1.0, 0.3]) * rng.uniform(0.05, 0.6)
        low, high = ends.min(axis=0) - width, ends.max(axis=0) + width
        low[:, 2] = np.clip(low[:, 2], 0.0, pelvis[:, 2] - 0.05)
        everybody.append((pelvis, pelvis + 0.3 * stature * axis, level, low, high))
    return SubjectTrack.from_people(*(np.stack(a) for a in zip(*everybody, strict=True)), fps)


lenses = st.builds(
    lambda size, fov: Lens.from_fov(np.radians(fov), *size), st.sampled_from(SIZES), st.floats(25.0, 100.0)
)


@settings(max_examples=120, deadline=None, derandomize=True)
@given(subject=people(), lens=lenses, shots=st.sampled_from(["auto", "all"]), seed=st.integers(0, 10**6))
def test_no_nan_no_flip_no_breach(subject, lens, shots, seed):
    plan = direct(subject, lens, World(), shots, np.random.default_rng(seed))
    pose = plan.path.T_world_camera
    assert np.isfinite(pose).all()
    assert np.isfinite(plan.path.K).all()
    assert (pose[:, 2, 1] < 0.0).all(), "the camera is never upside down"
    assert (np.einsum("ti,ti->t", plan.path.forward[1:], plan.path.forward[:-1]) > 0.9).all(), (
        "nor does it flip"
    )
    assert plan.findings == ()
    assert plan.path.num_frames == subject.num_frames


@settings(max_examples=150, deadline=None, derandomize=True)
@given(
    subject=people(),
    lens=lenses,
    scale=st.sampled_from(list(SCALES.values())),
    part=st.floats(0.0, 1.0),
    theta=st.floats(50.0, 105.0),
)
def test_the_framing_fills_what_it_says(subject, lens, scale, part, theta):
    """The extent is projected as two points, a second way to the closed form; face on in closer shots."""
    scene, polar = Scene(subject, lens), np.radians(theta)
    asked = scale.frac_min + part * (scale.frac_max - scale.frac_min)
    r, frac = scene.framing(0, asked, polar, scale, lens.focal)
    assert frac <= asked * (1.0 + 1e-9)
    above, below = (float(signal[0]) for signal in subject.extent(scale.anchor))
    image = lens.focal * image_of(scale, above, below, r, polar)
    assert (image[0] - image[1]) / lens.height == pytest.approx(frac, rel=1e-6)


def image_of(scale, above, below, r, theta):
    """Where head and feet lie over the anchor in an image of focal length 1."""
    ends = np.array([above, -below])
    if scale.anchor == "neck":
        return ends / r
    return ends * np.sin(theta) / (r - ends * np.cos(theta))


@settings(max_examples=60, deadline=None, derandomize=True)
@given(subject=people(), lens=lenses, seed=st.integers(0, 10**6))
def test_fractions_that_were_asked_for_are_in_the_finished_path(subject, lens, seed):
    plan = direct(subject, lens, World(), ["push-pull", "push", "pull"], np.random.default_rng(seed))
    for shot in plan.shots:
        scale = SCALES[shot.scale]
        for k in shot.keyframes:
            if k.frac is None or not float(k.frame).is_integer():
                continue
            frame = int(k.frame)
            offset = plan.path.location[frame] - plan.subject.anchor(scale.anchor)[frame]
            r, theta, _ = cartesian_to_spherical(offset)
            above, below = (float(signal[frame]) for signal in plan.subject.extent(scale.anchor))
            image = plan.path.focal[frame] * image_of(scale, above, below, r, theta)
            assert (image[0] - image[1]) / lens.height == pytest.approx(k.frac, rel=0.02)
