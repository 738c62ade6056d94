"""The equations of WHAC, one function each, NumPy only.

The world is the frame of the first camera, so that camera 0 is the identity. Subscripts of the paper: h
human, c camera; superscript: the frame. Lengths are metres, velocities metres a frame (the network's frame is
1/30 s).
"""

from collections.abc import Sequence

import numpy as np

from whacamole.baseline.rigid import FloatArray, inverse, rigid, rotate
from whacamole.evaluation.core.alignment import Similarity, umeyama

VELOCIMETER_JOINTS = (0, 1, 2, 4, 5, 7, 8, 12, 15, 16, 17, 18, 19, 20, 21)
"""The SMPL-X joints that the velocimeter sees: pelvis, hips, knees, ankles, neck, head, shoulders, elbows,
wrists, left before right."""

SCALE_WINDOW = 5
"""Frames in a window of the release's scale."""


def depth_from_scale(scale: FloatArray, focal: FloatArray, crop_side: FloatArray) -> FloatArray:
    """Depth of the root from a weak-perspective scale: t_z = (2 / I) (f / s), paper section 3.2.

    Args:
        scale: s, of a camera that sees [−1, 1] across the crop.
        focal: f [px] of the whole image.
        crop_side: I [px], side of the square crop in the whole image.

    Returns:
        t_z [m].
    """
    depth: FloatArray = (2.0 / crop_side) * (focal / scale)
    return depth


def refocus(root: FloatArray, focal: FloatArray | float, other: FloatArray | float) -> FloatArray:
    """The root (…, 3) [m] that an estimator would have placed had it been told another focal length.

    t_z is proportional to f (:func:`depth_from_scale`) and the root's pixel stays, so x and y stay too.
    """
    moved = root.copy()
    moved[..., 2] *= np.asarray(other) / np.asarray(focal)
    return moved


def joints_to_world(joints_camera: FloatArray, T_vo: FloatArray) -> FloatArray:
    """Camera-frame joints (T, J, 3) in the world by the odometry's poses T_vo (T, 4, 4), camera to world.

    Only the rotation carries over to what follows: the translation, whose unit nobody knows, is the same for
    all joints of a frame and leaves with the pelvis in :func:`canonicalise`.
    """
    turned = joints_camera @ np.swapaxes(T_vo[:, :3, :3], -1, -2)
    world: FloatArray = turned + T_vo[:, None, :3, 3]
    return world


def canonicalise(joints_world: FloatArray, first_orient: FloatArray) -> FloatArray:
    """Joints (T, J, 3) as the velocimeter takes them: pelvis at the origin, turned by the first root's
    inverse.

    θ_go,0⁻¹ (x_i − p_i). The pelvis is taken off frame by frame, as the paper's appendix and the released
    code do (its main text takes off the first one).

    Args:
        joints_world: (T, J, 3) [m], joint 0 is the pelvis.
        first_orient: θ_go,0 (3, 3), the root's orientation in the world at frame 0.
    """
    canonical: FloatArray = (joints_world - joints_world[:, :1]) @ first_orient
    return canonical


def decanonicalise(velocities: FloatArray, first_orient: FloatArray) -> FloatArray:
    """Velocities (T, 3) back in the world: V_i = θ_go,0 V_cano,i."""
    turned: FloatArray = velocities @ first_orient.T
    return turned


def trajectory(velocities: FloatArray) -> FloatArray:
    """Path (T, 3) [m] from velocities (T, 3), each from the frame before; frame 0 is the origin."""
    steps = velocities.copy()
    steps[:1] = 0.0
    return np.cumsum(steps, axis=0)


def derived_camera(T_world_human: FloatArray, T_camera_human: FloatArray) -> FloatArray:
    """Camera poses (T, 4, 4) that put the seen human where the velocimeter has him: T_c = T_h^w (T_h^c)⁻¹.

    Metric, since both humans are; drifting, since T_h^w is a sum of velocities.
    """
    derived: FloatArray = T_world_human @ inverse(T_camera_human)
    return derived


def align(vo: Sequence[FloatArray], derived: Sequence[FloatArray]) -> Similarity:
    """Umeyama's similarity from the odometry's camera path to the derived one, over one run of frames or
    several.

    Every run (a person over consecutive frames) has a path with an origin of its own, so each is taken about
    its mean; scale and rotation are common. For one run this is Umeyama's solution. The translation is left
    at zero: the world's origin is the first camera.

    Args:
        vo, derived: camera centres (n, 3) of each run, in any unit and in metres.

    Returns:
        Scale, rotation, no translation; the scale is NaN where the odometry never moves.
    """
    source = np.concatenate([_centred(path) for path in vo])
    target = np.concatenate([_centred(path) for path in derived])
    found = umeyama(source, target)
    return Similarity(found.scale, found.rotation, np.zeros(3))


def align_scale(vo: Sequence[FloatArray], derived: Sequence[FloatArray]) -> float:
    """The scale alone, with both paths in the world they share: s = Σ ⟨x, y⟩ / Σ ⟨x, x⟩.

    Both paths stand on the odometry's rotations, so no rotation between them is wanted; a fitted one turns
    the path against its own orientations and pushes the scale of a noisy path up.

    Returns:
        NaN where the odometry never moves; at least 0.
    """
    source = np.concatenate([_centred(path) for path in vo])
    target = np.concatenate([_centred(path) for path in derived])
    square = float((source * source).sum())
    return max(float((source * target).sum()) / square, 0.0) if square > 0.0 else float("nan")


def window_scales(vo: FloatArray, derived: FloatArray, window: int = SCALE_WINDOW) -> FloatArray:
    """The release's scales (n − window + 1,): Umeyama over every window of frames; 0 where it is
    undefined."""
    if len(vo) < window:
        return np.zeros(0)
    moving = np.lib.stride_tricks.sliding_window_view
    source, target = (np.swapaxes(moving(path, window, axis=0), -1, -2) for path in (vo, derived))
    return np.nan_to_num(np.asarray(umeyama(source, target).scale, dtype=np.float64))


def final_camera(T_vo: FloatArray, similarity: Similarity) -> FloatArray:
    """Metric camera poses (T, 4, 4): the odometry's rotations, its positions after the similarity."""
    positions = np.asarray(similarity.apply(T_vo[:, :3, 3]), dtype=np.float64)
    return rigid(T_vo[:, :3, :3], positions)


def final_human(T_world_camera: FloatArray, T_camera_human: FloatArray) -> FloatArray:
    """Metric human poses (T, 4, 4): T_h^w = T_c^w T_h^c."""
    placed: FloatArray = T_world_camera @ T_camera_human
    return placed


def human_poses(orient: FloatArray, root: FloatArray) -> FloatArray:
    """T_h (T, 4, 4) from root orientations (T, 3, 3) and root positions (T, 3)."""
    return rigid(orient, root)


def turned_roots(T_vo: FloatArray, roots: FloatArray) -> FloatArray:
    """Camera-frame roots (T, 3) turned into the world's axes, without the camera's place."""
    return rotate(T_vo[:, :3, :3], roots)


def _centred(path: FloatArray) -> FloatArray:
    centred: FloatArray = path - path.mean(axis=0)
    return centred
