"""Putting a camera on a take: the lens, the plan, and where the camera is just before and after."""

import numpy as np
from scipy.spatial.transform import Rotation

from camera_rigs import CameraPath, Lens, Plan, direct
from whacamole.recipe import Recipe
from whacamole.seeds import generator
from whacamole.take import Take

__all__ = ["camera_neighbours", "plan_camera"]


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
