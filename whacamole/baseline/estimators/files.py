"""What a published network wrote: people in the camera frame, from files.

Any format that `whacamole evaluate` reads will do (the project's npz, WHAM, TRAM, GVHMR, SLAHMR, PromptHMR
…). An npz may also give crops instead of ``transl_camera``, as SMPLer-X and SMPLest-X predict them:
``crop_scale`` (P, T) and ``crop_translation`` (P, T, 2) of the weak-perspective camera, ``crop_side`` (P, T)
and ``crop_center`` (P, T, 2) [px].
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from whacamole.baseline.footage import Footage
from whacamole.baseline.method import depth_from_scale, refocus
from whacamole.baseline.people import PersonEstimate, rest_pelvis
from whacamole.baseline.rigid import FloatArray
from whacamole.body import BodyModel, BodyParams
from whacamole.errors import BaselineError, EvaluationError
from whacamole.evaluation.io.arrays import read_npz, take, text
from whacamole.evaluation.io.native import people_of
from whacamole.evaluation.io.predictions import PredictionFolder
from whacamole.evaluation.records import CameraTrack, PersonTrack, Recording


@dataclass(frozen=True)
class FilesEstimator:
    """``files``: one file (or folder) a sequence, found by its id.

    Attributes:
        folder: where they are, or the one .npz for a video.
    """

    folder: Path
    name: str = "files"

    @property
    def ground_truth(self) -> tuple[str, ...]:
        """What the files say that they were given; of predictions of this project alone."""
        paths = [self.folder] if self.folder.is_file() else sorted(self.folder.glob("*.npz"))
        return tuple(dict.fromkeys(truth for path in paths for truth in truth_behind(path)))

    def estimate(self, footage: Footage, K: FloatArray, body: BodyModel) -> Sequence[PersonEstimate]:
        """The people of the footage's file.

        Estimates made with another focal length, where the file states it, are put to the depth of this one.

        Raises:
            BaselineError: there is no such file, it cannot be used, or it has nobody in the camera frame.
        """
        try:
            recording = self._read(footage, K)
        except EvaluationError as error:
            raise BaselineError(str(error)) from error
        rows = self._rows(recording, footage)
        people = [track for track in recording.people if track.camera is not None]
        if not people:
            raise BaselineError(
                f"{self.folder}: {footage.id} has nobody in the camera frame; give camera-frame output"
            )
        theirs = None if recording.camera is None else recording.camera.K
        found = []
        for number, track in enumerate(people):
            params, valid = _on_body(track, rows, footage.num_frames, body)
            if theirs is not None:
                ratio = np.ones(footage.num_frames)
                ratio[rows] = K[rows, 0, 0] / theirs[:, 0, 0]
                rest = rest_pelvis(body, params)
                params = replace(params, transl=refocus(params.transl + rest, 1.0, ratio) - rest)
            found.append(PersonEstimate(max(track.track_id, number + 1), params, valid))
        return found

    def _read(self, footage: Footage, K: FloatArray) -> Recording:
        path = self.folder if self.folder.is_file() else self.folder / f"{footage.id}.npz"
        if not path.is_file():
            return PredictionFolder(self.folder).read(footage.id, footage.fps)
        values = read_npz(path)
        if "detected" in values:
            # A prediction: there "valid" says that the camera was known too, which is of no matter here.
            values["valid"] = values["detected"]
        frame_index = take(values, "frame_index", path, (None,)).astype(np.intp)
        T, camera = len(frame_index), None
        if "transl_camera" not in values and "crop_scale" in values:
            place = np.searchsorted(footage.frame_index, frame_index).clip(0, footage.num_frames - 1)
            values["transl_camera"] = _from_crops(values, path, T, K[place])
        elif "K" in values:
            nowhere = np.tile(np.eye(4), (T, 1, 1))
            camera = CameraTrack(nowhere, np.zeros(T, dtype=bool), take(values, "K", path, (T, 3, 3)))
        return Recording(footage.id, frame_index, footage.fps, people_of(values, path, T), camera)

    def _rows(self, recording: Recording, footage: Footage) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
        """Place in the footage of every frame of the file."""
        if recording.by_position:
            rows = recording.frame_index
            inside = rows < footage.num_frames
        else:
            rows = np.searchsorted(footage.frame_index, recording.frame_index)
            inside = np.isin(recording.frame_index, footage.frame_index)
        if not inside.all():
            raise BaselineError(
                f"{self.folder}: {footage.id} has frame {int(recording.frame_index[~inside][0])}, "
                f"the video has {footage.num_frames} from {int(footage.frame_index[0])} on"
            )
        return np.asarray(rows, dtype=np.intp)


def truth_behind(path: Path) -> tuple[str, ...]:
    """True data that went into a prediction of this project; nothing for other files."""
    if path.suffix != ".npz":
        return ()
    try:
        used = text(read_npz(path), "ground_truth_used")
    except EvaluationError:
        return ()  # told where the file is used
    return tuple(part for part in used.split(",") if part)


def _from_crops(values: dict[str, np.ndarray], path: Path, T: int, K: FloatArray) -> FloatArray:  # type: ignore[type-arg]
    """``transl`` (P, T, 3) from weak-perspective crops by t_z = (2 / I) (f / s); the crop's centre is its
    axis."""
    scale = take(values, "crop_scale", path, (None, T))
    P = len(scale)
    side = take(values, "crop_side", path, (P, T))
    shift, center = (take(values, f"crop_{key}", path, (P, T, 2)) for key in ("translation", "center"))
    depth = depth_from_scale(scale, K[:, 0, 0], side)
    aside = (center - K[:, :2, 2]) * (2.0 / (side * scale))[..., None]
    return np.concatenate([shift + aside, depth[..., None]], axis=-1)


def _on_body(
    track: PersonTrack, rows: np.ndarray[tuple[int], np.dtype[np.intp]], frames: int, body: BodyModel
) -> tuple[BodyParams, np.ndarray[tuple[int], np.dtype[np.bool_]]]:
    """A track's pose on the body in use: its betas where they belong to this model, the mean shape
    elsewhere."""
    assert track.camera is not None
    own = track.kind == "smplx" and (not track.model_sha256 or body.matches(track.model_sha256))
    usable = track.valid & np.isfinite(track.camera.orient).all(-1) & np.isfinite(track.camera.transl).all(-1)
    usable &= np.isfinite(track.body_pose).all(axis=(1, 2))
    if track.betas.ndim == 2:
        usable &= np.isfinite(track.betas).all(axis=1)
    at = rows[usable]
    still = BodyParams.zeros(frames)

    def spread(values: FloatArray | None, like: FloatArray) -> FloatArray:
        whole = like.copy()
        if values is not None and values.shape[1:] == like.shape[1:]:
            whole[at] = np.nan_to_num(values[usable])
        return whole

    betas = still.betas
    if own:
        given = track.betas[..., :10]
        betas = spread(given, np.zeros((frames, 10))) if given.ndim == 2 else np.asarray(given)
    params = BodyParams(
        betas=betas,
        expression=spread(track.expression, still.expression),
        global_orient=spread(track.camera.orient, still.global_orient),
        transl=spread(track.camera.transl, still.transl),
        body_pose=spread(track.body_pose[:, :21], still.body_pose),
        left_hand_pose=spread(track.left_hand_pose, still.left_hand_pose),
        right_hand_pose=spread(track.right_hand_pose, still.right_hand_pose),
        jaw_pose=spread(track.jaw_pose, still.jaw_pose),
        leye_pose=spread(track.leye_pose, still.leye_pose),
        reye_pose=spread(track.reye_pose, still.reye_pose),
    )
    valid = np.zeros(frames, dtype=bool)
    valid[at] = True
    return params, valid
