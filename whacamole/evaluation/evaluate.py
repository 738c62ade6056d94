"""``evaluate``: ground truth and predictions in, a result out, one sequence in memory at a time."""

import sys
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from functools import partial
from itertools import chain, islice
from multiprocessing import get_context
from pathlib import Path
from typing import TypeVar

import numpy as np
import scipy.sparse

from whacamole.errors import EvaluationError
from whacamole.evaluation.io import inert
from whacamole.evaluation.io.arrays import read_npz
from whacamole.evaluation.io.predictions import PredictionFolder
from whacamole.evaluation.library import BodyLibrary
from whacamole.evaluation.protocol import Protocol, protocol_named
from whacamole.evaluation.records import Recording
from whacamole.evaluation.result import MethodResult, Result
from whacamole.evaluation.score import Scorer
from whacamole.evaluation.score_vertices import VertexOptions
from whacamole.evaluation.scores import SequenceScore
from whacamole.evaluation.truth.source import TruthSource, open_truth

Progress = Callable[[str, str, SequenceScore | str], None]
Outcomes = list[tuple[str, SequenceScore | str, str]]
"""Of each method its name, the scores or why there are none, and the truths it was given."""
Work = Callable[[str], Outcomes]
T = TypeVar("T")


@dataclass(frozen=True)
class Bodies:
    """Body model files and what vertices need.

    Attributes:
        files: model files or folders, for people who are not in the embedded body.
        vertices: whether vertex metrics are taken; a number takes about so many evenly spread SMPL-X vertices
            for all, which is an estimate of PVE.
        vertex_map: sparse matrix (V of truth, V of prediction), ``.npz`` of SciPy or a pickle with
            ``matrix``.
        joint_regressor: ``J_regressor_h36m.npy`` (17, V), for ``joints=h36m14``.
    """

    files: tuple[Path, ...] = ()
    vertices: bool | int = True
    vertex_map: Path | None = None
    joint_regressor: Path | None = None

    def library(self) -> BodyLibrary:
        """The models.

        Raises:
            EvaluationError: a path is not there.
        """
        return BodyLibrary(self.files, None if isinstance(self.vertices, bool) else self.vertices)

    def options(self) -> VertexOptions | None:
        """What vertex metrics need, ``None`` without them.

        Raises:
            EvaluationError: a file cannot be used.
        """
        if self.vertices is False:
            return None
        regressor = None
        if self.joint_regressor is not None:
            try:
                regressor = np.asarray(np.load(self.joint_regressor, allow_pickle=False), dtype=np.float64)
            except (OSError, ValueError) as error:
                raise EvaluationError(f"{self.joint_regressor}: not a plain array ({error})") from error
            if regressor.ndim != 2 or len(regressor) < 17:
                raise EvaluationError(
                    f"{self.joint_regressor}: {regressor.shape}, expected (17, V) of H36M joints"
                )
        return VertexOptions(None if self.vertex_map is None else _matrix(self.vertex_map), regressor)


def evaluate(
    data: Path | str | TruthSource,
    predictions: Path | str | Mapping[str, Path | str],
    protocol: str | Protocol = "whac",
    *,
    split: str = "test",
    truth: str = "auto",
    format: str = "auto",  # noqa: A002  # the word users type
    bodies: Bodies | None = None,
    jobs: int = 1,
    limit: int | None = None,
    progress: Progress | None = None,
) -> Result:
    """Score predictions against ground truth.

    Sequences are read, scored and forgotten one after the other (``jobs`` at a time): memory does not grow
    with their number, except for a few numbers a frame. A prediction that is missing, damaged or does not fit
    is recorded as a failure of its sequence and the rest is scored.

    Args:
        data: a dataset of this project, a folder of EMDB, 3DPW, RICH or EgoBody, or any other source.
        predictions: a folder, or folders by the name of the method.
        protocol: a name of :data:`~whacamole.evaluation.protocol.PROTOCOLS`, or one's own.
        split: of the data.
        truth: which benchmark ``data`` is, "auto" to tell by what it holds.
        format: of the predictions, "auto" to tell for each sequence.
        bodies: body model files and vertex options.
        jobs: sequences scored at the same time, each in a process of its own; the result is the same.
        limit: score only the first so many sequences.
        progress: called after each sequence with method, sequence id, and its scores or why there are none.

    Raises:
        EvaluationError: nothing can be scored at all: no ground truth, no folder of predictions, an unknown
            name.
    """
    source = open_truth(Path(data), truth) if isinstance(data, str | Path) else data
    chosen, given = protocol_named(protocol), bodies or Bodies()
    folders = _named(predictions)
    readers = {name: PredictionFolder(Path(path), format) for name, path in folders.items()}
    ids = source.ids(split)[:limit]
    scorer = Scorer(chosen, given.library(), given.options())
    methods = {name: MethodResult(name) for name in readers}

    work = partial(_score, source=source, readers=readers, scorer=scorer)
    for sequence_id, outcomes in _in_order(work, ids, jobs):
        for name, outcome, used in outcomes:
            _record(methods[name], sequence_id, outcome, used)
            if progress is not None:
                progress(name, sequence_id, outcome)
    return Result(chosen, source.name, split, tuple(ids), tuple(methods.values()))


