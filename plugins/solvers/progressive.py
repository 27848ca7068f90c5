"""Newton's method on references that approach the source."""

from __future__ import annotations

from dataclasses import dataclass

from workbench.api import Evaluation, Interrupt, Problem, Progress, ProgressiveSolver, State


@dataclass(frozen=True)
class Progressive(ProgressiveSolver):
    """Progressive parameterization: Newton steps for a reference from which no triangle is distorted by more than `bound`.

    The reference has one exponent for all triangles and equal weights, as in the authors' program (bound 250); once it meets
    the source, or a step gains less than `close`, the steps are those of Projected Newton on the source. Two things differ:
    the authors begin with SLIM and go over to CM, here all steps are Newton's; and the step length is found on the energy of
    the true source, so that the energy never rises. A reference whose step does not lower it is given up for the source.
    """

    id = "progressive"
    label = "Progressive references"
    short = "PP"
    citation = "Liu, Ye, Ni, Fu 2018 [LYNF18]; section 4.3"
    kinds = ("parameterize", "plane")

    def near(
        self, problem: Problem, state: State, evaluation: Evaluation, progress: Progress, interrupt: Interrupt
    ) -> tuple[State, Progress]:
        return self.newton(problem, problem, state, evaluation, interrupt), progress
