"""Bodies to score on: one interface over SMPL-X, SMPL-H and SMPL."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from whacamole.body import JOINT_INDEX, NUM_BETAS, NUM_EXPRESSION, BodyModel, BodyParams
from whacamole.body.skinning import Skin, rotations, skin_block
from whacamole.evaluation.core.alignment import FloatArray
from whacamole.evaluation.records import BodyKind, IntArray
from whacamole.evaluation.smpl import SmplModel

Float32Array = npt.NDArray[np.float32]

_PUBLISHED_FEET = {("smpl", 6890): (3216, 3387, 6617, 6787), ("smplh", 6890): (3216, 3387, 6617, 6787),
                   ("smplx", 10475): (8549, 8702, 8915, 6855)}  # fmt: skip
"""Foot vertices of WHAM's and GVHMR's evaluators (SMPL) and of BEDLAM2's (SMPL-X)."""

DENSE = 0.2
"""Share of pose correctives that are not zero from which on a dense product is the faster one."""

_SOLE = 0.02
"""Vertices this near the lowest of their foot at rest [m] may be its heel or toe."""


@dataclass(frozen=True, eq=False)
class LocalPose:
    """A person's pose on F frames without its root: what a body model needs beside the placement."""

    betas: FloatArray
    body_pose: FloatArray
    left_hand: FloatArray
    right_hand: FloatArray
    face: FloatArray
    expression: FloatArray
    root: FloatArray | None = None
    """(F, 3) turn about the pelvis, ``None`` for none."""

    def part(self, rows: IntArray, root: FloatArray | None = None) -> "LocalPose":
        """Some of the frames, with a turn of the root."""
        betas = self.betas[rows] if self.betas.ndim == 2 else self.betas
        rest = {
            name: getattr(self, name)[rows]
            for name in ("body_pose", "left_hand", "right_hand", "face", "expression")
        }
        return LocalPose(betas, **rest, root=root)


class Body(Protocol):
    """A body model as the scores need it. Local means: pelvis joint at the origin, the world left out."""

    kind: BodyKind
    extras: Mapping[str, Any]
    scored: IntArray | slice
    """Vertices that PVE is the mean over, as rows of :meth:`local_vertices`; a slice costs no copy."""
    feet: IntArray
    """Four foot points, as rows of :meth:`local_vertices`."""

    @property
    def topology(self) -> str:
        """Bodies with equal topology have the same vertices in the same order."""

    @property
    def weights(self) -> FloatArray:
        """Skinning weights (V, J) of the rows of :meth:`local_vertices`."""

    def rest_pelvis(self, betas: FloatArray) -> FloatArray:
        """j0 (…, 3) [m] for shapes (…, B)."""

    def local_joints(self, pose: LocalPose) -> FloatArray:
        """(F, J, 3) [m]."""

    def local_vertices(self, pose: LocalPose) -> Float32Array:
        """(V, 3, F) [m], frames last: the layout of :mod:`whacamole.evaluation.core.surface`."""


class SmplxBody:
    """A :class:`whacamole.body.BodyModel`; with ``sample`` only about so many vertices are posed."""

    kind: BodyKind = "smplx"

    def __init__(self, model: BodyModel, sample: int | None = None) -> None:
        V, full = model.num_vertices, model.arrays
        feet = foot_points(model.v_template, model.weights, self.kind)
        self.topology = f"smplx-{V}" if sample is None else f"smplx-{V}/{sample}"
        self.model, self.extras, self.feet = model, model.extras, feet
        self.scored: IntArray | slice = slice(None)
        kept: IntArray = np.arange(V)
        if sample is not None and sample < V:
            even = np.linspace(0, V - 1, sample).round().astype(np.intp)
            kept = np.unique(np.concatenate([even, feet]))
            self.scored, self.feet = np.searchsorted(kept, even), np.searchsorted(kept, feet)
        self._weights = full.weights[kept]
        self._template = full.v_template[kept].reshape(-1, 1)
        self._shape_dirs = full.shapedirs[kept].reshape(-1, NUM_BETAS)
        correctives = full.posedirs[(3 * kept[:, None] + np.arange(3)).ravel()]
        dense = bool(full.posedirs.nnz > DENSE * np.prod(full.posedirs.shape))
        self._skin = Skin.build(full.expression_dirs[kept], correctives, self._weights, dense=dense)

    @property
    def weights(self) -> FloatArray:
        """See :class:`Body`."""
        return self._weights

    def rest_pelvis(self, betas: FloatArray) -> FloatArray:
        """See :class:`Body`."""
        return self.model.rest_joints(_wide(betas))[..., 0, :]

    def local_joints(self, pose: LocalPose) -> FloatArray:
        """See :class:`Body`."""
        joints = self.model.pose_joints(self._params(pose))
        return joints - joints[:, :1]

    def local_vertices(self, pose: LocalPose) -> Float32Array:
        """See :class:`Body`."""
        params = self._params(pose)
        full = params.full_pose()
        rest = np.broadcast_to(self.model.rest_joints(params.betas, params.expression), full.shape)
        shaped = self._shape_dirs @ np.atleast_2d(params.betas).T.astype(np.float32)
        shaped += self._template
        vertices, joints = skin_block(self._skin, shaped, params.expression, rotations(full), rest)
        vertices -= joints[:, 0].T.astype(np.float32)
        return vertices

    def _params(self, pose: LocalPose) -> BodyParams:
        still = np.zeros((len(pose.body_pose), 3))
        root = still if pose.root is None else pose.root
        jaw, leye, reye = np.moveaxis(pose.face, 1, 0)
        return BodyParams(
            betas=_wide(pose.betas), expression=pose.expression, global_orient=root, transl=still,
            body_pose=pose.body_pose[:, :21], left_hand_pose=pose.left_hand, right_hand_pose=pose.right_hand,
            jaw_pose=jaw, leye_pose=leye, reye_pose=reye,
        )  # fmt: skip


