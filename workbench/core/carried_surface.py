"""A surface that a map of a volume carries with it (Fig. 8 of the survey)."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import numba
import numpy as np

from workbench.core.arrays import Booleans, Floats, Integers, frozen
from workbench.core.errors import MeshError
from workbench.core.jacobians import Elements, build_elements, simplex_measures
from workbench.core.measure import Measure, SingularValues
from workbench.core.mesh import Mesh
from workbench.core.nearest_tetrahedron import locate
from workbench.core.nouns import count_of
from workbench.core.quality import simplex_table
from workbench.core.surface_jacobians import surface_singular_values

OUTSIDE = 1e-9
"""A vertex is outside where it is farther from the volume than this part of the volume's diameter."""
FARTHEST = 0.5
"""A surface is refused where a vertex is farther out than this part of the diameter: its place or its unit is another."""


@dataclass(frozen=True, eq=False)
class CarriedSurface:
    """Every vertex of a surface as a weighted sum of four vertices of the volume.

    Parameters
    ----------
    surface : Mesh                triangles in space, where they are in the source
    corners : (k, 4) int64        vertices of the volume
    weights : (k, 4) float64      barycentric coordinates, their sum is 1
    outside : (k,) bool           vertices outside the volume: they follow the nearest tetrahedron, extrapolated
    farthest : float              greatest distance of a vertex from the volume, 0 where all are inside
    """

    surface: Mesh
    corners: Integers
    weights: Floats
    outside: Booleans
    farthest: float

    @property
    def outside_count(self) -> int:
        return int(np.count_nonzero(self.outside))

    @cached_property
    def has_area(self) -> Booleans:
        """(m,) bool: triangles that have an area in the source; the others are carried, but their map has no Jacobian."""
        return simplex_measures(self.surface) > 0.0

    @cached_property
    def measured(self) -> Mesh:
        """The surface without the triangles that have no area."""
        if self.has_area.all():
            return self.surface
        simplices = self.surface.simplices[self.has_area]
        return replace(self.surface, simplices=simplices, texture=None, polygons=None, attributes=None)

    @cached_property
    def elements(self) -> Elements:
        """Frames in the source of the triangles that are measured."""
        return build_elements(self.measured)

    def at(self, positions: Floats) -> Floats:
        """Vertices (k, 3) of the surface under the map of the volume with these positions (n, 3). Cost: O(k)."""
        moved = np.empty((len(self.corners), 3))
        _weighted_sums(np.ascontiguousarray(positions, dtype=np.float64), self.corners, self.weights, moved)
        return moved

    def measures(self, moved: Floats, measures: Iterable[Measure]) -> dict[str, Floats]:
        """Values (m,) of each measure of the surface's own map, from its place in the source to the vertices `moved` (k, 3).

        By id; NaN for triangles without an area.
        """
        sigma = SingularValues(surface_singular_values(self.elements, moved))
        return {measure.id: self._on_all(measure.prepare(2)(sigma)) for measure in measures}

    def table(self, moved: Floats) -> dict[str, Floats]:
        """The columns of `simplex_table` for the surface's own map; NaN for triangles without an area."""
        return {name: self._on_all(values) for name, values in simplex_table(self.measured, moved).items()}

    def _on_all(self, values: Floats) -> Floats:
        if self.measured is self.surface:
            return values
        spread = np.full(self.surface.simplex_count, np.nan)
        spread[self.has_area] = values
        return spread

    @property
    def note(self) -> str:
        """Sentences on vertices outside and triangles without an area; empty where there are none."""
        flat = int(np.count_nonzero(~self.has_area))
        sentences = []
        if self.outside_count:
            sentences.append(
                f"{count_of(self.outside_count, 'vertex')} of the carried surface {'is' if self.outside_count == 1 else 'are'} "
                f"outside the volume, by {self.farthest:.3g} at most: what is outside follows the nearest tetrahedron."
            )
        if flat:
            what = "has no area and is" if flat == 1 else "have no area and are"
            sentences.append(f"{count_of(flat, 'triangle')} of the carried surface {what} not measured.")
        return " ".join(sentences)


def carry(surface: Mesh, volume: Mesh) -> CarriedSurface:
    """`surface`, to be carried by maps of `volume`, in whose source it lies.

    Raises `MeshError` unless these are triangles in space in or near tetrahedra, none of them degenerate.
    Cost: O((m + k) log m), once.
    """
    if volume.dimension != 3:
        raise MeshError("Only a volume carries a surface, and this source is made of triangles; open tetrahedra first.")
    if surface.dimension != 2 or surface.vertices.shape[1] != 3:
        raise MeshError(f"{surface.name or 'The mesh'}: only triangles in space can be carried; name a file of a surface.")
    places = locate(volume, surface.vertices)
    farthest = float(places.distances.max())
    if farthest > FARTHEST * volume.diameter:
        raise MeshError(
            f"{surface.name or 'The surface'}: a vertex is {farthest:.3g} from the volume, whose diameter is "
            f"{volume.diameter:.3g}; scale and move the surface into the volume."
        )
    if not (simplex_measures(surface) > 0.0).any():
        raise MeshError(f"{surface.name or 'The surface'}: none of its triangles has an area; name a file of a surface.")
    is_outside = places.distances > OUTSIDE * volume.diameter
    corners = frozen(volume.simplices[places.simplices], np.int64)
    return CarriedSurface(surface, corners, frozen(places.weights), frozen(is_outside, np.bool_), farthest)


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _weighted_sums(x, corners, weights, out):  # type: ignore[no-untyped-def]
    for k in range(corners.shape[0]):
        for c in range(3):
            total = 0.0
            for j in range(4):
                total += weights[k, j] * x[corners[k, j], c]
            out[k, c] = total
