"""What a typed formula costs beside the registered distortion of the same value, a projected-Newton step at 50 k triangles.

    python tests/benchmarks/formula.py [--triangles N]

Both run in the same process, in turns, from the same maps; then the time from a typed text to the map after its first step,
on a run that is under way, as when a formula is changed in the window.
"""

from __future__ import annotations

import argparse
import statistics
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))  # run as a file, too

from workbench.core.distortion import Distortion
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.samples import make_sample
from workbench.engine.starts import make_start

PAIRS = {
    "symmetric-dirichlet": "sum(sigma^2 + 1/sigma^2)",
    "mips": "sum(sigma^2)/prod(sigma)^(2/n)",
    "condition-number": "sigma1/sigma2",
    "amips": "exp(sum(sigma^2)/det + max(det, 1/det)/2)",
}
STEPS = 5


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--triangles", type=int, default=50_000)
    options = parser.parse_args()
    mesh = make_sample("bumpy-disc", triangles=options.triangles)
    start = make_start(mesh, "parameterize", "tutte")
    solver = registry().solver("projected-newton")()
    shared = Problem.create(mesh, "parameterize", Distortion.resolve("symmetric-dirichlet"))
    state = solver.init(shared, start)
    for _ in range(8):
        state = solver.step(shared, state)
    print(f"{mesh.simplex_count} triangles, median of {STEPS} projected-Newton steps")
    for id, text in PAIRS.items():
        problems = [shared.with_distortion(Distortion.resolve(source)) for source in (id, text)]
        states = [solver.rebase(problem, state) for problem in problems]
        times: list[list[float]] = [[], []]
        for _ in range(STEPS):
            for row, problem in enumerate(problems):
                begin = time.perf_counter()
                states[row] = solver.step(problem, states[row])
                times[row].append(time.perf_counter() - begin)
        built_in, typed = (statistics.median(t) for t in times)
        ratio = typed / built_in
        print(f"{id:20s} registered {1e3 * built_in:6.1f} ms   typed {1e3 * typed:6.1f} ms   ratio {ratio:.2f}")
    for text in ("sum(sigma^2 + 1/sigma^2) + 0.1*max(sigma)/min(sigma)", "exp(0.2*sum(sigma^4 + sigma^-4))"):
        begin = time.perf_counter()
        problem = shared.with_distortion(Distortion.resolve(text))
        after = solver.step(problem, solver.rebase(problem, state))
        seconds = time.perf_counter() - begin
        print(f"from the text to its first step: {seconds:.3f} s, step size {after.step_size:.2f}   {text}")


if __name__ == "__main__":
    main()
