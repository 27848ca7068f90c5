"""Blended cured quasi-Newton: from Sobolev gradients to L-BFGS, along directions that no simplex blocks."""

from __future__ import annotations

from dataclasses import dataclass, replace

from workbench.api import (
    Floats,
    Pair,
    Problem,
    QuasiNewtonSolver,
    State,
    Status,
    direction_in_laplacian,
    inner,
    make_pair,
    parameter,
    unblocked_direction,
)


@dataclass(frozen=True)
class BlendedCuredQuasiNewton(QuasiNewtonSolver):
    """BCQN: L-BFGS in the metric of the source's Laplacian L, whose pairs are blended and whose directions are filtered.

    A step s is remembered with z = beta L s + (1 - beta) y, beta = |L| (y . L s) / volume kept within [0, 1]: far from the
    minimum steps are Sobolev gradients, near it those of L-BFGS. Before the line search the direction is moved to the
    nearest one along which no simplex loses all of its linearised content, by damped projected Jacobi iterations on the
    complementarity problem. Both, the half of the largest step without inversion and the optional stop at a
    characteristic gradient are the paper's. In space, |L| is measured at an edge of length one, so that the blend does not
    depend on the mesh's scale. With linear constraints directions are not filtered: the filter would leave A x = b.
    """

    id = "bcqn"
    label = "Blended cured quasi-Newton"
    short = "BCQN"
    citation = "Zhu, Bridson, Kaufman 2018 [ZBK18]; section 4.3"

    pairs: int = parameter(5, "steps that are remembered", minimum=1, maximum=50)
    blend: bool = parameter(True, "blend the remembered steps with the Laplacian; off: L-BFGS that begins with it")
    filter_iterations: int = parameter(
        20, "iterations of the filter against blocked steps; 0: no filter", minimum=0, maximum=500
    )
    safety: float = parameter(0.5, "part of the largest step without inversion that is taken", minimum=0.1, maximum=0.99)
    characteristic_stop: float = parameter(
        0.0, "stop at this part of the characteristic gradient norm, too (the paper: 1e-3); 0: by the common criteria alone",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip

    def prepare(self, problem: Problem) -> None:
        problem.workspace.laplacian.prepare()

    def initial(self, problem: Problem, gradient: Floats) -> Floats:
        return -direction_in_laplacian(problem, gradient)

    def pair(self, problem: Problem, step: Floats, difference: Floats) -> Pair | None:
        if not self.blend:
            return make_pair(step, difference)
        laplacian = problem.workspace.laplacian
        pushed = laplacian.multiply(step)
        pushed[problem.anchors.hard_vertices] = 0.0
        edge = (problem.total_measure / len(problem.elements.simplices)) ** (1.0 / problem.dimension)
        norm = laplacian.largest_eigenvalue / edge ** (2 * problem.dimension - 4)
        beta = min(max(norm * inner(difference, pushed) / problem.total_measure, 0.0), 1.0)
        return make_pair(step, beta * pushed + (1.0 - beta) * difference)

    def filtered(self, problem: Problem, state: State, direction: Floats, gradient: Floats) -> Floats:
        if not self.filter_iterations or problem.constraints is not None or problem.most_inverted(state.inverted) > 0:
            return direction
        cured = unblocked_direction(problem, state.positions, direction, self.filter_iterations)
        return cured if inner(cured, gradient) < 0.0 else direction

    def terminate(self, problem: Problem, state: State) -> Status:
        asked = max(self.characteristic_stop, problem.criteria.gradient_tolerance or 0.0)
        criteria = replace(problem.criteria, gradient_tolerance=asked if asked > 0.0 else None)
        return super().terminate(problem.with_criteria(criteria), state)
