"""Vertices in colours: those of one colour share no simplex, so that each may go down on its own."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numba
import numpy as np

from workbench.core.arrays import Booleans, Floats, Integers
from workbench.core.energy import Energy
from workbench.core.jacobians import Elements, determinants, signed_singular_values
from workbench.core.pattern import vertex_graph


@dataclass(frozen=True, eq=False)
class VertexBlock:
    """Vertices of one colour and the simplices round them.

    Parameters
    ----------
    vertices : (b,) int64      ascending
    simplices : (t,) int64     rows of the source's simplices, those of one vertex after those of another
    owners : (t,) int64        place in `vertices` of the one vertex that each of them has
    elements : Elements        these simplices alone
    """

    vertices: Integers
    simplices: Integers
    owners: Integers
    elements: Elements

    def narrowed(self, chosen: Booleans) -> VertexBlock:
        """The same block with the simplices of some of its vertices (b,) only; the others have no energy in it."""
        rows = np.flatnonzero(chosen[self.owners])
        return VertexBlock(self.vertices, self.simplices[rows], self.owners[rows], _part(self.elements, rows))

    def energies(self, density: Energy, positions: Floats, strict: bool) -> Floats:
        """(b,) energy of each vertex's own simplices; inf where one is inverted that must not be: any where `strict`."""
        sigma = signed_singular_values(self.elements, positions)
        columns = np.abs(sigma)
        kept = density.kept[self.simplices] if len(density.kept) else np.ones(len(sigma))
        if density.distortion.looks_at_start:
            columns = np.column_stack([columns, kept])
        tape = density.distortion.compiled(self.elements.dimension).value
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            values = tape.evaluate(columns)[:, 0] * self.elements.rest_measures
        inverted = ~(sigma[:, -1] > 0)
        if strict:
            values[inverted] = np.inf
        elif density.has_barrier:
            values[inverted & (kept > 0.5)] = np.inf
        values[np.isnan(values)] = np.inf
        return np.asarray(np.bincount(self.owners, values, len(self.vertices)), dtype=np.float64)

    def gradients(self, density: Energy, positions: Floats) -> Floats:
        """(b, d) gradient of the energy by each vertex."""
        kept = density.kept[self.simplices] if len(density.kept) else density.kept
        part = replace(density, elements=self.elements, kept=kept)
        return part.gradient(positions).gradient[self.vertices]

    def largest_steps(self, positions: Floats, direction: Floats) -> Floats:
        """(b,) part of `direction` (b, d) that each vertex may go before one of its own simplices inverts; inf where none does.

        With one vertex moving, the content of a simplex is linear in the step.
        """
        moved = positions.copy()
        moved[self.vertices] += direction
        before = determinants(self.elements, positions)
        after = determinants(self.elements, moved)
        shrinks = (before > 0.0) & (after < before)
        steps = np.full(len(self.vertices), np.inf)
        np.minimum.at(steps, self.owners[shrinks], before[shrinks] / (before[shrinks] - after[shrinks]))
        return steps


def _part(elements: Elements, rows: Integers) -> Elements:
    return Elements(elements.simplices[rows], elements.inverse_rest[rows], elements.rest_measures[rows], elements.vertex_count)


def vertex_blocks(elements: Elements) -> tuple[VertexBlock, ...]:
    """All vertices of the source that have a simplex, by colour; greedy, in the order of the vertices. Cost: O(m)."""
    simplices, count = elements.simplices, elements.vertex_count
    graph = vertex_graph(simplices, count)
    colours = np.full(count, -1, dtype=np.int64)
    colour_count = _colour(graph.indptr.astype(np.int64), graph.indices.astype(np.int64), colours)
    corner_colours = colours[simplices]
    blocks = []
    for colour in range(colour_count):
        rows, corners = np.nonzero(corner_colours == colour)
        own = simplices[rows, corners]
        order = np.argsort(own, kind="stable")
        vertices, owners = np.unique(own[order], return_inverse=True)
        if len(vertices):
            blocks.append(VertexBlock(vertices, rows[order], owners.astype(np.int64), _part(elements, rows[order])))
    return tuple(blocks)


@numba.njit(nogil=True, cache=True)
def _colour(starts, neighbours, colours):  # type: ignore[no-untyped-def]
    """Give each vertex the smallest colour that no neighbour has; returns how many there are."""
    taken = np.full(colours.shape[0] + 1, -1, dtype=np.int64)
    count = 0
    for v in range(colours.shape[0]):
        for k in range(starts[v], starts[v + 1]):
            c = colours[neighbours[k]]
            if c >= 0:
                taken[c] = v
        c = 0
        while taken[c] == v:
            c += 1
        colours[v] = c
        count = max(count, c + 1)
    return count
