"""Anchors (55) and linear constraints (58)."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import scipy

from workbench.core.arrays import Booleans, Floats, Integers, frozen
from workbench.core.errors import WorkbenchError

LARGEST_WEIGHT = 1e12
"""Of a soft anchor: beyond it the penalty drowns the distortion in rounding; such an anchor is a hard one."""
INDEPENDENT = 1e-10
"""Part of the length of a row that has to be left beyond the rows before it, or they say the same."""
CONTRADICTION = 1e-6
"""Part of its size by which a value has to differ from what the rows before it make of it: less may be rounding."""


@dataclass(frozen=True, eq=False)
class Anchors:
    """Vertices that are held at targets.

    Parameters
    ----------
    vertices : (k,) int64      each at most once
    targets : (k, d) float64
    weights : (k,) float64     inf is hard (the default), finite is the penalty weight |x - target|^2
    groups : (k,) int64        anchors of one number turn together on their way; -1 (the default): those that edges join do
    """

    vertices: Integers
    targets: Floats
    weights: Floats = None  # type: ignore[assignment]
    groups: Integers = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        vertices = frozen(np.asarray(self.vertices).reshape(-1), np.int64)
        weights = np.full(len(vertices), np.inf) if self.weights is None else np.asarray(self.weights)
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "targets", frozen(self.targets))
        object.__setattr__(self, "weights", frozen(weights.reshape(-1)))
        groups = np.full(len(vertices), -1) if self.groups is None else np.asarray(self.groups)
        object.__setattr__(self, "groups", frozen(groups.reshape(-1), np.int64))
        targets = self.targets
        if targets.ndim != 2 or len(targets) != len(vertices) or len(self.weights) != len(vertices):
            raise WorkbenchError(
                f"Anchors: {len(vertices)} vertices, targets of shape {targets.shape}; one row a vertex is needed."
            )
        if len(self.groups) != len(vertices):
            raise WorkbenchError(f"Anchors: {len(vertices)} vertices, {len(self.groups)} groups; one number each is needed.")
        if not np.isfinite(targets).all():
            raise WorkbenchError("Anchors: a target is not a finite number.")
        if len(np.unique(vertices)) != len(vertices):
            raise WorkbenchError("Anchors: a vertex is named twice.")
        if (self.weights < 0).any() or np.isnan(self.weights).any():
            raise WorkbenchError("Anchors: weights are positive numbers, inf for hard anchors.")

    @staticmethod
    def none(dimension: int) -> Anchors:
        """No anchors."""
        return Anchors(np.empty(0, dtype=np.int64), np.empty((0, dimension)))

    def check(self, vertex_count: int, dimension: int) -> None:
        """Raises `WorkbenchError` where they do not fit a map of `vertex_count` vertices in `dimension` columns."""
        if len(self.vertices) and (self.vertices.min() < 0 or self.vertices.max() >= vertex_count):
            bad = self.vertices[(self.vertices < 0) | (self.vertices >= vertex_count)][0]
            raise WorkbenchError(f"Anchors: vertex {bad} does not exist; the mesh has vertices 0 to {vertex_count - 1}.")
        if self.targets.shape[1] != dimension:
            raise WorkbenchError(f"Anchors: targets have {self.targets.shape[1]} coordinates, the map has {dimension}.")

    @cached_property
    def _hard(self) -> Booleans:
        return np.isinf(self.weights)

    @cached_property
    def hard_vertices(self) -> Integers:
        return frozen(self.vertices[self._hard], np.int64)

    @cached_property
    def hard_targets(self) -> Floats:
        return frozen(self.targets[self._hard])

    @cached_property
    def hard_groups(self) -> Integers:
        return frozen(self.groups[self._hard], np.int64)

    @cached_property
    def soft(self) -> tuple[Integers, Floats, Floats]:
        """Vertices, targets and weights of the soft ones."""
        chosen = ~self._hard & (self.weights > 0)
        return self.vertices[chosen], self.targets[chosen], self.weights[chosen]

    def error(self, positions: Floats) -> float:
        """Largest distance of a hard anchor from its target, 0 without any."""
        if not len(self.hard_vertices):
            return 0.0
        return float(np.linalg.norm(positions[self.hard_vertices] - self.hard_targets, axis=1).max())

    def with_added(self, vertices: Integers, targets: Floats) -> Anchors:
        """These and further hard ones; a vertex that is an anchor already keeps its target."""
        new = ~np.isin(vertices, self.vertices)
        return Anchors(
            np.concatenate([self.vertices, vertices[new]]),
            np.concatenate([self.targets, targets[new]]),
            np.concatenate([self.weights, np.full(int(new.sum()), np.inf)]),
            np.concatenate([self.groups, np.full(int(new.sum()), -1)]),
        )


@dataclass(frozen=True, eq=False)
class LinearConstraints:
    """A x = b on the coordinates, vertex by vertex.

    Parameters
    ----------
    matrix : (p, n d) sparse or dense     solvers take those of its rows that are independent (see there)
    values : (p,) float64
    """

    matrix: scipy.sparse.csr_matrix
    values: Floats
    _kept: list[tuple[Integers, LinearConstraints]] = field(default_factory=list, init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "matrix", scipy.sparse.csr_matrix(self.matrix, dtype=np.float64))
        object.__setattr__(self, "values", frozen(np.asarray(self.values).reshape(-1)))
        if self.matrix.shape[0] != len(self.values):
            raise WorkbenchError(f"Linear constraints: {self.matrix.shape[0]} rows, {len(self.values)} values.")

    def residual(self, positions: Floats) -> Floats:
        """b - A x, (p,)."""
        result: Floats = self.values - self.matrix @ positions.reshape(-1)
        return result

    def independent(self, held: Integers, dimension: int) -> LinearConstraints:
        """The rows that say something new once the vertices `held` stand still; kept until these change."""
        if not self._kept or not np.array_equal(self._kept[0][0], held):
            rows, _ = self._split((held[:, None] * dimension + np.arange(dimension)).reshape(-1))
            every = len(rows) == len(self.values)
            self._kept[:] = [(held.copy(), self if every else LinearConstraints(self.matrix[rows], self.values[rows]))]
        return self._kept[0][1]

    def first_contradiction(self) -> tuple[int, float] | None:
        """The first row that those before it fix to another value than its own, and what they fix it to; None where none is."""
        lengths = np.maximum(scipy.sparse.linalg.norm(self.matrix, axis=1), np.finfo(float).tiny)
        units, values = scipy.sparse.diags(1.0 / lengths) @ self.matrix, self.values / lengths
        residual = scipy.sparse.linalg.lsmr(units, values, atol=1e-12, btol=1e-12, maxiter=4 * len(values))[3]
        if residual <= 0.1 * CONTRADICTION * np.linalg.norm(values):
            return None  # something solves them all; telling which rows depend on which takes far longer
        rows, misses = self._split(np.empty(0, dtype=np.int64))
        wrong = np.setdiff1d(np.flatnonzero(np.abs(misses) > CONTRADICTION), rows)
        if not len(wrong):
            return None
        first = int(wrong[0])
        # Told by rows of its own length: the answer is the one of the least norm that the rows before it allow.
        answer = scipy.sparse.linalg.lsmr(self.matrix[:first], self.values[:first], atol=1e-14, btol=1e-14)[0]
        return first, float((self.matrix[first] @ answer)[0])

    def _split(self, still: Integers) -> tuple[Integers, Floats]:
        """The independent rows, and (p,) how far the value of each is from what the ones before it make of it, to their size.

        By Gram and Schmidt, twice for each row: what is left of it beyond those before is rounding, or news. Coordinates that
        stand still count as 0.
        """
        free = np.ones(self.matrix.shape[1])
        free[still] = 0.0
        lengths = scipy.sparse.linalg.norm(self.matrix, axis=1)
        moving = scipy.sparse.csr_matrix(self.matrix @ scipy.sparse.diags(free))
        rows = moving[:, np.unique(moving.indices)].toarray()
        basis = np.empty_like(rows)
        heights = np.empty(len(rows))
        misses = np.zeros(len(rows))
        found: list[int] = []
        for index, row in enumerate(rows):
            before, reached = basis[: len(found)], heights[: len(found)]
            value = self.values[index]
            for _ in range(2):
                parts = before @ row
                row = row - before.T @ parts
                value -= parts @ reached
            left = float(np.linalg.norm(row))
            if left > INDEPENDENT * lengths[index]:
                basis[len(found)] = row / left
                heights[len(found)] = value / left
                found.append(index)
            elif value:
                misses[index] = value / (abs(self.values[index]) + lengths[index] * np.abs(reached).max(initial=0.0))
        return np.array(found, dtype=np.int64), misses

    def tangential(self, direction: Floats, held: Integers, inverse_metric: Floats | None = None) -> Floats:
        """The part of `direction` (n, d) that keeps A x, with the vertices `held` not moving at all.

        inverse_metric : (n, d) float64      of the diagonal metric in which that part is the nearest; None: the Euclidean one
        """
        free = np.ones(direction.shape)
        free[held] = 0.0
        flat = direction.reshape(-1)
        rows = self.matrix @ scipy.sparse.diags(free.reshape(-1))
        corrections = rows if inverse_metric is None else rows @ scipy.sparse.diags(inverse_metric.reshape(-1))
        multipliers = np.linalg.lstsq((rows @ corrections.T).toarray(), rows @ flat, rcond=None)[0]
        result: Floats = (flat - corrections.T @ multipliers).reshape(direction.shape)
        return result
