"""Descent by stages: a hard energy is replaced by an easier one, which comes nearer to it each time its minimum is reached."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from workbench.core.problem import Problem
from workbench.core.solver import Interrupt, Solver, counted
from workbench.core.state import State
from workbench.core.status import Status

SHRINKAGE = 0.1
"""The change of the energy after a stage, as part of the one before."""


Step = Callable[[Solver, Problem, State, Interrupt], State]
"""How a step is taken, that of a solver itself or one by stages."""


def plain_step(solver: Solver, problem: Problem, state: State, interrupt: Interrupt) -> State:
    """`solver.step`."""
    return solver.step(problem, state, interrupt)


@dataclass(frozen=True, eq=False)
class Stage:
    """A solver's memory on the easier problem `eased(amount)`: what it goes on from; `problem` is the one proper."""

    problem: Problem
    eased: Callable[[float], Problem]
    current: Problem
    state: State
    amount: float
    least: float


def kept_stage(problem: Problem, state: State) -> Stage | None:
    """The stage that the last step was taken in, if it was one of this very problem."""
    memory = state.memory
    return memory if isinstance(memory, Stage) and memory.problem is problem else None


def begin(
    solver: Solver, problem: Problem, state: State, eased: Callable[[float], Problem], amount: float, least: float
) -> Stage:
    """A stage with so much change of the energy; with the `least`, a minimum counts as one of the energy proper."""
    current = eased(amount)
    return Stage(problem, eased, current, replace(solver.rebase(current, state), iteration=state.iteration), amount, least)


def staged_step(solver: Solver, stage: Stage, state: State, interrupt: Interrupt, step: Step = plain_step) -> State:
    """`step` on the easier energy; CONVERGED where it is at its minimum with the least change.

    A step is kept only if the energy proper does not rise by it; else the change shrinks at once.
    """
    problem = stage.problem
    while True:
        following = step(solver, stage.current, stage.state, interrupt)
        if following.status is Status.INTERRUPTED:
            return replace(state, status=Status.INTERRUPTED)
        following = counted(stage.current, stage.state, following)
        energy = problem.energy_and_inverted(following.positions)[0]
        lags = problem.anchors_lag(state.positions)
        is_over = solver.terminate(stage.current, following) is not Status.RUNNING
        is_kept = following.positions is not stage.state.positions and (lags or energy <= state.energy)
        if is_over and lags:
            return replace(following, energy=energy)
        if (is_over or not is_kept) and stage.amount > stage.least:
            start = following if is_kept else state
            amount = max(SHRINKAGE * stage.amount, stage.least)
            stage = begin(solver, problem, start, stage.eased, amount, stage.least)
            if is_kept:
                return replace(following, energy=energy, status=Status.RUNNING, previous_energy=math.nan, memory=stage)
            continue
        if is_kept:
            previous = state.energy if is_over else math.nan
            status = Status.CONVERGED if is_over else following.status
            memory = replace(stage, state=following)
            return replace(following, energy=energy, previous_energy=previous, status=status, memory=memory)
        return replace(state, iteration=state.iteration + 1, step_size=0.0, status=Status.CONVERGED)
