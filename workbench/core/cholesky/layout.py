"""Where every number of a factor goes: arrays that compiled kernels take as one argument."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from workbench.core.arrays import Integers


class Layout(NamedTuple):
    """Coordinates are numbered in postorder; s supernodes. A panel holds all rows of a supernode's columns, by columns.

    Parameters
    ----------
    first : (s + 1,) int64           first column of each supernode
    row_starts : (s + 1,) int64      into `rows` and `in_parent`
    rows : (r,) uint32               rows of each supernode, its own columns first, ascending
    in_parent : (r,) uint32          place of a row among those of the parent; 0 for own columns and at roots
    panel_starts : (s + 1,) int64    into the factor
    children_starts, children        children of each supernode, ascending
    entry_starts : (s + 1,) int64    into `entries` and `targets`
    entries : (nnz,) int32           entries of the matrix, by supernode
    targets : (nnz,) int64           where each of them goes in the factor
    update_starts : (s,) int64       where the update matrix that a supernode leaves to its parent lies in the workspace
    scratch_starts : (s,) int64      where it is made, clear of those of the children
    """

    first: Integers
    row_starts: Integers
    rows: np.ndarray
    in_parent: np.ndarray
    panel_starts: Integers
    children_starts: Integers
    children: Integers
    entry_starts: Integers
    entries: np.ndarray
    targets: Integers
    update_starts: Integers
    scratch_starts: Integers
