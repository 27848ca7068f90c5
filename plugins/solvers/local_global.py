"""The alternation of rotations and one linear solve, for as-rigid-as-possible maps."""

from __future__ import annotations

from dataclasses import dataclass

from workbench.api import (
    SAFETY,
    DescentSolver,
    Evaluation,
    Interrupt,
    Problem,
    State,
    descend,
    direction_in_laplacian,
    parameter,
)


@dataclass(frozen=True)
class LocalGlobal(DescentSolver):
    """Local/global alternation: the rotation nearest to every Jacobian, then the map whose Jacobians are nearest to those.

    The second half is one solve with the Laplacian of the source, factored once (Sorkine & Alexa 2007 for spokes, Liu et al.
    2008 for single simplices, as here). With the rotations in place the gradient of ARAP is that of the quadratic, so the step
    is -K^-1 gradient: the same map without its rotations written out. The quadratic lies above the energy, so no step can
    raise it. What the papers do not have is the step bound: a map without inverted simplices stays so.
    """

    id = "local-global"
    label = "Local/global"
    short = "LG"
    citation = "Sorkine & Alexa 2007 [SA07]; Liu, Zhang, Xu, Gotsman, Gortler 2008 [LX*08]; section 4.3"
    distortions = ("arap", "arap-barrier")

    safety: float = parameter(SAFETY, "part of the largest step without inversion that is taken", minimum=0.1, maximum=0.99)

    def advance(self, problem: Problem, state: State, evaluation: Evaluation, interrupt: Interrupt) -> State:
        direction = direction_in_laplacian(problem, evaluation.gradient)
        return descend(problem, state, evaluation, direction, interrupt, safety=self.safety)
