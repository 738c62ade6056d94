"""``mediapipe``: from pixels to SMPL-X on a CPU, nothing licensed."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from whacamole.baseline.estimators.blazepose import BlazePose
from whacamole.baseline.estimators.body_points import BodyPoints, body_points
from whacamole.baseline.estimators.first_guess import first_guess, viewing_turn
from whacamole.baseline.estimators.fit import FitWeights, Observations, fit_track, residuals
from whacamole.baseline.estimators.fit_model import FitState, place_points
from whacamole.baseline.estimators.tracks import LandmarkTrack, follow
from whacamole.baseline.footage import Footage
from whacamole.baseline.people import PersonEstimate
from whacamole.baseline.rigid import BoolArray, FloatArray
from whacamole.body import BodyModel, BodyParams

WORST_PIXEL = 0.08
"""Median reprojection error, as a share of the person's size, above which a frame does not count as found."""


@dataclass(frozen=True)
class MediapipeEstimator:
    """BlazePose's landmarks, followed through the video, with SMPL-X fitted through every track.

    Hands stay relaxed and faces neutral: at the size people have in these videos their landmarks are noise.
    """

    name: str = "mediapipe"
    ground_truth: tuple[str, ...] = ()

    def estimate(self, footage: Footage, K: FloatArray, body: BodyModel) -> Sequence[PersonEstimate]:
        """The people in the footage, those seen longest first.

        Raises:
            BaselineError: MediaPipe is not installed.
        """
        with BlazePose() as pose:
            tracks = follow(footage.images(), footage.num_frames, pose)
        points = body_points(body)
        return [fit_person(number + 1, track, K, body, points) for number, track in enumerate(tracks)]


def fit_person(
    track_id: int, track: LandmarkTrack, K: FloatArray, body: BodyModel, points: BodyPoints
) -> PersonEstimate:
    """SMPL-X through one track, from its first frame to its last; valid where it was seen and the fit is
    good."""
    frames = np.flatnonzero(track.valid)
    span = slice(int(frames[0]), int(frames[-1]) + 1)
    pixels, metric, seen = _observed(track, K, span, points)
    state = fit_track(first_guess(metric, pixels, K[span], body), seen, points, body)
    valid = np.zeros(len(track.valid), dtype=bool)
    valid[span] = track.valid[span] & _good(state, seen, points, body)
    return PersonEstimate(track_id, _params(state, body, len(valid), span), valid)


def _observed(
    track: LandmarkTrack, K: FloatArray, span: slice, points: BodyPoints
) -> tuple[FloatArray, FloatArray, Observations]:
    """Landmarks (T, 33, …) in the camera's axes, gaps bridged to start from, and what the fit sees of
    them."""
    known = np.flatnonzero(track.valid[span])
    nearest = known[np.abs(np.arange(span.stop - span.start)[:, None] - known).argmin(axis=1)]
    pixels, metric = track.pixels[span][nearest], track.metric[span][nearest]
    center = pixels.mean(axis=1)
    metric = np.einsum("tij,tnj->tni", viewing_turn(center, K[span]), metric)
    size = np.linalg.norm(np.ptp(pixels, axis=1), axis=-1)
    weight = np.where(track.valid[span, None], np.nan_to_num(track.seen[span]), 0.0)[:, points.landmarks]
    chosen = points.landmarks
    return pixels, metric, Observations(pixels[:, chosen], metric[:, chosen], weight, size, K[span])


def _good(state: FitState, seen: Observations, points: BodyPoints, body: BodyModel) -> BoolArray:
    by = FitWeights()
    placed = place_points(state, points, body.rest_joints(state.betas))
    pixel, _ = residuals(placed, seen, points, by)
    error = np.median(np.linalg.norm(pixel, axis=-1), axis=1) * by.pixel
    return np.asarray((error < WORST_PIXEL) & (state.pelvis[:, 2] > 0.0))


def _params(state: FitState, body: BodyModel, num_frames: int, span: slice) -> BodyParams:
    params = BodyParams.zeros(num_frames, state.betas)
    orient, transl, pose = params.global_orient, params.transl, params.body_pose
    orient[span] = Rotation.from_matrix(state.orient).as_rotvec()
    transl[span] = state.pelvis - body.rest_joints(state.betas)[0]
    pose[span] = state.body_pose()
    hands = {
        key: np.tile(np.asarray(body.extras.get(name, np.zeros(45))).reshape(15, 3), (num_frames, 1, 1))
        for key, name in (("left_hand_pose", "hands_meanl"), ("right_hand_pose", "hands_meanr"))
    }
    return replace(params, global_orient=orient, transl=transl, body_pose=pose, **hands)
