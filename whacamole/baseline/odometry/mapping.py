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
_ANGLES = np.radians([1.2, 0.6, 0.3, 0.15])
"""Between the rays to a new point: the widest at which a map can be started; far walls offer no more."""

_ENOUGH = 40  # points for a start at an angle
_WITNESSES = 8  # frames asked which of several starts is right
_LOST = 4.0  # px, the most by which a point counts as missed then
_FAR = 1e4  # baselines to the furthest point that counts as before both cameras
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
        self._angle = float(_ANGLES[0])

    def begin(self, i: int, j: int) -> bool:
        """Start from frames i and j; false where they do not fit together.

        Two views of one plane, a floor say, have two explanations and an essential matrix finds either; so
        all that the two frames allow are tried, and the one that other frames agree with is taken.
        """
        self._start = (i, j)
        guesses = self._guesses(i, j)
        tried = [(self._disagreement(R, t), n) for n, (R, t) in enumerate(guesses)]
        if not tried:
            return False
        error, best = min(tried)
        return bool(np.isfinite(error)) and self._start_map(*guesses[best]) >= FEWEST

    def _guesses(self, i: int, j: int) -> list[tuple[FloatArray, FloatArray]]:
        """Rotations (3, 3) and directions (3,) from frame i to frame j: by the essential matrix, and as if
        all were one plane."""
        both = self._tracks.tracked[i] & self._tracks.tracked[j]
        first, second = (self._rays(frame, both)[:, :2] for frame in (i, j))
        threshold = 1.0 / float(self._K[i, 0, 0])
        robust = {"method": self._cv2.USAC_MAGSAC}
        found = []
        E, inliers = self._cv2.findEssentialMat(
            first, second, np.eye(3), prob=0.9999, threshold=threshold, **robust
        )
        if E is not None and E.shape == (3, 3):
            agreed, R, t, _, _ = self._cv2.recoverPose(
                E, first, second, np.eye(3), distanceThresh=_FAR, mask=inliers.copy()
            )
            if agreed >= FEWEST:
                found.append((R, t[:, 0]))
        H, _ = self._cv2.findHomography(first, second, ransacReprojThreshold=threshold, **robust)
        if H is not None:
            _, turns, ways, _ = self._cv2.decomposeHomographyMat(H, np.eye(3))
            found += [(R, t[:, 0] / max(np.linalg.norm(t), 1e-12)) for R, t in zip(turns, ways, strict=True)]
        return found

    def _start_map(self, R: FloatArray, t: FloatArray) -> int:
        """Begin anew with frame i at the origin and frame j at a guess; the number of points found."""
        i, j = self._start
        self._pose[:], self._placed[:], self._points[:] = np.eye(4), False, np.nan
        self._pose[j] = rigid(R, t)
        self._placed[[i, j]] = True
        found = 0
        for self._angle in _ANGLES:
            self._triangulate(i, j)
            found = int(np.isfinite(self._points[:, 0]).sum())
            if found >= _ENOUGH:
                break
        return found

    def _disagreement(self, R: FloatArray, t: FloatArray) -> float:
        """How badly other frames fit a guess: mean miss [px] of the points they see, at most :data:`_LOST`
        each; infinite where the guess gives no map."""
        if self._start_map(R, t) < FEWEST:
            return float("inf")
        i, j = self._start
        near = np.arange(max(0, 2 * i - j), min(len(self._pose), 2 * j - i + 1))
        misses = []
        for frame in near[:: max(1, len(near) // _WITNESSES)]:
            known = self._tracks.tracked[frame] & np.isfinite(self._points[:, 0])
            if known.sum() >= FEWEST:
                placed = self._place(int(frame))
                local = self._points[known] @ self._pose[frame, :3, :3].T + self._pose[frame, :3, 3]
                seen = self._rays(int(frame), known)[:, :2]
                miss = np.linalg.norm(local[:, :2] / np.maximum(local[:, 2:], 1e-6) - seen, axis=1)
                miss = np.minimum(miss * self._K[frame, 0, 0], _LOST)
                misses.append(float(miss.mean()) if placed else _LOST)
        # Points that a guess cannot place are no less a miss than those it places wrongly.
        both = (self._tracks.tracked[i] & self._tracks.tracked[j]).sum()
        share = np.isfinite(self._points[:, 0]).sum() / both
        return float(share * np.mean(misses) + (1.0 - share) * _LOST)

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
        good &= (toward[0] * toward[1]).sum(axis=1) < np.cos(self._angle)
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
