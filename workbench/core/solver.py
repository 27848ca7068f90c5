"""What a solver is, and the criteria that stop all of them alike."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.errors import WorkbenchError
from workbench.core.method import Method
from workbench.core.state import Approach, State
from workbench.core.status import Status

if TYPE_CHECKING:
    from workbench.core.distortion import Distortion
    from workbench.core.problem import Problem

Interrupt = Callable[[], bool]
"""Asked between line-search trials and factorisations: true when the step shall return the old positions."""

ROUNDING = 1e-13
"""A decrease below this part of the energy cannot be told from rounding."""
ZERO = 1e-14
"""An energy a unit of the source below which it is 0: one whose minimum is 0 never falls by a small part of itself."""
SLIGHT_STRAIN = 0.05
"""Square of a strain, all over the map, whose energy counts as slight."""
CONFIRMATIONS = 5
"""Small decreases in a row that end a run where a single one may be an accident (see `Solver.terminate`)."""


def never() -> bool:
    """The interrupt that never comes."""
    return False


class Solver(Method, ABC):
    """A value machine: `init -> step -> step ...`; subclasses are frozen dataclasses, fields are the parameters."""

    monotone: ClassVar[bool] = True
    """Whether the energy never rises in a step once the anchors are in place."""
    initializer: ClassVar[str] = ""
    """Id of the start that it wishes for; empty: the default of the kind of map."""
    second_order: ClassVar[bool] = False
    """Whether full steps are Newton's, so that one with a small decrease has come where nothing is left to gain."""
    takes_fences: ClassVar[bool] = True
    """Whether steps that the step bound shortens are taken along a fence (see `workbench.core.fence`)."""
    distortions: ClassVar[tuple[str, ...]] = ()
    """Ids of the distortions that it can minimise; empty: all."""

    @classmethod
    def check_distortion(cls, distortion: Distortion) -> None:
        """Raises `WorkbenchError` unless the solver can minimise this distortion."""
        if cls.distortions and distortion.id not in cls.distortions:
            names = " and ".join(cls.distortions)
            raise WorkbenchError(f"{cls.label} minimises {names} alone; choose such a distortion, or another solver.")

    def init(self, problem: Problem, positions: Floats) -> State:
        """The first state; INVERTED_START or NONFINITE where the energy is not finite there.

        Raises `WorkbenchError` for a distortion that the solver cannot minimise.
        """
        self.check_distortion(problem.distortion)
        x = np.ascontiguousarray(positions, dtype=np.float64)
        if x.shape != (problem.mesh.vertex_count, problem.dimension) or not np.isfinite(x).all():
            return State(x, status=Status.NONFINITE)
        state = self.rebase(problem, State(x))
        if state.inverted and problem.density.meets_barrier(x):
            return replace(state, status=Status.INVERTED_START)
        if not math.isfinite(state.energy) and not problem.may_overflow:
            return replace(state, status=Status.NONFINITE)
        return state

    def prepare(self, problem: Problem) -> None:
        """Make what steps need once a mesh, so that it counts as set-up: here the Newton system's symbolic analysis."""
        problem.system.solver  # noqa: B018

    @abstractmethod
    def step(self, problem: Problem, state: State, interrupt: Interrupt = never) -> State:
        """One accepted iterate of (62). Changes none of its inputs.

        While `problem.anchors_lag(state.positions)`, call `approach_anchors` (or lessen |A x - b| in another way).
        """

    def terminate(self, problem: Problem, state: State) -> Status:
        """The status after a step, by the criteria that all solvers share.

        CONVERGED where the anchors are in place and (E_before - E_after)/|E_after| <= tolerance. A full Newton step says so
        alone. After any other step, one of a method of linear rate or one that the step bound has shortened, a small decrease
        may be an accident far from the minimum, so it takes `CONFIRMATIONS` in a row, unless the map did not move at all or
        the energy is 0. Also CONVERGED where a gradient tolerance is given and the norm is at most that part of
        `characteristic_gradient`.
        """
        if state.status is not Status.RUNNING:
            return state.status
        if not math.isfinite(state.energy):
            # an exponential that overflows still goes down by its logarithm
            return Status.RUNNING if problem.may_overflow else Status.NONFINITE
        if problem.anchors_lag(state.positions):
            return Status.RUNNING
        if has_small_decrease(problem, state):
            is_full = self.second_order and state.limiting_simplex < 0
            is_still = state.step_size == 0.0 or abs(state.energy) <= ZERO * problem.total_measure
            if is_full or is_still or state.small_decreases >= CONFIRMATIONS:
                return Status.CONVERGED
        asked = problem.criteria.gradient_tolerance
        if asked is not None and state.gradient_norm <= asked * characteristic_gradient(problem):
            return Status.CONVERGED
        return Status.RUNNING

    def rebase(self, problem: Problem, state: State) -> State:
        """Anchors, distortion or parameters moved: the same map under the new problem; the solver's memory is dropped."""
        return restarted(problem, state)


def has_small_decrease(problem: Problem, state: State) -> bool:
    """Whether the last step lowered the energy by no more than the tolerance."""
    decrease = state.previous_energy - state.energy
    return 0.0 <= decrease <= max(problem.criteria.tolerance * abs(state.energy), ZERO * problem.total_measure)


def counted(problem: Problem, state: State, following: State) -> State:
    """`following`, the outcome of a step from `state`, with the number of small decreases in a row up to it."""
    count = state.small_decreases + 1 if has_small_decrease(problem, following) else 0
    return following if count == following.small_decreases else replace(following, small_decreases=count)


def restarted(problem: Problem, state: State) -> State:
    """The same map measured under `problem`; what the solver remembered of the way there is dropped."""
    evaluation = problem.evaluate(state.positions, 1)
    return replace(
        state,
        energy=evaluation.energy,
        gradient_norm=problem.free_gradient_norm(evaluation.gradient),
        inverted=evaluation.inverted,
        anchor_error=problem.anchor_error(state.positions),
        previous_energy=float("nan"),
        small_decreases=0,
        status=Status.RUNNING,
        memory=None,
        approach=Approach(),
    )


def characteristic_curvature(problem: Problem) -> float:
    """Spectral norm of the D_ij at the identity, or a tenth aside where D has a kink; where they vanish, norm of the D_i."""
    distortion, n = problem.distortion, problem.dimension
    sigma = np.linspace(1.1, 0.9, n)[None, :] if problem.density.has_kinks else np.ones((1, n))
    curvature = float(np.linalg.norm(distortion.hessian(sigma)[0], 2))
    if curvature < 1e-12:
        curvature = float(np.linalg.norm(distortion.gradient(sigma)))
    return max(curvature, 1e-30)


def energy_scale(problem: Problem, energy: float) -> float:
    """What rises of the energy are measured by: the energy; where it all but vanishes, as at rest, that of a slight strain."""
    return max(abs(energy), SLIGHT_STRAIN * characteristic_curvature(problem) * problem.total_measure)


def characteristic_gradient(problem: Problem) -> float:
    """Scale of the gradient norm, so that a tolerance means the same on every mesh and for every distortion.

    The characteristic curvature times the norm over the vertices of what bounds their stars: lengths in the plane, areas in
    space. Source: Zhu, Bridson, Kaufman 2018, section 6.
    """
    elements = problem.elements
    opposite = problem.dimension * np.linalg.norm(elements.hat_gradients, axis=2) * elements.rest_measures[:, None]
    star = np.bincount(elements.simplices.reshape(-1), opposite.reshape(-1), elements.vertex_count)
    return characteristic_curvature(problem) * float(np.linalg.norm(star))
