"""A verdict on a map, with what is to blame in a form that can be listed, marked and zoomed to."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import combinations
from typing import Literal

import numpy as np

from workbench.core.arrays import Integers
from workbench.core.mesh import Mesh

OffenderKind = Literal["inverted", "degenerate", "vertices", "edges", "boundary"]

_NONE = np.empty(0, dtype=np.int64)
_NO_EDGES = np.empty((0, 2), dtype=np.int64)
_NO_PAIRS = np.empty((0, 2, 2), dtype=np.int64)


@dataclass(frozen=True, eq=False)
class Offenders:
    """What is to blame, of one kind.

    Parameters
    ----------
    kind : str         inverted, degenerate: simplices; vertices, edges: whose stars overlap; boundary: pairs that meet
    label : str        the kind in words, plural
    indices : int64    (k,) simplices or vertices, (k, 2) vertices of edges, (k, 2, n) vertices of pairs of boundary facets
    """

    kind: OffenderKind
    label: str
    indices: Integers

    def __len__(self) -> int:
        return len(self.indices)

    def vertices(self, mesh: Mesh, row: int) -> Integers:
        """Vertices (c,) of one offender: where to look."""
        if self.kind in ("inverted", "degenerate"):
            return mesh.simplices[self.indices[row]]
        return np.unique(self.indices[row])

    def simplices(self, mesh: Mesh) -> Integers:
        """Simplices (s,) to mark: those at fault, those of the star of a vertex or an edge, those along the boundary."""
        if self.kind in ("inverted", "degenerate"):
            return self.indices
        # a star of a vertex has all simplices with that vertex, a star of an edge those with both, and so on
        corners = self.indices.reshape(-1, 1) if self.kind == "vertices" else self.indices.reshape(-1, self.indices.shape[-1])
        rows = np.unique(np.sort(corners, axis=1), axis=0)
        is_named = np.zeros(mesh.vertex_count, dtype=bool)
        is_named[rows.ravel()] = True
        candidates = np.flatnonzero(is_named[mesh.simplices].sum(axis=1) >= rows.shape[1])
        found = np.zeros(len(candidates), dtype=bool)
        wanted = {tuple(row) for row in rows.tolist()}
        for columns in combinations(range(mesh.simplices.shape[1]), rows.shape[1]):
            sides = np.sort(mesh.simplices[candidates][:, list(columns)], axis=1)
            found |= np.fromiter((tuple(side) in wanted for side in sides.tolist()), dtype=bool, count=len(sides))
        return candidates[found]


@dataclass(frozen=True, eq=False)
class Verdict:
    """Whether a map is injective, why not, and what is to blame.

    Parameters
    ----------
    holds : bool or None                  None where it cannot be told
    reason : str                          one sentence
    inverted : (k,) int64                 simplices that are turned over, compared with the source
    degenerate : (k,) int64               simplices of exactly no area or volume
    vertices : (k,) int64                 vertices whose star overlaps itself
    edges : (k, 2) int64                  with two triangles on one side, or wound round more than once by tetrahedra
    boundary_pairs : (k, 2, n) int64      pairs of boundary edges (triangles) that meet wrongly
    """

    holds: bool | None
    reason: str
    inverted: Integers = field(default_factory=lambda: _NONE)
    degenerate: Integers = field(default_factory=lambda: _NONE)
    vertices: Integers = field(default_factory=lambda: _NONE)
    edges: Integers = field(default_factory=lambda: _NO_EDGES)
    boundary_pairs: Integers = field(default_factory=lambda: _NO_PAIRS)

    @property
    def offenders(self) -> tuple[Offenders, ...]:
        """Everything to blame, kind by kind; kinds without any are left out.

        A map that is mirrored as a whole has inverted simplices, but these are not to blame for anything.
        """
        overlaps = len(self.vertices) or len(self.edges) or len(self.boundary_pairs)
        kinds: tuple[tuple[OffenderKind, str, Integers], ...] = (
            ("inverted", "inverted simplices", _NONE if self.holds or overlaps else self.inverted),
            ("degenerate", "degenerate simplices", self.degenerate),
            ("vertices", "vertices whose star overlaps itself", self.vertices),
            ("edges", "edges whose star overlaps itself", self.edges),
            ("boundary", "pairs of boundary facets that meet", self.boundary_pairs),
        )
        return tuple(Offenders(kind, label, indices) for kind, label, indices in kinds if len(indices))
