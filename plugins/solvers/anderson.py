"""Anderson acceleration of the local/global alternation."""

from __future__ import annotations

from dataclasses import dataclass, replace

from workbench.api import (
    SAFETY,
    Derivatives,
    DescentSolver,
    Evaluation,
    Floats,
    Interrupt,
    Problem,
    State,
    Status,
    anderson_step,
    descend,
    direction_in_laplacian,
    largest_step,
    moved_state,
    parameter,
)


@dataclass(frozen=True, eq=False)
class Iterates(Derivatives):
    """The derivatives at the newest map, and the maps before it with the local/global step from each, newest last."""

    before: tuple[tuple[Floats, Floats], ...]


@dataclass(frozen=True)
class Anderson(DescentSolver):
    """Anderson acceleration: the next map is put together from the last `window` local/global steps.

    After Peng et al. 2018: with the differences of the last maps and of their steps, the mixture whose step would be the
    shortest (least squares) is taken; where it does not lower the energy, the plain local/global step is. That step never
    raises the energy, so neither does the method. Zhang et al. 2019 and Ouyang et al. 2020 carry the same to ADMM, which is
    not done here. Ours is the step bound: an accelerated map is approached below the largest step without inversion. One that
    gains less than the tolerance is passed over, so that the end of a run is judged by plain steps.
    """

    id = "anderson"
    label = "Anderson acceleration"
    short = "AA"
    citation = "Peng et al. 2018 [PDZ*18]; Zhang et al. 2019 [ZPOD19]; Ouyang et al. 2020 [OPY*20]; section 4.3"
    distortions = ("arap", "arap-barrier")

    window: int = parameter(5, "steps that are put together; 0: no acceleration", minimum=0, maximum=50)
    safety: float = parameter(SAFETY, "part of the largest step without inversion that is taken", minimum=0.1, maximum=0.99)

    def advance(self, problem: Problem, state: State, evaluation: Evaluation, interrupt: Interrupt) -> State:
        plain = direction_in_laplacian(problem, evaluation.gradient)
        before = state.memory.before if isinstance(state.memory, Iterates) else ()
        iterates = (*before, (state.positions, plain))[-self.window - 1 :]
        following = self._accelerated(problem, state, iterates) if len(iterates) > 1 else None
        if interrupt():
            return replace(state, status=Status.INTERRUPTED)
        if following is None:
            following = descend(problem, state, evaluation, plain, interrupt, safety=self.safety)
        memory = following.memory
        if isinstance(memory, Derivatives):
            following = replace(following, memory=Iterates(memory.problem, memory.evaluation, iterates))
        return following

    def _accelerated(self, problem: Problem, state: State, iterates: tuple[tuple[Floats, Floats], ...]) -> State | None:
        """The state at the mixture of `iterates`; None where it lowers the energy too little."""
        step, size = anderson_step(iterates), 1.0
        if problem.forbids_inversions:
            size = min(1.0, self.safety * largest_step(state.positions, step, problem.elements.simplices)[0])
        following = moved_state(problem, state, state.positions + size * step)
        if following is None or state.energy - following.energy <= problem.criteria.tolerance * abs(state.energy):
            return None
        return replace(following, iteration=state.iteration + 1, previous_energy=state.energy, step_size=size)
