"""No clock of a race runs while a kernel is compiled."""

from __future__ import annotations

import subprocess
import sys

import pytest

SCRIPT = """
import gc
import sys

import numpy as np
from numba.core.dispatcher import Dispatcher

from workbench.core.constraints import Anchors
from workbench.core.distortion import Distortion
from workbench.core.problem import Problem
from workbench.core.samples import make_sample
from workbench.engine.race import Contestant, Race

sample, kind, *solvers = sys.argv[1:]


def ready():
    kernels = [item for item in gc.get_objects() if isinstance(item, Dispatcher)]
    return {(kernel.__module__, kernel.__name__, str(types)) for kernel in kernels for types in kernel.signatures}


mesh = make_sample(sample)
rest = np.ascontiguousarray(mesh.vertices[:, : mesh.dimension])
held = np.array([0, mesh.vertex_count - 1])
problem = Problem.create(mesh, kind, Distortion.resolve("symmetric-dirichlet"), Anchors(held, rest[held] + [[0.0], [0.2]]))
race = Race(problem, rest, [Contestant.of(solver) for solver in solvers])
before = ready()
assert len(before) > 10
for _ in range(4):
    race.step_all()
assert all(racer.rows[-1].iteration >= 2 and not racer.fault for racer in race.racers)
late = sorted(f"{module}.{name}" for module, name, _ in ready() - before)
print("late:", *late)
"""


@pytest.mark.parametrize(("sample", "kind"), [("bar", "plane"), ("bar-3d", "volume")])
def test_kernels_are_ready_before_the_first_step(sample: str, kind: str) -> None:
    """In a process of its own: other tests have used the kernels here."""
    arguments = [sys.executable, "-c", SCRIPT, sample, kind, "projected-newton", "aqp", "l-bfgs", "slim"]
    done = subprocess.run(arguments, capture_output=True, text=True, timeout=300, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == "late:"
