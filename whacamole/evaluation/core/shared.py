"""Everybody and the camera in one alignment: is the scene right as a whole?

W-MPJPE aligns each person alone, C-ATE the camera alone: a method that puts two dancers in different rooms
scores perfectly. Here all people and the camera of a segment share one rigid motion. It is fitted so that
every person and the camera weigh the same, whatever the number of joints.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from whacamole.evaluation.core.alignment import FloatArray, umeyama
from whacamole.evaluation.core.pose import MILLIMETRES, distances

IntArray = npt.NDArray[np.intp]
BoolArray = npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class SharedError:
    """The scene's errors after its one alignment a segment.

    Attributes:
        people: mean joint error (P, F) [mm], SW-MPJPE.
        camera: error of the camera's centre (F,) [mm], SW-camera.
        offset: mean error of the vectors between the roots of any two people and between each root and the
            camera (F,) [mm], SW-offset: the relative placement.
    """

    people: FloatArray
    camera: FloatArray
    offset: FloatArray


def shared_world_error(
    people: tuple[FloatArray, FloatArray],
    roots: tuple[FloatArray, FloatArray],
    cameras: tuple[FloatArray, FloatArray],
    present: tuple[BoolArray, BoolArray],
    rows: list[IntArray],
    *,
    with_scale: bool = False,
) -> SharedError:
    """Score a scene in one alignment a segment.

    Args:
        people: predicted and true joints (P, F, J, 3) [m], each in one world.
        roots: predicted and true root joints (P, F, 3) [m].
        cameras: predicted and true camera centres (F, 3) [m] in the same worlds.
        present: which people (P, F) and cameras (F,) there are; the rest may hold anything.
        rows: rows of each segment.
        with_scale: a similarity in place of a rigid motion.
    """
    P, F, J = people[1].shape[:3]
    result = SharedError(np.full((P, F), np.nan), np.full(F, np.nan), np.full(F, np.nan))
    seen, filmed = present
    for segment in rows:
        here, camera_here = seen[:, segment], filmed[segment]
        weights = np.concatenate([np.repeat(here.ravel() / J, J), camera_here.astype(np.float64)])
        if not weights.any():
            continue
        points = [
            np.concatenate([joints[:, segment].reshape(-1, 3), centres[segment]])
            for joints, centres in zip(people, cameras, strict=True)
        ]
        # What is absent may be NaN, and NaN times weight 0 is NaN.
        source, target = (np.where(weights[:, None] > 0.0, p, 0.0) for p in points)
        found = umeyama(source, target, with_scale=with_scale, weights=weights)
        apart = distances(found.apply(source), target) * MILLIMETRES
        result.people[:, segment] = np.where(
            here, apart[: here.size * J].reshape(*here.shape, J).mean(-1), np.nan
        )
        result.camera[segment] = np.where(camera_here, apart[here.size * J :], np.nan)
        entities = [
            np.concatenate([root[:, segment], centre[None, segment]])
            for root, centre in zip(roots, cameras, strict=True)
        ]
        turned = found.scale * entities[0] @ found.rotation.T
        result.offset[segment] = _offsets(turned, entities[1], np.concatenate([here, camera_here[None]]))
    return result


def _offsets(prediction: FloatArray, truth: FloatArray, present: BoolArray) -> FloatArray:
    """Mean error of the vectors between pairs of E entities (E, F, 3) [m] → (F,) [mm]; NaN without one."""
    first, second = np.triu_indices(len(truth), k=1)
    both = present[first] & present[second]
    apart = distances(prediction[first] - prediction[second], truth[first] - truth[second])
    count = both.sum(axis=0)
    total = np.where(both, apart, 0.0).sum(axis=0) * MILLIMETRES
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)
