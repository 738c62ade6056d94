"""The page of a dataset: complete, small, offline, and deaf to whatever names hold."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import chromium
from whacamole.check.findings import Finding, Findings
from whacamole.check.stored import read_findings, store_findings
from whacamole.cli import app
from whacamole.dataset import Dataset, DatasetLayout
from whacamole.dataset.statistics import Statistics, collect
from whacamole.errors import DatasetError
from whacamole.viewing.page import page_html, write_page
from whacamole.viewing.places import Places

PAPER = 2434
"""Sequences of WHAC-A-Mole."""

HOSTILE = "</script><script>window.broken=1</script><img src=x onerror=window.broken=1>'\"&<!--"
SHOTS = ("arc-horizontal", "tracking", "push-pull", "pan")


def _large(root: Path, count: int) -> Dataset:
    """A dataset of which only the index is there."""
    rng = np.random.default_rng(0)
    ids = tuple(f"subject_{number:04d}_some_longer_name_poses-00" for number in range(count))
    entries: list[dict[str, Any]] = [
        {
            "id": name, "motion_source": "amass-smplx",
            "motion_id": f"SFU/{number:04d}/some_longer_name_poses",
            "shots": [SHOTS[number % 4]], "stage": ("park", "plaza")[number % 2], "people": 1 + number % 2,
            "frames": 60 + number % 180, "fps": 30.0, "width": 640, "height": 360, "image_format": "jpg",
            "interactive": bool(number % 2), "mean_visible_fraction": float(rng.random()),
            "checksums": {"people.npz": "0" * 64},
        }
        for number, name in enumerate(ids)
    ]  # fmt: skip
    entries[0]["motion_id"] = entries[0]["stage"] = HOSTILE
    layout = DatasetLayout(root)
    layout.splits.mkdir(parents=True)
    layout.index.write_text(json.dumps({"format_version": "1.0", "sequences": entries}))
    (layout.splits / "train.txt").write_text("\n".join(ids[:2000]))
    (layout.splits / "test.txt").write_text("\n".join(ids[2000:]))
    for name in ids[:3]:
        (layout.sequence(name).folder).mkdir(parents=True)
    return Dataset(layout, ids)


@pytest.fixture(scope="module")
def large(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page of a dataset as large as the paper's, with one hostile name."""
    data = _large(tmp_path_factory.mktemp("large") / "dataset", PAPER)
    found = Findings((Finding(data.ids[1], 3, "people.joints_image", HOSTILE, 5.0, 0.05),), PAPER, 9)
    store_findings(data.layout.root, found)
    numbers = Statistics(sequences=PAPER, stages={HOSTILE: 1, "park": 9})
    page = Places(data.layout.root).page
    page.write_text(page_html(data, numbers, read_findings(data.layout.root)))
    return page


def test_the_page_of_a_large_dataset_is_small(large: Path) -> None:
    assert large.stat().st_size < 700_000
    text = large.read_text()
    assert text.count(HOSTILE[:9]) == 2  # the two scripts that are ours
    assert re.findall(r"https?://", text) == []
    (rows,) = re.findall(r'<script id="rows" type="application/json">(.*?)</script>', text, re.DOTALL)
    stored = json.loads(rows)
    assert len(stored["rows"]) == PAPER
    assert stored["rows"][0][stored["columns"].index("motion")] == HOSTILE


@pytest.mark.slow
@chromium.needs_chromium
def test_it_opens_and_filters_in_a_browser(large: Path, tmp_path: Path) -> None:
    with chromium.tab(tmp_path / "profile") as tab:
        tab.open(large)
        count = "document.getElementById('count').value"
        cards = "document.querySelectorAll('.card').length"
        assert tab.value(count).startswith("2,434 of 2,434 sequences")
        first = tab.value(cards)
        assert 0 < first <= 120  # the rest comes with scrolling
        tab.value("scrollTo(0, document.body.scrollHeight)")
        tab.wait(f"{cards} > {first}", 30)
        choose = (
            "(name, value) => { const form = document.getElementById('filters');"
            " form.elements[name].value = value; form.dispatchEvent(new Event('input', {bubbles: true}));"
            f" return {count}; }}"
        )
        assert tab.value(f"({choose})('shots', 'tracking')").startswith("609 of")
        assert tab.value(f"({choose})('split', 'test')").startswith("109 of")
        assert "shots=tracking" in tab.value("location.hash")
        tab.value("document.querySelector('#filters button').click()")
        tab.wait(f"{count}.startsWith('2,434')")
        assert tab.value(f"({choose})('words', '0001')").startswith("1 of")
        tab.value("document.querySelector('.card').click()")
        assert HOSTILE in tab.value("document.getElementById('detail').innerText")  # the finding, as text
        tab.value("document.getElementById('detail').close()")
        tab.value(f"({choose})('words', '0000')")
        tab.value("document.querySelector('.card').click()")
        assert HOSTILE in tab.value(
            "document.getElementById('detail').innerText"
        )  # the motion's name, as text
        assert tab.value("window.broken") is None
        assert tab.requests == []
        assert tab.errors == []


def test_the_command_writes_the_page_with_what_is_there(dataset: Dataset) -> None:
    places = Places(dataset.layout.root)
    places.folder.mkdir(exist_ok=True)
    places.video("walk-01").touch()
    found = CliRunner().invoke(app, ["page", str(dataset.layout.root)], catch_exceptions=False)
    places.video("walk-01").unlink()
    assert found.exit_code == 0
    text = places.page.read_text()
    stored = json.loads(text.split('type="application/json">')[1].split("</script>")[0])
    links = {row[0]: row[stored["columns"].index("links")] for row in stored["rows"]}
    assert links == {"duet-00": 0, "walk-00": 0, "walk-01": 2}
    numbers = collect(dataset)
    assert f"{numbers.instances:,} instances" in text
    assert "Not audited yet" in text


def test_the_audit_is_kept_and_known_to_be_old(dataset: Dataset) -> None:
    root = dataset.layout.root
    CliRunner().invoke(app, ["check", str(root), "--quiet"], catch_exceptions=False)
    kept = read_findings(root)
    assert kept is not None
    assert kept.current
    assert kept.sequences == len(dataset)
    index = dataset.layout.index
    before = index.read_text()
    index.write_text(before + "\n")
    again = read_findings(root)
    index.write_text(before)
    assert again is not None
    assert not again.current
    (root / "check.json").write_text('{"findings": 3}')
    with pytest.raises(DatasetError, match="whacamole check"):
        read_findings(root)
    write_page(dataset.layout)  # a broken outcome is said, and no reason to be without a page
    assert "not the outcome of an audit" in Places(root).page.read_text()
    (root / "check.json").unlink()
