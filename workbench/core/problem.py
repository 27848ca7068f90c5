"""What is minimised: a source, a distortion, anchors and constraints."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

import numpy as np
import scipy

from workbench.core.arrays import Booleans, Floats
from workbench.core.constraints import Anchors, LinearConstraints
from workbench.core.distortion import Distortion
from workbench.core.energy import Energy, Evaluation
from workbench.core.jacobians import Elements, build_elements, determinants
from workbench.core.laplacian_system import LaplacianSystem
from workbench.core.mesh import Mesh
from workbench.core.method import Kind
from workbench.core.newton_system import NewtonSystem
from workbench.core.vertex_blocks import VertexBlock, vertex_blocks

ANCHOR_TOLERANCE = 1e-9
"""An anchor is in place within this part of the source's diameter."""


@dataclass(frozen=True)
class Criteria:
    """When every solver stops alike.

    `tolerance` : relative energy decrease of a step;  `gradient_tolerance` : characteristic gradient norm, None: not asked
    """

    tolerance: float = 1e-6
    gradient_tolerance: float | None = None


class Workspace:
    """Working memory that outlives a step: the last factor, and seconds and counts by part.

    Problems that differ in anchors or distortion share it; it never holds a result, only what saves time.
    """

    def __init__(self, energy: Energy) -> None:
        self._energy = energy
        self._system: NewtonSystem | None = None
        self._laplacian: LaplacianSystem | None = None
        self._blocks: tuple[VertexBlock, ...] | None = None
        self.seconds = {"assemble": 0.0, "line_search": 0.0}
        self.counts = {"energy": 0, "gradient": 0, "hessian": 0, "trials": 0}
        self._looked_at = {"energy": 0, "gradient": 0}
        self.groups: tuple[bytes, list[np.ndarray]] | None = None

    @property
    def system(self) -> NewtonSystem:
        """Made when first asked for: that builds the pattern and the symbolic analysis."""
        if self._system is None:
            self._system = NewtonSystem(self._energy.pattern)
        return self._system

    @property
    def laplacian(self) -> LaplacianSystem:
        """The Laplacian of the source, made when first asked for; its factor outlives distortions and targets."""
        if self._laplacian is None:
            self._laplacian = LaplacianSystem(self._energy.elements, self._energy.scalar_pattern)
        return self._laplacian

    @property
    def vertex_blocks(self) -> tuple[VertexBlock, ...]:
        """The vertices by colour, made when first asked for."""
        if self._blocks is None:
            self._blocks = vertex_blocks(self._energy.elements)
        return self._blocks

    def forget_factor(self) -> None:
        if self._system is not None:
            self._system.forget()

    def all_seconds(self) -> dict[str, float]:
        """Seconds by part: assemble, factorise, solve, line_search."""
        systems = [s.seconds for s in (self._system, self._laplacian) if s is not None]
        return {**self.seconds, **{part: sum(s[part] for s in systems) for part in ("factorise", "solve")}}

    def all_counts(self) -> dict[str, int]:
        """How often so far: energy, gradient, hessian, line-search trials, factorise, solve.

        Evaluations of parts of the mesh are added up to whole ones.
        """
        systems = [s.counts for s in (self._system, self._laplacian) if s is not None]
        size = max(len(self._energy.elements.simplices), 1)
        whole = {part: self.counts[part] + simplices // size for part, simplices in self._looked_at.items()}
        return {**self.counts, **whole, **{part: sum(s[part] for s in systems) for part in ("factorise", "solve")}}

    def count_part(self, part: Literal["energy", "gradient"], simplices: int) -> None:
        """Count an evaluation on so many simplices alone."""
        self._looked_at[part] += simplices

    @contextmanager
    def timed(self, part: str) -> Iterator[None]:
        begin = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[part] += time.perf_counter() - begin


@dataclass(frozen=True, eq=False, repr=False)
class Problem:
    """A minimisation over the maps of one source; frozen, `with_...` makes variants that share what stays the same."""

    mesh: Mesh
    kind: Kind
    density: Energy
    anchors: Anchors
    constraints: LinearConstraints | None = None
    criteria: Criteria = Criteria()
    workspace: Workspace = field(default=None, repr=False)  # type: ignore[assignment]

    def __post_init__(self) -> None:
        if self.workspace is None:
            object.__setattr__(self, "workspace", Workspace(self.density))
        self.anchors.check(self.mesh.vertex_count, self.dimension)

    @staticmethod
    def create(
        mesh: Mesh,
        kind: Kind,
        distortion: Distortion | str = "symmetric-dirichlet",
        anchors: Anchors | None = None,
        *,
        constraints: LinearConstraints | None = None,
        allow_inversions: bool = False,
        criteria: Criteria | None = None,
    ) -> Problem:
        """A problem on a source that suits `kind` (see `workbench.core.fixes.check_for_kind`); a text names a distortion.

        Raises `MeshError` for degenerate simplices, `WorkbenchError` for anchors that do not fit,
        `FormulaError` where the distortion does not exist in this dimension.
        """
        if isinstance(distortion, str):
            distortion = Distortion.resolve(distortion)
        distortion.compiled(mesh.dimension)
        energy = Energy(build_elements(mesh), distortion, allow_inversions, mesh=mesh)
        return Problem(mesh, kind, energy, anchors or Anchors.none(mesh.dimension), constraints, criteria or Criteria())

    def __repr__(self) -> str:
        mesh, anchors = self.mesh, len(self.anchors.vertices)
        size = f"{mesh.vertex_count:,} vertices, {mesh.simplex_count:,} {mesh.simplex_noun(mesh.simplex_count)}"
        return f"<Problem {self.kind}, {self.distortion.id}, {size}, {anchors} anchor{'' if anchors == 1 else 's'}>"

    # ---------------------------------------------------------------------------------------- variants

    def with_anchors(self, anchors: Anchors) -> Problem:
        """Other anchors; shares everything that does not depend on them."""
        return replace(self, anchors=anchors)

    def with_constraints(self, constraints: LinearConstraints | None) -> Problem:
        """Other linear constraints; shares everything that does not depend on them."""
        return replace(self, constraints=constraints)

    def with_distortion(self, distortion: Distortion, allow_inversions: bool = False) -> Problem:
        """Another distortion on the same source; the last factor is forgotten, the pattern and its analysis are kept."""
        distortion.compiled(self.dimension)
        self.workspace.forget_factor()
        return replace(self, density=self.density.with_distortion(distortion, allow_inversions))

    def from_start(self, positions: Floats) -> Problem:
        """For a distortion that looks at the start (N, d), the problem that begins there; else the problem itself."""
        density = self.density.from_start(np.ascontiguousarray(positions, dtype=np.float64))
        return self if density is self.density else replace(self, density=density)

    @property
    def may_overflow(self) -> bool:
        """Whether the distortion is made of exponentials, which `tempered` tames."""
        return self.distortion.compiled(self.dimension).has_logarithm

    def tempered(self, power: float) -> Problem:
        """The same problem with the distortion raised to `power`, or its logarithm where that is 0; see `may_overflow`."""
        distortion = self.distortion.tempered(self.dimension, power)
        assert distortion is not None
        return replace(self, density=self.density.with_distortion(distortion, self.density.allow_inversions))

    @property
    def may_collapse(self) -> bool:
        """Whether the distortion, like a norm, has a kink where singular values vanish and no barrier before it."""
        return self.distortion.is_kinked_at_zero(self.dimension)

    def softened(self, softening: float) -> Problem:
        """The same problem on sqrt(sigma^2 + softening^2) in place of sigma; see `may_collapse`."""
        distortion = replace(self.distortion, softening=softening, barrier=False)
        return replace(self, density=self.density.with_distortion(distortion, self.density.allow_inversions))

    @cached_property
    def needs_fence(self) -> bool:
        """Whether nothing but the step bound keeps simplices from inverting."""
        return self.forbids_inversions and not self.distortion.rises_to_barrier(self.dimension)

    def fenced(self, fence: float) -> Problem:
        """The same problem with fence/det added to the distortion; see `needs_fence`."""
        distortion = self.distortion.fenced(fence)
        return replace(self, density=self.density.with_distortion(distortion, self.density.allow_inversions))

    def with_criteria(self, criteria: Criteria) -> Problem:
        return replace(self, criteria=criteria)

    # -------------------------------------------------------------------------------------- properties

    @property
    def elements(self) -> Elements:
        return self.density.elements

    @property
    def distortion(self) -> Distortion:
        return self.density.distortion

    @property
    def dimension(self) -> int:
        return self.elements.dimension

    @property
    def system(self) -> NewtonSystem:
        """The Newton system with its last factor."""
        return self.workspace.system

    @cached_property
    def total_measure(self) -> float:
        """Area or volume of the source."""
        return float(self.elements.rest_measures.sum())

    @property
    def forbids_inversions(self) -> bool:
        """Whether a map without inverted simplices must stay so: always, unless inversions are allowed and finite."""
        return self.density.has_barrier or not self.density.allow_inversions

    def held_simplices(self, inverted: int) -> Booleans | slice:
        """Which simplices a step may not invert, from a map that has `inverted` of them.

        All of them; while some are inverted, those whose barrier is removed are free, or one that has just unfolded, with
        nothing that keeps it so, would hold the whole map.
        """
        return self.density.kept > 0.5 if inverted and len(self.density.kept) else slice(None)

    def most_inverted(self, inverted: int) -> float:
        """Inverted simplices that a step may leave, from a map that has `inverted` of them."""
        return 0.0 if inverted == 0 and self.forbids_inversions else math.inf

    # -------------------------------------------------------------------------------------- evaluation

    def evaluate(self, positions: Floats, order: int = 1, *, project: bool = True) -> Evaluation:
        """Energy with gradient (order 1) and Hessian values on the pattern (order 2), soft anchors included."""
        with self.workspace.timed("assemble"):
            self.workspace.counts["hessian" if order == 2 else "gradient"] += 1
            density = self.density
            result = density.hessian(positions, project=project) if order == 2 else density.gradient(positions)
            vertices, targets, weights = self.anchors.soft
            if not len(vertices):
                return result
            offset = positions[vertices] - targets
            result.gradient[vertices] += 2.0 * weights[:, None] * offset
            if result.hessian_values is not None:
                self.add_soft_anchors(result.hessian_values)
            return replace(result, energy=result.energy + float(weights @ (offset**2).sum(axis=1)))

    def add_soft_anchors(self, values: Floats) -> None:
        """Add the Hessian of the soft anchors' penalties to `values` (nnz,) on the pattern."""
        vertices, _, weights = self.anchors.soft
        d, pattern = self.dimension, self.density.pattern
        coordinates = pattern.place[vertices][:, None] * d + np.arange(d)
        values[pattern.diagonal[coordinates]] += 2.0 * weights[:, None]

    def energy_and_inverted(self, positions: Floats) -> tuple[float, int]:
        """(energy, inverted count), soft anchors included; +inf where a barrier distortion meets an inversion."""
        self.workspace.counts["energy"] += 1
        energy, inverted = self.density.value(positions)
        vertices, targets, weights = self.anchors.soft
        if len(vertices):
            energy += float(weights @ ((positions[vertices] - targets) ** 2).sum(axis=1))
        return energy, inverted

    def energy(self, positions: Floats) -> float:
        """Sum of w D over the simplices, plus the penalties of soft anchors."""
        return self.energy_and_inverted(np.ascontiguousarray(positions, dtype=np.float64))[0]

    def gradient(self, positions: Floats) -> Floats:
        """(N, d) gradient of `energy`."""
        return self.evaluate(np.ascontiguousarray(positions, dtype=np.float64), 1).gradient

    def hessian(self, positions: Floats, *, project: bool = True) -> scipy.sparse.csc_matrix:
        """(N d, N d) Hessian of `energy`, coordinates of a vertex together; positive semi-definite where projected."""
        result = self.evaluate(np.ascontiguousarray(positions, dtype=np.float64), 2, project=project)
        assert result.hessian_values is not None
        return self.density.pattern.matrix(result.hessian_values)

    def inverted(self, positions: Floats) -> int:
        """Simplices with det J <= 0."""
        return int(np.count_nonzero(~(determinants(self.elements, positions) > 0)))

    # ------------------------------------------------------------------------------------- constraints

    @property
    def free_constraints(self) -> LinearConstraints | None:
        """Those linear constraints that say something beyond each other and the hard anchors."""
        return None if self.constraints is None else self.constraints.independent(self.anchors.hard_vertices, self.dimension)

    def anchor_error(self, positions: Floats) -> float:
        """Largest distance of a hard anchor from its target, or residual of a linear constraint."""
        error = self.anchors.error(positions)
        if self.constraints is not None:
            error = max(error, float(np.abs(self.constraints.residual(positions)).max(initial=0.0)))
        return error

    @property
    def anchor_tolerance(self) -> float:
        return ANCHOR_TOLERANCE * self.mesh.diameter

    def anchors_lag(self, positions: Floats) -> bool:
        """Whether A x = b does not hold yet."""
        return self.anchor_error(positions) > self.anchor_tolerance

    def free_gradient_norm(self, gradient: Floats) -> float:
        """Euclidean norm over the vertices that no hard anchor holds, along A x = const."""
        fixed = self.anchors.hard_vertices
        if self.constraints is not None:
            free = gradient.copy()
            free[fixed] = 0.0
            return float(np.linalg.norm(self.constraints.tangential(free, fixed)))
        square = float(np.einsum("ij,ij->", gradient, gradient))
        held = gradient[fixed]
        return float(np.sqrt(max(0.0, square - float(np.einsum("ij,ij->", held, held)))))
