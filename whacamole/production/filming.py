"""Putting a camera on a take: the lens, the plan, and where the camera is just before and after."""

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from camera_rigs import CameraPath, Lens, Plan, direct
from whacamole.body import JOINT_INDEX
from whacamole.labels.camera import Film
from whacamole.recipe import Recipe
from whacamole.seeds import generator
from whacamole.take import Take

__all__ = ["camera_neighbours", "film_of", "focus_distance", "plan_camera"]

NEAREST_FOCUS_M = 0.3
"""A lens is not focused nearer than this."""


def plan_camera(take: Take, recipe: Recipe, shot_index: int) -> Plan:
    """Plan the camera of a take: a lens drawn evenly over the logarithm of its range, and the shots.

    Raises:
        PlanError: no shot that was asked for applies to this motion.
    """
    rng = generator(recipe.seed, take.motion.id, shot_index, "camera")
    shortest, longest = np.log(recipe.focal_mm)
    lens = Lens.from_millimetres(float(np.exp(rng.uniform(shortest, longest))), *recipe.size)
    shots = recipe.shots[0] if len(recipe.shots) == 1 else recipe.shots
    return direct(take.subject, lens, take.stage.world, shots, rng, interactive=take.motion.interactive)


def film_of(take: Take, plan: Plan, recipe: Recipe, shot_index: int) -> Film:
    """Draw how the pictures of a take are exposed, evenly between the recipe's numbers (f-number: over its
    logarithm)."""
    rng = generator(recipe.seed, take.motion.id, shot_index, "film")
    shutter, exposure, noise = (
        float(rng.uniform(*span)) for span in (recipe.motion_blur, recipe.exposure, recipe.noise)
    )
    opened = recipe.f_number is not None
    stop = float(np.exp(rng.uniform(*np.log(recipe.f_number)))) if recipe.f_number is not None else np.inf
    seed = generator(recipe.seed, take.motion.id, shot_index, "sampling").integers(2**31)
    return Film(
        shutter=shutter,
        f_number=stop,
        focus_distance=focus_distance(take, plan.path) if opened else None,
        exposure=take.stage.exposure + exposure,
        noise=noise,
        noise_seed=int(seed),
    )


def focus_distance(take: Take, path: CameraPath) -> NDArray[np.float64]:
    """Return the depth (T,) [m] in focus: that of the neck of whoever is nearest over the whole take.

    One person keeps the focus, so that it is pulled and never jumps.
    """
    inverse = np.linalg.inv(path.T_world_camera)
    necks = np.stack([person.posed.joints[1:-1, JOINT_INDEX["neck"]] for person in take.performers])
    depth = np.einsum("tj,ptj->pt", inverse[:, 2, :3], necks) + inverse[:, 2, 3]
    before = np.where(depth > 0, depth, np.inf)
    nearest = int(np.argmin(np.median(before, axis=1)))
    return np.asarray(np.maximum(depth[nearest], NEAREST_FOCUS_M), np.float64)


def camera_neighbours(path: CameraPath) -> CameraPath:
    """Return the camera at frames −1 and T, moving on as at the path's ends.

    The flow of the last frame and motion blur at both ends depend on them. A path of one frame stands still.
    """
    poses = []
    for end, inner in ((0, 1), (-1, -2)):
        here = path.T_world_camera[end]
        inside = path.T_world_camera[inner if path.num_frames > 1 else end]
        turn = Rotation.from_matrix(here[:3, :3]) * Rotation.from_matrix(inside[:3, :3]).inv()
        pose = np.eye(4)
        pose[:3, :3] = (turn * Rotation.from_matrix(here[:3, :3])).as_matrix()
        pose[:3, 3] = 2.0 * here[:3, 3] - inside[:3, 3]
        poses.append(pose)
    return CameraPath(path.K[[0, -1]], np.stack(poses), path.fps, path.width, path.height)
