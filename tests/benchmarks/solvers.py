"""Every solver on the same meshes from the same Tutte start, symmetric Dirichlet without anchors: a table a mesh.

    python tests/benchmarks/solvers.py [--meshes NAME,...] [--solvers ID,...] [--triangles N] [--iterations N] [--seconds S]

Columns: iterations and seconds to the stop, factorisations, evaluations, line-search trials, final mean distortion, its
relative error against the best of all, and iterations / seconds to within 1e-3 and 1e-6 of that best.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))  # run as a file, too

from tests.conftest import DATA
from workbench.core.errors import WorkbenchError
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import RunResult, run
from workbench.core.samples import make_sample
from workbench.engine.starts import make_start
from workbench.io.read import read_mesh

MESHES = ("bumpy-disc", "fingers", "hilbert", "face", "camel_vova", "hencky", "bunny_cut")
"""Samples by id; others by a part of a file's name, where the folder of trial meshes is there."""


def find_mesh(name: str, triangles: int) -> Mesh | None:
    """The sample or trial mesh of that name, None where it is missing."""
    try:
        return make_sample(name, triangles=triangles)
    except WorkbenchError:
        found = sorted(DATA.rglob(f"*{name}*.obj")) if DATA.is_dir() else []
        return read_mesh(str(found[0])).mesh if found else None


def compare(name: str, mesh: Mesh, ids: list[str], iterations: int, seconds: float) -> None:
    """Print the table of one mesh."""
    distortion = registry().distortions["symmetric-dirichlet"]
    start = make_start(mesh, "parameterize", "tutte")
    results: dict[str, tuple[RunResult, dict[str, int]]] = {}
    for id in ids:
        solver = registry().solvers[id]
        if "parameterize" not in solver.kinds or (solver.distortions and distortion.id not in solver.distortions):
            continue
        problem = Problem.create(mesh, "parameterize", distortion)
        run(solver(), problem, start, iterations=1)  # compiles
        problem = Problem.create(mesh, "parameterize", distortion)
        found = run(solver(), problem, start, tolerance=1e-9, iterations=iterations, time_limit=seconds)
        results[id] = (found, problem.workspace.all_counts())
    best = min(result.state.energy for result, _ in results.values())
    area = Problem.create(mesh, "parameterize", distortion).total_measure
    print(f"\n{name}: {mesh.simplex_count} triangles, best mean distortion {best / area:.9f}")
    print(
        f"{'solver':26} {'status':14} {'iter':>5} {'sec':>7} {'factor':>6} {'energy':>6} {'grad':>5} {'trials':>6} "
        f"{'mean':>12} {'error':>8} {'to 1e-3':>13} {'to 1e-6':>13}"
    )
    for id, (result, counts) in sorted(results.items(), key=lambda item: reached(item[1][0], best * (1 + 1e-3))[1]):
        energy = result.state.energy
        marks = [reached(result, best * (1 + part)) for part in (1e-3, 1e-6)]
        shown = " ".join(f"{f'{i}/{s:.2f}s' if np.isfinite(s) else '-':>13}" for i, s in marks)
        print(
            f"{id:26} {result.state.status.name:14} {result.state.iteration:5d} {result.seconds['total']:7.2f} "
            f"{counts['factorise']:6d} {counts['energy']:6d} {counts['gradient'] + counts['hessian']:5d} {counts['trials']:6d} "
            f"{energy / area:12.6f} {energy / best - 1:8.1e} {shown}",
            flush=True,
        )


def reached(result: RunResult, goal: float) -> tuple[int, float]:
    """Iteration and seconds at which the energy first was at most `goal`; inf seconds where never."""
    for row in result.rows:
        if row.energy <= goal:
            return row.iteration, row.seconds
    return -1, float("inf")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--meshes", default=",".join(MESHES))
    parser.add_argument("--solvers", default=",".join(sorted(registry().solvers)))
    parser.add_argument("--triangles", type=int, default=5000)
    parser.add_argument("--iterations", type=int, default=1000)
    parser.add_argument("--seconds", type=float, default=4.0)
    options = parser.parse_args()
    for name in options.meshes.split(","):
        mesh = find_mesh(name, options.triangles)
        if mesh is None:
            print(f"\n{name}: not here")
            continue
        compare(name, mesh, options.solvers.split(","), options.iterations, options.seconds)
