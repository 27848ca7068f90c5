"""The frame that descent methods share: what every step asks before it looks for a direction."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from workbench.core.anchor_steps import approach_anchors
from workbench.core.arrays import Floats
from workbench.core.descent import derivatives_at, is_finite
from workbench.core.energy import Evaluation
from workbench.core.linear_back_end import SingularMatrixError
from workbench.core.newton_system import SHIFTS
from workbench.core.solver import Interrupt, Solver, never
from workbench.core.state import State
from workbench.core.status import Status

if TYPE_CHECKING:
    from workbench.core.problem import Problem


class DescentSolver(Solver):
    """A solver whose step goes down from the energy and its derivatives at the current map.

    Anchors that lag, energies that are not finite, interrupts and singular systems are seen to here.
    """

    derivative_order: ClassVar[int] = 1
    """1: energy and gradient; 2: the projected Hessian too."""

    @abstractmethod
    def advance(self, problem: Problem, state: State, evaluation: Evaluation, interrupt: Interrupt) -> State:
        """The state after one step from `state`, whose energy and derivatives are `evaluation`.

        May raise `SingularMatrixError`: the step ends as SINGULAR.
        """

    def step(self, problem: Problem, state: State, interrupt: Interrupt = never) -> State:
        """See `Solver.step`."""
        if problem.anchors_lag(state.positions):
            return approach_anchors(problem, state, interrupt)
        evaluation = derivatives_at(problem, state, self.derivative_order)
        if not is_finite(evaluation):
            return replace(state, status=Status.NONFINITE)
        if interrupt():
            return replace(state, status=Status.INTERRUPTED)
        try:
            return self.advance(problem, state, evaluation, interrupt)
        except SingularMatrixError:
            return replace(state, status=Status.SINGULAR)


class LaplacianDescentSolver(DescentSolver):
    """A descent method whose metric is the source's Laplacian: no Newton system is made unless anchors move."""

    def prepare(self, problem: Problem) -> None:
        """See `Solver.prepare`."""
        problem.workspace.laplacian.prepare()


def direction_in_metric(problem: Problem, values: Floats, gradient: Floats, shifts: tuple[float, ...] = SHIFTS) -> Floats:
    """-K^-1 gradient for K given on the pattern: one factorisation, hard anchors eliminated, along A x = const.

    Parameters
    ----------
    values : (nnz,) float64       positive semi-definite, soft anchors included
    gradient : (N, d) float64
    shifts : tuple of float       see `NewtonSystem.factorise`

    Returns
    -------
    (N, d) float64, zero at the hard anchors

    Raises `SingularMatrixError`, also where the result is not finite.
    """
    constraints = problem.free_constraints
    residual = np.zeros(len(constraints.values)) if constraints is not None else None
    problem.system.factorise(values, problem.anchors.hard_vertices, shifts)
    direction = problem.system.solve(gradient, None, constraints, residual)
    if not np.isfinite(direction).all():
        raise SingularMatrixError("the direction is not finite")
    return direction


def direction_in_laplacian(problem: Problem, gradient: Floats) -> Floats:
    """-K^-1 gradient (n, d) for the Laplacian of the source (see `LaplacianSystem`), factored once; else as above."""
    laplacian = problem.workspace.laplacian
    laplacian.serve(problem.anchors)
    direction = laplacian.direction(gradient, problem.free_constraints)
    if not np.isfinite(direction).all():
        raise SingularMatrixError("the direction is not finite")
    return direction


def grown_step(state: State, growth: float, otherwise: float = 1.0) -> float:
    """First trial of a line search: `growth` times the last accepted step, `otherwise` where there is none to go by."""
    return growth * state.step_size if state.memory is not None and state.step_size > 0.0 else otherwise


def free_gradient(problem: Problem, gradient: Floats) -> Floats:
    """The part of a gradient (N, d) that may move: zero at the hard anchors, along A x = const."""
    free = gradient.copy()
    hard = problem.anchors.hard_vertices
    free[hard] = 0.0
    return free if problem.constraints is None else problem.constraints.tangential(free, hard)
