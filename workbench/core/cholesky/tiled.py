"""The dense steps of a large supernode, cut into tiles that the threads share."""

from __future__ import annotations

from workbench.core.arrays import Floats
from workbench.core.cholesky.kernels import factor_tile, has_finite_diagonal, solve_tile, subtract_tile
from workbench.core.cholesky.routines import dense_routines
from workbench.core.threads import over_pieces

TILE = 128
"""Columns a tile; tiles do not depend on the number of threads, and so neither do the results."""
STRIP = 512
"""Rows that one thread solves for at a time."""


def eliminate_columns(factor: Floats, panel: int, columns: int, height: int) -> bool:
    """Cholesky factor of the top `columns` x `columns` of a panel (`height` rows) at `factor[panel]`, and the rows below it.

    Panels stand one after another in `factor` (entries,), each column by column. False where a pivot is not positive and
    finite.
    """
    routines = dense_routines()
    base = factor.ctypes.data + 8 * panel

    def at(row: int, column: int) -> int:
        return base + 8 * (column * height + row)

    for begin in range(0, columns, TILE):
        end = min(begin + TILE, columns)
        width = end - begin
        if factor_tile(routines, width, at(begin, begin), height) != 0:
            return False
        if not has_finite_diagonal(factor, panel + begin * (height + 1), width, height):
            return False

        def solve(row: int, begin: int = begin, width: int = width) -> None:
            rows = min(STRIP, height - row)
            solve_tile(routines, rows, width, at(begin, begin), height, at(row, begin), height)

        def update(column: int, begin: int = begin, width: int = width) -> None:
            wide, tall = min(TILE, columns - column), height - column
            source, target = at(column, begin), at(column, column)
            subtract_tile(routines, tall, wide, width, source, height, source, height, 1, target, height)

        over_pieces(solve, range(end, height, STRIP))
        over_pieces(update, range(end, columns, TILE))
    return True


def update_matrix(factor: Floats, panel: int, columns: int, height: int, workspace: Floats, scratch: int) -> None:
    """The lower triangle of -B B^T into `workspace[scratch]`, B the rows of the panel below its first `columns`.

    `factor` is as for `eliminate_columns`; the result (height - columns, height - columns) stands column by column.
    """
    routines = dense_routines()
    below = height - columns
    source, target = factor.ctypes.data + 8 * (panel + columns), workspace.ctypes.data + 8 * scratch

    def square(column: int) -> None:
        wide, tall = min(TILE, below - column), below - column
        rows, corner = source + 8 * column, target + 8 * column * (below + 1)
        subtract_tile(routines, tall, wide, columns, rows, height, rows, height, 0, corner, below)

    over_pieces(square, range(0, below, TILE))
