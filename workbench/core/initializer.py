"""What an initializer is."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from workbench.core.arrays import Floats
from workbench.core.mesh import Mesh
from workbench.core.method import Kind, Method

if TYPE_CHECKING:
    from workbench.core.problem import Problem


@dataclass(frozen=True)
class StartRequest:
    """What a start is made for.

    Parameters
    ----------
    mesh : Mesh       the source; for `plane` its vertices have two columns
    kind : Kind       kind of map
    file : str        path that the user named, for the initializer `file`; empty otherwise
    problem : Problem    what the start will be used for, where that is known
    make : callable      id -> start (N, d) of another initializer, for those that choose between several
    """

    mesh: Mesh
    kind: Kind
    file: str = ""
    problem: Problem | None = None
    make: Callable[[str], Floats] | None = None


class Initializer(Method, ABC):
    """A linear or combinatorial method that makes a start.

    Subclasses are frozen dataclasses; fields are the parameters.
    """

    @abstractmethod
    def start(self, request: StartRequest) -> Floats:
        """Positions of the start.

        Returns
        -------
        (n, d) float64     one row a vertex of `request.mesh`; d is the dimension of the target

        Raises `WorkbenchError` where the mesh does not allow this start: what is wrong and what to do.
        """
