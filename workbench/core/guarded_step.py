"""A solver's step with the laws checked that keep a plugin's fault from becoming a wrong map."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from workbench.core.errors import WorkbenchError
from workbench.core.fence import fenced_step
from workbench.core.overflow import tempered_step
from workbench.core.problem import Problem
from workbench.core.softening import softened_step
from workbench.core.solver import Interrupt, Solver, counted
from workbench.core.state import State
from workbench.core.status import Status


class SolverFaultError(WorkbenchError):
    """A solver raised, or broke a law in a step; the map before the step is the last good one."""


def guarded_step(solver: Solver, problem: Problem, state: State, interrupt: Interrupt) -> State:
    """A step of `solver`, checked: a map of the right shape, finite, and without inverted simplices where it had none.

    Positions that are not finite end the run with NONFINITE on the map before. Raises `SolverFaultError` for all else.
    """
    try:
        following = _step(solver, problem, state, interrupt)
    except (Exception, SystemExit) as error:
        said = f"{type(error).__name__}: {error}".rstrip(": ")
        raise SolverFaultError(f"{solver.label} failed in step {state.iteration + 1}: {said}") from error
    if not isinstance(following, State):
        raise SolverFaultError(f"{solver.label} returned no state in step {state.iteration + 1}.")
    return checked(solver, problem, state, following)


def checked(solver: Solver, problem: Problem, state: State, following: State) -> State:
    """`following`, the outcome of a step from `state`; see `guarded_step`."""
    if following.positions is state.positions:
        return following
    if following.positions.shape != state.positions.shape:
        shapes = f"{following.positions.shape} instead of {state.positions.shape}"
        raise SolverFaultError(f"{solver.label} made a map of the wrong shape in step {state.iteration + 1}: {shapes}.")
    if not np.isfinite(following.positions).all():
        return replace(state, status=Status.NONFINITE)
    if state.inverted == 0 and problem.forbids_inversions and problem.inverted(following.positions):
        raise SolverFaultError(f"{solver.label} made a map with inverted simplices; the last good map is kept.")
    return counted(problem, state, following)


def _step(solver: Solver, problem: Problem, state: State, interrupt: Interrupt) -> State:
    """A step in stages where a plain one would fail: exponentials far out, norms that collapse simplices, no barrier."""
    if problem.may_overflow:
        return tempered_step(solver, problem, state, interrupt)
    if problem.may_collapse:
        return softened_step(solver, problem, state, interrupt)
    return fenced_step(solver, problem, state, interrupt)
