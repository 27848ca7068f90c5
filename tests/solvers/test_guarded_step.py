"""What a solver may do wrong, and what a run makes of it."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pytest

from tests.conftest import grid
from workbench.core.distortion import Distortion
from workbench.core.guarded_step import SolverFaultError
from workbench.core.problem import Problem
from workbench.core.run import run
from workbench.core.solver import Interrupt, Solver, never
from workbench.core.state import State
from workbench.core.status import Status


@dataclass(frozen=True)
class Faulty(Solver):
    """Does what the test says."""

    id = "faulty"
    label = "Faulty"
    outcome: Callable[[State], Any] = field(default=lambda state: state)

    def step(self, problem: Problem, state: State, interrupt: Interrupt = never) -> State:
        return self.outcome(state)  # type: ignore[no-any-return]


def problem() -> Problem:
    return Problem.create(grid(3), "plane", Distortion("d", "d", "sum(sigma^2 + 1/sigma^2)"))


def leave(state: State) -> State:
    sys.exit(0)


@pytest.mark.parametrize(
    "outcome",
    [
        leave,
        lambda state: None,
        lambda state: 1 / 0,
        lambda state: replace(state, positions=state.positions[:2]),
        lambda state: replace(state, positions=state.positions[:, ::-1]),
    ],
    ids=["leaves", "no state", "raises", "too few vertices", "mirrored"],
)
def test_a_fault_is_named_with_the_solver(outcome: Callable[[State], Any]) -> None:
    square = problem()
    with pytest.raises(SolverFaultError, match="Faulty"):
        run(Faulty(outcome), square, square.mesh.vertices * [1.1, 1.0])


def test_positions_that_are_not_finite_leave_the_map_before() -> None:
    square = problem()
    start = square.mesh.vertices * [1.1, 1.0]
    result = run(Faulty(lambda state: replace(state, positions=state.positions * np.nan)), square, start)
    assert result.state.status is Status.NONFINITE
    assert np.array_equal(result.state.positions, start)


def test_a_solver_that_stands_still_reaches_the_limit_of_iterations() -> None:
    square = problem()
    result = run(Faulty(), square, square.mesh.vertices * [1.1, 1.0], iterations=5)
    assert result.state.status is Status.MAX_ITERATIONS
