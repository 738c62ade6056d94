from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from whacamole.body import BodyModel, BodyParams

SEEDS = st.integers(0, 2**32 - 1)


def _rigid(rng, frames=None):
    T = np.zeros((4, 4) if frames is None else (frames, 4, 4))
    T[..., :3, :3] = Rotation.random(frames, random_state=rng).as_matrix()
    T[..., :3, 3] = 3 * rng.normal(size=T[..., :3, 3].shape)
    T[..., 3, 3] = 1
    return T


@settings(max_examples=20, deadline=None, derandomize=True)
@given(seed=SEEDS, per_frame=st.booleans())
def test_transformed_parameters_pose_the_transformed_body(make_params, seed, per_frame):
    model = BodyModel.embedded()
    params = make_params(seed, 2)
    T_c = _rigid(np.random.default_rng(seed), 2 if per_frame else None)
    j0 = model.rest_joints(params.betas, params.expression)[:, 0]

    before, after = model.pose(params), model.pose(params.transformed(T_c, j0))

    R, t = T_c[..., :3, :3], T_c[..., :3, 3]
    moved = before.vertices.astype(np.float64) @ np.swapaxes(R, -1, -2) + np.expand_dims(t, -2)
    np.testing.assert_allclose(after.vertices, moved, atol=1e-5)
    np.testing.assert_allclose(
        after.joints, before.joints @ np.swapaxes(R, -1, -2) + np.expand_dims(t, -2), atol=1e-9
    )


@settings(max_examples=20, deadline=None, derandomize=True)
@given(seed=SEEDS)
def test_a_change_of_frame_and_back_changes_nothing(make_params, seed):
    params, rng = make_params(seed, 3), np.random.default_rng(seed)
    T_c, j0 = _rigid(rng, 3), rng.normal(size=3)
    back = params.transformed(T_c, j0).transformed(np.linalg.inv(T_c), j0)
    np.testing.assert_allclose(back.transl, params.transl, atol=1e-9)
    turn = Rotation.from_rotvec(back.global_orient) * Rotation.from_rotvec(params.global_orient).inv()
    assert turn.magnitude().max() < 1e-7


def test_transformed_refuses_what_is_not_a_rigid_motion(make_params):
    params = make_params(0, 2)
    mirror, scale = np.diag([1.0, 1.0, -1.0, 1.0]), np.diag([2.0, 2.0, 2.0, 1.0])
    for T_c in (mirror, scale):
        with pytest.raises(ValueError, match="not a rotation"):
            params.transformed(T_c, np.zeros(3))
    with pytest.raises(ValueError, match=r"T_new_old: shape \(3, 3\)"):
        params.transformed(np.eye(3), np.zeros(3))
    with pytest.raises(ValueError, match=r"rest_pelvis: shape \(1, 3\)"):
        params.transformed(np.eye(4), np.zeros((1, 3)))


def test_full_pose_lays_the_joints_out_as_smplx_does(make_params):
    params = make_params(1, 2)
    full = params.full_pose()
    assert full.shape == (2, 55, 3)
    for first, field in ((0, "global_orient"), (22, "jaw_pose"), (23, "leye_pose"), (24, "reye_pose")):
        np.testing.assert_array_equal(full[:, first], getattr(params, field))
    for first, field in ((1, "body_pose"), (25, "left_hand_pose"), (40, "right_hand_pose")):
        values = getattr(params, field)
        np.testing.assert_array_equal(full[:, first : first + values.shape[1]], values)


@pytest.mark.parametrize("field", [field.name for field in fields(BodyParams)])
def test_a_wrong_shape_or_a_nan_is_refused_by_name(make_params, field):
    params = make_params(2, 3)
    value = getattr(params, field)
    with pytest.raises(ValueError, match=rf"{'expression|' if field == 'transl' else ''}{field}: shape"):
        replace(params, **{field: value[..., :-1]} if field != "transl" else {field: value[:-1]})
    broken = value.copy()
    broken[..., 0] = np.nan
    with pytest.raises(ValueError, match=f"{field}: holds values that are not finite"):
        replace(params, **{field: broken})


def test_parameters_are_a_copy():
    transl = np.zeros((1, 3))
    params = replace(BodyParams.zeros(1), transl=transl)
    transl[:] = 9
    assert not params.transl.any()


@pytest.mark.parametrize("betas_per_frame", [False, True])
def test_slice_takes_the_same_frames_of_every_array(make_params, betas_per_frame):
    params = make_params(3, 6, betas_per_frame)
    part = params.slice(1, None, 2)
    assert part.num_frames == 3
    for field in fields(BodyParams):
        whole = getattr(params, field.name)
        expected = whole[1::2] if whole.shape[0] == 6 else whole
        np.testing.assert_array_equal(getattr(part, field.name), expected)


@pytest.mark.parametrize("frame", ["world", "camera"])
def test_arrays_carry_the_names_of_people_npz_and_come_back(make_params, frame):
    params = make_params(4, 3)
    arrays = params.to_arrays(frame)
    assert set(arrays) == {
        "betas", "expression", f"global_orient_{frame}", f"transl_{frame}", "body_pose", "left_hand_pose",
        "right_hand_pose", "jaw_pose", "leye_pose", "reye_pose",
    }  # fmt: skip
    back = BodyParams.from_arrays(arrays, frame)
    people = {key: np.stack([np.zeros_like(value), value]) for key, value in arrays.items()}
    second = BodyParams.from_arrays(people, frame, person=1)
    for field in fields(BodyParams):
        np.testing.assert_array_equal(getattr(back, field.name), getattr(params, field.name))
        np.testing.assert_array_equal(getattr(second, field.name), getattr(params, field.name))
    with pytest.raises(ValueError, match="no betas, jaw_pose"):
        BodyParams.from_arrays({k: v for k, v in arrays.items() if k not in ("betas", "jaw_pose")}, frame)
