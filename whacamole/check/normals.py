"""Whether the normals are those of the surface whose depth is stored, in the frame they should be in.

The depth of a surface says how it is inclined: over a plane, 1 / z is an affine function of the pixel. A
plane through the depths of a pixel and its eight neighbours gives a normal that owes nothing to the stored.
"""

from collections import deque
from dataclasses import dataclass

import numpy as np
from scipy import ndimage

from whacamole.check.findings import Report
from whacamole.check.limits import Limits
from whacamole.check.order import REACH, report_order
from whacamole.dataset import Sequence
from whacamole.labels.arrays import Bools, Float64s, Floats, Integers

_UNEVEN = 0.004  # share of the depth by which the nine depths of an even spot may leave their plane
_ASKEW = np.cos(np.radians(30.0))  # beyond what smoothing, folds and normal maps turn a normal by
_FADE = 10.0  # degrees; how far a normal may differ and still speak for this frame
_FEWEST = 50  # even pixels, below which normals say nothing


@dataclass(frozen=True, eq=False)
class Slopes:
    """How the surfaces of one frame are inclined, by their depth.

    Attributes:
        normal: ``(H, W, 3)`` unit normals towards the camera, camera frame.
        even: ``(H, W)`` where they can be told: no edge of mask or depth near, no sharp bend.
    """

    normal: Float64s
    even: Bools


def slopes(mask: Integers, depth: Floats, K: Float64s) -> Slopes:
    """Normals from the depth of a frame.

    Args:
        mask: ``(H, W)`` track ids.
        depth: ``(H, W)`` planar z [m], ``inf`` where nothing is hit.
        K: ``(3, 3)`` intrinsics.
    """
    near = np.divide(1.0, depth, out=np.zeros(depth.shape), where=np.isfinite(depth) & (depth > 0))
    mean = ndimage.uniform_filter(near, 3, mode="nearest")
    across, down = (
        ndimage.correlate1d(ndimage.uniform_filter1d(near, 3, 1 - axis, mode="nearest"), [-0.5, 0, 0.5], axis,
                            mode="nearest")
        for axis in (1, 0)
    )  # fmt: skip
    even = (near > 0) & (mask == ndimage.minimum_filter(mask, 3)) & (mask == ndimage.maximum_filter(mask, 3))
    height, width = depth.shape
    padded = np.pad(near, 1)
    for row in (-1, 0, 1):
        for column in (-1, 0, 1):
            there = padded[1 + row : 1 + row + height, 1 + column : 1 + column + width]
            even &= np.abs(there - mean - row * down - column * across) < _UNEVEN * mean
    x, y = np.arange(width) + 0.5, np.arange(height)[:, None] + 0.5
    # n · X = d on the plane and X = z K⁻¹ (x, y, 1), so 1 / z = (K⁻ᵀ n / d) · (x, y, 1).
    inclined = np.stack([across, down, mean - across * x - down * y], axis=-1) @ K
    length = np.linalg.norm(inclined, axis=-1, keepdims=True)
    return Slopes(-np.divide(inclined, length, out=np.zeros_like(inclined), where=length > 0), even)


def smoothed(normal: Floats) -> Float64s:
    """Unit means ``(H, W, 3)`` of each normal and its eight neighbours, as the slopes are of nine depths."""
    mean = ndimage.uniform_filter(normal.astype(np.float64), (3, 3, 1), mode="nearest")
    length = np.linalg.norm(mean, axis=-1, keepdims=True)
    return np.divide(mean, length, out=np.zeros_like(mean), where=length > 0)


@dataclass(frozen=True, eq=False)
class _Frame:
    number: int
    normal: Float64s  # smoothed, (H, W, 3)
    slope: Float64s  # of the people's even pixels, (n, 3)
    people: Bools  # (H, W) which these are


class NormalAudit:
    """Goes through the normals of a sequence once, with a few frames in memory.

    Args:
        sequence: whose normals.
        limits: what is sound.
    """

    def __init__(self, sequence: Sequence, limits: Limits) -> None:
        self._sequence, self._limits = sequence, limits
        self._ids = [int(track) for track in sequence.people["track_id"]]
        self._length, self._away = np.zeros(len(sequence)), np.zeros(len(sequence))
        self._askew = {track: np.zeros(len(sequence)) for track in (0, *self._ids)}
        self._band = np.full((len(sequence), 2 * REACH + 1), np.nan)
        self._window: deque[_Frame] = deque(maxlen=REACH + 1)

    def add(self, number: int, mask: Integers, depth: Floats, normal: Floats) -> None:
        """Measure one frame; frames come in order, some may be left out.

        Args:
            number: the frame.
            mask: ``(H, W)`` track ids.
            depth: ``(H, W)`` planar z [m].
            normal: ``(H, W, 3)`` as stored.
        """
        K, slack = self._sequence.camera["K"][number], self._limits.slack
        hit = np.isfinite(depth)
        off = np.abs(np.linalg.norm(normal, axis=-1) - hit) > self._limits.unit
        self._length[number] = max(np.count_nonzero(off) - slack, 0) / off.size
        height, width = depth.shape
        x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
        rays = np.stack([x, y, np.ones_like(x)], axis=-1) @ np.linalg.inv(K).T
        away = (normal * rays).sum(axis=-1) > 0
        self._away[number] = max(np.count_nonzero(away) - slack, 0) / max(np.count_nonzero(hit), 1)
        by_depth, mean = slopes(mask, depth, K), smoothed(normal)
        askew = by_depth.even & ((by_depth.normal * mean).sum(axis=-1) < _ASKEW)
        for track, shares in self._askew.items():
            told = np.count_nonzero(by_depth.even & (mask == track))
            if told >= _FEWEST:
                shares[number] = max(np.count_nonzero(askew & (mask == track)) - slack, 0) / told
        people = by_depth.even & (mask > 0)
        self._window.append(_Frame(number, mean, by_depth.normal[people], people))
        self._compare()

    def _compare(self) -> None:
        """The newest frame against itself and those before it."""
        newest = self._window[-1]
        for older in self._window:
            shift = newest.number - older.number
            if shift <= REACH:
                self._band[older.number, REACH + shift] = _likeness(older, newest)
                self._band[newest.number, REACH - shift] = _likeness(newest, older)

    def tell(self, report: Report) -> None:
        """Report what was found."""
        limits = self._limits
        message = "share of pixels whose length is neither 1 where something is hit nor 0 where nothing is"
        report.at_most("normal", message, self._length, 0.0)
        report.at_most("normal", "share of pixels that face away from the camera", self._away, limits.away)
        for track, shares in self._askew.items():
            whose = f"track {track}" if track else "scenery"
            limit = limits.askew if track else limits.askew_scenery
            message = f"{whose}: share of even pixels more than 30° off the slope of the depth"
            report.at_most("normal", message, shares, limit)
        report_order("normal", self._band, limits.order_labels, report)


def _likeness(depths: _Frame, normals: _Frame) -> float:
    """How well the normals of one frame fit the depths of another on people, 0 to 1; NaN if none is seen."""
    if len(depths.slope) < _FEWEST:
        return float("nan")
    cosine = (depths.slope * normals.normal[depths.people]).sum(axis=-1)
    return float(np.exp(-np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))) / _FADE).mean())
