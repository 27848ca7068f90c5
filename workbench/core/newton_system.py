"""The linear system of a Newton step with anchors eliminated and further constraints by (65)."""

from __future__ import annotations

import time

import numpy as np

from workbench.core.anchor_response import AnchorResponse
from workbench.core.arrays import Floats, Integers
from workbench.core.constraints import LinearConstraints
from workbench.core.linear_back_end import LinearSolver, SingularMatrixError
from workbench.core.linear_solver import make_linear_solver
from workbench.core.pattern import HessianPattern

SHIFTS = (1e-10, 1e-8, 1e-6, 1e-4)
"""Relative shifts of the diagonal, tried in turn: a map without anchors may float and turn freely, its Hessian is singular."""


class NewtonSystem:
    """A factorised projected Hessian with the hard anchors eliminated.

    Anchored coordinates keep their place in the matrix, with a unit diagonal and nothing else: that is elimination without
    a new pattern, so that the symbolic analysis outlives every change of anchors.
    """

    def __init__(self, pattern: HessianPattern) -> None:
        self.pattern = pattern
        self._solver: LinearSolver | None = None
        self._fixed: Integers = np.empty(0, dtype=np.int64)
        self._fixed_coordinates: Integers = np.empty(0, dtype=np.int64)
        self._fixed_entries: Integers = np.empty(0, dtype=np.int64)
        self._fixed_mask = np.zeros(pattern.size, dtype=bool)
        self._values: Floats | None = None
        self.kept_response: AnchorResponse | None = None  # of the last factor
        self.factorised_at = 0.0  # time.perf_counter() at the end of the last factorisation
        self.seconds = {"factorise": 0.0, "solve": 0.0}
        self.counts = {"factorise": 0, "solve": 0}
        self.last_factorisation_seconds = 0.0

    @property
    def solver(self) -> LinearSolver:
        """The back end; making it is the symbolic analysis."""
        if self._solver is None:
            self._solver = make_linear_solver(self.pattern)
        return self._solver

    @property
    def hessian_values(self) -> Floats:
        """(nnz,) the Hessian of the last factor, before elimination."""
        assert self._values is not None
        return self._values

    def anchor_forces(self, direction: Floats) -> tuple[Floats, float]:
        """What moving the eliminated vertices along `direction` (N, d) asks of the rest, with the Hessian of the last factor.

        Returns
        -------
        (N, d) force H_fa d_a on the free vertices, and the work d_a . (H d)_a at the anchors
        """
        vector = self.pattern.to_matrix_order(direction)
        pushed = self._pushed(vector)
        pushed[self._fixed_coordinates] = 0.0
        work = float(vector[self._fixed_coordinates] @ self._reaction(vector))
        return self.pattern.from_matrix_order(pushed), work

    def response(self, shapes: Floats) -> Floats:
        """How the map follows eliminated vertices by the last factor: -H_ff^-1 H_fa, and the anchors themselves.

        Parameters
        ----------
        shapes : (k, r) float64      displacements of the eliminated vertices, as numbers that stand for any one coordinate

        Returns
        -------
        (r d, N d) float64      displacement of every vertex for each shape in each coordinate
        """
        pattern, d = self.pattern, self.pattern.dimension
        rhs = np.empty((pattern.size, shapes.shape[1] * d))
        for column in range(rhs.shape[1]):
            shape, coordinate = divmod(column, d)
            moved = np.zeros(pattern.size)
            moved[self._fixed_coordinates[coordinate::d]] = shapes[:, shape]
            rhs[:, column] = -self._pushed(moved)
            rhs[self._fixed_coordinates, column] = moved[self._fixed_coordinates]
        solution = self.solver.solve(rhs)
        self.counts["solve"] += 1
        return np.stack([pattern.from_matrix_order(c).reshape(-1) for c in solution.T])

    def _pushed(self, vector: Floats) -> Floats:
        """H times the eliminated part of `vector`, (dN,); only entries in eliminated rows and columns are touched."""
        rows, columns, values = self._fixed_triplets()
        out = np.zeros(self.pattern.size)
        column_fixed, row_fixed = self._fixed_mask[columns], self._fixed_mask[rows]
        np.add.at(out, rows[column_fixed], (values * vector[columns])[column_fixed])
        mirrored = row_fixed & (rows != columns)
        np.add.at(out, columns[mirrored], (values * vector[rows])[mirrored])
        return out

    def _reaction(self, vector: Floats) -> Floats:
        """(k d,) rows of H at the eliminated coordinates times `vector`."""
        rows, columns, values = self._fixed_triplets()
        out = np.zeros(self.pattern.size)
        row_fixed = self._fixed_mask[rows]
        np.add.at(out, rows[row_fixed], (values * vector[columns])[row_fixed])
        mirrored = self._fixed_mask[columns] & (rows != columns)
        np.add.at(out, columns[mirrored], (values * vector[rows])[mirrored])
        return out[self._fixed_coordinates]

    def _fixed_triplets(self) -> tuple[Integers, Integers, Floats]:
        entries = self._fixed_entries
        return self.pattern.rows[entries], self.pattern.columns[entries], self.hessian_values[entries]

    def serves(self, fixed: Integers) -> bool:
        """Whether there is a factor in which just the vertices `fixed` are eliminated."""
        return self._values is not None and np.array_equal(self._fixed, fixed)

    def forget(self) -> None:
        """The last factor belongs to another energy; do not use it again."""
        self._values = None
        self.kept_response = None

    def _set_fixed(self, fixed: Integers) -> None:
        if np.array_equal(self._fixed, fixed):
            return
        pattern, d = self.pattern, self.pattern.dimension
        self._fixed = fixed
        coordinates = (pattern.place[fixed][:, None] * d + np.arange(d)).reshape(-1)
        mask = np.zeros(pattern.size, dtype=bool)
        mask[coordinates] = True
        self._fixed_coordinates = coordinates
        self._fixed_mask = mask
        self._fixed_entries = np.flatnonzero(mask[pattern.rows] | mask[pattern.columns])

    def factorise(self, values: Floats, fixed: Integers, shifts: tuple[float, ...] = SHIFTS) -> None:
        """Factorise the Hessian `values` (nnz,), vertices `fixed` (k,) eliminated, its diagonal shifted as little as will do.

        Raises `SingularMatrixError` where none of the relative `shifts` will.
        """
        begin = time.perf_counter()
        self._values = None
        self.kept_response = None
        self._set_fixed(fixed)
        diagonal = self.pattern.diagonal
        scale = float(values[diagonal].max(initial=0.0))
        if not np.isfinite(scale) or scale <= 0.0:
            raise SingularMatrixError("the Hessian vanishes or is not finite")
        for shift in shifts:
            matrix = values.copy()
            matrix[diagonal] = np.maximum(matrix[diagonal] * (1.0 + shift), 1e-280 * scale + 1e-300)
            matrix[self._fixed_entries] = 0.0
            matrix[diagonal[self._fixed_coordinates]] = 1.0
            self.counts["factorise"] += 1
            try:
                self.solver.factorise(matrix)
                break
            except SingularMatrixError:
                if shift == shifts[-1]:
                    self.seconds["factorise"] += time.perf_counter() - begin
                    raise
        self._values = values
        self.factorised_at = time.perf_counter()
        self.last_factorisation_seconds = self.factorised_at - begin
        self.seconds["factorise"] += self.last_factorisation_seconds

    def solve(
        self,
        gradient: Floats,
        displacement: Floats | None = None,
        constraints: LinearConstraints | None = None,
        residual: Floats | None = None,
    ) -> Floats:
        """Direction d of (65): H d + A^T lambda = -gradient, A d = residual, d = displacement at the eliminated vertices.

        Parameters
        ----------
        gradient : (N, d) float64
        displacement : (k, d) float64      of the vertices eliminated in `factorise`; zero where None
        constraints, residual              rows A and b - A x, where there are any

        Returns
        -------
        (N, d) float64
        """
        begin = time.perf_counter()
        assert self._values is not None
        pattern = self.pattern
        rhs = -pattern.to_matrix_order(gradient)
        if displacement is not None and displacement.any():
            moved = np.zeros(pattern.size)
            moved[self._fixed_coordinates] = displacement.reshape(-1)
            rhs -= self._pushed(moved)
            rhs[self._fixed_coordinates] = displacement.reshape(-1)
        else:
            rhs[self._fixed_coordinates] = 0.0
        direction = self.solver.solve(rhs)
        if constraints is not None and residual is not None and len(residual):
            direction = self._constrained(direction, constraints, residual)
        self.counts["solve"] += 1
        self.seconds["solve"] += time.perf_counter() - begin
        return pattern.from_matrix_order(direction)

    def _constrained(self, free: Floats, constraints: LinearConstraints, residual: Floats) -> Floats:
        """Correct the direction that ignores A by the Schur complement of (65)."""
        pattern, d = self.pattern, self.pattern.dimension
        order = (pattern.order[:, None] * d + np.arange(d)).reshape(-1)
        rows = constraints.matrix[:, order].toarray().T
        own = rows.copy()
        own[self._fixed_coordinates] = 0.0  # eliminated coordinates do not move any further
        response = self.solver.solve(own)
        response[self._fixed_coordinates] = 0.0
        schur = rows.T @ response
        try:
            multipliers = np.linalg.solve(schur, rows.T @ free - residual)
        except np.linalg.LinAlgError:
            raise SingularMatrixError("the linear constraints depend on each other or on the anchors") from None
        result: Floats = free - response @ multipliers
        return result
