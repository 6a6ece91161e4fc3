"""Names for the types of arrays, as annotations write them."""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.int32]
Int64s: TypeAlias = NDArray[np.int64]
Bools: TypeAlias = NDArray[np.bool_]
Index: TypeAlias = NDArray[np.integer]
"""Integers of any width, such as NumPy returns for indices."""
Array: TypeAlias = NDArray[Any]
