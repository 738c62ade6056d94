"""What a motion file becomes: people in one world at one frame rate, z up, metres."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

FPS = 30.0
"""Frame rate of a :class:`Motion` unless another is asked for."""


@dataclass(frozen=True)
class MotionPerson:
    """One person through a motion of T frames. Rotations are axis-angle [rad], float64.

    ``pelvis`` is the world position of the pelvis *joint*, not a model's ``transl``. SMPL-family models
    turn about the pelvis, x_world = R (x_rest − j0) + j0 + transl, so pelvis = transl + j0 is the one
    position that survives a change of body model, of shape and of world axes. For a body with rest pelvis
    j0 take transl = pelvis − j0.

    ``betas`` belong to the shape space named by ``shape_space`` (``"smplx"``, ``"smplh"`` or ``"smpl"``); the
    coefficients of one space mean nothing in another.
    """

    gender: str
    betas: FloatArray
    global_orient: FloatArray
    pelvis: FloatArray
    body_pose: FloatArray
    left_hand_pose: FloatArray
    right_hand_pose: FloatArray
    jaw_pose: FloatArray
    leye_pose: FloatArray
    reye_pose: FloatArray
    expression: FloatArray
    has_hands: bool
    shape_space: str = "smplx"

    @property
    def num_frames(self) -> int:
        """T."""
        return len(self.pelvis)


@dataclass(frozen=True)
class Motion:
    """One or several people in one world: ``fps`` frames a second, z up, metres, near the ground z = 0.

    "Near": the lowest point of a nominal skeleton touches z = 0, by one shift for the whole scene, so that a
    pair keeps its relative height. The exact contact depends on the body model and is made where the body is.
    ``interactive`` says that the people were captured together (a pair), so their relative place has meaning.
    ``licence`` is what the file says in ``licence``, else its format's usual terms.
    ``up`` is the axis of the file that became z (such as ``"+y"``).
    """

    id: str
    source: str
    path: Path
    people: tuple[MotionPerson, ...]
    interactive: bool
    licence: str
    up: str = "+z"
    fps: float = FPS

    @property
    def num_frames(self) -> int:
        """T, the same for all people."""
        return self.people[0].num_frames


@dataclass(frozen=True)
class MotionFile:
    """A motion found on disk, not yet read.

    ``paths`` holds the file, or the two files of a pair in the order of their names. ``num_frames`` is the
    length at 30 fps where the header tells it. ``problem`` is the one-line reason why the file cannot be
    used; :func:`whacamole.motion.read_motion` raises it as :class:`whacamole.errors.MotionError`.
    """

    id: str
    paths: tuple[Path, ...]
    source: str
    num_frames: int | None = None
    num_people: int = 1
    problem: str | None = None

    @property
    def path(self) -> Path:
        """The first (or only) file."""
        return self.paths[0]
