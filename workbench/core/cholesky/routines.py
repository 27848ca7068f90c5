"""Which BLAS and LAPACK the factorisation uses: SciPy's, or Intel's where the extra `mkl` is installed."""

from __future__ import annotations

import ctypes
from contextlib import AbstractContextManager
from functools import lru_cache
from importlib.util import find_spec

import numpy as np
from numba.extending import get_cython_function_address
from threadpoolctl import ThreadpoolController

from workbench.core.arrays import Integers

_NAMES = {"dpotrf": "cython_lapack", "dtrsm": "cython_blas", "dsyrk": "cython_blas", "dgemm": "cython_blas"}
_REPEATABLE = 2
"""MKL_CBWR_AUTO: the same operands at the same alignment give the same bits."""


@lru_cache(maxsize=1)
def dense_routines() -> Integers:
    """(4,) where dpotrf, dtrsm, dsyrk, dgemm lie in this process. Kernels take them: in cached code they would be stale."""
    addresses = _from_mkl() if find_spec("pypardiso") else None
    if addresses is None:
        addresses = [get_cython_function_address(f"scipy.linalg.{module}", name) for name, module in _NAMES.items()]
    return np.array(addresses, dtype=np.int64)


def _from_mkl() -> list[int | None] | None:
    """None where the library is not to be had, or has not all of them."""
    try:
        import pypardiso

        library = pypardiso.PyPardisoSolver().libmkl
        library.MKL_CBWR_Set(_REPEATABLE)
        return [ctypes.cast(getattr(library, f"{name}_"), ctypes.c_void_p).value for name in _NAMES]
    except (ImportError, OSError, AttributeError):
        return None


def one_dense_thread() -> AbstractContextManager[object]:
    """Dense routines use the calling thread meanwhile: there is one call a core at a time already."""
    dense_routines()  # a library that comes later would not be among those that the controller knows
    return _controller().limit(limits=1, user_api="blas")


@lru_cache(maxsize=1)
def _controller() -> ThreadpoolController:
    return ThreadpoolController()
