"""How a sequence is cut into the segments that W-MPJPE and WA-MPJPE are aligned on."""

from typing import Literal

import numpy as np
import numpy.typing as npt

Tail = Literal["own", "merge", "tram"]
IntArray = npt.NDArray[np.intp]


def segments(
    num_frames: int, length: int | None, tail: Tail = "own", shortest: int = 1
) -> list[tuple[int, int]]:
    """Half-open frame ranges that a sequence is scored in.

    Args:
        num_frames: N.
        length: L frames a segment; ``None`` for the whole sequence as one.
        tail: what becomes of the last N mod L frames.
            ``own``: they are a segment (WHAM, GVHMR). ``merge``: they join the segment before them if they
                are fewer
            than ``shortest``, otherwise they are a segment. ``tram``: starts are range(0, N − L, L) and a
            segment with no full one after it runs to N − 1, so the last frame is dropped, N ≤ L gives
            nothing, and N = 2 L gives only the first L frames, exactly as TRAM's ``run_eval.py`` does.
        shortest: see ``merge``.

    Returns:
        Ranges (start, stop) in order, without overlap.

    Raises:
        ValueError: a negative number of frames, a length below 1 or an unknown tail.
    """
    if num_frames < 0 or (length is not None and length < 1):
        raise ValueError(f"segments of {length} in {num_frames} frames")
    if num_frames == 0:
        return []
    if length is None:
        return [(0, num_frames)]
    if tail == "tram":
        starts = range(0, num_frames - length, length)
        return [(a, num_frames - 1 if a + 2 * length > num_frames else a + length) for a in starts]
    ranges = [(a, min(a + length, num_frames)) for a in range(0, num_frames, length)]
    if tail == "merge":
        if len(ranges) > 1 and ranges[-1][1] - ranges[-1][0] < shortest:
            ranges[-2:] = [(ranges[-2][0], num_frames)]
    elif tail != "own":
        raise ValueError(f"no rule {tail!r} for the tail")
    return ranges


def rows_of_segments(ranges: list[tuple[int, int]], position: IntArray) -> list[IntArray]:
    """For each range the rows whose ``position`` (F,), ascending, lies in it; none for an empty range."""
    edges = np.searchsorted(position, np.asarray(ranges, dtype=np.intp).reshape(-1, 2))
    return [np.arange(a, b, dtype=np.intp) for a, b in edges if b > a]
