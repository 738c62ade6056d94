"""``opencv``: visual odometry on a CPU without weights.

Corners are followed by optical flow. Two frames with enough parallax start a map (essential matrix), the
others are placed by it (PnP) while it grows, and bundle adjustment keeps it straight. A video whose camera
only turns has no parallax: then turns are all there is, and all that is claimed.
"""

from dataclasses import dataclass

import numpy as np

from whacamole.baseline.odometry.features import follow_points, load_cv2
from whacamole.baseline.odometry.mapping import Mapper
from whacamole.baseline.odometry.trajectory import Odometry, Scene
from whacamole.baseline.odometry.turning import turning_only, widest_pair
from whacamole.errors import BaselineError

FEWEST = 40
"""Points that two frames must share."""

PARALLAX = 0.003
ENOUGH = 0.02
"""Parallax, as a share of the image diagonal, below which the camera counts as only turning, and at which the
search for a wider pair ends."""


@dataclass(frozen=True)
class OpenCVOdometry:
    """``opencv``."""

    name: str = "opencv"

    def track(self, scene: Scene) -> Odometry:
        """The camera through the footage.

        Raises:
            BaselineError: OpenCV is missing, or the footage shows too little of a static world.
        """
        cv2 = load_cv2()
        cv2.setRNGSeed(0)
        tracks = follow_points(scene)
        diagonal = float(np.hypot(scene.footage.width, scene.footage.height))
        pair = widest_pair(tracks, scene.K, FEWEST, ENOUGH * diagonal)
        if pair is None:
            raise BaselineError(
                f"{scene.footage.id}: fewer than {FEWEST} points of the background can be followed; "
                "try --vo colmap or --vo files"
            )
        mapper = Mapper(cv2, tracks, scene.K)
        if pair[2] < PARALLAX * diagonal or not mapper.begin(pair[0], pair[1]):
            turns = turning_only(tracks, scene.K, FEWEST)
            note = f"odometry: parallax of {pair[2]:.1f} px at most, so only the camera's turns were found"
            return Odometry.from_poses(turns.T_world_camera, turns.reached, scene.mask_truth, (note,))
        mapper.grow()
        return Odometry.from_poses(*mapper.poses(), scene.mask_truth)
