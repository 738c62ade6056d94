"""The arrays of ``camera.npz``."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from camera_rigs import CameraPath
from whacamole.labels.arrays import AnyArray


@dataclass(frozen=True, eq=False)
class Film:
    """How the picture was exposed: a pinhole and an endless fast, noiseless sensor unless said otherwise.

    Attributes:
        shutter: share of the frame time during which the shutter was open, centred on the frame.
        f_number: focal length (film 36 mm along the longer side) over the lens's opening; inf is a pinhole.
        focus_distance: (T,) planar depth [m] in focus; None where all depths are.
        exposure: stops.
        noise: standard deviation of the sensor's noise at middle grey, in 8-bit levels.
        noise_seed: what the noise was drawn from.
    """

    shutter: float = 0.0
    f_number: float = np.inf
    focus_distance: NDArray[np.float64] | None = None
    exposure: float = 0.0
    noise: float = 0.0
    noise_seed: int = 0

    def arrays(self, num_frames: int) -> dict[str, AnyArray]:
        """Its part of ``camera.npz``, with ``focus_distance`` (T,) inf where all depths are in focus."""
        focus = np.full(num_frames, np.inf) if self.focus_distance is None else self.focus_distance
        return {
            "shutter": np.array(self.shutter, dtype=np.float64),
            "f_number": np.array(self.f_number, dtype=np.float64),
            "focus_distance": np.asarray(focus, dtype=np.float64),
            "exposure": np.array(self.exposure, dtype=np.float64),
            "noise": np.array(self.noise, dtype=np.float64),
            "noise_seed": np.array(self.noise_seed, dtype=np.int64),
        }


def camera_arrays(camera: CameraPath, film: Film | None = None) -> dict[str, AnyArray]:
    """``camera.npz`` for a path of T frames.

    Returns:
        ``K`` (T, 3, 3) pixels and ``T_world_camera``, ``T_camera_world`` (T, 4, 4) OpenCV axes, metres, all
        float64; ``fps`` float64, ``width``, ``height`` int64 scalars; ``frame_index`` (T,) int64; and the
        arrays of :class:`Film`.
    """
    return {
        "K": np.asarray(camera.K, dtype=np.float64),
        "T_world_camera": np.asarray(camera.T_world_camera, dtype=np.float64),
        "T_camera_world": np.asarray(camera.T_camera_world, dtype=np.float64),
        "fps": np.array(camera.fps, dtype=np.float64),
        "width": np.array(camera.width, dtype=np.int64),
        "height": np.array(camera.height, dtype=np.int64),
        "frame_index": np.arange(camera.num_frames, dtype=np.int64),
        **(film or Film()).arrays(camera.num_frames),
    }
