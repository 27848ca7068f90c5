"""Small problems to try a solver on: a plane figure, a surface and a volume, with anchors and without."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.constraints import Anchors
from workbench.core.distortion import Distortion
from workbench.core.energy import Energy, Evaluation
from workbench.core.mesh import Mesh
from workbench.core.method import Kind
from workbench.core.problem import Problem, Workspace
from workbench.core.registry import registry
from workbench.core.samples import make_sample

if TYPE_CHECKING:
    from workbench.core.solver import Solver

SAMPLES: dict[Kind, tuple[str, int]] = {"plane": ("bar", 80), "parameterize": ("bumpy-disc", 96), "volume": ("bar-3d", 60)}
ANCHORS = {"none": "without anchors", "held": "two anchors in place", "moved": "two anchors moved away"}


@dataclass(frozen=True)
class SolverCase:
    """A kind of map, and whether anchors are absent (none), in place (held) or away from their targets (moved)."""

    kind: Kind
    anchors: str
    distortion: str

    def __str__(self) -> str:
        sample, _ = SAMPLES[self.kind]
        return f"{sample} ({_source(self.kind).simplex_count} simplices, {self.kind}), {ANCHORS[self.anchors]}"

    @property
    def start(self) -> Floats:
        """(n, d) float64, no simplex inverted: the source sheared and stretched, its vertices moved a little."""
        mesh = _source(self.kind)
        n = mesh.dimension
        jitter = np.random.default_rng(0).uniform(-1.0, 1.0, size=(mesh.vertex_count, n))
        turn = np.array([[1.4, 0.3, 0.0], [-0.2, 0.8, 0.1], [0.0, 0.2, 1.1]])[:n, :n]
        moved: Floats = (mesh.vertices[:, :n] + 0.08 * _shortest_edge(mesh) * jitter) @ turn
        return moved

    def problem(self) -> Problem:
        """The problem, made anew: nothing that an earlier solver left behind."""
        mesh, distortion = _source(self.kind), Distortion.resolve(self.distortion)
        return Problem.create(mesh, self.kind, distortion, self.anchors_at(1.0))

    def anchors_at(self, reach: float) -> Anchors:
        """The anchors of the case, moved `reach` times as far from the start as the case says."""
        mesh, x = _source(self.kind), self.start
        if self.anchors == "none":
            return Anchors.none(mesh.dimension)
        held = np.array([0, mesh.vertex_count - 1])
        offset = np.array([[-0.3, 0.15, 0.1], [0.25, 0.2, -0.15]])[:, : mesh.dimension]
        return Anchors(held, x[held] + (reach * offset if self.anchors == "moved" else 0.0))


def cases_for(method: type[Solver]) -> Iterator[SolverCase]:
    """Every case that a solver takes."""
    for kind in SAMPLES:
        for anchors in ANCHORS if kind in method.kinds else ():
            yield SolverCase(kind, anchors, distortion_for(method))


def distortion_for(method: type[Solver]) -> str:
    """Id of the distortion that a solver is tried with: symmetric Dirichlet, or one of the few that it minimises."""
    fitting = [id for id in method.distortions if id in registry().distortions]
    return fitting[-1] if fitting else "symmetric-dirichlet"


@cache
def _source(kind: Kind) -> Mesh:
    mesh = make_sample(*SAMPLES[kind])
    return Mesh(mesh.vertices[:, :2], mesh.simplices, mesh.name) if kind == "plane" else mesh


def _shortest_edge(mesh: Mesh) -> float:
    corners = mesh.vertices[mesh.simplices]
    return float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).min())


class WalledEnergy(Energy):
    """The same derivatives, but every trial of a line search meets twice the energy: no step can be found."""

    def value(self, positions: Floats) -> tuple[float, int]:
        """See `Energy.value`."""
        energy, inverted = super().value(positions)
        return 2.0 * energy, inverted


class UndefinedEnergy(Energy):
    """The same energy with derivatives that are not numbers."""

    def gradient(self, positions: Floats) -> Evaluation:
        """See `Energy.gradient`."""
        return _undefined(super().gradient(positions))

    def hessian(self, positions: Floats, *, project: bool = True) -> Evaluation:
        """See `Energy.hessian`."""
        return _undefined(super().hessian(positions, project=project))


def _undefined(evaluation: Evaluation) -> Evaluation:
    return replace(evaluation, gradient=np.full_like(evaluation.gradient, np.nan))


def with_energy(problem: Problem, kind: type[Energy]) -> Problem:
    """The problem with another class of energy over the same elements and distortion."""
    density = kind(problem.elements, problem.distortion, problem.density.allow_inversions)
    return replace(problem, density=density, workspace=Workspace(density))
