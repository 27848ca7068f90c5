"""The road from a mesh to the optimum of symmetric Dirichlet: projected Newton, the fast solver, and libigl's SLIM, in one run.

    python tests/benchmarks/road.py [MESH ...] [--triangles N] [--budget SECONDS]

A mesh is a file or the id of a sample. Projected Newton and SLIM begin at Tutte's embedding; the fast solver does so once, and
once at the start that it picks itself. SLIM goes on until it is within 1e-4 (relative) of the fast solver's optimum from the
same start, or its seconds are spent.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))  # run as a file, too

from tests.libigl_reference import run_slim
from workbench.core.distortion import Distortion
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import run
from workbench.core.samples import make_sample
from workbench.engine.starts import make_start
from workbench.io.opening import open_source

NEAR = 1e-4
"""SLIM's own tail is long: it counts as there within this part of the optimum."""


def mesh_of(name: str, triangles: int) -> Mesh:
    return open_source(name).mesh if Path(name).exists() else make_sample(name, triangles=triangles)


def travel(name: str, triangles: int, budget: float) -> None:
    """Print a block for one mesh."""
    mesh = mesh_of(name, triangles)
    distortion = Distortion.resolve("symmetric-dirichlet")
    begin = time.perf_counter()
    tutte = make_start(mesh, "parameterize", "tutte")
    tutte_seconds = time.perf_counter() - begin
    print(f"{Path(name).stem}: {mesh.simplex_count} triangles, Tutte {tutte_seconds:.2f} s")
    energies = {}
    for id, initializer in (("projected-newton", "tutte"), ("fast", "tutte"), ("fast", "auto")):
        problem = Problem.create(Mesh(mesh.vertices, mesh.simplices), "parameterize", distortion)
        begin = time.perf_counter()
        start = make_start(problem.mesh, "parameterize", initializer, problem=problem)
        start_seconds = time.perf_counter() - begin
        result = run(registry().solver(id)(), problem, start)
        energies[id, initializer] = result.state.energy
        seconds, mean = result.seconds["total"], result.state.energy / problem.total_measure
        print(
            f"  {id:17s} from {initializer:6s} {result.state.iteration:4d} its  {seconds:7.3f} s  "
            f"(start {start_seconds:.2f} s)  mean {mean:.6f}  {result.state.status.name}, {result.state.inverted} inverted",
            flush=True,
        )
        if (id, initializer) == ("fast", "tutte"):
            fast_seconds = seconds
    goal = energies["fast", "tutte"] * (1.0 + NEAR)
    problem = Problem.create(mesh, "parameterize", distortion)
    slim = run_slim(problem, tutte, lambda energy: energy <= goal, budget)
    end = "there" if slim.energy <= goal else f"still {slim.energy / goal - 1.0:.1e} above"
    print(f"  libigl SLIM       from tutte  {slim.iterations:4d} its  {slim.seconds:7.3f} s  {end}", flush=True)
    bound = "" if slim.energy <= goal else "more than "
    print(f"  SLIM's seconds over those of fast from tutte: {bound}{slim.seconds / fast_seconds:.1f}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("meshes", nargs="*", default=["bumpy-disc", "fingers", "hilbert"])
    parser.add_argument("--triangles", type=int, default=20_000, help="of samples")
    parser.add_argument("--budget", type=float, default=30.0, help="seconds that SLIM gets for one mesh")
    options = parser.parse_args()
    for item in options.meshes:
        travel(item, options.triangles, options.budget)
