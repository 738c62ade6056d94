"""Trajectories that another program made (DPVO, DROID-SLAM, ORB-SLAM …), or a former run of this one."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from whacamole.baseline.estimators.files import truth_behind
from whacamole.baseline.footage import Footage
from whacamole.baseline.odometry.trajectory import Odometry, Scene
from whacamole.errors import BaselineError, EvaluationError
from whacamole.evaluation.io.arrays import read_npz, take
from whacamole.evaluation.io.native import camera_of
from whacamole.evaluation.io.tum import read_tum
from whacamole.evaluation.records import Recording


@dataclass(frozen=True)
class FilesOdometry:
    """``files``: ``FOLDER/<id>.txt`` or ``.tum``, lines ``time tx ty tz qx qy qz qw``, camera to world.

    Whole numbers as times are places in the video, others seconds. Frames without a line are lost frames.
    ``FOLDER/<id>.npz`` is a prediction of this project: the odometry that it was made from.

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
        path = self._path(footage.id)
        try:
            if path.suffix == ".npz":
                recording = _former_run(path, footage)
                rows = np.searchsorted(footage.frame_index, recording.frame_index)
                inside = np.isin(recording.frame_index, footage.frame_index)
            else:
                recording = read_tum(path, footage.id, footage.fps)
                rows, inside = recording.frame_index, recording.frame_index < footage.num_frames
        except EvaluationError as error:
            raise BaselineError(str(error)) from error
        camera = recording.camera
        if camera is None:
            raise BaselineError(f"{path}: no camera in it; give T_world_camera")
        if not inside.all():
            raise BaselineError(
                f"{path}: frame {int(recording.frame_index[~inside][-1])}, the video has "
                f"{footage.num_frames} from {int(footage.frame_index[0])} on; "
                "give its frames the numbers from 0 or times in seconds"
            )
        poses = np.tile(np.eye(4), (footage.num_frames, 1, 1))
        valid = np.zeros(footage.num_frames, dtype=bool)
        poses[rows], valid[rows] = camera.T_world_camera, camera.valid
        return Odometry.from_poses(poses, valid, truth_behind(path), recording.notes)

    def _path(self, footage_id: str) -> Path:
        if self.folder.is_file():
            return self.folder
        places = [self.folder / f"{footage_id}{end}" for end in (".txt", ".tum", ".npz")]
        path = next((place for place in places if place.is_file()), None)
        if path is None:
            raise BaselineError(f"{places[0]}: no trajectory for {footage_id}; write one in the TUM format")
        return path


def _former_run(path: Path, footage: Footage) -> Recording:
    """The odometry in a prediction; of other files of these names the camera."""
    values = read_npz(path)
    frame_index = take(values, "frame_index", path, (None,)).astype(np.intp)
    if "T_vo" in values:
        values = {"T_world_camera": values["T_vo"]}
    camera = camera_of(values, path, len(frame_index))
    return Recording(footage.id, frame_index, footage.fps, (), camera)
