"""CHOLMOD as cvxopt brings it: the one place that imports cvxopt."""

from __future__ import annotations

import os
from functools import lru_cache
from typing import Any


@lru_cache(maxsize=1)
def load_cvxopt() -> Any:
    """The package `cvxopt` with its modules `cholmod` and `amd`. Raises `ImportError` where it is missing.

    The OpenBLAS in cvxopt's wheels takes processors newer than itself for one without AVX, at half the speed. It reads the
    variable when it is loaded, so this has to come before the first import.
    """
    if _has_avx2():
        os.environ.setdefault("OPENBLAS_CORETYPE", "Haswell")
    import cvxopt
    import cvxopt.amd
    import cvxopt.cholmod

    return cvxopt


def _has_avx2() -> bool:
    try:
        with open("/proc/cpuinfo", encoding="ascii", errors="replace") as file:
            flags = next((line for line in file if line.startswith("flags")), "")
    except OSError:
        return False  # not Linux: leave OpenBLAS its own choice
    return {"avx2", "fma"} <= set(flags.split())
