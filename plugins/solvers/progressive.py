"""Newton's method on references that approach the source."""

from __future__ import annotations

from dataclasses import dataclass, replace

from workbench.api import (
    SAFETY,
    Derivatives,
    DescentSolver,
    Evaluation,
    Interrupt,
    Problem,
    SingularMatrixError,
    State,
    Status,
    descend,
    direction_in_metric,
    parameter,
    progressive_problem,
)


@dataclass(frozen=True, eq=False)
class Progress(Derivatives):
    """The derivatives at the newest map, and whether the map is so close that the true source is used from now on."""

    is_close: bool


@dataclass(frozen=True)
class Progressive(DescentSolver):
    """Progressive parameterization: Newton steps for a reference from which no triangle is distorted by more than `bound`.

    The reference is drawn anew at every step, with one exponent for all triangles and equal weights, as in the authors'
    program (bound 250); once it meets the source, or a step gains less than `close`, the steps are those of Projected Newton
    on the source. Two things differ: the authors begin with SLIM and go over to CM, here all steps are Newton's; and the step
    length is found on the energy of the true source, so that the energy never rises. A reference whose step does not lower
    it is given up for the source.
    """

    id = "progressive"
    label = "Progressive references"
    short = "PP"
    citation = "Liu, Ye, Ni, Fu 2018 [LYNF18]; section 4.3"
    kinds = ("parameterize", "plane")

    bound: float = parameter(250.0, "largest symmetric Dirichlet density against the reference", minimum=4.1, maximum=1e12)
    close: float = parameter(0.01, "relative decrease of a step below which the source is used", minimum=0.0, maximum=1.0)
    uniform: bool = parameter(True, "every triangle of a reference weighs the same, instead of its area")
    safety: float = parameter(SAFETY, "part of the largest step without inversion that is taken", minimum=0.1, maximum=0.99)
    reach: float = parameter(4.0, "longest step tried, in Newton steps; 1: never a longer one", minimum=1.0, maximum=10.0)

    def advance(self, problem: Problem, state: State, evaluation: Evaluation, interrupt: Interrupt) -> State:
        memory = state.memory
        is_close = isinstance(memory, Progress) and memory.is_close
        if not (is_close or state.inverted):
            reference, _ = progressive_problem(problem, state.positions, self.bound, self.uniform)
            following = None if reference is problem else self._approach(problem, reference, state, evaluation, interrupt)
            if following is not None:
                return following
        return self._remember(self._newton(problem, problem, state, evaluation, interrupt), True)

    def _approach(
        self, problem: Problem, reference: Problem, state: State, evaluation: Evaluation, interrupt: Interrupt
    ) -> State | None:
        """A step towards the minimum on the reference; None where it is of no use for the energy of the source."""
        try:
            following = self._newton(problem, reference, state, evaluation, interrupt)
        except SingularMatrixError:
            return None
        if following.status is Status.INTERRUPTED:
            return following
        if following.status is not Status.RUNNING or following.step_size == 0.0:
            return None
        gained = state.energy - following.energy
        # A small gain here says that the source is due, not that the map is the optimum.
        return self._remember(replace(following, previous_energy=float("nan")), gained <= self.close * abs(following.energy))

    def _newton(
        self, problem: Problem, reference: Problem, state: State, evaluation: Evaluation, interrupt: Interrupt
    ) -> State:
        at = reference.evaluate(state.positions, 2)
        assert at.hessian_values is not None
        direction = direction_in_metric(reference, at.hessian_values, at.gradient)
        return descend(problem, state, evaluation, direction, interrupt, furthest=self.reach, safety=self.safety)

    def _remember(self, following: State, is_close: bool) -> State:
        memory = following.memory
        if isinstance(memory, Derivatives):
            following = replace(following, memory=Progress(memory.problem, memory.evaluation, is_close))
        return following
