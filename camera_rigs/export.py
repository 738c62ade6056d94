"""Camera paths in formats that other tools read, as text and dictionaries; no files are written."""

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from camera_rigs.path import CameraPath


def to_tum(path: CameraPath) -> str:
    """The path as TUM trajectory text: one line `time x y z qx qy qz qw` a frame, camera to world.

    Time in seconds from the first frame, metres, OpenCV axes, unit quaternions, the real part last.
    """
    time = np.arange(path.num_frames) / path.fps
    quaternion = Rotation.from_matrix(path.T_world_camera[:, :3, :3]).as_quat()
    rows = np.concatenate([time[:, None], path.location, quaternion], axis=1)
    return "".join(" ".join(f"{value:.9f}" for value in row) + "\n" for row in rows)


def to_nerfstudio(path: CameraPath, file_template: str = "rgb/{:06d}.jpg") -> dict[str, Any]:
    """The path as the dictionary of a nerfstudio `transforms.json`, intrinsics per frame.

    nerfstudio's cameras have OpenGL axes (x right, y up, z backward): T · diag(1, −1, −1, 1).

    Args:
        path: the camera path.
        file_template: path of the image of a frame relative to the file, formatted with the frame index.
    """
    opengl = path.T_world_camera @ np.diag([1.0, -1.0, -1.0, 1.0])
    frames = [
        {
            "file_path": file_template.format(index),
            "transform_matrix": opengl[index].tolist(),
            "fl_x": float(K[0, 0]),
            "fl_y": float(K[1, 1]),
            "cx": float(K[0, 2]),
            "cy": float(K[1, 2]),
            "w": path.width,
            "h": path.height,
        }
        for index, K in enumerate(path.K)
    ]
    return {"camera_model": "OPENCV", "frames": frames}