class SmplBody:
    """A :class:`~whacamole.evaluation.smpl.SmplModel`, SMPL or SMPL-H."""

    def __init__(self, model: SmplModel) -> None:
        self.model, self.extras = model, model.extras
        self.kind: BodyKind = "smpl" if len(model.parents) == 24 else "smplh"
        self.topology = f"smpl-{len(model.v_template)}"  # SMPL-H has SMPL's vertices
        self.scored: IntArray | slice = slice(None)
        self.feet = foot_points(model.v_template, model.weights, self.kind)

    @property
    def weights(self) -> FloatArray:
        """See :class:`Body`."""
        return self.model.weights

    def rest_pelvis(self, betas: FloatArray) -> FloatArray:
        """See :class:`Body`."""
        return self.model.rest_joints(betas)[..., 0, :]

    def local_joints(self, pose: LocalPose) -> FloatArray:
        """See :class:`Body`."""
        joints = self.model.pose_joints(self._full(pose), pose.betas)
        return joints - joints[:, :1]

    def local_vertices(self, pose: LocalPose) -> Float32Array:
        """See :class:`Body`."""
        joints, vertices = self.model.pose(self._full(pose), pose.betas)
        vertices -= joints[:, 0].T.astype(np.float32)
        return vertices

    def _full(self, pose: LocalPose) -> FloatArray:
        root = np.zeros((len(pose.body_pose), 1, 3)) if pose.root is None else pose.root[:, None]
        rest = (pose.left_hand, pose.right_hand) if self.kind == "smplh" else ()
        body = pose.body_pose[:, :21] if self.kind == "smplh" else _with_hands(pose.body_pose)
        return np.concatenate([root, body, *rest], axis=1)


def _with_hands(body_pose: FloatArray) -> FloatArray:
    """SMPL's 23 joints of a pose of 21 (hands flat) or 23."""
    return np.pad(body_pose, ((0, 0), (0, 23 - body_pose.shape[1]), (0, 0)))


def _wide(betas: FloatArray) -> FloatArray:
    """Ten shape coefficients of however many."""
    cut = betas[..., :NUM_BETAS]
    return np.pad(cut, [(0, 0)] * (cut.ndim - 1) + [(0, NUM_BETAS - cut.shape[-1])])


def foot_points(template: npt.NDArray[Any], weights: npt.NDArray[Any], kind: BodyKind) -> IntArray:
    """Four foot vertices: the published ones for the published meshes, else left toe, heel, right toe, heel.

    Toe and heel are the foremost and rearmost (+z is forward) of the vertices of a foot that lie within 2 cm
    of its lowest at rest.
    """
    published = _PUBLISHED_FEET.get((kind, len(template)))
    if published:
        return np.array(published, dtype=np.intp)
    points = []
    for side in ("left", "right"):
        foot = weights[:, [JOINT_INDEX[f"{side}_ankle"], JOINT_INDEX[f"{side}_foot"]]].sum(axis=1) > 0.5
        sole = np.flatnonzero(foot & (template[:, 1] < template[foot, 1].min() + _SOLE))
        points += [sole[template[sole, 2].argmax()], sole[template[sole, 2].argmin()]]
    return np.array(points, dtype=np.intp)


def full_expression(expression: FloatArray | None, frames: int) -> FloatArray:
    """Ten expression coefficients (F, 10) of however many, or of none."""
    if expression is None:
        return np.zeros((frames, NUM_EXPRESSION))
    cut = expression[:, :NUM_EXPRESSION]
    return np.pad(cut, ((0, 0), (0, NUM_EXPRESSION - cut.shape[1])))
