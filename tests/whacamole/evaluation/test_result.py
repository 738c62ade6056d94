"""Results: pooling that is exact, intervals that cover, files that come back whole."""

import os

import numpy as np
import pytest

from whacamole.evaluation import (
    METRICS,
    Bodies,
    EvaluationError,
    MethodResult,
    Result,
    SequenceScore,
    evaluate,
    groups,
    paired_bootstrap,
    pooled,
    summary,
)
from whacamole.evaluation.pooling import moments
from whacamole.evaluation.protocol import PROTOCOLS
from whacamole.evaluation.truth.dataset import DatasetTruth


@pytest.fixture(scope="module")
def folders(scenes, make, tmp_path_factory):
    root = tmp_path_factory.mktemp("pred")
    return {
        name: make["predictions"](
            root / name, {s.id: make["prediction"](s, noise=noise, seed=7) for s in scenes}
        )
        for name, noise in (("good", 0.01), ("bad", 0.04))
    }


@pytest.fixture(scope="module")
def result(dataset, folders) -> Result:
    return evaluate(dataset, folders, "whac", bodies=Bodies(vertices=200))


def assert_same(a: Result, b: Result):
    assert (a.protocol, a.truth, a.split, a.ids, a.version) == (
        b.protocol,
        b.truth,
        b.split,
        b.ids,
        b.version,
    )
    for ours, theirs in zip(a.methods, b.methods, strict=True):
        assert ours.failures == theirs.failures
        assert ours.counts == theirs.counts
        for name, score in ours.sequences.items():
            other = theirs.sequences[name]
            assert (score.shots, score.matches, score.notes, score.up) == (
                other.shots, other.matches, other.notes, other.up
            )  # fmt: skip
            for mine, yours in (
                (score.values, other.values),
                (score.weights, other.weights),
                (score.paths, other.paths),
            ):
                assert mine.keys() == yours.keys()
                for key in mine:
                    np.testing.assert_array_equal(mine[key], yours[key])


def test_saved_and_read_back_it_is_the_same(result, tmp_path):
    assert_same(result, Result.load(result.save(tmp_path / "new" / "result.npz")))


def test_any_number_of_processes_gives_the_same(dataset, folders, result):
    assert_same(result, evaluate(dataset, folders, "whac", bodies=Bodies(vertices=200), jobs=3))


class Deadly(DatasetTruth):
    """Ends the process that reads it, unless it is the first one."""

    def __init__(self, root):
        super().__init__(root)
        self._home = os.getpid()

    def read(self, sequence_id):
        if os.getpid() != self._home:
            os._exit(1)
        return super().read(sequence_id)


def test_what_a_killed_process_had_not_finished_is_done_by_the_first(dataset, folders, result):
    assert_same(result, evaluate(Deadly(dataset), folders, "whac", bodies=Bodies(vertices=200), jobs=2))


def test_less_noise_is_better_in_everything_that_counts(result):
    good, bad = (summary(result)[name] for name in ("good", "bad"))
    for key in ("mpjpe", "pa_mpjpe", "pve", "w_mpjpe", "wa_mpjpe", "accel", "c_rpe_t", "sw_mpjpe", "jitter"):
        assert good[key] < bad[key]


def test_pooling_is_the_mean_over_all_frames_of_all_sequences(result):
    method = result.method("bad")
    every = np.concatenate([score.values["mpjpe"].ravel() for score in method.sequences.values()])
    assert pooled(method.sequences.values(), "mpjpe") == pytest.approx(every.mean())
    people = np.concatenate([score.values["h_ate"] for score in method.sequences.values()])
    assert pooled(method.sequences.values(), "h_ate") == pytest.approx(people.mean())


@pytest.mark.parametrize("by", ["sequence", "shot", "source", "visibility"])
def test_groups_cover_the_whole_and_pool_back_to_it(result, by):
    method = result.method("good")
    parts = [
        np.sum([moments(score, "mpjpe", selection) for score in method.sequences.values()], axis=0)
        for _, selection in groups(result, by)
    ]
    total = np.sum(parts, axis=0)
    assert total[1] == 2 * (40 + 50 + 60)
    assert total[0] / total[1] == pytest.approx(summary(result)["good"]["mpjpe"])


def test_values_of_a_sequence_belong_to_a_group_only_if_all_of_it_does(result):
    method = result.method("good")
    for by, expected in (("source", True), ("shot", False), ("visibility", False)):
        for _, selection in groups(result, by):
            assert np.isfinite(pooled(method.sequences.values(), "c_ate", selection)) == expected
    for _, selection in groups(result, "visibility"):
        assert np.isnan(pooled(method.sequences.values(), "c_rpe_t", selection))
    for _, selection in groups(result, "shot"):
        assert np.isfinite(pooled(method.sequences.values(), "c_rpe_t", selection))


