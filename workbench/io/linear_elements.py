"""Elements of higher order made linear: their corners stay, the vertices between them go."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from workbench.core.arrays import Integers
from workbench.core.mesh import Mesh
from workbench.core.nouns import count_of

CORNERS = {"triangle": 3, "quad": 4, "tetra": 4}
"""Corners of the elements that have kinds of higher order, as `tetra10`; in every one of these the corners come first."""

Blocks = list[tuple[str, Any]]
"""Kind of element, and a row of vertices an element."""


def is_of_higher_order(kind: str) -> bool:
    """Whether these elements have vertices beside their corners."""
    return kind not in CORNERS and _linear_kind(kind) in CORNERS


def linear_blocks(blocks: Blocks) -> tuple[Blocks, Integers]:
    """`blocks` with linear elements in the place of those of higher order, and the vertices that these had beside."""
    linear, inner = [], [np.empty(0, dtype=np.int64)]
    for kind, data in blocks:
        if is_of_higher_order(kind):
            kind = _linear_kind(kind)
            table = np.asarray(data)
            data, between = table[:, : CORNERS[kind]], table[:, CORNERS[kind] :]
            inner.append(between.astype(np.int64).ravel())
        linear.append((kind, data))
    return linear, np.unique(np.concatenate(inner))


def without_inner_vertices(mesh: Mesh, inner: Integers) -> tuple[Mesh, str]:
    """`mesh` without those of the vertices `inner` that no simplex uses, and a note; the others keep their order."""
    dropped = np.zeros(mesh.vertex_count, dtype=bool)
    dropped[inner[(inner >= 0) & (inner < mesh.vertex_count)]] = True
    dropped[mesh.simplices] = False
    number = np.cumsum(~dropped) - 1
    note = f"Elements of higher order were made linear; {count_of(int(dropped.sum()), 'vertex')} between corners dropped."
    return replace(mesh, vertices=mesh.vertices[~dropped], simplices=number[mesh.simplices]), note


def _linear_kind(kind: str) -> str:
    return kind.rstrip("0123456789")
