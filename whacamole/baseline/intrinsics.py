"""Where the focal length comes from: known, or guessed from the size of the image."""

import numpy as np

from whacamole.baseline.rigid import FloatArray
from whacamole.errors import BaselineError

FOCAL_SOURCES = ("given", "diagonal", "24mm", "dummy")
"""``given``: the true K. ``diagonal``: the image diagonal (Kissos et al. 2020; the paper's "assumed").
``24mm``: a 24 mm lens where the longer side is 35 mm (the released code). ``dummy``: 5000 px."""

DUMMY_FOCAL = 5000.0


def focal_length(source: str, width: int, height: int) -> float:
    """The guessed focal length [px] of an image; ``source`` is one of :data:`FOCAL_SOURCES` or a number of
    pixels.

    Raises:
        BaselineError: no such source, or "given" where nothing is given.
    """
    guesses = {
        "diagonal": float(np.hypot(width, height)),
        "24mm": max(width, height) * 24.0 / 35.0,
        "dummy": DUMMY_FOCAL,
    }
    if source in guesses:
        return guesses[source]
    try:
        focal = float(source)
    except ValueError:
        focal = float("nan")
    if not 0.0 < focal < np.inf:
        raise BaselineError(
            f"focal length {source!r}: expected {', '.join(FOCAL_SOURCES)} or a number of pixels; "
            "'given' needs a dataset that holds K"
        )
    return focal


def intrinsics(
    source: str, width: int, height: int, num_frames: int, given: FloatArray | None = None
) -> FloatArray:
    """K (T, 3, 3) [px] with a centred principal point, or the given one.

    Raises:
        BaselineError: see :func:`focal_length`.
    """
    if source == "given" and given is not None:
        return given
    focal = focal_length(source, width, height)
    K = np.array([[focal, 0.0, width / 2.0], [0.0, focal, height / 2.0], [0.0, 0.0, 1.0]])
    return np.tile(K, (num_frames, 1, 1))
