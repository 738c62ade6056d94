"""Points of the body that stand for MediaPipe's 33 landmarks: fixed to joints, on any SMPL-X-schema model.

Landmarks on the skin (nose, ears, heels, toes) are found on the mean shape at rest by where they are, not by
vertex numbers, which differ from model to model.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from whacamole.baseline.rigid import FloatArray
from whacamole.body import JOINT_INDEX, NUM_BETAS, BodyModel

_ON_JOINTS: Mapping[int, str] = {
    2: "left_eye", 5: "right_eye", 11: "left_shoulder", 12: "right_shoulder", 13: "left_elbow",
    14: "right_elbow",
    15: "left_wrist", 16: "right_wrist", 17: "left_pinky1", 18: "right_pinky1", 19: "left_index1",
    20: "right_index1", 23: "left_hip", 24: "right_hip", 25: "left_knee", 26: "right_knee",
    27: "left_ankle", 28: "right_ankle",
}  # fmt: skip

HIPS = (23, 24)
SHOULDERS = (11, 12)


@dataclass(frozen=True, eq=False)
class BodyPoints:
    """Points fixed to joints.

    Attributes:
        landmarks: (N,) MediaPipe's number of each.
        joints: (N,) the joint it moves with.
        offsets: (N, 3) from that joint at rest [m].
    """

    landmarks: NDArray[np.intp]
    joints: NDArray[np.intp]
    offsets: FloatArray


def body_points(body: BodyModel) -> BodyPoints:
    """The points on a body model, by the shape of its mean."""
    vertices = body.rest_vertices(np.zeros(NUM_BETAS)).astype(np.float64)
    rest = body.rest_joints(np.zeros(NUM_BETAS))
    owner = body.weights.argmax(axis=1)
    chosen: dict[int, tuple[int, FloatArray]] = {
        landmark: (JOINT_INDEX[name], np.zeros(3)) for landmark, name in _ON_JOINTS.items()
    }
    head = JOINT_INDEX["head"]
    skin = vertices[owner == head]
    # The nose is the foremost point near the middle; the ears stick out at the sides at the height of the
    # eyes.
    eyes = rest[[JOINT_INDEX["left_eye"], JOINT_INDEX["right_eye"]]].mean(axis=0)
    middle = skin[(np.abs(skin[:, 0]) < 0.02) & (np.abs(skin[:, 1] - eyes[1]) < 0.07)]
    chosen[0] = (head, middle[middle[:, 2].argmax()] - rest[head])
    level = skin[(np.abs(skin[:, 1] - eyes[1]) < 0.05) & (skin[:, 2] < eyes[2] - 0.04)]
    for landmark, sign in ((7, 1.0), (8, -1.0)):
        chosen[landmark] = (head, level[(sign * level[:, 0]).argmax()] - rest[head])
    for heel, toe, side in ((29, 31, "left"), (30, 32, "right")):
        ankle, foot = JOINT_INDEX[f"{side}_ankle"], JOINT_INDEX[f"{side}_foot"]
        sole = vertices[(owner == ankle) & (vertices[:, 1] < rest[ankle, 1] - 0.02)]
        chosen[heel] = (ankle, sole[sole[:, 2].argmin()] - rest[ankle])
        front = vertices[owner == foot]
        chosen[toe] = (foot, front[front[:, 2].argmax()] - rest[foot])
    numbers = sorted(chosen)
    return BodyPoints(
        np.array(numbers, dtype=np.intp),
        np.array([chosen[number][0] for number in numbers], dtype=np.intp),
        np.stack([chosen[number][1] for number in numbers]),
    )
