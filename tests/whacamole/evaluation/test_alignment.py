"""Umeyama's similarity against SciPy, evo, a second derivation and its own invariances."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from whacamole.evaluation.core.alignment import align, spread, umeyama

seeds = st.integers(0, 2**32 - 1)


def similarity(rng: np.random.Generator) -> tuple[float, np.ndarray, np.ndarray]:
    return (
        float(rng.uniform(0.2, 5.0)),
        Rotation.random(random_state=rng).as_matrix(),
        rng.normal(size=3) * 10,
    )


@settings(max_examples=50, deadline=None, derandomize=True)
@given(seeds, st.integers(3, 40))
def test_a_known_similarity_is_found_again(seed, count):
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(count, 3))
    s, R, t = similarity(rng)
    found = umeyama(points, s * points @ R.T + t)
    np.testing.assert_allclose(found.scale, s, rtol=1e-9)
    np.testing.assert_allclose(found.rotation, R, atol=1e-8)
    np.testing.assert_allclose(found.translation, t, atol=1e-8)


@settings(max_examples=5, deadline=None, derandomize=True)
@given(seeds)
def test_no_other_similarity_is_nearer(seed):
    rng = np.random.default_rng(seed)
    source, target = rng.normal(size=(12, 3)), rng.normal(size=(12, 3))

    def residual(p):
        return (np.exp(p[0]) * Rotation.from_rotvec(p[1:4]).apply(source) + p[4:] - target).ravel()

    ours = np.sum((align(source, target) - target) ** 2)
    starts = [np.r_[0.0, Rotation.random(random_state=rng).as_rotvec(), 0, 0, 0] for _ in range(2)]
    theirs = min(2.0 * least_squares(residual, start).cost for start in starts)
    assert ours <= theirs + 1e-9


@settings(max_examples=50, deadline=None, derandomize=True)
@given(seeds)
def test_the_rotation_is_that_of_scipy(seed):
    rng = np.random.default_rng(seed)
    source, target, weights = rng.normal(size=(9, 3)), rng.normal(size=(9, 3)), rng.uniform(0.1, 2.0, size=9)
    mean = [np.average(p, axis=0, weights=weights) for p in (source, target)]
    theirs, _ = Rotation.align_vectors(target - mean[1], source - mean[0], weights=weights)
    ours = umeyama(source, target, with_scale=False, weights=weights)
    np.testing.assert_allclose(ours.rotation, theirs.as_matrix(), atol=1e-9)
    assert ours.scale == 1.0


@settings(max_examples=25, deadline=None, derandomize=True)
@given(seeds, st.booleans())
def test_all_of_it_is_that_of_evo(seed, with_scale):
    geometry = pytest.importorskip("evo.core.geometry")
    rng = np.random.default_rng(seed)
    source, target = rng.normal(size=(20, 3)), rng.normal(size=(20, 3))
    rotation, translation, scale = geometry.umeyama_alignment(source.T, target.T, with_scale)
    ours = umeyama(source, target, with_scale=with_scale)
    np.testing.assert_allclose(ours.rotation, rotation, atol=1e-9)
    np.testing.assert_allclose(ours.translation, translation, atol=1e-9)
    np.testing.assert_allclose(ours.scale, scale, atol=1e-9)


def test_a_mirror_image_gets_a_rotation_all_the_same():
    points = np.random.default_rng(0).normal(size=(10, 3))
    found = umeyama(points, points * [-1.0, 1.0, 1.0])
    assert np.linalg.det(found.rotation) == pytest.approx(1.0)


def test_a_weight_is_a_repetition_and_weight_nothing_is_absence():
    rng = np.random.default_rng(1)
    source, target = rng.normal(size=(6, 3)), rng.normal(size=(6, 3))
    weights = np.array([1.0, 2.0, 0.0, 3.0, 1.0, 1.0])
    repeated = np.repeat(np.arange(6), weights.astype(int))
    weighted = umeyama(source, target, weights=weights)
    listed = umeyama(source[repeated], target[repeated])
    np.testing.assert_allclose(weighted.apply(source), listed.apply(source), atol=1e-12)


def test_many_at_once_are_each_alone():
    rng = np.random.default_rng(2)
    source, target = rng.normal(size=(2, 5, 7, 3)), rng.normal(size=(2, 5, 7, 3))
    together = align(source, target)
    for index in np.ndindex(2, 5):
        np.testing.assert_allclose(together[index], align(source[index], target[index]), atol=1e-12)


def test_the_precision_of_vertices_is_kept():
    rng = np.random.default_rng(3)
    points = rng.normal(size=(4, 14000, 3)).astype(np.float32)
    s, R, t = similarity(rng)
    moved = align(points, (s * points @ R.T + t).astype(np.float32))
    assert moved.dtype == np.float32
    assert np.abs(moved - (s * points @ R.T + t)).max() < 5e-5


def test_points_in_one_place_have_no_scale():
    here = np.ones((4, 3))
    assert np.isnan(umeyama(here, np.random.default_rng(0).normal(size=(4, 3))).scale)
    assert umeyama(here, here + 1.0, with_scale=False).apply(here) == pytest.approx(here + 1.0)


@pytest.mark.parametrize(("a", "b"), [((3, 3), (4, 3)), ((0, 3), (0, 3)), ((4, 2), (4, 2))])
def test_shapes_that_do_not_fit_are_refused(a, b):
    with pytest.raises(ValueError, match="umeyama"):
        umeyama(np.zeros(a), np.zeros(b))


def test_weights_must_weigh_something():
    with pytest.raises(ValueError, match="add up to nothing"):
        umeyama(np.zeros((3, 3)), np.zeros((3, 3)), weights=np.zeros(3))
    with pytest.raises(ValueError, match="weights"):
        umeyama(np.zeros((3, 3)), np.zeros((3, 3)), weights=np.zeros(4))


def test_spread_is_the_radius_of_a_circle():
    angle = np.linspace(0, 2 * np.pi, 100, endpoint=False)
    assert spread(np.stack([3 * np.cos(angle), 3 * np.sin(angle), 7 + 0 * angle], axis=1)) == pytest.approx(
        3.0
    )
