"""Array types of the labels, and one way to walk ragged arrays."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

AnyArray = NDArray[Any]
Bools = NDArray[np.bool_]
Floats = NDArray[np.floating[Any]]
"""float32 or float64."""
Float64s = NDArray[np.float64]
Indices = NDArray[np.intp]
Integers = NDArray[np.integer[Any]]
"""Any integer type."""


def ranges(counts: Indices) -> tuple[Indices, Indices]:
    """For counts ``[2, 0, 3]``: owners ``[0, 0, 2, 2, 2]`` and offsets ``[0, 1, 0, 1, 2]``."""
    owner = np.repeat(np.arange(len(counts)), counts)
    start = np.cumsum(counts) - counts
    return owner, np.arange(len(owner)) - start[owner]
