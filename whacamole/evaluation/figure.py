"""A person with a body on the frames that can be scored: joints and vertices, placed in either space."""

from collections.abc import Mapping
from functools import cached_property

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

from whacamole.body import PARENTS
from whacamole.errors import EvaluationError
from whacamole.evaluation.bodies import Body, Float32Array, LocalPose, full_expression
from whacamole.evaluation.core.alignment import FloatArray
from whacamole.evaluation.records import (
    BoolArray,
    CameraTrack,
    IntArray,
    PersonTrack,
    Placement,
    Space,
    usable,
)
from whacamole.evaluation.smpl import chain


class Figure:
    """One person on the frames where nothing is missing.

    Args:
        person: parameters.
        body: the model they belong to; ``None`` if only stored joints are wanted.
        camera: the recording's camera, by which one space follows from the other where the source gives only
            one.
        stored: joints (T, 55, 3) that the source itself gives, taken in place of the body's.
        mean_betas: one shape for the track, the mean of what was given.
        smooth_root: σ of a Gaussian over the root's path in the world [frames], 0 for none.

    Attributes:
        rows: frames of the recording (F,).
        dropped: frames that should count but hold values that are not finite.
    """

    def __init__(
        self,
        person: PersonTrack,
        body: Body | None,
        camera: CameraTrack | None = None,
        stored: Mapping[Space, FloatArray] | None = None,
        *,
        mean_betas: bool = False,
        smooth_root: float = 0.0,
    ) -> None:
        self.person, self.body = person, body
        usable = person.valid & _finite(person, stored or {})
        self.dropped = int((person.valid & ~usable).sum())
        if camera is not None and (person.world is None or person.camera is None):
            usable = usable & camera.valid
        self.rows: IntArray = np.flatnonzero(usable)
        self._stored = {space: joints[self.rows] for space, joints in (stored or {}).items()}
        self._T_world_camera = None if camera is None else camera.T_world_camera[self.rows]
        self._smooth_root = smooth_root
        betas = person.betas if person.betas.ndim == 1 else person.betas[self.rows]
        betas = betas if len(self.rows) else np.zeros_like(betas)
        self.betas = betas.mean(axis=0) if mean_betas and betas.ndim == 2 and len(betas) else betas
        self._roots: dict[Space, tuple[FloatArray, FloatArray] | None] = {}

    @cached_property
    def pose(self) -> LocalPose:
        """The pose without the root."""
        person, rows = self.person, self.rows
        face = [
            np.zeros((len(rows), 3)) if part is None else part[rows]
            for part in (person.jaw_pose, person.leye_pose, person.reye_pose)
        ]
        expression = None if person.expression is None else person.expression[rows]
        return LocalPose(
            betas=self.betas,
            body_pose=person.body_pose[rows],
            left_hand=self._hand("l", person.left_hand_pose),
            right_hand=self._hand("r", person.right_hand_pose),
            face=np.stack(face, axis=1),
            expression=full_expression(expression, len(rows)),
        )

    def _hand(self, side: str, given: FloatArray | None) -> FloatArray:
        """Fifteen axis-angles; principal components are about the model's mean hand."""
        if given is None:
            return np.zeros((len(self.rows), 15, 3))
        if given.ndim == 3:
            return given[self.rows]
        extras, count = self._body.extras, given.shape[1]
        if f"hands_components{side}" not in extras or f"hands_mean{side}" not in extras:
            raise EvaluationError("its body model has no hand components, which the hand poses are given in")
        full = given[self.rows] @ np.asarray(extras[f"hands_components{side}"])[:count]
        return np.asarray(full + extras[f"hands_mean{side}"]).reshape(-1, 15, 3)

    @property
    def _body(self) -> Body:
        if self.body is None:
            raise EvaluationError(
                "its joints are not stored and its body model was not given; add --body-model"
            )
        return self.body

    @cached_property
    def local_joints(self) -> FloatArray:
        """(F, J, 3) [m], pelvis at the origin, root not turned."""
        if self._stored:
            space, joints = next(iter(self._stored.items()))
            root = self.root(space)
            if root is not None:
                return (joints - joints[:, :1]) @ root[0]
        return self._body.local_joints(self.pose)

    def local_vertices(self, at: IntArray, turn: FloatArray | None = None) -> Float32Array:
        """(V, 3, len(at)) [m] of some of the rows, pelvis at the origin, root turned by (len(at), 3, 3)."""
        root = None if turn is None else Rotation.from_matrix(turn).as_rotvec()
        return self._body.local_vertices(self.pose.part(at, root))

    def root(self, space: Space) -> tuple[FloatArray, FloatArray] | None:
        """Orientation (F, 3, 3) and pelvis (F, 3) [m] in a space, ``None`` where nothing tells."""
        if space not in self._roots:
            found = self._given(space) or self._derived(space)
            if found and space == "world" and self._smooth_root:
                found = found[0], gaussian_filter1d(found[1], self._smooth_root, axis=0, mode="reflect")
            self._roots[space] = found
        return self._roots[space]

    def _given(self, space: Space) -> tuple[FloatArray, FloatArray] | None:
        placement = self.person.world if space == "world" else self.person.camera
        if placement is None:
            return None
        orient = (
            Rotation.from_rotvec(placement.orient[self.rows]).as_matrix()
            if len(self.rows)
            else np.empty((0, 3, 3))
        )
        if space in self._stored:
            return orient, self._stored[space][:, 0]
        return orient, placement.transl[self.rows] + self._body.rest_pelvis(self.betas)

    def _derived(self, space: Space) -> tuple[FloatArray, FloatArray] | None:
        """From the other space, through the camera."""
        other = self._given("camera" if space == "world" else "world")
        if other is None or self._T_world_camera is None:
            return None
        R, t = self._T_world_camera[:, :3, :3], self._T_world_camera[:, :3, 3]
        if space == "world":
            return R @ other[0], np.einsum("fij,fj->fi", R, other[1]) + t
        turned = np.swapaxes(R, -1, -2)
        return turned @ other[0], np.einsum("fij,fj->fi", turned, other[1] - t)

    def place(self, local: FloatArray, space: Space, at: IntArray | None = None) -> FloatArray | None:
        """Local points (F, N, 3) in a space; ``at`` says which rows they are of."""
        root = self.root(space)
        if root is None:
            return None
        orient, pelvis = root if at is None else (root[0][at], root[1][at])
        return local @ np.swapaxes(orient, -1, -2) + pelvis[:, None]

    def joints(self, space: Space) -> FloatArray | None:
        """All joints (F, J, 3) [m] in a space."""
        return self._stored[space] if space in self._stored else self.place(self.local_joints, space)

    def joint_rotations(self, space: Space) -> FloatArray | None:
        """Global rotations (F, 22, 3, 3) of the body joints."""
        root = self.root(space)
        if root is None:
            return None
        pose = self.person.body_pose[self.rows, :21]
        local = Rotation.from_rotvec(pose.reshape(-1, 3)).as_matrix().reshape(-1, 21, 3, 3)
        chained = np.concatenate([root[0][:, None], local], axis=1)
        return chain(chained, np.zeros((len(pose), 22, 3)), PARENTS[:22])[0]


def _finite(person: PersonTrack, stored: Mapping[Space, FloatArray]) -> BoolArray:
    """Frames (T,) whose every number is finite and no larger than a body or a place allows."""
    placements: list[Placement] = [p for p in (person.world, person.camera) if p is not None]
    arrays: list[FloatArray | None] = [
        person.body_pose, person.left_hand_pose, person.right_hand_pose, person.jaw_pose, person.leye_pose,
        person.reye_pose, person.expression, *(p.orient for p in placements), *(p.transl for p in placements),
        *stored.values(),
    ]  # fmt: skip
    if person.betas.ndim == 2:
        arrays.append(person.betas)
    shaped = person.betas.ndim == 2 or bool(usable(person.betas[None])[0])
    given = [usable(array) for array in arrays if array is not None]
    return np.asarray(np.logical_and.reduce([np.full(len(person.valid), shaped), *given]))
