"""Whether what is stored about people follows from their parameters and the camera."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from whacamole.body import BodyModel, BodyParams
from whacamole.check.findings import Report
from whacamole.check.limits import Limits
from whacamole.dataset import Sequence
from whacamole.labels.arrays import Float64s

_BEHIND = 0.01
_LIMBS = {"left_hand": slice(25, 40), "right_hand": slice(40, 55)}


@dataclass(frozen=True, eq=False)
class Posed:
    """The people of a sequence, posed from their world-frame parameters.

    Attributes:
        model: the body model.
        params: of each person, world frame.
        joints: ``(P, T, 55, 3)`` in the world [m].
    """

    model: BodyModel
    params: list[BodyParams]
    joints: Float64s


def pose_people(sequence: Sequence, model: BodyModel) -> Posed:
    """Read the world-frame parameters and find the joints."""
    count = len(sequence.people["track_id"])
    params = [BodyParams.from_arrays(sequence.people, "world", number) for number in range(count)]
    return Posed(model, params, np.stack([model.pose_joints(person) for person in params]))


def check_bodies(sequence: Sequence, posed: Posed, limits: Limits, report: Report) -> None:
    """Joints, both frames of reference, projections and what is said about them."""
    people, camera = sequence.people, sequence.camera
    view = camera["T_camera_world"]
    for number, track in enumerate(people["track_id"].tolist()):
        joints = posed.joints[number]
        name = f"track {track}: "
        apart = np.linalg.norm(people["joints_world"][number] - joints, axis=-1)
        for limb, rows in _LIMBS.items():
            if apart[:, rows].max() > limits.joint >= np.delete(apart, np.r_[rows], axis=1).max():
                name = f"track {track}, {limb}: "
        message = name + "joints of the parameters lie elsewhere [m]"
        report.at_most("people.joints_world", message, apart.max(axis=1), limits.joint)
        in_camera = np.einsum("tij,tnj->tni", view[:, :3, :3], joints) + view[:, None, :3, 3]
        apart = np.linalg.norm(people["joints_camera"][number] - in_camera, axis=-1).max(axis=1)
        message = f"track {track}: not the world's joints seen from the camera [m]"
        report.at_most("people.joints_camera", message, apart, limits.joint)
        _check_projection(sequence, number, in_camera, limits, report)
        _check_camera_params(sequence, posed, number, limits, report)


def _check_camera_params(
    sequence: Sequence, posed: Posed, number: int, limits: Limits, report: Report
) -> None:
    """The camera-frame parameters pose the same body."""
    people, track = sequence.people, int(sequence.people["track_id"][number])
    view = sequence.camera["T_camera_world"]
    seen = posed.model.pose_joints(BodyParams.from_arrays(people, "camera", number))
    wanted = np.einsum("tij,tnj->tni", view[:, :3, :3], posed.joints[number]) + view[:, None, :3, 3]
    apart = np.linalg.norm(seen - wanted, axis=-1).max(axis=1)
    message = f"track {track}: the camera-frame body lies elsewhere than the world-frame one [m]"
    report.at_most("people.transl_camera", message, apart, limits.joint)
    world = Rotation.from_rotvec(people["global_orient_world"][number])
    turned = Rotation.from_matrix(view[:, :3, :3]) * world
    apart_by = turned.inv() * Rotation.from_rotvec(people["global_orient_camera"][number])
    off = np.linalg.norm(apart_by.as_rotvec(), axis=-1)
    message = f"track {track}: the camera-frame body is turned otherwise [rad]"
    report.at_most("people.global_orient_camera", message, off, limits.turn)


def _check_projection(
    sequence: Sequence, number: int, in_camera: Float64s, limits: Limits, report: Report
) -> None:
    people, camera = sequence.people, sequence.camera
    track = int(people["track_id"][number])
    stored = people["joints_image"][number]
    before = in_camera[..., 2] > _BEHIND
    depth = np.where(before, in_camera[..., 2], 1.0)
    pixel = np.einsum("tij,tnj->tni", camera["K"][:, :2], in_camera / depth[..., None])
    off = np.where(before, np.linalg.norm(stored - pixel, axis=-1), 0.0)
    # Far outside the image float32 itself is coarse.
    allowed = limits.pixel + 1e-6 * np.abs(pixel).max(axis=-1)
    message = f"track {track}: not where the camera projects the joints [px]"
    worst = (off - allowed).max(axis=1) + limits.pixel
    report.at_most("people.joints_image", message, worst, limits.pixel)
    width, height = int(camera["width"]), int(camera["height"])
    x, y = np.moveaxis(stored, -1, 0)
    inside = before & (x >= 0) & (x < width) & (y >= 0) & (y < height)
    wrong = (inside != (people["joint_visibility"][number] > 0)).sum(axis=1).astype(np.float64)
    message = f"track {track}: joints said to be in the image that are not, or the other way"
    report.at_most("people.joint_visibility", message, wrong, 0.0)
