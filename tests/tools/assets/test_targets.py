"""Macro sliders and target files."""

import gzip

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from open_people.targets import MacroShape, TargetLibrary, macro_weights

fraction = st.floats(0, 1)


@settings(derandomize=True, max_examples=60, deadline=None)
@given(gender=fraction, age=st.floats(0.2, 1), muscle=fraction, weight=fraction, african=st.floats(0.01, 1))
def test_the_base_targets_are_a_partition_of_one(gender, age, muscle, weight, african):
    """Gender × age × muscle × weight, and gender × age × origin, are convex mixes."""
    weights = macro_weights(MacroShape(gender=gender, age=age, muscle=muscle, weight=weight, african=african))
    universal = [w for name, w in weights.items() if name.startswith("macrodetails/universal-")]
    origin = [
        w for name, w in weights.items() if name.rsplit("-", 2)[0].endswith(("african", "asian", "caucasian"))
    ]
    for parts in (universal, origin):
        assert min(parts) >= 0
        np.testing.assert_allclose(sum(parts), 1)


def test_sliders_at_an_anchor_take_one_target():
    weights = macro_weights(
        MacroShape(gender=1.0, age=0.5, muscle=1.0, weight=0.0, height=1.0, african=1, asian=0, caucasian=0)
    )
    stem = "male-young-maxmuscle-minweight"
    assert weights[f"macrodetails/universal-{stem}"] == 1
    assert weights[f"macrodetails/height/{stem}-maxheight"] == 1
    assert weights["macrodetails/african-male-young"] == 1
    assert not any("female" in name for name in weights)


def test_average_height_has_no_target():
    assert not any("height/" in name for name in macro_weights(MacroShape(height=0.5)))


@pytest.mark.parametrize("packed", [True, False])
def test_targets_are_read_in_metres_and_absent_ones_are_zero(tmp_path, packed):
    text = "# a comment\n2 1.0 -.5 0\n0 0 0 10\n"
    if packed:
        (tmp_path / "nose.target.gz").write_bytes(gzip.compress(text.encode()))
    else:
        (tmp_path / "nose.target").write_text(text)
    library = TargetLibrary(tmp_path, 4)
    np.testing.assert_allclose(library.dense("nose"), [[0, 0, 1], [0, 0, 0], [0.1, -0.05, 0], [0, 0, 0]])
    assert not library.dense("absent").any()
