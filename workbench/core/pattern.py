"""The fixed sparsity pattern of the Hessian: built once a mesh, in a fill-reducing order of the vertices."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numba
import numpy as np
import scipy

from workbench.core.arrays import Floats, Integers
from workbench.core.cholmod_library import load_cvxopt


@dataclass(frozen=True, eq=False)
class HessianPattern:
    """Lower triangle by columns, in the order of elimination; coordinates of a vertex stay together.

    Parameters
    ----------
    dimension : int               d, coordinates a vertex
    order : (N,) int64            vertex at each place of the order
    place : (N,) int64            place of each vertex
    column_starts : (dN + 1,)     int64
    rows : (nnz,) int64           row of each entry, ascending in a column
    slots : (m, k) int32          entry of each upper-triangular value of a simplex's Hessian block, row by row
    """

    dimension: int
    order: Integers
    place: Integers
    column_starts: Integers
    rows: Integers
    slots: np.ndarray

    @property
    def size(self) -> int:
        return len(self.column_starts) - 1

    @property
    def entry_count(self) -> int:
        return len(self.rows)

    @cached_property
    def columns(self) -> Integers:
        """(nnz,) int64: column of each entry."""
        return np.repeat(np.arange(self.size), np.diff(self.column_starts))

    @cached_property
    def diagonal(self) -> Integers:
        """(dN,) int64: entry of each diagonal value (the first of its column)."""
        return self.column_starts[:-1]

    def to_matrix_order(self, values: Floats) -> Floats:
        """(N, d) by vertex -> (dN,) in the order of the matrix."""
        out = np.empty(self.size)
        _gather_rows(np.ascontiguousarray(values), self.order, out.reshape(-1, self.dimension))
        return out

    def from_matrix_order(self, values: Floats) -> Floats:
        """(dN,) in the order of the matrix -> (N, d) by vertex."""
        out = np.empty((len(self.order), self.dimension))
        _gather_rows(np.ascontiguousarray(values).reshape(-1, self.dimension), self.place, out)
        return out

    def matrix(self, values: Floats) -> scipy.sparse.csc_matrix:
        """The full symmetric matrix by vertex (coordinates of a vertex together), for tests and other solvers."""
        d = self.dimension
        dof = (self.order[:, None] * d + np.arange(d)).reshape(-1)
        rows, columns = dof[self.rows], dof[self.columns]
        lower = scipy.sparse.coo_matrix((values, (rows, columns)), shape=(self.size, self.size))
        off = rows != columns
        upper = scipy.sparse.coo_matrix((values[off], (columns[off], rows[off])), shape=(self.size, self.size))
        return scipy.sparse.csc_matrix(lower + upper)

    def multiply(self, values: Floats, vector: Floats) -> Floats:
        """Symmetric product, (dN,) in and out in the order of the matrix."""
        out = np.zeros(self.size)
        _symmetric_product(self.column_starts, self.rows, values, np.ascontiguousarray(vector), out)
        return out


def vertex_graph(simplices: Integers, vertex_count: int) -> scipy.sparse.csr_matrix:
    """Symmetric adjacency (n, n) of the vertices of simplices (m, k), pattern only; indices sorted, no diagonal."""
    width = simplices.shape[1]
    pairs = [(a, b) for a in range(width) for b in range(width) if a != b]
    rows = np.concatenate([simplices[:, a] for a, _ in pairs])
    columns = np.concatenate([simplices[:, b] for _, b in pairs])
    graph = scipy.sparse.csr_matrix((np.ones(len(rows), dtype=np.int8), (rows, columns)), shape=(vertex_count, vertex_count))
    graph.sum_duplicates()
    graph.sort_indices()
    return graph


def elimination_order(graph: scipy.sparse.csr_matrix) -> Integers:
    """Nested dissection of the vertices by METIS, (n,), or minimum degree where METIS is missing."""
    try:
        import pymetis

        order, _ = pymetis.nested_dissection(pymetis.CSRAdjacency(graph.indptr, graph.indices))
        result = np.asarray(order, dtype=np.int64)
    except ImportError:
        result = _minimum_degree_order(graph)
    return result


def _minimum_degree_order(graph: scipy.sparse.csr_matrix) -> Integers:
    try:
        cvxopt = load_cvxopt()
        coordinates = scipy.sparse.coo_matrix(graph + scipy.sparse.identity(graph.shape[0], format="csr"))
        lower = coordinates.row >= coordinates.col
        matrix = cvxopt.spmatrix(1.0, coordinates.row[lower].tolist(), coordinates.col[lower].tolist(), graph.shape, tc="d")
        return np.array(cvxopt.amd.order(matrix, "L"), dtype=np.int64).reshape(-1)
    except ImportError:
        return np.asarray(scipy.sparse.csgraph.reverse_cuthill_mckee(graph, symmetric_mode=True), dtype=np.int64)


def build_pattern(simplices: Integers, vertex_count: int, dimension: int, order: Integers | None = None) -> HessianPattern:
    """Pattern of the Hessian of any energy on these simplices. Cost: O(m), and one ordering where `order` is None."""
    graph = vertex_graph(simplices, vertex_count)
    if order is None:
        order = elimination_order(graph)
    place = np.empty(vertex_count, dtype=np.int64)
    place[order] = np.arange(vertex_count)

    coordinates = graph.tocoo()
    block_row, block_column = place[coordinates.row], place[coordinates.col]
    below = block_row > block_column
    diagonal = np.arange(vertex_count)
    keys = np.concatenate([block_column[below], diagonal]) * vertex_count + np.concatenate([block_row[below], diagonal])
    keys.sort()
    block_columns, block_rows = keys // vertex_count, keys % vertex_count
    block_starts = np.searchsorted(block_columns, np.arange(vertex_count + 1))
    block_counts = np.diff(block_starts)

    d = dimension
    lengths = d * block_counts[:, None] - np.arange(d)  # entries in each of the d columns of a vertex
    column_starts = np.concatenate([[0], np.cumsum(lengths.reshape(-1))])
    rows = np.empty(int(column_starts[-1]), dtype=np.int64)
    rank = np.arange(len(keys)) - block_starts[block_columns]  # place of a block in its block column
    on_diagonal = rank == 0
    for c in range(d):
        base = column_starts[block_columns * d + c]
        for i in range(d):
            entry = base + d * rank + i - c
            use = ~on_diagonal if i < c else slice(None)
            rows[entry[use]] = block_rows[use] * d + i

    slots = _slots(simplices, place, keys, block_starts, column_starts, vertex_count, d)
    return HessianPattern(d, order, place, column_starts, rows, slots)


def _slots(
    simplices: Integers,
    place: Integers,
    keys: Integers,
    block_starts: Integers,
    column_starts: Integers,
    vertex_count: int,
    d: int,
) -> np.ndarray:
    corners = place[simplices]
    width = simplices.shape[1]
    slots = np.empty((len(simplices), width * d * (width * d + 1) // 2), dtype=np.int32)
    ranks = {}
    for a in range(width):
        for b in range(a, width):
            row, column = np.maximum(corners[:, a], corners[:, b]), np.minimum(corners[:, a], corners[:, b])
            ranks[a, b] = np.searchsorted(keys, column * vertex_count + row) - block_starts[column]
    slot = 0
    for p in range(width * d):
        for q in range(p, width * d):
            (a, i), (b, j) = divmod(p, d), divmod(q, d)
            a_below = corners[:, a] > corners[:, b]
            if a == b:
                column, i_row, j_column = corners[:, a], max(i, j), min(i, j)
                slots[:, slot] = column_starts[column * d + j_column] + i_row - j_column
            else:
                # the vertex that comes later in the order gives the row
                column = np.where(a_below, corners[:, b], corners[:, a])
                j_columns = np.where(a_below, j, i)
                i_rows = np.where(a_below, i, j)
                slots[:, slot] = column_starts[column * d + j_columns] + d * ranks[a, b] + i_rows - j_columns
            slot += 1
    return slots


@numba.njit(nogil=True, cache=True)
def _symmetric_product(column_starts, rows, values, x, out):  # type: ignore[no-untyped-def]
    for j in range(column_starts.shape[0] - 1):
        start = column_starts[j]
        xj = x[j]
        total = values[start] * xj
        for k in range(start + 1, column_starts[j + 1]):
            i = rows[k]
            out[i] += values[k] * xj
            total += values[k] * x[i]
        out[j] += total


@numba.njit(nogil=True, cache=True)
def _gather_rows(values, rows, out):  # type: ignore[no-untyped-def]
    """out[i] = values[rows[i]]: several times faster than indexing with an array when rows are short."""
    for i in range(rows.shape[0]):
        row = rows[i]
        for c in range(out.shape[1]):
            out[i, c] = values[row, c]
