"""Points followed through a video: corners, tracked by optical flow forth and back, people masked out."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from whacamole.baseline.odometry.trajectory import Masker, Scene
from whacamole.baseline.rigid import BoolArray, FloatArray
from whacamole.errors import BaselineError

MAX_POINTS = 600
SPACING = 0.012  # of the image diagonal, between corners
REFILL = 0.7  # of MAX_POINTS, below which new corners are looked for
_BACK = 0.7  # px, by which a point may miss its start when tracked back
_GROWN = 0.012  # of the diagonal, by which masks are grown


@dataclass(frozen=True, eq=False)
class PointTracks:
    """N points over T frames.

    Attributes:
        pixels: (T, N, 2) float32, NaN where not tracked.
    """

    pixels: NDArray[np.float32]

    @property
    def tracked(self) -> BoolArray:
        """(T, N)."""
        return np.asarray(np.isfinite(self.pixels[..., 0]))


def follow_points(scene: Scene) -> PointTracks:
    """Follow corners of the static world through the footage.

    Raises:
        BaselineError: OpenCV is not installed.
    """
    cv2 = load_cv2()
    frames: list[tuple[NDArray[np.intp], NDArray[np.float32]]] = []
    for ids, pixels in _followed(cv2, scene):
        frames.append((ids, pixels))
    count = 1 + max((int(ids.max()) for ids, _ in frames if len(ids)), default=-1)
    table = np.full((len(frames), count, 2), np.nan, dtype=np.float32)
    for frame, (ids, pixels) in enumerate(frames):
        table[frame, ids] = pixels
    return PointTracks(table)


def _followed(cv2: Any, scene: Scene) -> Iterator[tuple[NDArray[np.intp], NDArray[np.float32]]]:
    diagonal = float(np.hypot(scene.footage.width, scene.footage.height))
    ids, points = np.empty(0, dtype=np.intp), np.empty((0, 2), dtype=np.float32)
    before: NDArray[np.uint8] | None = None
    following = 0
    for frame, image in enumerate(scene.footage.images()):
        gray = cv2.cvtColor(image, cv2.COLOR_RGB2GRAY)
        static = static_world(cv2, scene.masker, frame, image, diagonal)
        if before is not None and len(points):
            kept, points = _step(cv2, before, gray, points)
            ids, points = ids[kept], points[kept]
            column, row = np.floor(points).astype(int).T
            on_world = static[row, column] > 0
            ids, points = ids[on_world], points[on_world]
        if len(points) < REFILL * MAX_POINTS:
            new = _corners(cv2, gray, static, points, SPACING * diagonal)
            ids = np.concatenate([ids, np.arange(following, following + len(new))])
            points = np.concatenate([points, new])
            following += len(new)
        yield ids, points
        before = gray


def static_world(
    cv2: Any, masker: Masker | None, frame: int, image: NDArray[np.uint8], diagonal: float
) -> NDArray[np.uint8]:
    """255 where the world may be looked at: away from people, the masks grown a little."""
    if masker is None:
        return np.full(image.shape[:2], 255, dtype=np.uint8)
    people = masker(frame, image).astype(np.uint8)
    size = 2 * max(1, round(_GROWN * diagonal)) + 1
    grown = cv2.dilate(people, cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (size, size)))
    static: NDArray[np.uint8] = np.where(grown > 0, 0, 255).astype(np.uint8)
    return static


def _step(
    cv2: Any, before: NDArray[np.uint8], now: NDArray[np.uint8], points: NDArray[np.float32]
) -> tuple[BoolArray, NDArray[np.float32]]:
    """Which points were found again, and where all are."""
    options = {"winSize": (17, 17), "maxLevel": 3}
    there, found, _ = cv2.calcOpticalFlowPyrLK(before, now, points[:, None], None, **options)
    back, found_back, _ = cv2.calcOpticalFlowPyrLK(now, before, there, None, **options)
    missed = np.linalg.norm(back[:, 0] - points, axis=1)
    at: NDArray[np.float32] = there[:, 0]
    height, width = now.shape
    inside = (at >= 0).all(axis=1) & (at[:, 0] < width) & (at[:, 1] < height)
    return (found[:, 0] > 0) & (found_back[:, 0] > 0) & (missed < _BACK) & inside, at


def _corners(
    cv2: Any, gray: NDArray[np.uint8], static: NDArray[np.uint8], known: NDArray[np.float32], spacing: float
) -> NDArray[np.float32]:
    """New corners away from those that are followed already."""
    free = static.copy()
    for x, y in known:
        cv2.circle(free, (int(x), int(y)), int(spacing), 0, -1)
    found = cv2.goodFeaturesToTrack(gray, MAX_POINTS - len(known), 0.003, spacing, mask=free, blockSize=5)
    if found is None:
        return np.empty((0, 2), dtype=np.float32)
    corners: NDArray[np.float32] = found[:, 0]
    return corners


def rays(pixels: FloatArray, K: FloatArray) -> FloatArray:
    """Directions (…, 3) with z = 1 of pixels (…, 2) through one K (3, 3)."""
    aside = (pixels - K[:2, 2]) / K[[0, 1], [0, 1]]
    return np.concatenate([aside, np.ones((*aside.shape[:-1], 1))], axis=-1)


def load_cv2() -> Any:
    """OpenCV.

    Raises:
        BaselineError: it is not installed.
    """
    try:
        import cv2
    except ImportError as error:
        raise BaselineError(
            f"OpenCV is needed for this ({error}); pip install 'whacamole[video]', or choose --vo files"
        ) from error
    return cv2
