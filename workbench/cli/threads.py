"""The number of threads: the kernels', numba's and the linear algebra's."""

from __future__ import annotations

import os
import sys

VARIABLES = ("NUMBA_NUM_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def limit_threads(count: int | None) -> None:
    """Use `count` threads from now on.

    The libraries read the environment when they are loaded, so this is called before that; where they are loaded
    already (a notebook), they are told directly.
    """
    if count is None:
        return
    if "numpy" not in sys.modules:
        for name in VARIABLES:
            os.environ[name] = str(count)
    else:
        from threadpoolctl import threadpool_limits

        threadpool_limits(count)
    from workbench.core.threads import set_thread_count

    set_thread_count(count)
