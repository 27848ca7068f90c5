"""Which stretches of a run can be repeated: where the solver begins to iterate on its own, and what moves the map between."""

from __future__ import annotations

from dataclasses import replace

from workbench.core.problem import Problem
from workbench.core.solver import Solver
from workbench.core.state import State
from workbench.engine.messages import LegBegun, SetAnchors, SetProblem, SetSolver

KEY_LEGS = 64
"""Every so many legs the map is told with one that merely goes on, so that older ones can be forgotten."""

Choices = tuple[SetProblem, SetSolver, SetAnchors | None, float]
"""Problem, solver, anchors, and the tolerance of the run."""


class LegBook:
    """Knows whether the next step goes on with a leg, or a new one has to be told first (see `LegBegun`)."""

    def __init__(self) -> None:
        self._number = 0
        self._leads_to_map = False
        self._origin = "start"
        self.is_open = False

    @property
    def leg(self) -> int:
        """Number of the leg that led to the present map; 0 where something else had the last word."""
        return self._number if self._leads_to_map else 0

    def changed(self) -> None:
        """The problem, or what the solver knew of it, is another; the map is as the last leg left it."""
        self.is_open = False

    def moved(self, origin: str = "map") -> None:
        """The map was moved by something that cannot be repeated, or is the `start`."""
        self.is_open, self._leads_to_map, self._origin = False, False, origin

    def open(self, generation: int, state: State, choices: Choices) -> LegBegun:
        """A leg begins at `state` under these choices: what is to be told of it."""
        self._number += 1
        origin, self._origin = self._origin, "previous"
        self.is_open = self._leads_to_map = True
        wants_map = origin != "previous" or self._number % KEY_LEGS == 0
        positions = state.positions if wants_map else None
        return LegBegun(generation, self._number, origin, state.iteration, positions, *choices)


def state_without_past(solver: Solver, problem: Problem, state: State) -> tuple[Problem, State]:
    """Problem and state as they are for one who knows the map alone: so a leg can be repeated to the last bit."""
    problem = problem.from_start(state.positions)
    problem.workspace.forget_factor()
    return problem, replace(solver.init(problem, state.positions), iteration=state.iteration)
