"""A bound on what reading a file may allocate: a damaged count asks for tens of gigabytes in one line."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator
from pathlib import Path

HEADROOM = 2**31
"""Bytes that reading any file may take."""
EXPANSION = 64
"""Bytes that reading may take for each byte of the file."""
_one_at_a_time = threading.RLock()
"""The bound is of the whole process: two threads within it would each put back what the other had set."""


@contextlib.contextmanager
def limited_memory(file_size: int) -> Iterator[None]:
    """Within `with`, allocations out of all proportion to the file raise `MemoryError`.

    The bound is that of the process's address space, so it exists where Linux does; elsewhere nothing is bounded. One
    thread at a time is within it; others wait.
    """
    with _one_at_a_time:
        try:
            import resource

            pages = int(Path("/proc/self/statm").read_text().split()[0])
            before = resource.getrlimit(resource.RLIMIT_AS)
        except (ImportError, OSError, ValueError):
            yield
            return
        allowed = pages * resource.getpagesize() + HEADROOM + EXPANSION * file_size
        soft = min((limit for limit in (allowed, *before) if limit != resource.RLIM_INFINITY), default=allowed)
        resource.setrlimit(resource.RLIMIT_AS, (soft, before[1]))
        try:
            yield
        finally:
            resource.setrlimit(resource.RLIMIT_AS, before)
