"""Whether the cameras of a sequence are cameras, and move like one."""

import numpy as np
from scipy.spatial.transform import Rotation

from whacamole.check.findings import Report
from whacamole.check.limits import Limits
from whacamole.labels.arrays import AnyArray


def check_cameras(camera: dict[str, AnyArray], limits: Limits, report: Report) -> bool:
    """Rigid, inverse of one another, of sensible optics, without jumps.

    Returns:
        Whether the matrices are cameras at all, so that the other checks can go on.
    """
    before = len(report.found)
    pose, inverse, K = camera["T_world_camera"], camera["T_camera_world"], camera["K"]
    R = pose[:, :3, :3]
    stretch = np.abs(R @ R.transpose(0, 2, 1) - np.eye(3)).max(axis=(1, 2))
    report.at_most("camera.T_world_camera", "the rotation is not orthonormal", stretch, limits.rigid)
    report.at_most("camera.T_world_camera", "the axes are mirrored", 1 - np.linalg.det(R), 1.0)
    for name, matrix in (("T_world_camera", pose), ("T_camera_world", inverse)):
        rest = np.abs(matrix[:, 3] - [0, 0, 0, 1]).max(axis=1)
        report.at_most(f"camera.{name}", "the last row is not 0 0 0 1", rest, 0.0)
    mismatch = np.abs(pose @ inverse - np.eye(4)).max(axis=(1, 2))
    report.at_most("camera.T_camera_world", "not the inverse of T_world_camera", mismatch, limits.rigid * 10)
    _check_optics(K, int(camera["width"]), int(camera["height"]), report)
    if len(report.found) > before:
        return False
    fps = float(camera["fps"])
    if len(pose) > 2:
        jump = np.linalg.norm(np.diff(pose[:, :3, 3], n=2, axis=0), axis=1) * fps**2
        report.at_most(
            "camera.T_world_camera", "the camera jumps [m/s²]", _centred(jump), limits.acceleration
        )
        step = Rotation.from_matrix(R[1:]) * Rotation.from_matrix(R[:-1]).inv()
        turn = np.linalg.norm(np.diff(step.as_rotvec(), axis=0), axis=1) * fps**2
        report.at_most("camera.T_world_camera", "the camera twitches [rad/s²]", _centred(turn), limits.spin)
    return True


def _centred(values: AnyArray) -> AnyArray:
    """Second differences, at the middle one of their three frames."""
    return np.concatenate([[0.0], values, [0.0]])


def _check_optics(K: AnyArray, width: int, height: int, report: Report) -> None:
    form = np.abs(K[:, [0, 1, 2, 2, 2], [1, 0, 0, 1, 2]] - [0, 0, 0, 0, 1]).max(axis=1)
    report.at_most("camera.K", "skew, or a last row other than 0 0 1", form, 1e-9)
    focal = K[:, [0, 1], [0, 1]]
    report.at_most("camera.K", "a focal length that is not positive", -focal.min(axis=1), -1e-6)
    centre = np.abs(K[:, :2, 2] / [width, height] - 0.5).max(axis=1)
    report.at_most("camera.K", "the principal point is far from the image's middle", centre, 0.5)
