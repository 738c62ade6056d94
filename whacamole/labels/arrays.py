"""Array types of the labels."""

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
