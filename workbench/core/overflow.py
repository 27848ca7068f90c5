"""Exponential distortions far from their minimum: a descent on a small power of them until they can be computed.

The energy of exp(g), and of all that is made of such parts, overflows where g passes 709, and long before that its Hessian
weighs one simplex 1e100 times another, so that a factorisation loses what holds the rest. While the mean distortion is beyond
`FAR`, a step is taken on the sum of w D^p instead, with p so small that its mean stays near `FAR`, or on the sum of w log D
while nothing else can be computed; every solver works on those as on any other energy. The step is kept only if the energy
proper does not rise by it: else p is doubled, up to 1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from workbench.core.problem import Problem
from workbench.core.solver import Interrupt, Solver
from workbench.core.state import State
from workbench.core.status import Status

FAR = 1e8
"""Mean distortion beyond which an exponential is tempered."""


@dataclass(frozen=True, eq=False)
class Tempered:
    """A solver's memory on a tempered problem: what it goes on from in the next step; `problem` is the one proper."""

    problem: Problem
    tempered: Problem
    state: State
    power: float


def tempered_step(solver: Solver, problem: Problem, state: State, interrupt: Interrupt) -> State:
    """`solver.step` for a distortion made of exponentials, on a power of it while it is far from its minimum."""
    if state.energy <= FAR * problem.total_measure:
        return _direct(solver, problem, state, interrupt)
    wanted = _power(problem, state)
    kept = state.memory if isinstance(state.memory, Tempered) and state.memory.problem is problem else None
    power = wanted if kept is None or not kept.power <= wanted < 2.0 * kept.power + (wanted == 0.0) else kept.power
    while power < 1.0:
        if kept is None or kept.power != power:
            tempered = problem.tempered(power)
            kept = Tempered(problem, tempered, solver.rebase(tempered, state), power)
        following = _attempt(solver, kept, state, interrupt)
        if following is not None:
            return following
        if power == 0.0 and not math.isfinite(state.energy):
            return replace(state, status=Status.NONFINITE)
        power = max(2.0 * power, wanted, 1e-3)
    return _direct(solver, problem, state, interrupt)


def _attempt(solver: Solver, kept: Tempered, state: State, interrupt: Interrupt) -> State | None:
    """The state after a step on the tempered problem; None where that does not lessen the energy proper."""
    problem, inner = kept.problem, kept.state
    following = solver.step(kept.tempered, inner, interrupt)
    if following.status is Status.INTERRUPTED:
        return replace(state, status=Status.INTERRUPTED)
    if following.positions is inner.positions:
        return None
    energy = problem.energy_and_inverted(following.positions)[0]
    if math.isfinite(state.energy) and energy > state.energy and not problem.anchors_lag(state.positions):
        return None
    if not math.isfinite(energy) and solver.terminate(kept.tempered, following) is Status.CONVERGED:
        return None
    return replace(following, energy=energy, previous_energy=float("nan"), memory=replace(kept, state=following))


def _direct(solver: Solver, problem: Problem, state: State, interrupt: Interrupt) -> State:
    if isinstance(state.memory, Tempered):
        state = replace(solver.rebase(problem, state), iteration=state.iteration)
    return solver.step(problem, state, interrupt)


def _power(problem: Problem, state: State) -> float:
    """Power that brings the mean distortion near `FAR`; 0, for the logarithm, where that mean is not finite."""
    if not math.isfinite(state.energy):
        return 0.0
    return math.log(FAR) / math.log(state.energy / problem.total_measure)
