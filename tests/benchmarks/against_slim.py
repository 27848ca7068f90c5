"""Projected Newton against the SLIM of libigl, from the same Tutte start on the bumpy disc, in the same run.

    python tests/benchmarks/against_slim.py [TRIANGLES ...] [--budget SECONDS]

Time to a relative decrease of 1e-6 for ours; libigl's goes on until its energy is within 1e-6 (relative) of ours or the
budget is spent, and then its time is a lower bound. One process, libigl's default solver; energies by our own code for both.
"""

from __future__ import annotations

import argparse
import resource
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))  # run as a file, too

from tests.libigl_reference import run_slim
from workbench.core.distortion import Distortion
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import RunResult, run
from workbench.core.samples import make_sample
from workbench.engine.starts import make_start

TOLERANCE = 1e-6


def compare(triangles: int, budget: float) -> None:
    """Print one block for one size."""
    mesh = make_sample("bumpy-disc", triangles=triangles)
    begin = time.perf_counter()
    start = make_start(mesh, "parameterize", "tutte")
    start_seconds = time.perf_counter() - begin
    problem = Problem.create(mesh, "parameterize", Distortion.resolve("symmetric-dirichlet"))
    ours = run(registry().solver("projected-newton")(), problem, start, tolerance=TOLERANCE)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024**2
    _print_ours(mesh.simplex_count, start_seconds, ours, memory)

    goal = ours.state.energy * (1 + TOLERANCE)
    slim = run_slim(problem, start, lambda energy: energy <= goal, budget)
    is_there = slim.energy <= goal
    reached = "reached ours" if is_there else f"still {slim.energy / ours.state.energy - 1:.2e} above ours"
    spent, each = slim.seconds, slim.seconds / max(slim.iterations, 1)
    print(
        f"  libigl SLIM  {spent:8.3f} s  {slim.iterations:3d} iterations  {each:.3f} s each, {reached}\n"
        f"  ratio        {'' if is_there else 'at least '}{spent / ours.seconds['total']:.1f}x",
        flush=True,
    )


def _print_ours(triangles: int, start_seconds: float, result: RunResult, memory: float) -> None:
    seconds, count = result.seconds, max(result.state.iteration, 1)
    split = "  ".join(f"{k} {1e3 * seconds[k] / count:.1f}" for k in ("assemble", "factorise", "solve", "line_search"))
    print(
        f"{triangles} triangles (start {start_seconds:.2f} s, peak memory {memory:.2f} GB)\n"
        f"  ours         {seconds['total']:8.3f} s  {result.state.iteration:3d} iterations  {result.state.status.name}, "
        f"set-up {seconds['setup']:.3f} s; ms an iteration: {split}",
        flush=True,
    )


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("triangles", nargs="*", type=int, default=[20_000, 200_000])
    parser.add_argument("--budget", type=float, default=120.0, help="seconds that libigl gets for one size")
    options = parser.parse_args()
    for size in options.triangles:
        compare(size, options.budget)
