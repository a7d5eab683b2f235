"""Array aliases with their shapes in the name, and the one way to freeze an array."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
"""Real numbers of any shape; docstrings give the shape."""

Points = npt.NDArray[np.float64]
"""(n, 3) positions, mm."""

Vectors = npt.NDArray[np.float64]
"""(n, 3) directions, unit unless said otherwise."""

Indices = npt.NDArray[np.int64]
"""Integer indices of any shape."""

Mask = npt.NDArray[np.bool_]
"""Truth values of any shape."""


def frozen(values: npt.ArrayLike, dtype: Any = np.float64) -> npt.NDArray[Any]:
    """A read-only, contiguous copy of *values*."""
    array = np.array(values, dtype=dtype, order="C")
    array.setflags(write=False)
    return array


def unit(vectors: Floats) -> Floats:
    """*vectors* (..., 3) scaled to length one; a zero vector stays zero."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > 0.0, length, 1.0)
