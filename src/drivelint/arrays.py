"""Names the types of numpy arrays."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Times = NDArray[np.int64]  # nanoseconds, mostly
Mask = NDArray[np.bool_]
Indices = NDArray[np.intp]
Codes = NDArray[np.int8]  # indices into a tuple of words, -1: unknown
