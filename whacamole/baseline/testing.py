"""How wrong the velocimeter is on clips whose truth is known."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np

from whacamole.baseline.augmentation import plain_batch
from whacamole.baseline.clips import Clip, windows_of
from whacamole.baseline.velocimeter import FPS, WINDOW, MotionVelocimeter


@dataclass(frozen=True)
class Errors:
    """Errors over clips, cut into windows as at inference.

    Attributes:
        velocity: mean error of a frame's velocity [m/s].
        drift: error of a window's displacement, as a share of the length of the true paths (sum over sum).
        pace: predicted displacements projected on the true ones, sum over sum: the scale that it would give.
        windows: how many were measured.
    """

    velocity: float
    drift: float
    pace: float
    windows: int

    def as_dict(self) -> dict[str, float]:
        """Plain values, for JSON."""
        return asdict(self)


def measure(velocimeter: MotionVelocimeter, clips: Sequence[Clip]) -> Errors | None:
    """Errors on clips as they are, without noise; ``None`` where there are none."""
    windows = list(windows_of(clips, WINDOW))
    if not windows:
        return None
    batch = plain_batch(windows, WINDOW)
    found, counts = velocimeter(batch.joints), batch.counts[..., None]
    error, truth = (found - batch.velocities) * counts, batch.velocities * counts
    apart, moved = error.sum(axis=1), truth.sum(axis=1)
    path = np.linalg.norm(truth, axis=-1).sum()
    along = ((apart + moved) * moved).sum() / max(float((moved * moved).sum()), 1e-12)
    return Errors(
        velocity=float(np.linalg.norm(error, axis=-1).sum() / batch.counts.sum() * FPS),
        drift=float(np.linalg.norm(apart, axis=-1).sum() / max(path, 1e-9)),
        pace=float(along),
        windows=len(windows),
    )