def made(name, means, frames=50):
    """A method whose MPJPE has a known mean in each sequence."""
    method = MethodResult(name)
    for number, mean in enumerate(means):
        score = SequenceScore(f"s{number}", "", np.arange(frames), ("",) * frames, np.ones((1, frames)))
        score.values["mpjpe"] = np.full((1, frames), float(mean))
        method.sequences[score.id] = score
    return method


def test_a_constant_difference_has_an_interval_of_no_width():
    rng = np.random.default_rng(0)
    level = rng.uniform(50, 150, size=20)
    found = paired_bootstrap(made("a", level), made("b", level + 3.0), "mpjpe")
    assert (found.difference, found.low, found.high) == pytest.approx((3.0, 3.0, 3.0))
    assert found.clear
    assert found.sequences == 20


def test_the_interval_covers_the_true_difference_as_often_as_it_says():
    rng = np.random.default_rng(1)
    covered = 0
    for trial in range(200):
        level = rng.normal(100, 30, size=30)
        a, b = made("a", level, 2), made("b", level + rng.normal(1.0, 4.0, size=30), 2)
        found = paired_bootstrap(a, b, "mpjpe", seed=trial, resamples=400)
        covered += found.low <= 1.0 <= found.high
    assert 0.88 <= covered / 200 <= 0.99


def test_the_interval_is_that_of_the_pooled_mean_with_sequences_of_any_length():
    """Against a loop that draws sequences and pools their frames."""
    rng = np.random.default_rng(2)
    a, b = made("a", rng.uniform(0, 9, size=6)), made("b", rng.uniform(0, 9, size=6))
    for name, frames in zip(list(a.sequences), (3, 10, 20, 40, 5, 9), strict=True):
        for method in (a, b):
            method.sequences[name].values["mpjpe"][:, frames:] = np.nan
    found = paired_bootstrap(a, b, "mpjpe", seed=5, resamples=4000)
    differences, names = [], list(a.sequences)
    for _ in range(4000):
        drawn = rng.choice(names, size=6)
        means = [
            np.nanmean(np.concatenate([m.sequences[n].values["mpjpe"][0] for n in drawn])) for m in (a, b)
        ]
        differences.append(means[1] - means[0])
    low, high = np.percentile(differences, [2.5, 97.5])
    assert found.low == pytest.approx(low, abs=0.4)  # six sequences give few distinct means
    assert found.high == pytest.approx(high, abs=0.4)  # six sequences give few distinct means


def test_the_interval_is_repeatable_and_needs_two_common_sequences():
    a, b = made("a", [1, 2, 3]), made("b", [2, 2, 5])
    assert paired_bootstrap(a, b, "mpjpe") == paired_bootstrap(a, b, "mpjpe")
    assert paired_bootstrap(a, made("b", [1]), "mpjpe") is None
    assert paired_bootstrap(a, b, "pve") is None


def test_methods_evaluated_apart_join_to_one_result(dataset, folders, result, tmp_path):
    parts = [
        evaluate(dataset, {name: path}, "whac", bodies=Bodies(vertices=200)) for name, path in folders.items()
    ]
    joined = Result.load(parts[0].save(tmp_path / "a.npz")).joined(parts[1])
    assert_same(joined, result)
    with pytest.raises(EvaluationError, match="both results have a method"):
        joined.joined(parts[1])
    with pytest.raises(EvaluationError, match="different protocol: whac and wham"):
        parts[0].joined(Result(PROTOCOLS["wham"], "whacamole", "test", (), ()))
    with pytest.raises(EvaluationError, match="different split: test and train"):
        parts[0].joined(Result(PROTOCOLS["whac"], "whacamole", "train", (), ()))


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04", b"no zip at all"])
def test_what_is_no_result_is_refused(tmp_path, content):
    (tmp_path / "r.npz").write_bytes(content)
    with pytest.raises(EvaluationError, match="no saved result"):
        Result.load(tmp_path / "r.npz")


def test_results_of_another_format_and_absent_ones_are_refused(tmp_path):
    np.savez(tmp_path / "r.npz", meta=np.array('{"format": "something else"}'))
    with pytest.raises(EvaluationError, match="evaluate again"):
        Result.load(tmp_path / "r.npz")
    with pytest.raises(EvaluationError, match="no saved result"):
        Result.load(tmp_path / "nothing.npz")


def test_a_place_that_cannot_be_written_is_said(result, tmp_path):
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(EvaluationError, match="can be written"):
        result.save(tmp_path / "file" / "r.npz")


def test_an_unknown_method_is_said(result):
    with pytest.raises(EvaluationError, match="only good, bad"):
        result.method("ugly")


def test_every_metric_has_its_level(result):
    shapes = {"person_frame": 2, "frame": 1, "person": 1, "sequence": 0}
    for method in result.methods:
        for score in method.sequences.values():
            for key, values in score.values.items():
                assert values.ndim == shapes[METRICS[key].level], key


def test_the_truths_a_method_was_given_are_kept(result):
    assert result.method("good").ground_truth_used == "boxes"
