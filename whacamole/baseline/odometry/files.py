"""Trajectories that another program made, one TUM file a sequence (DPVO, DROID-SLAM, ORB-SLAM …)."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from whacamole.baseline.odometry.trajectory import Odometry, Scene
from whacamole.errors import BaselineError, EvaluationError
from whacamole.evaluation.io.tum import read_tum


@dataclass(frozen=True)
class FilesOdometry:
    """``files``: ``FOLDER/<id>.txt`` or ``.tum``, lines ``time tx ty tz qx qy qz qw``, camera to world.

    Whole numbers as times are places in the video, others seconds. Frames without a line are lost frames.

    Attributes:
        folder: where the files are, or the one file for a video.
    """

    folder: Path
    name: str = "files"

    def track(self, scene: Scene) -> Odometry:
        """The trajectory of the footage.

        Raises:
            BaselineError: there is none, or it cannot be used.
        """
        footage = scene.footage
        places = [self.folder] if self.folder.is_file() else [
            self.folder / f"{footage.id}{end}" for end in (".txt", ".tum")
        ]  # fmt: skip
        path = next((place for place in places if place.is_file()), None)
        if path is None:
            raise BaselineError(f"{places[0]}: no trajectory for {footage.id}; write one in the TUM format")
        try:
            recording = read_tum(path, footage.id, footage.fps)
        except EvaluationError as error:
            raise BaselineError(str(error)) from error
        assert recording.camera is not None
        inside = recording.frame_index < footage.num_frames
        if not inside.all():
            raise BaselineError(
                f"{path}: frame {int(recording.frame_index.max())}, the video has {footage.num_frames}; "
                "give its frames the numbers from 0 or times in seconds"
            )
        poses = np.tile(np.eye(4), (footage.num_frames, 1, 1))
        valid = np.zeros(footage.num_frames, dtype=bool)
        poses[recording.frame_index], valid[recording.frame_index] = recording.camera.T_world_camera, True
        return Odometry.from_poses(poses, valid, notes=recording.notes)
