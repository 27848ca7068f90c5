"""A solid bar turned at one end: our steps part by part, our linear solvers side by side, and libigl's SLIM in the same run.

    python -m tests.benchmarks.tetrahedra [CELLS ...] [--budget SECONDS]

The bar is 5 x 1 x 1 and has 5 c x c x c cells of six tetrahedra (c = 10: 30 k, c = 15: 101 k). Its right end is turned by 90
degrees and stretched by 1.2, or by 180 degrees and 1.3. Projected Newton starts at rest, and the anchors are dragged; then
once more from the bar turned evenly along its length, which is where SLIM starts, whose anchors are soft. SLIM goes on until
its energy is within 1e-4 of ours or the budget is spent. Energies by our own code for both; libigl's default linear solver.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))  # run as a file, too

from tests.libigl_reference import run_slim
from workbench.core.constraints import Anchors
from workbench.core.distortion import Distortion
from workbench.core.linear_solver import make_linear_solver
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import RunResult, run
from workbench.core.samples.grids import solid_bar

LENGTH = 5.0
AXIS = np.array([0.0, 0.5, 0.5])
TURNS = ((90.0, 1.2), (180.0, 1.3))
REACHED = 1e-4
PARTS = ("assemble", "factorise", "solve", "line_search")


def bar(cells: int) -> Mesh:
    """The bar of 5 c x c x c cells."""
    return Mesh(*solid_bar(30 * cells**3, LENGTH), "bar")


def turned_evenly(mesh: Mesh, degrees: float, stretch: float) -> np.ndarray:
    """(N, 3) every section turned by its share: no tetrahedron inverts, and the ends are where they shall be."""
    share = mesh.vertices[:, :1] / LENGTH
    turn = Rotation.from_rotvec(np.radians(degrees) * share * [[1.0, 0.0, 0.0]])
    return turn.apply(mesh.vertices - AXIS) * [stretch, 1.0, 1.0] + AXIS


def problem_of(mesh: Mesh, target: np.ndarray) -> Problem:
    """Both ends held where `target` (N, 3) has them."""
    ends = np.flatnonzero((mesh.vertices[:, 0] <= 0.0) | (mesh.vertices[:, 0] >= LENGTH))
    return Problem.create(mesh, "volume", Distortion.resolve("symmetric-dirichlet"), Anchors(ends, target[ends]))


def ours(mesh: Mesh, target: np.ndarray, start: np.ndarray, name: str, words: str) -> RunResult:
    """One run with the linear solver `name`, printed; kernels are compiled before."""
    solver = registry().solver("projected-newton")()
    for iterations in (2, 1000):  # the first run compiles and warms up
        problem = problem_of(mesh, target)
        problem.system._solver = make_linear_solver(problem.density.pattern, name)
        most: list[int] = []
        result = run(solver, problem, start, iterations=iterations, on_row=lambda row: most.append(row.inverted))  # noqa: B023
    count = max(result.state.iteration, 1)
    split = "  ".join(f"{part} {1e3 * result.seconds[part] / count:.0f}" for part in PARTS)
    mean, total = result.state.energy / problem.total_measure, result.seconds["total"]
    print(
        f"  {name:13s} {words:12s} {total:7.2f} s  {count:3d} steps of {1e3 * total / count:4.0f} ms ({split})"
        f"  {result.state.status.name}, mean {mean:.6f}, at most {max(most)} inverted",
        flush=True,
    )
    return result


def theirs(problem: Problem, start: np.ndarray, goal: float, budget: float) -> None:
    """SLIM from `start` until it is near the energy `goal`, printed."""
    slim = run_slim(problem, start, lambda energy: abs(energy / goal - 1.0) <= REACHED, budget)
    each = 1e3 * slim.seconds / max(slim.iterations, 1)
    print(
        f"  libigl SLIM   turned start {slim.seconds:7.2f} s  {slim.iterations:3d} steps of {each:4.0f} ms,"
        f" energy {slim.energy / goal - 1.0:+.1e} of ours, anchors off by {problem.anchor_error(slim.positions):.1e}",
        flush=True,
    )


def main(sizes: list[int], budget: float, names: list[str]) -> None:
    """A block for each size and turn."""
    for cells in sizes:
        mesh = bar(cells)
        for degrees, stretch in TURNS:
            target = turned_evenly(mesh, degrees, stretch)
            print(f"{mesh.simplex_count} tetrahedra, {degrees:.0f} degrees", flush=True)
            for name in names:
                result = ours(mesh, target, mesh.vertices, name, "rest")
            ours(mesh, target, target, names[0], "turned start")
            if budget > 0.0:
                theirs(problem_of(mesh, target), target, result.state.energy, budget)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("cells", nargs="*", type=int, default=[10, 15])
    parser.add_argument("--budget", type=float, default=60.0, help="seconds that libigl gets for one block; 0: none")
    parser.add_argument("--linear-solvers", default="multifrontal,cg", help="names, separated by commas")
    options = parser.parse_args()
    main(options.cells, options.budget, options.linear_solvers.split(","))
