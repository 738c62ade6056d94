"""A map of points and the cameras that saw them, grown frame by frame."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from whacamole.baseline.odometry.bundle import Bundle, Sightings, adjust, reprojection
from whacamole.baseline.odometry.features import PointTracks, rays
from whacamole.baseline.rigid import BoolArray, FloatArray, inverse, rigid

FEWEST = 12
"""Map points that must agree on a camera."""

_MISS = 2.5  # px, by which a point may miss its sighting
_ANGLE = np.radians(1.2)  # between the rays to a new point
_KEYFRAME = 3  # every so many frames go into the bundle adjustment
_PERIOD = 45  # frames between adjustments while the map grows
_MAP_POINTS = 700  # in a bundle adjustment, those seen most


class Mapper:
    """Grows a map from two frames.

    Args:
        cv2: OpenCV.
        tracks: points followed through the video.
        K: (T, 3, 3).
    """

    def __init__(self, cv2: Any, tracks: PointTracks, K: FloatArray) -> None:
        self._cv2, self._tracks, self._K = cv2, tracks, K
        T, N = tracks.tracked.shape
        self._pose = np.tile(np.eye(4), (T, 1, 1))  # world to camera
        self._placed: BoolArray = np.zeros(T, dtype=bool)
        self._points = np.full((N, 3), np.nan)

    def begin(self, i: int, j: int) -> bool:
        """Start from frames i and j; false where they do not fit together."""
        both = self._tracks.tracked[i] & self._tracks.tracked[j]
        first, second = (self._rays(frame, both)[:, :2] for frame in (i, j))
        threshold = 1.0 / float(self._K[i, 0, 0])
        E, inliers = self._cv2.findEssentialMat(
            first, second, np.eye(3), method=self._cv2.USAC_MAGSAC, prob=0.9999, threshold=threshold
        )
        if E is None or E.shape != (3, 3):
            return False
        agreed, R, t, _ = self._cv2.recoverPose(E, first, second, np.eye(3), mask=inliers.copy())
        if agreed < FEWEST:
            return False
        self._pose[j] = rigid(R, t[:, 0])
        self._placed[[i, j]] = True
        self._start = (i, j)
        self._triangulate(i, j)
        return bool(np.isfinite(self._points[:, 0]).sum() >= FEWEST)

    def grow(self) -> None:
        """Place all other frames, from the first two outwards, and adjust."""
        i, j = self._start
        T = len(self._pose)
        order = [*range(i + 1, j), *range(j + 1, T), *range(i - 1, -1, -1)]
        for count, frame in enumerate(order, start=1):
            if self._place(frame):
                self._widen(frame)
            if count % _PERIOD == 0 or frame == j - 1:
                self._adjust()
        self._adjust()
        for frame in range(T):
            if not self._placed[frame] or frame % _KEYFRAME:
                self._placed[frame] = self._place(frame)

    def poses(self) -> tuple[FloatArray, BoolArray]:
        """Camera to world (T, 4, 4), in the map's unit, and which frames were placed."""
        return inverse(self._pose), self._placed

    def _rays(self, frame: int, points: BoolArray) -> FloatArray:
        return rays(self._tracks.pixels[frame, points].astype(np.float64), self._K[frame])

    def _place(self, frame: int) -> bool:
        """Place a frame by the points of the map that it sees."""
        known = self._tracks.tracked[frame] & np.isfinite(self._points[:, 0])
        if known.sum() < FEWEST:
            return False
        near = self._nearest(frame)
        rvec, _ = self._cv2.Rodrigues(self._pose[near, :3, :3])
        tvec = self._pose[near, :3, 3:].copy()
        points, pixels = self._points[known], self._tracks.pixels[frame, known].astype(np.float64)
        found, rvec, tvec, inliers = self._cv2.solvePnPRansac(
            points, pixels, self._K[frame], None, rvec, tvec, True, 200, _MISS, 0.999
        )
        if not found or inliers is None or len(inliers) < max(FEWEST, 0.4 * len(points)):
            return False
        chosen = inliers[:, 0]
        rvec, tvec = self._cv2.solvePnPRefineLM(
            points[chosen], pixels[chosen], self._K[frame], None, rvec, tvec
        )
        self._pose[frame] = rigid(self._cv2.Rodrigues(rvec)[0], tvec[:, 0])
        self._placed[frame] = True
        return True

    def _nearest(self, frame: int) -> int:
        placed = np.flatnonzero(self._placed)
        return int(placed[np.abs(placed - frame).argmin()])

    def _widen(self, frame: int) -> None:
        """New points from this frame and the placed ones furthest in time that still share points with it."""
        new = self._tracks.tracked[frame] & ~np.isfinite(self._points[:, 0])
        if new.sum() < FEWEST:
            return
        placed = np.flatnonzero(self._placed & (np.arange(len(self._placed)) != frame))
        shared = (self._tracks.tracked[placed] & new).sum(axis=1)
        for other in placed[np.argsort(-np.abs(placed - frame) * (shared >= FEWEST))][:3]:
            self._triangulate(int(other), frame)

    def _triangulate(self, i: int, j: int) -> None:
        """Points seen in both frames that have no place yet, where rays meet well."""
        both = self._tracks.tracked[i] & self._tracks.tracked[j] & ~np.isfinite(self._points[:, 0])
        if not both.any():
            return
        first, second = self._rays(i, both), self._rays(j, both)
        A, B = self._pose[i, :3], self._pose[j, :3]
        found = self._cv2.triangulatePoints(A, B, first[:, :2].T.copy(), second[:, :2].T.copy())
        with np.errstate(divide="ignore", invalid="ignore"):
            place = (found[:3] / found[3]).T
        good = np.isfinite(place).all(axis=1)
        toward = []
        for pose, ray, frame in ((A, first, i), (B, second, j)):
            local = place @ pose[:, :3].T + pose[:, 3]
            ahead = np.maximum(local[:, 2:], 1e-6)
            miss = np.linalg.norm(local[:, :2] / ahead - ray[:, :2], axis=1) * self._K[frame, 0, 0]
            good &= (local[:, 2] > 0) & (miss < _MISS)
            center = -pose[:, :3].T @ pose[:, 3]
            toward.append((place - center) / np.linalg.norm(place - center, axis=1, keepdims=True))
        good &= (toward[0] * toward[1]).sum(axis=1) < np.cos(_ANGLE)
        self._points[np.flatnonzero(both)[good]] = place[good]

    def _adjust(self) -> None:
        """Bundle-adjust every third placed frame, and drop points that still miss."""
        start = self._start[0]
        placed = np.flatnonzero(self._placed)
        frames = placed[(placed % _KEYFRAME == 0) | (placed == start)]
        frames = np.concatenate([[start], frames[frames != start]])
        seen = self._tracks.tracked[frames] & np.isfinite(self._points[:, 0])
        chosen = np.argsort(-seen.sum(axis=0), kind="stable")[:_MAP_POINTS]
        chosen = chosen[seen[:, chosen].sum(axis=0) >= 3]
        if len(frames) < 3 or len(chosen) < FEWEST:
            return
        camera, point = np.nonzero(seen[:, chosen])
        sightings = Sightings(camera, point, self._pixels(frames[camera], chosen[point]), self._K[frames])
        bundle = Bundle(self._pose[frames, :3, :3], self._pose[frames, :3, 3], self._points[chosen])
        bundle = adjust(bundle, sightings)
        self._pose[frames] = rigid(bundle.R, bundle.t)
        error, depth = reprojection(bundle, sightings)
        miss = np.linalg.norm(error, axis=1)
        bad = np.bincount(point, (miss > 2 * _MISS) | (depth <= 0), len(chosen)) > 0.5 * np.bincount(point)
        self._points[:] = np.nan
        self._points[chosen[~bad]] = bundle.points[~bad]
        for frame in frames[1:]:
            self._retriangulate(int(frame))

    def _retriangulate(self, frame: int) -> None:
        """Bring back points that the adjustment left out, by the adjusted cameras."""
        if frame % (2 * _KEYFRAME) == 0:
            self._widen(frame)

    def _pixels(self, frames: NDArray[np.intp], points: NDArray[np.intp]) -> FloatArray:
        return self._tracks.pixels[frames, points].astype(np.float64)
