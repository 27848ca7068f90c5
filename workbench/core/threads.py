"""A few threads for kernels that release the interpreter lock; the work is split in a fixed way."""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import TypeVar

T = TypeVar("T")
Piece = TypeVar("Piece")

COUNT = "WORKBENCH_THREADS"
"""Environment variable: how many threads there are in the beginning, at least one; anything else leaves it to the program."""


def _first_count() -> int:
    wanted = os.environ.get(COUNT, "")
    return int(wanted) if wanted.isdecimal() and 0 < int(wanted) <= 1024 else min(os.cpu_count() or 1, 8)


_count = _first_count()
_pool: ThreadPoolExecutor | None = None


def thread_count() -> int:
    """Threads that kernels use; results are the same bit for bit as long as it stays."""
    return _count


def set_thread_count(count: int) -> None:
    """Use `count` >= 1 threads from now on."""
    global _count, _pool
    if count != _count:
        _count = max(1, int(count))
        if _pool is not None:
            _pool.shutdown(wait=False)
            _pool = None


@contextmanager
def one_thread() -> Iterator[None]:
    """Do all work in the calling thread meanwhile: for when the other cores are known to be busy."""
    global _count
    kept, _count = _count, 1
    try:
        yield
    finally:
        _count = kept


def over_ranges(work: Callable[[int, int, int], T], size: int, grain: int = 4096) -> list[T]:
    """`work(part, start, stop)` over equal parts of range(size), in parallel; results in order of the parts."""
    parts = max(1, min(_count, size // grain))
    bounds = [size * p // parts for p in range(parts + 1)]
    if parts == 1:
        return [work(0, 0, size)]
    pool = _threads()
    futures = [pool.submit(work, p, bounds[p], bounds[p + 1]) for p in range(1, parts)]
    first = work(0, bounds[0], bounds[1])
    return [first, *[f.result() for f in futures]]


def over_pieces(work: Callable[[Piece], T], pieces: Sequence[Piece]) -> list[T]:
    """`work` on every piece, each taken by the first thread that is free; results in order of the pieces."""
    results: dict[int, T] = {}
    tickets = itertools.count()

    def worker() -> None:
        while (ticket := next(tickets)) < len(pieces):
            results[ticket] = work(pieces[ticket])

    futures = [_threads().submit(worker) for _ in range(min(_count, len(pieces)) - 1)]
    worker()
    for future in futures:
        future.result()
    return [results[ticket] for ticket in range(len(pieces))]


def _threads() -> ThreadPoolExecutor:
    global _pool
    if _pool is None:
        _pool = ThreadPoolExecutor(max_workers=_count, thread_name_prefix="kernel")
    return _pool
