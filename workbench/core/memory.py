"""How the C library hands memory back."""

from __future__ import annotations

import ctypes
import sys

_TRIM_THRESHOLD, _MMAP_THRESHOLD = -1, -3  # parameters of mallopt(3)
_ONE_GIBIBYTE = 1 << 30


def keep_freed_memory() -> None:
    """Let a solving process keep the memory it frees for the next step.

    By default every large array goes back to the system at once, and the next one of the same size costs a page fault each
    4 KiB: a tenth of a factorisation. Does nothing where the C library is not glibc.
    """
    if sys.platform != "linux":
        return
    try:
        mallopt = ctypes.CDLL(None).mallopt
    except (OSError, AttributeError):
        return
    mallopt(_MMAP_THRESHOLD, _ONE_GIBIBYTE)
    mallopt(_TRIM_THRESHOLD, _ONE_GIBIBYTE)
