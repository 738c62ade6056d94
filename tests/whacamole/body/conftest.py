"""Shared by the tests of the body: random parameters, a synthetic model in the SMPL-X schema."""

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from whacamole.body import JOINT_NAMES, BodyModel, BodyParams

Array = npt.NDArray[Any]
MakeParams = Callable[..., BodyParams]
MakeArrays = Callable[..., dict[str, Array]]

# The tree as the official files have it, written out so that the package's table is not its own judge.
SMPLX_PARENTS = [
    2**32 - 1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 15, 15, 15,
    20, 25, 26, 20, 28, 29, 20, 31, 32, 20, 34, 35, 20, 37, 38,
    21, 40, 41, 21, 43, 44, 21, 46, 47, 21, 49, 50, 21, 52, 53,
]  # fmt: skip


@pytest.fixture(scope="session")
def model() -> BodyModel:
    return BodyModel.embedded()


@pytest.fixture(scope="session")
def make_params() -> MakeParams:
    """Random parameters: bends up to about a radian, a step of metres, every coefficient in use."""

    def make(seed: int, num_frames: int, betas_per_frame: bool = False) -> BodyParams:
        rng = np.random.default_rng(seed)
        T = num_frames
        return BodyParams(
            betas=rng.normal(size=(T, 10) if betas_per_frame else 10),
            expression=rng.normal(size=(T, 10)),
            global_orient=rng.normal(size=(T, 3)),
            transl=2 * rng.normal(size=(T, 3)),
            body_pose=0.4 * rng.normal(size=(T, 21, 3)),
            left_hand_pose=0.4 * rng.normal(size=(T, 15, 3)),
            right_hand_pose=0.4 * rng.normal(size=(T, 15, 3)),
            jaw_pose=0.2 * rng.normal(size=(T, 3)),
            leye_pose=0.2 * rng.normal(size=(T, 3)),
            reye_pose=0.2 * rng.normal(size=(T, 3)),
        )

    return make


@pytest.fixture(scope="session")
def make_arrays() -> MakeArrays:
    """A random full-schema model. Everything is dense and in use, so that no index can be confused unseen."""

    def make(seed: int = 0, V: int = 40, width: int = 20) -> dict[str, Array]:
        rng = np.random.default_rng(seed)
        regressor = rng.dirichlet(np.full(V, 0.1), size=len(JOINT_NAMES))
        return {
            "v_template": rng.normal(size=(V, 3)),
            "f": rng.integers(0, V, size=(2 * V, 3), dtype=np.uint32),
            "shapedirs": 0.02 * rng.normal(size=(V, 3, width)),
            "posedirs": 0.002 * rng.normal(size=(V, 3, 486)),
            "J_regressor": regressor,
            "weights": rng.dirichlet(np.full(len(JOINT_NAMES), 0.05), size=V),
            "kintree_table": np.array([SMPLX_PARENTS, range(len(JOINT_NAMES))], dtype=np.int64),
            "vt": rng.random((V + 5, 2)),
            "ft": rng.integers(0, V + 5, size=(2 * V, 3), dtype=np.uint32),
            "lmk_faces_idx": rng.integers(0, 2 * V, size=51),
            "lmk_bary_coords": rng.dirichlet(np.ones(3), size=51),
            "hands_meanl": rng.normal(size=45),
            "hands_meanr": rng.normal(size=45),
            "hands_componentsl": np.eye(45),
            "hands_componentsr": np.eye(45),
        }

    return make
