"""What changes while a solver runs."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from workbench.core.arrays import Floats, frozen
from workbench.core.status import Status

if TYPE_CHECKING:
    from workbench.core.energy import Evaluation


@dataclass(frozen=True, eq=False)
class Approach:
    """How the walk towards moved anchors goes (see `workbench.core.anchor_steps`).

    `refresh` : the last factor has grown poor;  `hold` : hold the anchors and relax first;
    `stuck` : steps in a row that brought the anchors no nearer;  `predicted` : the last step only predicted;
    `evaluation` : energy and gradient at `positions`
    """

    refresh: bool = False
    hold: bool = False
    stuck: int = 0
    predicted: bool = False
    positions: Floats | None = field(default=None, repr=False)
    evaluation: Evaluation | None = field(default=None, repr=False)


@dataclass(frozen=True, eq=False)
class State:
    """One iterate.

    Parameters
    ----------
    positions : (n, d) float64    the current map
    iteration : int
    energy : float                sum of w D, plus penalties of soft anchors
    gradient_norm : float         Euclidean norm over the free coordinates
    step_size : float             of the step that led here, in units of its direction; 0 where none was taken
    inverted : int                simplices with det <= 0
    anchor_error : float          largest distance of a hard anchor from its target
    status : Status
    previous_energy : float       energy before the last step, at the same anchors; NaN where there is none
    small_decreases : int         steps in a row, up to this one, that lowered the energy by no more than the tolerance
    limiting_simplex : int        simplex that bounded the last step, -1 where none did
    memory : object               the solver's own
    approach : Approach           of anchors that lag
    """

    positions: Floats
    iteration: int = 0
    energy: float = float("nan")
    gradient_norm: float = float("nan")
    step_size: float = 0.0
    inverted: int = 0
    anchor_error: float = 0.0
    status: Status = Status.RUNNING
    previous_energy: float = float("nan")
    small_decreases: int = 0
    limiting_simplex: int = -1
    memory: Any = field(default=None, repr=False)
    approach: Approach = Approach()

    def __post_init__(self) -> None:
        object.__setattr__(self, "positions", frozen(self.positions, np.float64))
