"""SMPL and SMPL-H models from the user's own licensed files, posed in NumPy.

The project's :class:`whacamole.body.BodyModel` is SMPL-X. Benchmarks and methods in SMPL (24 joints) and
SMPL-H (52) need their own model files: ``.npz``, or the published ``.pkl``, read without executing anything.
"""

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Self

import numpy as np
import numpy.typing as npt
import scipy.sparse

from whacamole.body.skinning import Skin, deform, rotations
from whacamole.errors import EvaluationError
from whacamole.evaluation.core.alignment import FloatArray
from whacamole.evaluation.io import inert

Float32Array = npt.NDArray[np.float32]

NUM_JOINTS = {24: "smpl", 52: "smplh"}
_NEEDED = ("v_template", "shapedirs", "posedirs", "J_regressor", "weights", "kintree_table")


@dataclass(frozen=True, eq=False)
class SmplModel:
    """One SMPL or SMPL-H model (Loper et al., SIGGRAPH Asia 2015).

    Attributes:
        name, sha256: of the file.
        v_template: (V, 3) [m].
        shapedirs: (V, 3, B).
        posedirs: (3V, 9 (J − 1)) float32.
        joint_regressor: (J, V).
        weights: (V, J).
        parents: (J,), −1 for the root.
        extras: other plain arrays (hand components and means of SMPL-H).
    """

    name: str
    sha256: str
    v_template: FloatArray
    shapedirs: FloatArray
    posedirs: Float32Array
    joint_regressor: FloatArray
    weights: FloatArray
    parents: tuple[int, ...]
    extras: Mapping[str, Any]

    @classmethod
    def load(cls, path: Path) -> Self:
        """Read a model file.

        Raises:
            EvaluationError: it is no SMPL or SMPL-H model; one line.
        """
        arrays = _read(path)
        absent = [key for key in _NEEDED if key not in arrays]
        if absent:
            raise EvaluationError(f"{path}: no {', '.join(absent)}; give an SMPL or SMPL-H model file")
        weights = np.asarray(arrays["weights"], dtype=np.float64)
        V, J = weights.shape
        posedirs = np.asarray(arrays["posedirs"], dtype=np.float32).reshape(3 * V, -1)
        if J not in NUM_JOINTS or posedirs.shape[1] != 9 * (J - 1):
            raise EvaluationError(f"{path}: {J} joints, neither SMPL (24) nor SMPL-H (52)")
        parents = np.asarray(arrays["kintree_table"])[0].astype(np.int64).copy()
        parents[0] = -1
        return cls(
            name=path.stem,
            sha256=hashlib.sha256(path.read_bytes()).hexdigest(),
            v_template=np.asarray(arrays["v_template"], dtype=np.float64),
            shapedirs=np.asarray(arrays["shapedirs"], dtype=np.float64).reshape(V, 3, -1),
            posedirs=posedirs,
            joint_regressor=np.asarray(_dense(arrays["J_regressor"]), dtype=np.float64),
            weights=weights,
            parents=tuple(int(p) for p in parents),
            extras={key: value for key, value in arrays.items() if key not in _NEEDED},
        )

    def rest_joints(self, betas: FloatArray) -> FloatArray:
        """Joints (…, J, 3) [m] of shapes (…, B); missing coefficients are 0, surplus ones are left out."""
        template, directions = self._joint_shapes
        count = min(betas.shape[-1], directions.shape[2])
        joints: FloatArray = template + np.einsum(
            "jik,...k->...ji", directions[:, :, :count], betas[..., :count]
        )
        return joints

    @cached_property
    def _joint_shapes(self) -> tuple[FloatArray, FloatArray]:
        """Joints of the mean shape (J, 3) and their directions (J, 3, B): the vertices' ones, regressed."""
        directions = self.joint_regressor @ self.shapedirs.reshape(len(self.v_template), -1)
        return self.joint_regressor @ self.v_template, directions.reshape(-1, *self.shapedirs.shape[1:])

    def pose_joints(self, pose: FloatArray, betas: FloatArray) -> FloatArray:
        """Joints (T, J, 3) [m] of :meth:`pose` alone."""
        return self._posed(pose, betas)[2]

    def pose(self, pose: FloatArray, betas: FloatArray) -> tuple[FloatArray, Float32Array]:
        """Joints (T, J, 3) and vertices (V, 3, T) float32 [m], the rest pelvis in its place, no translation.

        Args:
            pose: axis-angle (T, J, 3).
            betas: (B,) or (T, B).
        """
        local, turned, placed, rest = self._posed(pose, betas)
        feature = (local[:, 1:] - np.eye(3)).reshape(len(pose), -1)
        moves = np.concatenate(
            [turned, (placed - np.einsum("tjab,tjb->tja", turned, rest))[..., None]], axis=-1
        )
        return placed, deform(self._skin, self._shaped(np.atleast_2d(betas)), feature, moves)

    def _shaped(self, betas: FloatArray) -> Float32Array:
        """Rest vertices (3V, n) of shapes (n, B)."""
        directions = self.shapedirs.reshape(3 * len(self.v_template), -1)
        count = min(betas.shape[1], directions.shape[1])
        shaped = self.v_template.reshape(-1, 1) + directions[:, :count] @ betas[:, :count].T
        return shaped.astype(np.float32)

    @cached_property
    def _skin(self) -> Skin:
        still = np.zeros((len(self.v_template), 3, 0), dtype=np.float32)
        weights = self.weights.astype(np.float32)
        return Skin.build(still, scipy.sparse.csr_array(self.posedirs), weights, dense=True)

    def _posed(
        self, pose: FloatArray, betas: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Local and global rotations (T, J, 3, 3), joints and joints at rest (T, J, 3)."""
        local = rotations(pose)
        rest = np.broadcast_to(self.rest_joints(betas), pose.shape)
        return local, *chain(local, rest, self.parents), rest


def chain(local: FloatArray, rest: FloatArray, parents: tuple[int, ...]) -> tuple[FloatArray, FloatArray]:
    """Global rotations (T, J, 3, 3) and joints (T, J, 3) of local rotations along a tree, parents first."""
    turned, placed = local.copy(), rest.copy()
    for joint, parent in enumerate(parents):
        if parent >= 0:
            turned[:, joint] = turned[:, parent] @ local[:, joint]
            offset = rest[:, joint] - rest[:, parent]
            placed[:, joint] = placed[:, parent] + np.einsum("tab,tb->ta", turned[:, parent], offset)
    return turned, placed


def _read(path: Path) -> dict[str, Any]:
    if path.suffix != ".npz":
        value = inert.load(path)
        if not isinstance(value, dict):
            raise EvaluationError(f"{path}: holds no model; give an SMPL or SMPL-H model file")
        return value
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as archive:
            return {key: archive[key] for key in archive.files if _plain(archive, key)}
    except (OSError, ValueError) as error:
        raise EvaluationError(f"{path}: not readable ({error}); fetch the model file again") from error


def _plain(archive: Any, key: str) -> bool:
    """Whether an entry is a plain array; official files also hold pickled ones, left unread."""
    try:
        archive[key]
    except ValueError:
        return False
    return True


def _dense(value: Any) -> Any:
    return value.toarray() if hasattr(value, "toarray") else value
