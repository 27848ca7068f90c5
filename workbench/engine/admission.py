"""Whether a map can go on under another distortion."""

from __future__ import annotations

import math

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.errors import WorkbenchError
from workbench.core.jacobians import signed_singular_values
from workbench.core.load_report import first_few
from workbench.core.nouns import count_of
from workbench.core.problem import Problem


def check_admissible(problem: Problem, positions: Floats) -> None:
    """Raises `WorkbenchError` where the distortion is no finite number on the present map (N, d), saying on which simplices.

    A map that is inverted where the distortion has its barrier passes: its status says what stands in the way, and an
    exponential that is too large for a number does, too, since solvers lessen its logarithm.
    """
    if math.isfinite(problem.energy(positions)) or problem.density.meets_barrier(positions):
        return
    if problem.may_overflow and math.isfinite(problem.tempered(0.0).energy(positions)):
        return
    values = problem.distortion.value(signed_singular_values(problem.elements, positions))
    bad = np.flatnonzero(~np.isfinite(values))
    if not len(bad):
        raise WorkbenchError("With this distortion the energy of the present map is too large for a number; the old one stays.")
    noun = "triangle" if problem.dimension == 2 else "tetrahedron"
    raise WorkbenchError(
        f"This distortion is not a finite number on {count_of(len(bad), noun)} of the present map "
        f"({first_few(bad)}, from 0); the one before stays in force. Change the formula or its parameters, or reset the map."
    )
