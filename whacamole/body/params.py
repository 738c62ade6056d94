"""SMPL-X parameters of one person over time, and their change of frame."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Literal, Self

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from whacamole.body.joints import NUM_BETAS, NUM_BODY_JOINTS, NUM_EXPRESSION, NUM_HAND_JOINTS

FloatArray = npt.NDArray[np.float64]
Frame = Literal["world", "camera"]

_PER_FRAME: dict[str, tuple[int, ...]] = {
    "expression": (NUM_EXPRESSION,),
    "global_orient": (3,),
    "transl": (3,),
    "body_pose": (NUM_BODY_JOINTS, 3),
    "left_hand_pose": (NUM_HAND_JOINTS, 3),
    "right_hand_pose": (NUM_HAND_JOINTS, 3),
    "jaw_pose": (3,),
    "leye_pose": (3,),
    "reye_pose": (3,),
}
_IN_A_FRAME = ("global_orient", "transl")


@dataclass(frozen=True, eq=False)
class BodyParams:
    """One person's SMPL-X parameters for T frames, axis-angle, flat hand = zero, float64.

    ``x_world = R (x_rest − j0) + j0 + transl``: SMPL-X turns about its rest pelvis ``j0``, not about the
    origin. Arrays are copied to float64; a wrong shape or a value that is not finite raises ``ValueError``
    with the field's name.

    Attributes:
        betas: (10,) shape; (T, 10) where a method predicts a shape for every frame.
        expression: (T, 10).
        global_orient: (T, 3) rotation of the root.
        transl: (T, 3) [m].
        body_pose: (T, 21, 3).
        left_hand_pose: (T, 15, 3).
        right_hand_pose: (T, 15, 3).
        jaw_pose: (T, 3).
        leye_pose: (T, 3).
        reye_pose: (T, 3).
    """

    betas: FloatArray
    expression: FloatArray
    global_orient: FloatArray
    transl: FloatArray
    body_pose: FloatArray
    left_hand_pose: FloatArray
    right_hand_pose: FloatArray
    jaw_pose: FloatArray
    leye_pose: FloatArray
    reye_pose: FloatArray

    def __post_init__(self) -> None:
        frames = np.shape(self.transl)[0] if np.ndim(self.transl) else 0
        for field in fields(self):
            value = np.array(getattr(self, field.name), dtype=np.float64)
            per_frame = _PER_FRAME.get(field.name, (NUM_BETAS,))
            wanted = [(frames, *per_frame)]
            if field.name == "betas":
                wanted.insert(0, (NUM_BETAS,))
            if value.shape not in wanted:
                raise ValueError(
                    f"{field.name}: shape {value.shape}, expected {' or '.join(map(str, wanted))}"
                )
            if not np.isfinite(value).all():
                raise ValueError(f"{field.name}: holds values that are not finite")
            object.__setattr__(self, field.name, value)

    @classmethod
    def zeros(cls, num_frames: int, betas: npt.ArrayLike | None = None) -> Self:
        """The rest pose at the origin for ``num_frames`` frames, with the mean shape or ``betas`` (10,)."""
        shape = np.zeros(NUM_BETAS) if betas is None else np.asarray(betas, dtype=np.float64)
        return cls(shape, **{name: np.zeros((num_frames, *tail)) for name, tail in _PER_FRAME.items()})

    @property
    def num_frames(self) -> int:
        """T."""
        return len(self.transl)

    def full_pose(self) -> FloatArray:
        """Rotations (T, 55, 3): root, body 21, jaw, left eye, right eye, left hand 15, right hand 15."""
        one_joint = (self.jaw_pose, self.leye_pose, self.reye_pose)
        return np.concatenate(
            [
                self.global_orient[:, None],
                self.body_pose,
                *(pose[:, None] for pose in one_joint),
                self.left_hand_pose,
                self.right_hand_pose,
            ],
            axis=1,
        )

    def transformed(self, T_new_old: npt.ArrayLike, rest_pelvis: npt.ArrayLike) -> Self:
        """The same body in another frame: ``R' = R_c R`` and ``t' = R_c (t + j0) + t_c − j0``.

        Args:
            T_new_old: rigid transform from the present frame to the new one, (4, 4) or one a frame (T, 4, 4).
            rest_pelvis: j0 (3,) or (T, 3) [m], ``BodyModel.rest_joints(...)[..., 0, :]`` for this shape.

        Raises:
            ValueError: the shapes do not fit or the transform is not rigid.
        """
        T_c = np.asarray(T_new_old, dtype=np.float64)
        j0 = np.asarray(rest_pelvis, dtype=np.float64)
        if T_c.shape not in ((4, 4), (self.num_frames, 4, 4)):
            raise ValueError(f"T_new_old: shape {T_c.shape}, expected (4, 4) or {(self.num_frames, 4, 4)}")
        if j0.shape not in ((3,), (self.num_frames, 3)):
            raise ValueError(f"rest_pelvis: shape {j0.shape}, expected (3,) or {(self.num_frames, 3)}")
        R_c, t_c = T_c[..., :3, :3], T_c[..., :3, 3]
        unit = np.abs(R_c @ np.swapaxes(R_c, -1, -2) - np.eye(3)).max(initial=0.0) < 1e-5
        if not unit or (np.linalg.det(R_c) < 0).any():
            raise ValueError("T_new_old: the upper left 3×3 is not a rotation")
        orient = Rotation.from_matrix(R_c) * Rotation.from_rotvec(self.global_orient)
        transl = (R_c * (self.transl + j0)[:, None, :]).sum(axis=-1) + t_c - j0
        return replace(self, global_orient=orient.as_rotvec(), transl=transl)

    def slice(self, start: int | None, stop: int | None, step: int | None = None) -> Self:
        """Frames ``start:stop:step``, as a Python slice reads them."""
        part = slice(start, stop, step)
        changes = {name: getattr(self, name)[part] for name in _PER_FRAME}
        if self.betas.ndim == 2:
            changes["betas"] = self.betas[part]
        return replace(self, **changes)

    def to_arrays(self, frame: Frame = "world") -> dict[str, FloatArray]:
        """Arrays by their names in ``people.npz``, the root's with their frame: ``global_orient_world`` …"""
        return {_key(field.name, frame): getattr(self, field.name) for field in fields(self)}

    @classmethod
    def from_arrays(
        cls, arrays: Mapping[str, npt.NDArray[np.generic]], frame: Frame = "world", person: int | None = None
    ) -> Self:
        """Read back :meth:`to_arrays`, or row ``person`` of the arrays of a ``people.npz`` or a prediction.

        Raises:
            ValueError: a key is absent or a shape is wrong.
        """
        names = {field.name: _key(field.name, frame) for field in fields(cls)}
        absent = sorted(key for key in names.values() if key not in arrays)
        if absent:
            raise ValueError(f"body parameters: no {', '.join(absent)}")
        values = {name: np.asarray(arrays[key], dtype=np.float64) for name, key in names.items()}
        return cls(**(values if person is None else {name: value[person] for name, value in values.items()}))


def _key(name: str, frame: Frame) -> str:
    """A field's name in the contract of ``people.npz``."""
    return f"{name}_{frame}" if name in _IN_A_FRAME else name
