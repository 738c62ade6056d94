"""One sequence: match its people, score each, score the scene, count what could not be scored."""

from dataclasses import dataclass, replace

import numpy as np

from whacamole.errors import EvaluationError
from whacamole.evaluation.bodies import Body
from whacamole.evaluation.figure import Figure
from whacamole.evaluation.library import BodyLibrary
from whacamole.evaluation.matching import Match, match_tracks
from whacamole.evaluation.pairing import Pair, Timeline
from whacamole.evaluation.protocol import Protocol
from whacamole.evaluation.records import IntArray, PersonTrack, Recording
from whacamole.evaluation.score_person import score_person
from whacamole.evaluation.score_scene import (
    score_camera,
    score_ground_contact,
    score_pairs,
    score_shared_world,
)
from whacamole.evaluation.score_vertices import VertexOptions
from whacamole.evaluation.scores import SequenceScore


@dataclass(frozen=True, eq=False)
class Scorer:
    """Scores sequences under one protocol.

    Attributes:
        protocol: the choices.
        library: body models.
        vertices: what vertex metrics need, ``None`` to leave them out.
    """

    protocol: Protocol
    library: BodyLibrary
    vertices: VertexOptions | None = None

    def score(self, truth: Recording, prediction: Recording) -> SequenceScore:
        """Score one sequence.

        Raises:
            EvaluationError: nothing of the prediction can be compared; one line.
        """
        row_of_truth, frame_of_prediction = _common_frames(truth, prediction)
        score = _empty(truth, prediction)
        prediction = _with_checked_camera(prediction, score)
        posed = bool(prediction.people)  # a camera alone needs nobody's body
        people = [self._figure(truth, i, posed=posed) for i in range(len(truth.people))]
        tracks = [self._figure(prediction, i, predicted=True) for i in range(len(prediction.people))]
        matches = match_tracks(people, tracks, frame_of_prediction)
        timeline = Timeline.of(truth.frame_index, truth.fps, self.protocol)
        pairs = [
            Pair(m.truth, people[m.truth], tracks[m.prediction], frame_of_prediction, timeline, self.protocol)
            for m in matches
        ]
        for pair in pairs:
            score_person(pair, self.protocol, timeline.fps, self.vertices, score)
        score_camera(truth, prediction, row_of_truth, timeline, self.protocol, score)
        score_pairs(pairs, truth.num_frames, score)
        score_shared_world(pairs, truth, prediction, row_of_truth, timeline, self.protocol, score)
        assigned = {match.truth: match.prediction for match in matches}
        score_ground_contact(pairs, assigned, truth, prediction, row_of_truth, score)
        _count(people, tracks, matches, pairs, score)
        return score

    def _figure(self, recording: Recording, i: int, *, predicted: bool = False, posed: bool = True) -> Figure:
        person = recording.people[i]
        stored = {space: joints[i] for space, joints in recording.joints.items()}
        return Figure(
            person,
            self._body(person, required=posed and not stored),
            recording.camera,
            stored,
            mean_betas=predicted and self.protocol.betas == "mean",
            smooth_root=self.protocol.smooth_root if predicted else 0.0,
        )

    def _body(self, person: PersonTrack, *, required: bool) -> Body | None:
        try:
            return self.library.body_of(person)
        except EvaluationError:
            if required:
                raise
            return None


def _common_frames(truth: Recording, prediction: Recording) -> tuple[IntArray, IntArray]:
    """Row of the prediction for each row of the truth (T,), and the other way round; −1 for none."""
    a = np.arange(truth.num_frames) if prediction.by_position else truth.frame_index
    b = prediction.frame_index
    rows, at_truth, at_prediction = np.intersect1d(a, b, return_indices=True)
    if not len(rows):
        spans = (
            f"{a[0]} … {a[-1]} and {b[0]} … {b[-1]}" if len(a) and len(b) else f"{len(a)} and {len(b)} frames"
        )
        raise EvaluationError(f"no common frames: truth and prediction have {spans}")
    row_of_truth = np.full(truth.num_frames, -1, dtype=np.intp)
    frame_of_prediction = np.full(prediction.num_frames, -1, dtype=np.intp)
    row_of_truth[at_truth], frame_of_prediction[at_prediction] = at_prediction, at_truth
    return row_of_truth, frame_of_prediction


def _with_checked_camera(prediction: Recording, score: SequenceScore) -> Recording:
    """The prediction without camera poses that are none, counted in a note."""
    if prediction.camera is None:
        return prediction
    camera = prediction.camera.checked()
    lost = int(prediction.camera.valid.sum() - camera.valid.sum())
    if lost:
        score.note(f"{lost} camera poses are not finite or not rigid: left out")
    return replace(prediction, camera=camera)


def _empty(truth: Recording, prediction: Recording) -> SequenceScore:
    P, T = len(truth.people), truth.num_frames
    score = SequenceScore(
        id=truth.id,
        source=truth.source,
        frame_index=truth.frame_index,
        shots=truth.shots or ("",) * T,
        visible=np.full((P, T), np.nan) if truth.visible_fraction is None else truth.visible_fraction,
        up=truth.up or (0.0, 0.0, 0.0),
    )
    for line in (*truth.notes, *prediction.notes):
        score.note(line)
    return score


def _count(
    people: list[Figure], tracks: list[Figure], matches: list[Match], pairs: list[Pair], score: SequenceScore
) -> None:
    """Coverage: what there was, what was scored, what was missing and why."""
    wanted = sum(len(person.rows) for person in people)
    scored = sum(len(pair.rows) for pair in pairs)
    score.counts |= {
        "people": len(people),
        "people_matched": len(matches),
        "people_missing": len(people) - len(matches),
        "tracks_extra": len(tracks) - len(matches),
        "person_frames": wanted,
        "person_frames_scored": scored,
        "person_frames_missing": wanted - scored,
        "person_frames_nan": sum(tracks[match.prediction].dropped for match in matches),
    }
    score.matches = [
        (people[m.truth].person.track_id, tracks[m.prediction].person.track_id, m.distance) for m in matches
    ]
