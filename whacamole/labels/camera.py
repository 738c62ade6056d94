"""The arrays of ``camera.npz``."""

import numpy as np

from camera_rigs import CameraPath
from whacamole.labels.arrays import AnyArray


def camera_arrays(camera: CameraPath) -> dict[str, AnyArray]:
    """``camera.npz`` for a path of T frames.

    Returns:
        ``K`` (T, 3, 3) pixels and ``T_world_camera``, ``T_camera_world`` (T, 4, 4) OpenCV axes, metres, all
        float64; ``fps`` float64, ``width``, ``height`` int64 scalars; ``frame_index`` (T,) int64.
    """
    return {
        "K": np.asarray(camera.K, dtype=np.float64),
        "T_world_camera": np.asarray(camera.T_world_camera, dtype=np.float64),
        "T_camera_world": np.asarray(camera.T_camera_world, dtype=np.float64),
        "fps": np.array(camera.fps, dtype=np.float64),
        "width": np.array(camera.width, dtype=np.int64),
        "height": np.array(camera.height, dtype=np.int64),
        "frame_index": np.arange(camera.num_frames, dtype=np.int64),
    }
