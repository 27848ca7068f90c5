"""The energy E_D (47) of a map: value, exact gradient (96)(97) and Hessian on a fixed pattern."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.distortion import Distortion
from workbench.core.element_kernels import derivatives_2d, energy_2d
from workbench.core.jacobians import Elements, determinants
from workbench.core.mesh import Mesh
from workbench.core.pattern import HessianPattern, build_pattern
from workbench.core.predicates import orientation, orientation_3d
from workbench.core.tape import Tape
from workbench.core.tetrahedron_kernels import derivatives_3d, energy_3d
from workbench.core.threads import over_ranges

DOUBTFUL = 1e-8
"""A determinant below may owe its sign to rounding."""
EVERY: Floats = np.empty(0)
"""No list of simplices that keep their barrier: all do."""


@dataclass(frozen=True, eq=False)
class Evaluation:
    """Energy and what was asked for with it.

    `gradient` : (N, d) float64;  `hessian_values` : (nnz,) float64 on the pattern, positive semi-definite where projected
    """

    energy: float
    inverted: int
    gradient: Floats
    hessian_values: Floats | None = None


@dataclass(frozen=True, eq=False)
class Energy:
    """Sum of w D over the simplices of a source.

    `kept` : (m,) float64, 1 where the barrier holds and 0 where a simplex was inverted at the start; empty where all keep it
    `mesh` : what the elements are of; its order of elimination serves the pattern, too
    """

    elements: Elements
    distortion: Distortion
    allow_inversions: bool = False
    _shared: dict[str, HessianPattern] = field(default_factory=dict, repr=False)
    kept: Floats = field(default_factory=lambda: EVERY, repr=False)
    mesh: Mesh | None = field(default=None, repr=False)

    @property
    def pattern(self) -> HessianPattern:
        """Built when first asked for and shared by every energy on these elements."""
        if "pattern" not in self._shared:
            e = self.elements
            self._shared["pattern"] = build_pattern(e.simplices, e.vertex_count, e.dimension, self._known_order)
        return self._shared["pattern"]

    @property
    def scalar_pattern(self) -> HessianPattern:
        """The pattern of one coordinate in the same order of elimination; built when first asked for and shared."""
        if "scalar" not in self._shared:
            e = self.elements
            self._shared["scalar"] = build_pattern(e.simplices, e.vertex_count, 1, self._known_order)
        return self._shared["scalar"]

    @property
    def _known_order(self) -> Integers | None:
        if self.mesh is not None:
            return self.mesh.elimination_order
        return next((pattern.order for pattern in self._shared.values()), None)

    def with_distortion(self, distortion: Distortion, allow_inversions: bool) -> Energy:
        """The same source with another density: elements and pattern are shared, what one looked at is not another's."""
        kept = self.kept if distortion.looks_at_start else EVERY
        return replace(self, distortion=distortion, allow_inversions=allow_inversions, kept=kept)

    def from_start(self, positions: Floats) -> Energy:
        """For a distortion that looks at the start (N, d): the barrier of what is inverted there is removed."""
        if not self.distortion.looks_at_start:
            return self
        return replace(self, kept=(determinants(self.elements, positions) > 0).astype(np.float64))

    @cached_property
    def has_barrier(self) -> bool:
        return self.distortion.has_barrier(self.elements.dimension)

    def value(self, positions: Floats) -> tuple[float, int]:
        """(energy, inverted count); +inf where a barrier distortion meets an inversion (then the count is a lower bound)."""
        e = self.elements
        tape = self.distortion.compiled(e.dimension).value
        kernel = energy_2d if e.dimension == 2 else energy_3d
        barrier, kept = self.has_barrier, self.barrier_flags

        def work(part: int, start: int, stop: int) -> tuple[float, int]:
            return kernel(  # type: ignore[no-any-return]
                positions, e.simplices, e.inverse_rest, e.rest_measures, kept,
                tape.code, tape.outputs, tape.registers(), barrier, start, stop,
            )  # fmt: skip

        results = over_ranges(work, len(e.simplices))
        energy, inverted = float(sum(r[0] for r in results)), int(sum(r[1] for r in results))
        if not inverted and self.may_graze and (grazed := self._inverted_by_rounding(positions)):
            return (float("inf") if barrier else energy), grazed
        return energy, inverted

    def gradient(self, positions: Floats) -> Evaluation:
        """Energy and gradient. Not finite where a barrier distortion meets an inversion."""
        return self._derivatives(positions, self.distortion.compiled(self.elements.dimension).gradient, 1, False)

    def hessian(self, positions: Floats, *, project: bool = True) -> Evaluation:
        """Energy, gradient and Hessian; `project` makes every simplex's block positive semi-definite.

        A projected Hessian bounds kinks of D from above, see `workbench.core.element_kernels`; the other one is exact.
        """
        compiled = self.distortion.compiled(self.elements.dimension)
        return self._derivatives(positions, compiled.majoriser if project else compiled.hessian, 2, project)

    @property
    def barrier_flags(self) -> Floats:
        """`kept`, written out where the distortion has a formula of its own for simplices without a barrier."""
        if self.distortion.looks_at_start and not len(self.kept):
            return np.ones(len(self.elements.simplices))
        return self.kept

    def _derivatives(self, positions: Floats, tape: Tape, order: int, project: bool) -> Evaluation:
        e = self.elements
        kernel = derivatives_2d if e.dimension == 2 else derivatives_3d
        slots = self.pattern.slots if order == 2 else np.empty((1, 1), dtype=np.int32)
        kept, kink = self.barrier_flags, self.distortion.compiled(e.dimension).is_kinked_at_ties
        entry_count = self.pattern.entry_count if order == 2 else 1

        def work(part: int, start: int, stop: int) -> tuple[float, int, Floats, Floats]:
            gradient = np.zeros((e.vertex_count, e.dimension))
            values = np.zeros(entry_count)
            energy, inverted = kernel(
                positions, e.simplices, e.inverse_rest, e.rest_measures, kept, tape.code, tape.outputs, tape.registers(),
                order, project, kink, slots, start, stop, gradient, values,
            )  # fmt: skip
            return energy, inverted, gradient, values

        results = over_ranges(work, len(e.simplices))
        energy, inverted, gradient, values = results[0]
        with np.errstate(invalid="ignore", over="ignore"):  # an energy that is not finite has a gradient that is not
            for other in results[1:]:
                energy += other[0]
                inverted += other[1]
                gradient += other[2]
                values += other[3]
        if inverted and self.meets_barrier(positions):
            energy = float("inf")
        if not inverted and self.may_graze and (inverted := self._inverted_by_rounding(positions)) and self.has_barrier:
            energy = float("inf")
        return Evaluation(float(energy), int(inverted), gradient, values if order == 2 else None)

    @cached_property
    def may_graze(self) -> bool:
        """Whether nothing but the step bound, or a fence that is as good as gone, keeps simplices off a collapse."""
        faint = self.distortion.fence > 0.0 or not self.distortion.rises_to_barrier(self.elements.dimension)
        return faint and not self.allow_inversions

    def _inverted_by_rounding(self, positions: Floats) -> int:
        """Simplices that are collapsed or inverted exactly, although their determinant comes out as a tiny positive number."""
        e = self.elements
        doubtful = np.flatnonzero(determinants(e, positions) < DOUBTFUL)
        if not len(doubtful):
            return 0
        corners = positions[e.simplices[doubtful]].transpose(1, 0, 2)
        rest = np.sign(
            np.linalg.det(e.inverse_rest[doubtful] / np.abs(e.inverse_rest[doubtful]).max(axis=(1, 2), keepdims=True))
        )
        exact = orientation(*corners) if e.dimension == 2 else orientation_3d(*corners)
        return int(np.count_nonzero(exact * rest <= 0))

    def meets_barrier(self, positions: Floats) -> bool:
        """Whether D is infinite because a simplex that keeps its barrier is inverted."""
        if not self.has_barrier:
            return False
        inverted = ~(determinants(self.elements, positions) > 0)
        return bool((inverted & (self.barrier_flags > 0.5)).any() if len(self.barrier_flags) else inverted.any())

    @cached_property
    def has_kinks(self) -> bool:
        """Whether D is not smooth everywhere: at ties of singular values, or at a switch of max, min or abs."""
        compiled = self.distortion.compiled(self.elements.dimension)
        return compiled.is_kinked_at_ties or compiled.majoriser is not compiled.hessian
