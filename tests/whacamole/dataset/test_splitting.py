"""Splits by a rule: nothing leaks, nothing moves that need not, and what cannot be split is refused."""

import json
from pathlib import Path

import numpy as np
import pytest
import typer
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from whacamole.cli.split import split
from whacamole.dataset import DatasetLayout, side_of, write_index, write_summary
from whacamole.dataset.files import write_arrays
from whacamole.dataset.splitting import SplitRule, assign, refresh_splits, split_dataset
from whacamole.errors import DatasetError, RecipeError

LINKS = st.dictionaries(
    st.integers(0, 30).map(str),
    st.lists(st.sampled_from("abcdefghijkl"), min_size=1, max_size=3),
    min_size=1,
    max_size=12,
)


@settings(derandomize=True, max_examples=150, deadline=None)
@given(LINKS, st.floats(0, 1), st.integers(0, 3))
def test_what_is_linked_is_on_one_side(links: dict[str, list[str]], fraction: float, seed: int) -> None:
    side = assign(links, SplitRule("motion", fraction, seed))
    assert set(side) == set(links)
    for one, tied in links.items():
        for other, also in links.items():
            if set(tied) & set(also):
                assert side[one] == side[other]


@settings(derandomize=True, max_examples=100, deadline=None)
@given(LINKS, st.lists(st.sampled_from("mnopq"), min_size=1, max_size=2))
def test_a_sequence_of_new_motions_moves_no_other(links: dict[str, list[str]], new: list[str]) -> None:
    before = assign(links, SplitRule())
    after = assign({**links, "new": new}, SplitRule())
    assert {key: after[key] for key in links} == before


def test_one_motion_a_sequence_is_split_as_ever() -> None:
    links = {f"s{number}": [f"motion {number}"] for number in range(200)}
    side = assign(links, SplitRule("motion", 0.2, 0))
    assert all(side[f"s{number}"] == side_of(f"motion {number}", 0.2) for number in range(200))
    assert assign(links, SplitRule("motion", 0.2, 1)) != side


def _finish(layout: DatasetLayout, name: str, motions: list[str], stage: str, betas: list[float]) -> None:
    sequence = layout.sequence(name)
    sequence.folder.mkdir(parents=True)
    people = {
        "motion_id": np.array(motions),
        "gender": np.array(["female"] * len(motions)),
        "betas": np.array([[value] * 10 for value in betas]),
        "body_model_sha256": "0",
    }
    write_arrays(sequence.people, people)
    write_summary(sequence, {"id": name, "motion_id": motions[0], "stage": stage})


@pytest.fixture
def layout(tmp_path: Path) -> DatasetLayout:
    """Twelve motions in six pairs that share a stage, in four groups of three that share a person."""
    found = DatasetLayout(tmp_path)
    for number in range(12):
        _finish(found, f"m{number}-00", [f"m{number}"], f"stage{number // 2}", [number // 3])
    write_index(found, {})
    refresh_splits(found, 0.2)
    return found


def _side_of(layout: DatasetLayout) -> dict[str, str]:
    return {
        name: side
        for side in ("train", "test")
        for name in (layout.splits / f"{side}.txt").read_text().split()
    }


@pytest.mark.parametrize(("by", "together"), [("stage", 2), ("person", 3)])
def test_stages_and_people_stay_on_one_side(layout: DatasetLayout, by: str, together: int) -> None:
    split_dataset(layout, SplitRule(by, 0.5, 2))
    side = _side_of(layout)
    assert len(side) == 12
    assert set(side.values()) == {"train", "test"}
    for number in range(12):
        first = number - number % together
        assert side[f"m{number}-00"] == side[f"m{first}-00"]


def test_companions_do_not_leak(layout: DatasetLayout) -> None:
    """A scene of m0 with m5 as companion ties the two together."""
    side = assign({f"m{n}-00": [f"m{n}"] for n in range(12)}, SplitRule("motion", 0.5))
    apart = next(n for n in range(1, 12) if side[f"m{n}-00"] != side["m0-00"])
    _finish(layout, "crowd-00", ["m0", f"m{apart}"], "park", [7, 8])
    split_dataset(layout, SplitRule("motion", 0.5))
    found = _side_of(layout)
    assert found["m0-00"] == found[f"m{apart}-00"] == found["crowd-00"]


def test_a_split_that_would_leak_is_refused_and_the_old_one_kept(layout: DatasetLayout) -> None:
    before = _side_of(layout)
    _finish(layout, "crowd-00", [f"m{number}" for number in range(12)], "park", [0] * 12)
    with pytest.raises(DatasetError, match="hang together"):
        split_dataset(layout, SplitRule("motion", 0.5))
    assert _side_of(layout) == before
    refresh_splits(layout, 0.5)  # a render goes on: all on one side, nothing leaks
    assert len(set(_side_of(layout).values())) == 1


def test_the_rule_is_kept_for_what_is_added_later(layout: DatasetLayout) -> None:
    split_dataset(layout, SplitRule("stage", 0.5, 2))
    before = _side_of(layout)
    _finish(layout, "late-00", ["late"], "stage0", [99])
    refresh_splits(layout, 0.2)
    after = _side_of(layout)
    assert after.pop("late-00") == before["m0-00"]
    assert after == before
    (layout.splits / "rule.json").write_text('{"by": "colour"}')
    with pytest.raises(DatasetError, match=r"rule\.json"):
        refresh_splits(layout, 0.2)


def test_a_rule_that_means_nothing_is_refused() -> None:
    with pytest.raises(RecipeError, match="--by"):
        SplitRule("colour")  # type: ignore[arg-type]
    with pytest.raises(RecipeError, match="--test-fraction"):
        SplitRule(test_fraction=1.5)


def test_the_command_prints_the_sides(layout: DatasetLayout) -> None:
    app = typer.Typer()
    app.command()(split)
    run = CliRunner().invoke(app, [str(layout.root), "--by", "stage", "--test-fraction", "0.5", "--json"])
    assert run.exit_code == 0
    sides = json.loads(run.stdout)
    assert {name: side for side, names in sides.items() for name in names} == _side_of(layout)
