"""Clothes pose as the body does."""

import numpy as np
import pytest
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from whacamole.body import BodyParams
from whacamole.wardrobe.catalogue import catalogue
from whacamole.wardrobe.layer import item_layer, join

ITEMS = ("tee", "jeans", "trainers_white", "hair_long", "brows_01")


@pytest.mark.parametrize("name", ITEMS)
def test_a_layer_is_the_mix_of_its_support_plus_offsets(name):
    wardrobe = catalogue()
    geometry, support = wardrobe.geometry(name), wardrobe.support
    betas = np.random.default_rng(0).normal(size=10)
    shaped = support.v_template + support.shapedirs @ betas
    expected = np.einsum("nk,nkc->nc", geometry.weights, shaped[geometry.refs]) + geometry.offsets
    np.testing.assert_allclose(item_layer(wardrobe, name).rest(betas), expected, atol=2e-6)


@pytest.mark.parametrize("name", ITEMS)
def test_at_rest_a_layer_stays_where_it_was_bound(body, name):
    layer = item_layer(catalogue(), name)
    betas = np.linspace(-1, 1, 10)
    posed = layer.pose(body, BodyParams.zeros(2, betas))
    np.testing.assert_allclose(posed[0], layer.rest(betas), atol=2e-6)


def test_turning_the_root_moves_clothes_rigidly_with_the_body(body):
    betas = np.linspace(1, -1, 10)
    turn = Rotation.from_rotvec([0.3, -1.2, 0.5])
    arrays = BodyParams.zeros(1, betas).to_arrays()
    arrays["global_orient_world"] = turn.as_rotvec()[None]
    arrays["transl_world"] = np.array([[1.0, -2.0, 0.5]])
    params = BodyParams.from_arrays(arrays)
    layer = join([item_layer(catalogue(), name) for name in ITEMS])
    pelvis = body.rest_joints(betas)[0]
    expected = turn.apply(layer.rest(betas) - pelvis) + pelvis + [1.0, -2.0, 0.5]
    np.testing.assert_allclose(layer.pose(body, params)[0], expected, atol=1e-5)


def test_a_joined_layer_is_its_parts_in_order(body, member, make_params):
    params = make_params(member.betas)
    parts = [item_layer(catalogue(), name) for name in ITEMS]
    whole = join(parts).pose(body, params)
    np.testing.assert_array_equal(whole, np.concatenate([part.pose(body, params) for part in parts], axis=1))


@pytest.mark.parametrize("seed", range(3))
def test_tight_clothes_stay_on_the_skin(body, member, make_params, seed):
    """Whatever the pose, cloth is about as far from the body as at rest (frame 0)."""
    params = make_params(member.betas, seed=seed)
    skin = body.pose(params).vertices
    for name in ("jeans_fitted", "trainers_white", "tee_fitted"):
        cloth = item_layer(catalogue(), name).pose(body, params)
        gaps = [cKDTree(skin[frame]).query(cloth[frame])[0] for frame in range(params.num_frames)]
        assert np.max(np.abs(gaps - gaps[0])) < 0.03, name


def test_a_shape_a_frame_is_refused(body, make_params):
    params = BodyParams.zeros(2, np.zeros(10))
    arrays = params.to_arrays() | {"betas": np.zeros((2, 10))}
    with pytest.raises(ValueError, match="one shape"):
        item_layer(catalogue(), "tee").pose(body, BodyParams.from_arrays(arrays))