def _record(method: MethodResult, sequence_id: str, outcome: SequenceScore | str, used: str) -> None:
    """Put the scores of a sequence, or why there are none, where they belong."""
    if isinstance(outcome, str):
        method.failures[sequence_id] = outcome
        return
    method.sequences[sequence_id] = outcome
    words = {*method.ground_truth_used.split(","), *used.split(",")} - {""}
    method.ground_truth_used = ",".join(sorted(words))


def score_recording(
    truth: Recording, prediction: Recording, protocol: str | Protocol = "whac", bodies: Bodies | None = None
) -> SequenceScore:
    """Score one sequence from recordings in memory.

    Raises:
        EvaluationError: nothing of the prediction can be compared.
    """
    given = bodies or Bodies()
    return Scorer(protocol_named(protocol), given.library(), given.options()).score(truth, prediction)


def _score(
    sequence_id: str, source: TruthSource, readers: Mapping[str, PredictionFolder], scorer: Scorer
) -> Outcomes:
    truth = _tried("ground truth", lambda: source.read(sequence_id))
    if isinstance(truth, str):
        return [(name, truth, "") for name in readers]
    outcomes: Outcomes = []
    for name, reader in readers.items():
        prediction = _tried("prediction", partial(reader.read, sequence_id, truth.fps))
        if isinstance(prediction, str):
            outcomes.append((name, prediction, ""))
            continue
        score = _tried("scoring", partial(scorer.score, truth, prediction))
        outcomes.append((name, score, prediction.ground_truth_used))
    return outcomes


def _tried(what: str, act: Callable[[], T]) -> T | str:
    """What ``act`` returns, or one line on why it does not.

    Files come from anywhere: whatever a reader or a metric did not foresee costs one sequence, not the rest.
    """
    try:
        return act()
    except EvaluationError as error:
        return f"{what}: {error}" if what == "ground truth" else str(error)
    except Exception as error:
        said = " ".join(str(error).split())
        return f"{what} failed ({type(error).__name__}: {said}); check the arrays of its files"


def _in_order(work: Work, ids: Sequence[str], jobs: int) -> Iterator[tuple[str, Outcomes]]:
    """Work on ``jobs`` sequences at a time, hand back in order, hold no more than twice as many."""
    names, pending = iter(ids), deque[tuple[str, Future[Outcomes]]]()
    if jobs > 1 and len(ids) > 1:
        method = "fork" if sys.platform == "linux" else "spawn"
        with ProcessPoolExecutor(
            min(jobs, len(ids)), get_context(method), initializer=_adopt, initargs=(work,)
        ) as pool:
            try:
                pending.extend((name, pool.submit(_perform, name)) for name in islice(names, 2 * jobs))
                while pending:
                    yield pending[0][0], pending[0][1].result()
                    pending.popleft()
                    pending.extend((name, pool.submit(_perform, name)) for name in islice(names, 1))
            except BrokenProcessPool:  # somebody ended a worker: what it had not finished is done here
                names = chain([name for name, _ in pending], names)
    for name in names:
        yield name, work(name)


_adopted: list[Work] = []


def _adopt(work: Work) -> None:
    """Keep the work in a process of the pool."""
    _adopted[:] = [work]


def _perform(name: str) -> Outcomes:
    return _adopted[0](name)


def _named(predictions: Path | str | Mapping[str, Path | str]) -> Mapping[str, Path | str]:
    if isinstance(predictions, str | Path):
        return {Path(predictions).resolve().name: predictions}
    if not predictions:
        raise EvaluationError("no predictions were given")
    return predictions


def _matrix(path: Path) -> object:
    """A sparse vertex map."""
    if path.suffix == ".npz":
        values = read_npz(path)
        if {"data", "indices", "indptr", "shape"} <= values.keys():
            parts = (values["data"], values["indices"], values["indptr"])
            return scipy.sparse.csr_array(parts, shape=tuple(values["shape"]))
        dense = values.get("matrix")
    else:
        loaded = inert.load(path)
        dense = loaded.get("matrix") if isinstance(loaded, dict) else None
    if dense is None:
        raise EvaluationError(f"{path}: no vertex map ('matrix', or scipy.sparse.save_npz of a CSR matrix)")
    return scipy.sparse.csr_array(np.asarray(dense, dtype=np.float32))
