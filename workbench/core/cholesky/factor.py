"""The numeric factor: subtrees side by side on the threads, what is above them with all threads at each dense step."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.cholesky.analysis import SymbolicFactor
from workbench.core.cholesky.kernels import assemble_panel, factor_supernodes, pass_on, solve_backward, solve_forward
from workbench.core.cholesky.routines import dense_routines, one_dense_thread
from workbench.core.cholesky.tiled import eliminate_columns, update_matrix
from workbench.core.threads import over_pieces

LINE = 8
"""Numbers in a cache line."""
LITTLE_FACTOR = 3_000_000
"""Numbers of a factor up to which one thread solves."""
SMALL = 384
"""Rows up to which the dense steps of a supernode are not worth sharing."""


class NotPositiveDefiniteError(ArithmeticError):
    """A pivot was not positive, or not finite."""


class CholeskyFactor:
    """L with P A P^T = L L^T. Its arrays are made once and written anew by every `factorise`."""

    def __init__(self, symbolic: SymbolicFactor) -> None:
        self.symbolic = symbolic
        self._factor = _aligned(symbolic.factor_size)
        self._workspace = _aligned(symbolic.workspace_size)
        self._subtrees = [(int(begin), int(end)) for begin, end in symbolic.subtrees]
        # What a solve takes in parts: all at once where sharing costs more than it saves.
        is_little = symbolic.factor_size < LITTLE_FACTOR
        self._pieces = [np.arange(begin, end) for begin, end in symbolic.subtrees] if not is_little else []
        self._last = symbolic.top if not is_little else np.arange(len(symbolic.layout.first) - 1)

    def factorise(self, values: Floats) -> None:
        """Factorise; (nnz,) values on the pattern. Raises `NotPositiveDefiniteError`."""
        layout, factor, workspace = self.symbolic.layout, self._factor, self._workspace

        def subtree(piece: tuple[int, int]) -> bool:
            return bool(factor_supernodes(*piece, layout, dense_routines(), values, factor, workspace))

        with one_dense_thread():
            fine = all(over_pieces(subtree, self._subtrees)) and all(
                self._eliminate(node, values) for node in self.symbolic.top
            )
        if not fine:
            raise NotPositiveDefiniteError("a pivot is not positive")

    def _eliminate(self, node: int, values: Floats) -> bool:
        """One supernode; the dense steps of a large one are shared by the threads."""
        layout, factor, workspace = self.symbolic.layout, self._factor, self._workspace
        panel = int(layout.panel_starts[node])
        columns = int(layout.first[node + 1] - layout.first[node])
        height = int(layout.row_starts[node + 1] - layout.row_starts[node])
        if height <= SMALL:
            return bool(factor_supernodes(node, node + 1, layout, dense_routines(), values, factor, workspace))
        assemble_panel(node, layout, values, factor, workspace)
        if not eliminate_columns(factor, panel, columns, height):
            return False
        if height > columns:
            update_matrix(factor, panel, columns, height, workspace, int(layout.scratch_starts[node]))
            pass_on(node, layout, workspace)
        return True

    def solve(self, rhs: Floats) -> Floats:
        """Solution of A x = rhs; (N,) or (N, k), a new array. Needs a factorisation."""
        s = self.symbolic
        x = np.ascontiguousarray(rhs.reshape(s.size, -1)[s.order].T)
        spare: list[Floats] = []

        def forward(supernodes: Integers) -> Floats:
            above = spare.pop() if spare else np.zeros_like(x)
            solve_forward(supernodes, s.layout, self._factor, x, above)
            rows = self._rows_above(supernodes[-1])
            asked: Floats = above[:, rows]
            above[:, rows] = 0.0
            spare.append(above)
            return asked

        def backward(supernodes: Integers) -> None:
            solve_backward(supernodes, s.layout, self._factor, x)

        asked = over_pieces(forward, self._pieces)
        above = spare.pop() if spare else np.zeros_like(x)
        for supernodes, values in zip(self._pieces, asked, strict=True):  # in this order whoever was first
            above[:, self._rows_above(supernodes[-1])] += values
        solve_forward(self._last, s.layout, self._factor, x, above)
        backward(self._last)
        over_pieces(backward, self._pieces)
        result = np.empty((s.size, len(x)))
        result[s.order] = x.T
        return result.reshape(rhs.shape)

    def _rows_above(self, supernode: int) -> np.ndarray:
        layout = self.symbolic.layout
        columns = layout.first[supernode + 1] - layout.first[supernode]
        return layout.rows[layout.row_starts[supernode] + columns : layout.row_starts[supernode + 1]]


def _aligned(size: int) -> Floats:
    """At a multiple of a cache line, wherever: routines may sum in another order for another alignment."""
    memory = np.empty(size + LINE)
    offset = -memory.ctypes.data // memory.itemsize % LINE
    return memory[offset : offset + size]
