"""Errors of surfaces in float32 and frames last, against the same in float64 and frames first."""

import numpy as np
import pytest

from whacamole.evaluation.core.alignment import Similarity, umeyama
from whacamole.evaluation.core.pose import point_error, procrustes_error
from whacamole.evaluation.core.surface import Region, aligned_error, region_errors, surface_similarity

V, F = 700, 9  # no whole number of tiles


@pytest.fixture
def surfaces():
    """Two surfaces the size of a body (F, V, 3) [m], a few centimetres apart."""
    rng = np.random.default_rng(0)
    truth = 0.4 * rng.normal(size=(F, V, 3)) + 0.2
    return (truth + 0.05 * rng.normal(size=truth.shape)).astype(np.float32), truth.astype(np.float32)


def frames_last(points):
    return np.ascontiguousarray(points.transpose(1, 2, 0))


def test_regions_are_means_over_their_vertices(surfaces):
    rng = np.random.default_rng(1)
    theirs, ours = (side.astype(np.float64) for side in surfaces)
    shifts = rng.normal(size=(3, 3, F)) * np.array([0.0, 0.1, 5.0])[:, None, None]
    rows = [None, np.flatnonzero(rng.random(V) < 0.2), np.arange(300, 310)]
    found = region_errors(
        *map(frames_last, surfaces), [Region(*pair) for pair in zip(rows, shifts, strict=True)]
    )
    for error, chosen, shift in zip(found, rows, shifts, strict=True):
        part = slice(None) if chosen is None else chosen
        expected = point_error((theirs + shift.T[:, None])[:, part], ours[:, part])
        np.testing.assert_allclose(error, expected, rtol=2e-6)


def test_the_similarity_is_umeyamas(surfaces):
    found = surface_similarity(*map(frames_last, surfaces))
    exact = umeyama(*(side.astype(np.float64) for side in surfaces))
    np.testing.assert_allclose(found.rotation, exact.rotation, atol=2e-6)
    np.testing.assert_allclose(found.scale, exact.scale, atol=2e-6)
    np.testing.assert_allclose(found.translation, exact.translation, atol=2e-6)
    error = aligned_error(*map(frames_last, surfaces), found)
    np.testing.assert_allclose(error, procrustes_error(*(s.astype(np.float64) for s in surfaces)), rtol=2e-6)


def test_a_known_similarity_is_undone(surfaces):
    theirs = surfaces[0].astype(np.float64)
    turn = umeyama(*(side[:, :5].astype(np.float64) for side in surfaces)).rotation
    known = Similarity(np.full(F, 1.3), turn, np.arange(3.0 * F).reshape(F, 3))
    moved = known.apply(theirs).astype(np.float32)
    error = aligned_error(frames_last(surfaces[0]), frames_last(moved), known)
    np.testing.assert_allclose(error, 0.0, atol=1e-2)  # millimetres; the points are up to 40 m away
