"""Counts against counts made another way; the card says them."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import typer
from hypothesis import given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

import tiny_dataset
import whacamole
from whacamole.body import EMBEDDED_NAME
from whacamole.cli.split import split
from whacamole.cli.stats import stats
from whacamole.dataset import Dataset
from whacamole.dataset.card import card_text, statistics_text, write_card
from whacamole.dataset.statistics import Spread, Statistics, collect
from whacamole.viewing.page import write_page


@pytest.fixture(scope="module")
def numbers(whole: Dataset) -> Statistics:
    return collect(whole)


def test_counts_are_those_of_the_scene(numbers: Statistics) -> None:
    assert (numbers.sequences, numbers.frames, numbers.people, numbers.motions) == (3, 12, 4, 2)
    assert numbers.instances == 2 * 4 + 2 * 3  # the walker is out of view in the last frame, twice
    assert numbers.interactive == 1
    assert numbers.seconds == pytest.approx(12 / 30)
    assert numbers.stages == {"park": 1, "plaza": 1, "studio": 1}
    assert numbers.genders == {"female": 3, "male": 1}
    assert numbers.licences == {"CC0-1.0": 3}
    assert numbers.shots == {"arc-horizontal": 3}
    assert list(numbers.body_models) == [EMBEDDED_NAME]
    assert sum(numbers.splits.values()) == 3


def test_distributions_are_over_instances(numbers: Statistics, whole: Dataset) -> None:
    assert all(sum(spread.counts) == numbers.instances for spread in numbers.spreads.values())
    distances = [
        np.linalg.norm(sequence.people["joints_camera"][p, t, 0])
        for sequence in whole
        for p, t in np.argwhere(sequence.people["valid"])
    ]
    spread = numbers.spreads["distance_m"]
    np.testing.assert_allclose(
        [spread.low, spread.mean, spread.high],
        [min(distances), np.mean(distances), max(distances)],
        rtol=1e-6,
    )
    focal = numbers.spreads["focal_mm"]
    assert focal.low == pytest.approx(80.0 * 36.0 / 97.0)


def test_shares_are_of_instances_and_joints(numbers: Statistics, whole: Dataset) -> None:
    visibility = np.concatenate([s.people["joint_visibility"][s.people["valid"]] for s in whole])
    expected = [round(float((visibility == value).mean()), 4) for value in range(3)]
    assert list(numbers.joints.values()) == expected
    touching = sum(
        bool(s.contact["ground_contact"][p, t].any())
        for s in whole
        for p, t in np.argwhere(s.people["valid"])
    )
    assert numbers.ground_contact == pytest.approx(touching / numbers.instances, abs=1e-4)


@settings(derandomize=True, max_examples=100, deadline=None)
@given(st.lists(st.lists(st.floats(-5, 50), max_size=8), max_size=5))
def test_pieces_count_as_the_whole(pieces: list[list[float]]) -> None:
    edges = (0.0, 1.0, 2.5, 10.0)
    apart, whole = Spread(edges), np.array([value for piece in pieces for value in piece])
    for piece in pieces:
        apart.add(np.array(piece))
    bins = [*edges[1:], np.inf]
    lower = [-np.inf, *edges[1:]]
    assert apart.counts == [
        int(((whole >= low) & (whole < high)).sum()) for low, high in zip(lower, bins, strict=True)
    ]
    if whole.size:
        assert (apart.low, apart.high) == (whole.min(), whole.max())
        assert apart.mean == pytest.approx(whole.mean(), abs=1e-9)


def test_the_card_says_which_body_and_what_betas_mean(numbers: Statistics, whole: Dataset) -> None:
    text = card_text(numbers, whole.index)
    assert f"`{EMBEDDED_NAME}` (sha256 `{whole.index['body_model']['sha256'][:12]}`)" in text
    assert "not SMPL-X betas" in text
    assert "| instances (a person in an image) | 14 |" in text
    assert "| CC0-1.0 | 3 |" in text


def test_the_card_is_written_beside_the_index_and_again_the_same(whole: Dataset) -> None:
    write_card(whole.layout)
    first = (whole.layout.root / "README.md").read_bytes()
    write_card(whole.layout)
    assert (whole.layout.root / "README.md").read_bytes() == first


def test_an_empty_dataset_has_statistics_too() -> None:
    assert "| sequences | 0 |" in statistics_text(Statistics())
    assert card_text(Statistics(), {}).startswith("# Dataset card")


def test_the_command_prints_json(whole: Dataset) -> None:
    app = typer.Typer()
    app.command()(stats)
    run = CliRunner().invoke(app, [str(whole.layout.root), "--json"])
    assert run.exit_code == 0
    assert json.loads(run.stdout)["instances"] == 14
    assert "Shots" in CliRunner().invoke(app, [str(whole.layout.root)]).stdout


def test_plots_leave_out_empty_rows_at_the_ends(numbers: Statistics) -> None:
    spread = Spread((0.0, 1.0, 2.0, 3.0, 4.0))
    spread.add(np.array([1.5, 3.2, 3.4, 3.6]))
    shown = statistics_text(replace(numbers, spreads={"distance_m": spread}))
    rows = shown.partition("```text\n")[2].splitlines()[:4]
    assert [" ".join(row.split()[:4]) for row in rows[:3]] == ["1 to 2 25.0%", "2 to 3 0.0%", "3 to 4 75.0%"]
    assert rows[3].startswith("least 1.5")


def test_a_split_counts_card_and_page_anew(tmp_path: Path) -> None:
    tiny_dataset.write_dataset(tmp_path / "dataset")
    layout = whacamole.open(tmp_path / "dataset").layout
    write_card(layout)
    app = typer.Typer()
    app.command()(split)
    for fraction, sides in (
        ("1.0", ("| test | 3 |", "| train | 0 |")),
        ("0.0", ("| test | 0 |", "| train | 3 |")),
    ):
        assert CliRunner().invoke(app, [str(layout.root), "--test-fraction", fraction]).exit_code == 0
        assert all(side in layout.card.read_text() for side in sides)
        assert not (layout.root / "index.html").exists()  # nobody made one
    write_page(layout)
    before = (layout.root / "index.html").read_text()
    CliRunner().invoke(app, [str(layout.root), "--test-fraction", "1.0"])
    assert (layout.root / "index.html").read_text() != before


def test_bins_of_nothing_are_left_out_before_and_after() -> None:
    spread = Spread((0.0, 1.0, 2.0, 3.0, 4.0))
    assert spread.rows() == []
    spread.add(np.array([1.5, 3.5, 3.6]))
    assert spread.rows() == [("1 to 2", 1), ("2 to 3", 0), ("3 to 4", 2)]
    spread.add(np.array([9.0]))
    assert spread.rows()[-1] == ("4 and more", 1)
