"""Which back ends there are for linear systems, told without importing them."""

from __future__ import annotations

CHOICE = "WORKBENCH_LINEAR_SOLVER"
"""Environment variable that names a back end."""


def available_back_ends() -> tuple[str, ...]:
    """Names of the back ends that factorise and whose libraries can be imported, the preferred one first."""
    from importlib.util import find_spec

    names = ["multifrontal"]
    if find_spec("cvxopt"):
        names.append("cholmod")
    if find_spec("pypardiso"):
        names.append("pardiso")
    return (*names, "superlu")
