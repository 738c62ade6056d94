"""``whacamole baseline run``: footage in, predictions out."""

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from whacamole.baseline.estimators import EstimatorSource
from whacamole.baseline.footage import Footage, sequence_footage, video_footage
from whacamole.baseline.intrinsics import intrinsics
from whacamole.baseline.modes import Components, Mode
from whacamole.baseline.odometry import Odometry, OdometrySource, Scene
from whacamole.baseline.odometry.masks import masker_of
from whacamole.baseline.people import PersonEstimate
from whacamole.baseline.predictions import prediction_arrays, write_prediction
from whacamole.baseline.recover import recover
from whacamole.baseline.rigid import FloatArray
from whacamole.baseline.velocimeter import MotionVelocimeter
from whacamole.baseline.weights import bundled_weights, trained_on
from whacamole.body import BodyModel
from whacamole.errors import BaselineError, WhacamoleError


@dataclass(frozen=True)
class Setup:
    """Everything that decides a prediction, besides the footage.

    Attributes:
        estimator, odometry: the sources.
        mode: how WHAC is done.
        body: whose parameters are predicted.
        focal: where K comes from; "auto": given where there is one, else the mode's guess.
        masks: how people are hidden from odometry.
        components: for ablations.
        weights: of the velocimeter; ``None``: the bundled ones.
    """

    estimator: EstimatorSource
    odometry: OdometrySource
    mode: Mode
    body: BodyModel
    focal: str = "auto"
    masks: str = "detector"
    components: Components = "both"
    weights: MotionVelocimeter | None = None


@dataclass(frozen=True)
class Outcome:
    """What became of one video.

    Attributes:
        id: of the sequence or video.
        people: found.
        frames: of the video.
        camera_frames: whose camera was found.
        scale: metres for a unit of the odometry, NaN where not known.
        ground_truth_used: comma separated.
        notes: what the user should know.
        problem: why there is no prediction, "" where there is one.
    """

    id: str
    people: int = 0
    frames: int = 0
    camera_frames: int = 0
    scale: float = float("nan")
    ground_truth_used: str = ""
    notes: tuple[str, ...] = field(default=())
    problem: str = ""


Watch = Callable[[Footage, str, int], None]
"""Told the footage, what is being looked for ("people" or "camera") and how many frames were looked at."""


def _nobody_watches(footage: Footage, stage: str, frames: int) -> None:
    pass


def split_footage(root: Path, split: str) -> list[Footage]:
    """The footage of a split of a dataset, or of all of it.

    Raises:
        DatasetError: the dataset or the split is not there.
        BaselineError: the split is empty.
    """
    from whacamole.dataset import open_dataset

    data = open_dataset(root)
    chosen = data if split == "all" else data.split(split)
    if not len(chosen):
        raise BaselineError(f"{root}: the split {split} is empty; choose another, or all")
    return [sequence_footage(sequence) for sequence in chosen]


def run_all(
    footage: list[Footage], setup: Setup, out: Path, watch: Watch = _nobody_watches
) -> Iterator[Outcome]:
    """Predict every video into ``out``; one that cannot be done is told and left out, the others go on."""
    for one in footage:
        try:
            yield run_one(one, setup, out / f"{one.id}.npz", watch)
        except WhacamoleError as error:
            yield Outcome(one.id, frames=one.num_frames, problem=str(error))


def run_one(footage: Footage, setup: Setup, path: Path, watch: Watch = _nobody_watches) -> Outcome:
    """Predict one video and write it to ``path``.

    Raises:
        BaselineError: it cannot be done.
    """
    focal = setup.focal
    if focal == "auto":
        focal = "given" if footage.given_K is not None else setup.mode.focal
    K = intrinsics(focal, footage.width, footage.height, footage.num_frames, footage.given_K)
    people, odometry = _observed(footage, setup, K, watch)
    velocimeter, weight_notes = _weights(setup, footage)
    recovery = recover(
        people, odometry, footage.fps, setup.body, velocimeter.windows, setup.mode, setup.components
    )
    used = dict.fromkeys(
        (*setup.estimator.ground_truth, *odometry.ground_truth, *(("K",) if focal == "given" else ()))
    )
    notes = (*odometry.notes, *weight_notes, *_remarks(setup, len(people)))
    about = {
        "method": f"whac ({setup.mode.name}, {setup.estimator.name}, {setup.odometry.name}, "
        f"{setup.components}, focal {focal}, masks {setup.masks})",
        "ground_truth_used": ",".join(used),
        "notes": json.dumps(notes),
    }
    arrays = prediction_arrays(people, recovery, footage.frame_index, footage.fps, K, setup.body, about)
    arrays["T_vo"] = np.where(odometry.valid[:, None, None], odometry.T_vo, np.nan)
    write_prediction(path, arrays)
    return Outcome(
        id=footage.id,
        people=len(people),
        frames=footage.num_frames,
        camera_frames=int(recovery.camera_valid.sum()),
        scale=recovery.scale,
        ground_truth_used=about["ground_truth_used"],
        notes=notes,
    )


def _observed(
    footage: Footage, setup: Setup, K: FloatArray, watch: Watch
) -> tuple[Sequence[PersonEstimate], Odometry]:
    """People and camera as their sources see them."""

    def watched(stage: str) -> Footage:
        watch(footage, stage, 0)
        return footage.watched(lambda frames: watch(footage, stage, frames))

    people = setup.estimator.estimate(watched("people"), K, setup.body)
    masker = masker_of(setup.masks, footage, people, K, setup.body)
    return people, setup.odometry.track(Scene(watched("camera"), K, masker, setup.masks))


def one_video(path: Path) -> list[Footage]:
    """The footage of a video file, as :func:`run_all` takes it."""
    return [video_footage(path)]


def _weights(setup: Setup, footage: Footage) -> tuple[MotionVelocimeter, tuple[str, ...]]:
    """The velocimeter for this footage, and a warning where it was trained on its motion."""
    motions: set[str] = set()
    if footage.sequence is not None:
        motions = {str(motion) for motion in footage.sequence.people["motion_id"]}
    velocimeter = setup.weights or bundled_weights(next(iter(motions), None))
    seen = sorted(motions & trained_on(velocimeter))
    if seen:
        return velocimeter, (f"the velocimeter was trained on {', '.join(seen)}: no held-out result",)
    return velocimeter, ()


def _remarks(setup: Setup, people: int) -> tuple[str, ...]:
    notes = []
    oracles = [s.name for s in (setup.estimator, setup.odometry) if s.name == "noisy-labels"]
    if oracles:
        notes.append("made from the labels with noise: an ablation, not an estimate")
    if not people:
        notes.append("nobody was found")
    return tuple(notes)
