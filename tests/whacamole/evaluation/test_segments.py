"""How every protocol cuts a sequence, counted by hand."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from whacamole.evaluation import PROTOCOLS
from whacamole.evaluation.core.segments import rows_of_segments, segments

OWN = {
    1: [(0, 1)],
    2: [(0, 2)],
    99: [(0, 99)],
    100: [(0, 100)],
    101: [(0, 100), (100, 101)],
    199: [(0, 100), (100, 199)],
    200: [(0, 100), (100, 200)],
    250: [(0, 100), (100, 200), (200, 250)],
}
MERGED = OWN | {101: [(0, 101)]}
TRAM = {
    1: [],
    2: [],
    99: [],
    100: [],
    101: [(0, 100)],
    199: [(0, 198)],
    200: [(0, 100)],
    250: [(0, 100), (100, 249)],
}
WHOLE = {n: [(0, n)] for n in OWN}
BY_HAND = {"whac": MERGED, "wham": OWN, "tram": TRAM, "gvhmr": OWN, "emdb": OWN, "bedlam2": WHOLE}


@pytest.mark.parametrize("protocol", PROTOCOLS.values(), ids=PROTOCOLS)
@pytest.mark.parametrize("frames", OWN)
def test_the_segments_counted_by_hand(protocol, frames):
    cut = segments(frames, protocol.segment_frames, protocol.tail, protocol.shortest_tail)
    assert cut == BY_HAND[protocol.name][frames]


def test_a_tail_is_merged_below_the_shortest_and_kept_from_it_on():
    assert segments(109, 100, "merge", 10) == [(0, 109)]
    assert segments(110, 100, "merge", 10) == [(0, 100), (100, 110)]
    assert segments(5, 100, "merge", 10) == [(0, 5)]


@settings(max_examples=200, deadline=None, derandomize=True)
@given(st.integers(0, 2000), st.one_of(st.none(), st.integers(1, 300)), st.sampled_from(["own", "merge"]))
def test_every_frame_is_in_one_segment(frames, length, tail):
    cut = segments(frames, length, tail, 10)
    assert [i for a, b in cut for i in range(a, b)] == list(range(frames))


@settings(max_examples=200, deadline=None, derandomize=True)
@given(st.integers(0, 1500), st.integers(1, 200))
def test_tram_never_scores_the_last_frame_and_never_overlaps(frames, length):
    scored = [i for a, b in segments(frames, length, "tram") for i in range(a, b)]
    assert len(set(scored)) == len(scored)
    assert frames - 1 not in scored


def test_rows_fall_into_the_segment_of_their_time():
    position = np.array([0, 1, 4, 9, 10, 25])
    rows = rows_of_segments([(0, 10), (10, 20), (20, 30)], position)
    assert [r.tolist() for r in rows] == [[0, 1, 2, 3], [4], [5]]
    assert rows_of_segments([], position) == []
    assert [r.tolist() for r in rows_of_segments([(11, 20)], position)] == []


@pytest.mark.parametrize(("frames", "length"), [(-1, 100), (10, 0)])
def test_impossible_numbers_are_refused(frames, length):
    with pytest.raises(ValueError, match="segments of"):
        segments(frames, length)


def test_an_unknown_tail_is_refused():
    with pytest.raises(ValueError, match="tail"):
        segments(10, 3, "drop")
