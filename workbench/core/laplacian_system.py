"""The Laplacian of the source with anchors eliminated, factored once: the metric of methods that know the source alone."""

from __future__ import annotations

import time
from functools import cached_property

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.constraints import Anchors, LinearConstraints
from workbench.core.jacobians import Elements
from workbench.core.linear_back_end import SingularMatrixError
from workbench.core.newton_system import NewtonSystem
from workbench.core.pattern import HessianPattern


class LaplacianSystem:
    """K = Hessian, one coordinate at a time, of sum w |J|^2 + sum weight |x - target|^2 over the soft anchors.

    So K is twice the cotangent Laplacian, with 2 weight on the diagonal of soft anchors. All coordinates share one scalar
    matrix and its factor; hard anchors are eliminated in place. The factor lasts as long as the anchored vertices and the
    weights do: targets and maps may change freely. A map without any anchor floats: then K is shifted by a tiny part.

    Parameters
    ----------
    elements : Elements
    pattern : HessianPattern            of one coordinate
    simplex_weights : (m,) float64      w; the rest measures where None
    """

    def __init__(self, elements: Elements, pattern: HessianPattern, simplex_weights: Floats | None = None) -> None:
        self.dimension = elements.dimension
        weights = elements.rest_measures if simplex_weights is None else simplex_weights
        hats = elements.hat_gradients
        first, second = np.triu_indices(hats.shape[1])
        entries = 2.0 * weights[:, None] * np.einsum("mpi,mpi->mp", hats[:, first], hats[:, second])
        summed = np.bincount(pattern.slots.reshape(-1), entries.reshape(-1), pattern.entry_count)
        self._bare: Floats = np.asarray(summed, dtype=np.float64)
        self._values = self._bare
        self._pattern = pattern
        self._system = NewtonSystem(pattern)
        self._fixed: Integers = np.empty(0, dtype=np.int64)
        self._key: tuple[bytes, bytes, bytes] | None = None
        self._multipliers: tuple[LinearConstraints, Floats, Floats] | None = None

    @property
    def seconds(self) -> dict[str, float]:
        """Seconds spent so far: factorise, solve."""
        return self._system.seconds

    @property
    def counts(self) -> dict[str, int]:
        """Factorisations and solves so far; d right-hand sides together are one solve."""
        return self._system.counts

    @cached_property
    def largest_eigenvalue(self) -> float:
        """Of K without soft anchors, by power iteration: from below, to about a hundredth."""
        vector = np.cos(np.arange(self._pattern.size) * 2.4)
        size = 1.0
        for _ in range(30):
            vector = self._pattern.multiply(self._bare, vector / max(size, 1e-300))
            size = float(np.sqrt(np.einsum("i,i->", vector, vector)))
        return size

    def prepare(self) -> None:
        """Make the symbolic analysis."""
        self._system.solver  # noqa: B018

    def serve(self, anchors: Anchors) -> None:
        """Factorise for these anchors, unless the last factor has the same held vertices and weights.

        Raises `SingularMatrixError`.
        """
        vertices, _, weights = anchors.soft
        key = (anchors.hard_vertices.tobytes(), vertices.tobytes(), weights.tobytes())
        if key == self._key:
            return
        self._key, self._multipliers = None, None
        values = self._bare.copy()
        values[self._pattern.diagonal[self._pattern.place[vertices]]] += 2.0 * weights
        self._system.factorise(values, anchors.hard_vertices)
        self._values, self._fixed, self._key = values, anchors.hard_vertices, key

    def multiply(self, x: Floats) -> Floats:
        """K x, (N, d), with the anchored rows and columns still in K."""
        ordered = x[self._pattern.order]
        product = np.stack([self._pattern.multiply(self._values, column) for column in ordered.T], axis=1)
        result: Floats = product[self._pattern.place]
        return result

    def solve(self, rhs: Floats) -> Floats:
        """(N, c) right-hand sides -> x (N, c) with K x = rhs on the free rows and x = 0 at the hard anchors of `serve`."""
        begin = time.perf_counter()
        ordered = rhs[self._pattern.order]
        ordered[self._pattern.place[self._fixed]] = 0.0
        result: Floats = self._system.solver.solve(ordered)[self._pattern.place]
        self.counts["solve"] += 1
        self.seconds["solve"] += time.perf_counter() - begin
        return result

    def minimise(self, rhs: Floats, near: Floats, constraints: LinearConstraints | None = None) -> Floats:
        """Minimiser (N, d) of x.K x / 2 - rhs.x with the hard anchors where `near` (N, d) has them, and A x as `near` has it.

        With rhs = K t for a map t, the map whose Jacobians are nearest to those of t.
        """
        return near + self.direction(self.multiply(near) - rhs, constraints)

    def direction(self, gradient: Floats, constraints: LinearConstraints | None = None) -> Floats:
        """-K^-1 gradient, (N, d): steepest descent in this metric; 0 at the hard anchors, and along A x = const.

        Raises `SingularMatrixError` where constraints depend on each other or on the anchors.
        """
        free = self.solve(-gradient)
        if constraints is None or not len(constraints.values):
            return free
        rows, responses = self._responses(constraints)
        try:
            multipliers = np.linalg.solve(rows @ responses.T, rows @ free.reshape(-1))
        except np.linalg.LinAlgError:
            raise SingularMatrixError("the linear constraints depend on each other or on the anchors") from None
        return free - (multipliers @ responses).reshape(free.shape)

    def _responses(self, constraints: LinearConstraints) -> tuple[Floats, Floats]:
        """Rows of A and K^-1 times them, (p, N d); kept with the factor."""
        if self._multipliers is None or self._multipliers[0] is not constraints:
            rows = constraints.matrix.toarray()
            d = self.dimension
            columns = rows.reshape(len(rows), -1, d).transpose(1, 0, 2).reshape(-1, len(rows) * d)
            solved = self.solve(columns).reshape(-1, len(rows), d).transpose(1, 0, 2)
            self._multipliers = (constraints, rows, np.ascontiguousarray(solved).reshape(rows.shape))
        return self._multipliers[1:]
