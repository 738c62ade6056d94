"""Whether frames are in order: swapped pictures, labels a frame late, repeated frames.

What frame is a picture of? The one whose labels it fits best. A *band* holds, for the labels of frame t, how
well they fit the pictures of frames t - 2 … t + 2; in a sound sequence the middle is largest wherever
anything moves.
"""

from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from whacamole.check.findings import Report
from whacamole.labels.arrays import Float64s, Floats, Integers

REACH = 2
"""Frames before and after that a band holds."""

_BLUR = 0.7
_STEP = 0.05  # relative jump of depth that counts as an edge
_WINDOW = 6
_SMALLEST = 300  # pixels of people: in images of 64 by 36 sound pictures were found out of order
_FAINT = 0.12  # likeness below which a picture says nothing


@dataclass(frozen=True)
class Misplaced:
    """A picture that fits another frame's labels.

    Attributes:
        frame: whose picture.
        shift: how many frames later the picture that belongs there is found.
        gain: how much better it fits.
        frames: how many frames in a row.
    """

    frame: int
    shift: int
    gain: float
    frames: int


def misplaced(band: Float64s, gain: float) -> list[Misplaced]:
    """Swaps of two frames, and runs of frames that are late or early.

    Args:
        band: ``(T, 2 REACH + 1)``, NaN where there is no such frame.
        gain: by what factor another order must fit better.
    """
    count = len(band)
    found = []
    for shift in range(1, REACH + 1):
        for frame in range(count - shift):
            straight = np.array([band[frame, REACH], band[frame + shift, REACH]])
            crossed = np.array([band[frame, REACH + shift], band[frame + shift, REACH - shift]])
            # Both must fit better the other way round; if only one does, the pictures are late, not swapped.
            if (crossed > straight).all() and crossed.sum() > max(gain * straight.sum(), 2 * _FAINT):
                found.append(Misplaced(frame, shift, float(crossed.sum() / max(straight.sum(), 1e-6)), 2))
    return found or _late(band, gain)


def _late(band: Float64s, gain: float) -> list[Misplaced]:
    """The run of frames whose pictures are late or early by the shift that fits best, if there is one."""
    best: Misplaced | None = None
    for shift in (-1, 1, -2, 2):
        wrong = _late_by(band, shift, gain)
        if wrong is not None and (best is None or wrong.gain > best.gain):
            best = wrong
    return [] if best is None else [best]


def _late_by(band: Float64s, shift: int, gain: float) -> Misplaced | None:
    """Where, in windows of some frames, the pictures ``shift`` frames on fit better throughout."""
    straight, other = band[:, REACH], band[:, REACH + shift]
    known = np.isfinite(straight) & np.isfinite(other)
    width = min(_WINDOW, len(band))
    late = np.zeros(len(band), dtype=np.bool_)
    most = 0.0
    for start in range(len(band) - width + 1):
        rows = np.flatnonzero(known[start : start + width]) + start
        if len(rows) < max(2, width - 2):
            continue
        fits, others = straight[rows].sum(), other[rows].sum()
        if others > max(gain * fits, _FAINT * len(rows)):
            late[rows[other[rows] > straight[rows]]] = True
            most = max(most, float(others / max(fits, 1e-6)))
    if not late.any():
        return None
    return Misplaced(int(late.argmax()), shift, most, int(np.count_nonzero(late)))


def report_order(label: str, band: Float64s, gain: float, report: Report) -> None:
    """Note every misplaced picture."""
    for wrong in misplaced(band, gain):
        message = f"the picture of frame {wrong.frame + wrong.shift} fits better, by a factor of"
        report.add(label, message, round(wrong.gain, 3), gain, wrong.frame)


def label_edges(mask: Integers, depth: Floats) -> Float64s:
    """Where the mask or the depth jumps: edges that a colour picture of the same moment shows too."""
    log = np.log(np.clip(np.where(np.isfinite(depth), depth, 1e3), 1e-3, 1e3))
    edges = np.zeros(mask.shape)
    for axis in (0, 1):
        step = np.abs(np.diff(log, axis=axis)) > _STEP
        step |= np.diff(mask.astype(np.int64), axis=axis) != 0
        edges[tuple(slice(0, -1) if a == axis else slice(None) for a in (0, 1))] += step
    return np.asarray(ndimage.gaussian_filter(np.minimum(edges, 1.0), _BLUR), dtype=np.float64)


def colour_edges(rgb: Integers) -> Float64s:
    """Strength of the strongest colour edge at every pixel; the brightest two in a hundred are cut."""
    strongest = np.zeros(rgb.shape[:2])
    for channel in range(3):
        smooth = ndimage.gaussian_filter(rgb[..., channel].astype(np.float64), _BLUR)
        strongest = np.maximum(strongest, np.hypot(ndimage.sobel(smooth, 0), ndimage.sobel(smooth, 1)))
    return np.minimum(strongest, np.percentile(strongest, 98))


def correlation(edges: Float64s, colours: Float64s, mask: Integers) -> float:
    """Correlation ``-1 … 1`` of two edge images around the people of the mask; NaN if they are too small."""
    if np.count_nonzero(mask) < _SMALLEST:
        return float("nan")
    around = ndimage.binary_dilation(mask > 0, iterations=4)
    a, b = edges[around] - edges[around].mean(), colours[around] - colours[around].mean()
    scale = np.sqrt((a * a).sum() * (b * b).sum())
    return float((a * b).sum() / scale) if scale > 0 else float("nan")
