"""The true people, spoiled by a stated noise: an oracle, for ablations."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from scipy.spatial.transform import Rotation

from whacamole.baseline.footage import Footage
from whacamole.baseline.method import refocus
from whacamole.baseline.people import PersonEstimate, rest_pelvis
from whacamole.baseline.rigid import FloatArray
from whacamole.body import BodyModel, BodyParams
from whacamole.errors import BaselineError
from whacamole.seeds import generator

_MEMORY = 0.9
"""What wanders keeps this share of itself from frame to frame."""

LEAST_VISIBLE = 0.1
"""Share of a person that must be seen for the person to be found."""


@dataclass(frozen=True)
class LabelNoise:
    """Standard deviations; each is half of a constant of the track, half of what wanders in time.

    Attributes:
        pose: of each joint's rotation, about each axis [degrees].
        orient: of the root's [degrees].
        depth: of the logarithm of the root's depth: a person taken for larger is put further away.
        place: of the root's direction, as a share of the depth.
        shape: of each beta.
        jitter: of pose and orient, frame by frame [degrees].
    """

    pose: float = 8.0
    orient: float = 5.0
    depth: float = 0.05
    place: float = 0.004
    shape: float = 0.5
    jitter: float = 0.6

    def times(self, factor: float) -> "LabelNoise":
        """All of it times a factor."""
        return LabelNoise(*(factor * getattr(self, field.name) for field in fields(self)))


def spoil_rand(
    rng: np.random.Generator, params: BodyParams, body: BodyModel, noise: LabelNoise
) -> BodyParams:
    """Camera-frame parameters with noise on them."""
    T = params.num_frames
    pelvis = params.transl + rest_pelvis(body, params)
    betas = params.betas + noise.shape * rng.normal(size=params.betas.shape[-1])
    pelvis = pelvis * np.exp(noise.depth * _wander_rand(rng, T, (1,)))
    pelvis[:, :2] += noise.place * pelvis[:, 2:] * _wander_rand(rng, T, (2,))

    def turned(pose: FloatArray, degrees: float) -> FloatArray:
        shape = pose.shape[1:]
        shaky = degrees * _wander_rand(rng, T, shape) + noise.jitter * rng.normal(size=pose.shape)
        error = Rotation.from_rotvec(np.radians(shaky).reshape(-1, 3))
        vectors: FloatArray = (Rotation.from_rotvec(pose.reshape(-1, 3)) * error).as_rotvec()
        return vectors.reshape(pose.shape)

    spoiled = replace(
        params,
        betas=betas,
        global_orient=turned(params.global_orient, noise.orient),
        body_pose=turned(params.body_pose, noise.pose),
    )
    return replace(spoiled, transl=pelvis - rest_pelvis(body, spoiled))


def _wander_rand(rng: np.random.Generator, frames: int, shape: tuple[int, ...]) -> FloatArray:
    """Noise (frames, …) of unit variance, half constant and half an autoregressive process."""
    wander = rng.normal(size=(frames, *shape))
    for t in range(1, frames):
        wander[t] = _MEMORY * wander[t - 1] + np.sqrt(1.0 - _MEMORY**2) * wander[t]
    both: FloatArray = np.sqrt(0.5) * (rng.normal(size=shape) + wander)
    return both


@dataclass(frozen=True)
class NoisyLabelsEstimator:
    """``noisy-labels``: not an estimate; every report says so.

    With another K than the true one, depth is what an estimator would have made of it
    (:func:`whacamole.baseline.method.refocus`).

    Attributes:
        noise: its size.
        seed: of the noise.
    """

    noise: LabelNoise = LabelNoise()
    seed: int = 0
    name: str = "noisy-labels"
    ground_truth: tuple[str, ...] = ("people",)

    def estimate(self, footage: Footage, K: FloatArray, body: BodyModel) -> Sequence[PersonEstimate]:
        """The labelled people with noise, where enough of them is seen.

        Raises:
            BaselineError: the footage has no labels, or of another body model.
        """
        sequence = footage.sequence
        if sequence is None:
            raise BaselineError("--estimator noisy-labels needs a dataset with labels; choose mediapipe")
        people = sequence.people
        if not body.matches(str(people["body_model_sha256"])):
            raise BaselineError(
                f"{footage.id}: labelled with {people['body_model']}, not {body.name}; give --body-model"
            )
        focal, true_focal = K[:, 0, 0], np.asarray(sequence.camera["K"], dtype=np.float64)[:, 0, 0]
        found = []
        for row, track_id in enumerate(people["track_id"]):
            truth = BodyParams.from_arrays(people, frame="camera", person=row)
            rng = generator(self.seed, footage.id, int(track_id), "estimator noise")
            params = spoil_rand(rng, truth, body, self.noise)
            rest = rest_pelvis(body, params)
            moved = refocus(params.transl + rest, true_focal, focal) - rest
            seen = np.asarray(people["valid"][row], dtype=bool)
            if "visible_fraction" in people:
                seen = seen & (np.asarray(people["visible_fraction"][row]) >= LEAST_VISIBLE)
            found.append(PersonEstimate(int(track_id), replace(params, transl=moved), seen))
        return found
