"""The number of threads: numba's and the linear algebra's."""

from __future__ import annotations

import os
import sys

VARIABLES = ("NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def limit_threads(count: int | None) -> None:
    """Use `count` threads from now on.

    The libraries read the environment when they are loaded, so this is called before; where they are loaded already (a notebook),
    they are told directly, and numba's count can only fall.
    """
    if count is None:
        return
    if "numba" not in sys.modules and "numpy" not in sys.modules:
        for name in VARIABLES:
            os.environ[name] = str(count)
        return
    import numba
    from threadpoolctl import threadpool_limits

    numba.set_num_threads(min(count, numba.config.NUMBA_NUM_THREADS))
    threadpool_limits(count)


def thread_count() -> int:
    """Threads that the kernels use."""
    import numba

    return int(numba.get_num_threads())
