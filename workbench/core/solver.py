"""What a solver is, the criteria that stop all of them alike, and the only plain loop."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import TYPE_CHECKING

from workbench.core.arrays import Floats
from workbench.core.method import Method
from workbench.core.state import State
from workbench.core.status import Status

if TYPE_CHECKING:
    from workbench.core.problem import Problem

Interrupt = Callable[[], bool]
"""Asked between line-search trials and factorisations: true when the step shall return the old positions."""


def never() -> bool:
    """The interrupt that never comes."""
    return False


class Solver(Method, ABC):
    """A value machine: `init -> step -> step ...`; subclasses are frozen dataclasses, fields are the parameters."""

    monotone = True
    """Whether the energy never rises in a step once the anchors are in place."""

    @abstractmethod
    def step(self, problem: Problem, state: State, interrupt: Interrupt = never) -> State:
        """One accepted iterate of (62). Changes none of its inputs."""
