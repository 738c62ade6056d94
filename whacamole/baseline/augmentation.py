"""Batches for the velocimeter: random windows, seen by a random camera through random noise.

What an estimator gets wrong is wrong in the camera's frame: more along the viewing direction, slowly varying,
and with a bias. So a camera is drawn for every window (as in WHAM's augmentor: yaw anywhere, pitch and roll
normal, moving three times out of four), noise is put on in its frame, and all goes back to the world by a
camera rotation that drifts.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from whacamole.baseline.clips import Clip
from whacamole.baseline.rigid import FloatArray, rotate
from whacamole.baseline.velocimeter import FPS


@dataclass(frozen=True)
class Augmentation:
    """How much a window is disturbed; angles in degrees, lengths in metres, standard deviations.

    Attributes:
        bend: rate of turning laid over the motion [degrees a second].
        size: of the logarithm of a factor on everybody's size.
        bias: of a joint's place, constant over the window.
        wander: of a joint's place, slowly varying.
        jitter: of a joint's place, frame by frame.
        depth: factor on the three along the viewing direction.
        first_orient: of the root's orientation at frame 0, by which the window is turned.
        drift: of the camera's rotation, added up frame by frame.
    """

    bend: float = 25.0
    size: float = 0.08
    bias: float = 0.02
    wander: float = 0.015
    jitter: float = 0.004
    depth: float = 2.0
    first_orient: float = 6.0
    drift: float = 0.08


NO_AUGMENTATION = Augmentation(0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0)

_LEVEL = 2.0  # windows differ in quality: every one draws a factor from 0 to this on all of its noise
_MEMORY = 0.9  # of the wandering noise from frame to frame


@dataclass(frozen=True, eq=False)
class Batch:
    """B windows of L frames; a window shorter than L is filled up with its last frame.

    Attributes:
        joints: (B, L, 15, 3) canonical [m].
        velocities: (B, L, 3) canonical, each from the frame before [m a frame].
        counts: (B, L) whether the frame is of the window and has a frame before it.
    """

    joints: FloatArray
    velocities: FloatArray
    counts: FloatArray


def batch_rand(
    rng: np.random.Generator, clips: Sequence[Clip], size: int, length: int, augmentation: Augmentation
) -> Batch:
    """Draw ``size`` windows, a clip as often as it has frames, and disturb them."""
    frames = np.array([clip.num_frames for clip in clips], dtype=np.float64)
    chosen = rng.choice(len(clips), size=size, p=frames / frames.sum())
    cut = [_window_rand(rng, clips[i], length) for i in chosen]
    joints, orient, steps, counts = (np.stack(arrays) for arrays in zip(*(c[:4] for c in cut), strict=True))
    camera = _camera_rand(rng, size, length)
    for row, window in enumerate(cut):
        if window[4] is not None:
            camera[row] = window[4]
    return _disturb_rand(rng, joints, orient, steps, counts, camera, augmentation)


def plain_batch(windows: Sequence[Clip], length: int) -> Batch:
    """Windows as they are, for measuring errors."""
    cut = [_filled(window, 0, length) for window in windows]
    joints, orient, steps, counts = (np.stack(arrays) for arrays in zip(*(c[:4] for c in cut), strict=True))
    return _canonical(joints - joints[:, :, :1], steps, orient[:, 0], counts)


Window = tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray | None]


def _window_rand(rng: np.random.Generator, clip: Clip, length: int) -> Window:
    return _filled(clip, int(rng.integers(0, max(clip.num_frames - length, 0) + 1)), length)


def _filled(clip: Clip, start: int, length: int) -> Window:
    """Joints, root orientation, steps, counts and camera of a window, filled up to its length."""
    rows = np.minimum(np.arange(start, start + length), clip.num_frames - 1)
    pelvis = clip.joints[:, 0]
    steps = np.diff(pelvis, axis=0, prepend=pelvis[:1])[rows]
    counts = (np.arange(start, start + length) < clip.num_frames) & (rows > 0)
    camera = None if clip.camera is None else clip.camera[rows]
    return clip.joints[rows], clip.orient[rows], steps, counts.astype(np.float64), camera


def _camera_rand(rng: np.random.Generator, size: int, length: int) -> FloatArray:
    """Camera-to-world rotations (B, L, 3, 3), OpenCV axes in a world with z up; three in four move."""
    upright = Rotation.from_euler("x", -90.0, degrees=True)
    angles = rng.normal(size=(size, 3)) * np.radians([180.0, 22.5, 7.5]) + np.radians([0.0, 5.0, 0.0])
    first = (Rotation.from_euler("ZXY", angles) * upright).as_matrix()
    turn = rng.normal(size=(size, 3)) * np.radians([22.5, 45.0, 11.0]) * (rng.random((size, 1)) < 0.75)
    return first[:, None] @ _matrices(turn[:, None] * np.linspace(0.0, 1.0, length)[:, None])


def _disturb_rand(
    rng: np.random.Generator,
    joints: FloatArray,
    orient: FloatArray,
    steps: FloatArray,
    counts: FloatArray,
    camera: FloatArray,
    by: Augmentation,
) -> Batch:
    size, length = joints.shape[:2]
    factor = np.exp(by.size * rng.normal(size=(size, 1, 1)))
    local = (joints - joints[:, :, :1]) * factor[..., None]
    bend = _bend_rand(rng, size, length, by.bend)
    local = local @ np.swapaxes(bend, -1, -2)
    orient = bend @ orient
    steps = rotate(bend, steps * factor)
    level = rng.uniform(0.0, _LEVEL, size=(size, 1, 1, 1))
    seen = local @ camera + level * _noise_rand(rng, local.shape, by)
    drift = level[..., 0] * np.radians(by.drift) * rng.normal(size=(size, length, 3)).cumsum(axis=1)
    believed = _matrices(drift) @ camera
    local = seen @ np.swapaxes(believed, -1, -2)
    local = local - local[:, :, :1]
    wrong = _matrices(level[:, 0, 0] * np.radians(by.first_orient) * rng.normal(size=(size, 3)))
    return _canonical(local, steps, orient[:, 0] @ wrong, counts)


def _canonical(local: FloatArray, steps: FloatArray, first: FloatArray, counts: FloatArray) -> Batch:
    return Batch(local @ first[:, None], steps @ first, counts)


def _bend_rand(rng: np.random.Generator, size: int, length: int, degrees_a_second: float) -> FloatArray:
    """Turns about z (B, L, 3, 3) that grow by a rate that itself changes once."""
    rate = np.radians(degrees_a_second) / FPS * rng.normal(size=(size, 2))
    share = np.linspace(0.0, 1.0, length)
    angle = np.cumsum(rate[:, :1] * (1.0 - share) + rate[:, 1:] * share, axis=1)
    return _matrices(np.stack([0.0 * angle, 0.0 * angle, angle], axis=-1))


def _noise_rand(rng: np.random.Generator, shape: tuple[int, ...], by: Augmentation) -> FloatArray:
    """Noise (B, L, J, 3) in the camera's frame [m]."""
    size, length = shape[:2]
    bias = by.bias * rng.normal(size=(size, 1, *shape[2:]))
    wander = rng.normal(size=shape)
    for t in range(1, length):
        wander[:, t] = _MEMORY * wander[:, t - 1] + np.sqrt(1.0 - _MEMORY**2) * wander[:, t]
    noise: FloatArray = bias + by.wander * wander + by.jitter * rng.normal(size=shape)
    noise *= np.array([1.0, 1.0, by.depth])
    return noise


def _matrices(vectors: FloatArray) -> FloatArray:
    matrices: FloatArray = Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix()
    return matrices.reshape(*vectors.shape[:-1], 3, 3)
