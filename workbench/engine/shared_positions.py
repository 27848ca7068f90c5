"""Maps in shared memory: a ring of slots that one process writes and the other reads, newest wins."""

from __future__ import annotations

import contextlib
from multiprocessing import shared_memory

import numpy as np

from workbench.core.arrays import Floats

SLOTS = 8


class PositionRing:
    """`SLOTS` maps of one shape, each with a sequence number written before and after it."""

    def __init__(self, shape: tuple[int, int], name: str | None = None) -> None:
        """Create the memory, or attach to that called `name`."""
        self.shape = shape
        self._stride = 2 + shape[0] * shape[1]
        size = 8 * SLOTS * self._stride
        self._memory = shared_memory.SharedMemory(create=True, size=size) if name is None else shared_memory.SharedMemory(name)
        self._array: np.ndarray | None = np.ndarray((SLOTS, self._stride), dtype=np.float64, buffer=self._memory.buf)

    @property
    def name(self) -> str:
        return self._memory.name

    def write(self, number: int, positions: Floats) -> None:
        """Put map `number` in its slot."""
        assert self._array is not None
        slot = self._array[number % SLOTS]
        slot[0] = number
        slot[1:-1] = positions.reshape(-1)
        slot[-1] = number

    def read(self, number: int) -> Floats | None:
        """Copy of map `number`, None where it has been overwritten already."""
        assert self._array is not None
        slot = self._array[number % SLOTS]
        if slot[-1] != number:
            return None
        positions = slot[1:-1].reshape(self.shape).copy()
        return positions if slot[0] == number else None

    def unlink(self) -> None:
        """Give up the name; the memory lives on while it is mapped. Called once, by the reader, after it has attached."""
        with contextlib.suppress(FileNotFoundError):
            self._memory.unlink()

    def close(self) -> None:
        self._array = None
        with contextlib.suppress(BufferError):
            self._memory.close()
