"""How findings are told, and what the order of frames is told from."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from whacamole.body import BodyModel
from whacamole.check import Finding, Findings, check_dataset
from whacamole.check.findings import Report
from whacamole.check.order import REACH, misplaced
from whacamole.errors import DatasetError


def test_one_line_a_finding():
    finding = Finding("walk-00", 12, "mask", "off", 0.123456, 0.01, frames=3)
    assert finding.line() == "walk-00 frame 12 (worst of 3): mask: off: 0.1235, limit 0.01"
    assert Finding("", None, "dataset.json", "gone", "absent", "present").line() == (
        "dataset: dataset.json: gone: absent, limit present"
    )
    findings = Findings((finding,), 1, 20)
    assert findings.lines()[-1] == "1 sequence, 20 frames: 1 finding"
    noted = Findings((), 2, 1, ("a region file is missing",))
    assert noted.lines() == ["note: a region file is missing", "2 sequences, 1 frame: nothing wrong"]
    assert noted.ok
    assert noted.to_json()["notes"] == ["a region file is missing"]
    assert json.loads(json.dumps(findings.to_json()))["findings"][0]["frame"] == 12
    assert not findings.ok


def test_runs_of_bad_frames_become_one_finding():
    report = Report("s")
    report.at_most("x", "m", np.array([0, 2.0, 5, 3, 0, 0, np.nan, 1]), 1.0)
    assert [(f.frame, f.frames) for f in report.found] == [(2, 3), (6, 1)]


def band_of(pictures: list[int], sharpness: float = 1.0) -> np.ndarray:
    """How labels 0, 1, … fit pictures that in truth are of the frames given."""
    count = len(pictures)
    band = np.full((count, 2 * REACH + 1), np.nan)
    for frame in range(count):
        for shift in range(-REACH, REACH + 1):
            if 0 <= frame + shift < count:
                band[frame, REACH + shift] = 0.6 * np.exp(-sharpness * abs(pictures[frame + shift] - frame))
    return band


def test_frames_in_order_are_left_alone():
    assert misplaced(band_of(list(range(12))), 1.05) == []
    assert misplaced(band_of(list(range(12)), sharpness=0.0), 1.05) == []  # nothing moves


@given(frame=st.integers(0, 10), sharpness=st.floats(0.1, 3.0))
def test_a_swap_is_found_wherever_it_is(frame: int, sharpness: float):
    order = list(range(12))
    order[frame], order[frame + 1] = order[frame + 1], order[frame]
    found = misplaced(band_of(order, sharpness), 1.05)
    assert frame in {wrong.frame for wrong in found}


@pytest.mark.parametrize("shift", [-2, -1, 1, 2])
def test_late_and_early_pictures_are_found(shift: int):
    (wrong,) = misplaced(band_of([t - shift for t in range(12)], 0.3), 1.05)
    assert wrong.shift == shift
    assert wrong.frames >= 8


def test_a_repeated_frame_makes_the_rest_late():
    (wrong,) = misplaced(band_of([0, 1, 2, 3, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12], 0.5), 1.05)
    assert wrong.shift == 1
    assert wrong.frame == 4


def test_no_dataset(tmp_path):
    with pytest.raises(DatasetError, match=r"dataset\.json: not there"):
        check_dataset(tmp_path)


def test_labels_of_another_body_model(dataset):
    model = BodyModel.embedded()
    other = BodyModel(model.arrays, name="mine", sha256="ff" * 32)
    (finding,) = check_dataset(dataset, body_model=other, checksums=False)
    assert finding.label == "people.body_model_sha256"
    assert "give its file" in finding.message
