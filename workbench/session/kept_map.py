"""A map that is kept for later, in as few bytes as it takes."""

from __future__ import annotations

import zlib
from typing import Any

import numpy as np

from workbench.core.arrays import Floats

LEVEL = 1
"""Of the compression: what more effort saves on coordinates is not worth its time."""


class KeptMap:
    """A map (n, d) float64; packed to the last bit, or rounded to float32 where memory runs short.

    Packing and rounding may be done on another thread: the map can be read at any time.
    """

    def __init__(self, positions: Floats) -> None:
        self._raw: Floats | None = positions
        self._packed = b""
        self._shape = positions.shape
        self._type: np.dtype[Any] = np.dtype(np.float64)

    @property
    def byte_count(self) -> int:
        raw = self._raw
        return len(self._packed) if raw is None else raw.nbytes

    @property
    def is_exact(self) -> bool:
        return self._type == np.float64

    def holds(self, positions: Floats) -> bool:
        """Whether it was made of this very array."""
        return self._raw is positions

    def positions(self) -> Floats:
        """(n, d) float64"""
        raw = self._raw
        if raw is not None:
            return raw
        columns = np.frombuffer(zlib.decompress(self._packed), np.uint8).reshape(self._type.itemsize, -1)
        found = np.ascontiguousarray(columns.T).view(self._type).reshape(self._shape).astype(np.float64)
        found.flags.writeable = False
        return found

    def pack(self) -> None:
        """Compress; bytes of equal weight stand together, as neighbours in space agree in the first ones."""
        raw = self._raw
        if raw is not None:
            self._packed = _packed(np.ascontiguousarray(raw, np.float64))
            self._raw = None

    def rounded(self) -> KeptMap:
        """The same map in float32."""
        small = self.positions().astype(np.float32)
        other = KeptMap.__new__(KeptMap)
        other._raw, other._shape, other._type = None, self._shape, small.dtype
        other._packed = _packed(small)
        return other


def _packed(values: np.ndarray) -> bytes:
    columns = values.view(np.uint8).reshape(-1, values.dtype.itemsize)
    return zlib.compress(np.ascontiguousarray(columns.T).tobytes(), LEVEL)
