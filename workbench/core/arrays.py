"""Arrays that are copied once and then read-only."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Booleans = NDArray[np.bool_]
Points = NDArray[np.floating[Any]]
"""Places of what is drawn, of single or double precision."""


def frozen(values: ArrayLike, dtype: type = np.float64) -> NDArray[Any]:
    """Read-only, C-contiguous copy of `values`; an array that is frozen already is returned as it is."""
    array = np.asarray(values)
    if array.dtype == dtype and array.flags.c_contiguous and not array.flags.writeable and array.base is None:
        return array
    array = np.array(values, dtype=dtype, order="C", copy=True)
    array.flags.writeable = False
    return array
