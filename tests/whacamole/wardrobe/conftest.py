"""A body, a member and a short movement."""

import numpy as np
import pytest

from whacamole.body import JOINT_INDEX, BodyModel, BodyParams
from whacamole.wardrobe import cast


@pytest.fixture(scope="session")
def body():
    return BodyModel.embedded()


@pytest.fixture(scope="session")
def member():
    return cast(1)


@pytest.fixture(scope="session")
def make_params():
    """Random believable movement of a few frames for a shape."""

    def make(betas, frames=5, seed=0, scale=0.3):
        rng = np.random.default_rng(seed)
        zeros = BodyParams.zeros(frames, betas)
        pose = rng.normal(0, scale, (21, 3))
        pose[JOINT_INDEX["left_shoulder"] - 1, 2] -= 1
        pose[JOINT_INDEX["right_shoulder"] - 1, 2] += 1
        steps = np.linspace(0, 1, frames)[:, None]
        arrays = zeros.to_arrays()
        arrays["body_pose"] = steps[..., None] * pose
        arrays["global_orient_world"] = steps * rng.normal(0, 1, 3)
        arrays["transl_world"] = steps * rng.normal(0, 1, 3)
        arrays["expression"] = steps * rng.normal(0, 1, 10)
        arrays["jaw_pose"] = steps * np.array([0.2, 0, 0])
        return BodyParams.from_arrays(arrays)

    return make
