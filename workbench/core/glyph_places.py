"""Where glyphs of a map stand, and how large they are: equal circles in the source, and what the map makes of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Floats, Integers, Points
from workbench.core.even_sample import even_sample
from workbench.core.mesh import Mesh

if TYPE_CHECKING:
    from workbench.core.principal_stretches import PrincipalStretches

FILLED = 0.42
"""Radius of a circle in the source, as a part of the distance between two."""
NO_STRETCH = 1e-3
"""Relative change of length below which a line counts as neither stretched nor squeezed."""
LONGEST = 2.5
"""Times the radius at which lines in the source end: there a stretch is a length beside others, no image of anything."""


@dataclass(frozen=True, eq=False)
class PlacedGlyphs:
    """`centres` (k, d);  `axes` (k, n, d), half axes;  `signs` (k, n): 1 stretched, -1 squeezed, 0 neither"""

    centres: Points
    axes: Points
    signs: Integers


class GlyphPlaces:
    """An even choice among the triangles that are drawn of a source; it holds for every map of it.

    The glyph of a tetrahedron stands in the middle of its face that is seen.

    Parameters
    ----------
    mesh : Mesh
    points : (p, d) float         of the source as it is drawn, in any unit
    triangles : (t, 3) int64      that are drawn, rows of `points`
    owners : (t,) int64           the simplex of each; None: triangle i is simplex i
    count : int                   glyphs, at the most
    """

    def __init__(self, mesh: Mesh, points: Points, triangles: Integers, owners: Integers | None, count: int) -> None:
        centres = points[triangles].mean(axis=1)
        centres[~np.isfinite(centres)] = 0.0
        self.rows = even_sample(centres, count)
        self.triangles = triangles[self.rows]
        from workbench.core.principal_stretches import StretchProbe

        self._probe = StretchProbe(mesh, self.rows if owners is None else owners[self.rows])
        self.radius = FILLED * (_area(points, triangles) / max(len(self.rows), 1)) ** 0.5
        """Of the circles, in the unit of `points`."""

    def stretches(self, positions: Floats) -> PrincipalStretches:
        """Those of a map (n, d) of the mesh, at the places."""
        return self._probe.at(positions)

    def on_source(self, stretches: PrincipalStretches, points: Points, size: float = 1.0, *, as_lines: bool) -> PlacedGlyphs:
        """The circles themselves, or lines as long as they are stretched; `size` is a factor of the radius."""
        lengths = np.minimum(np.abs(stretches.values), LONGEST) if as_lines else np.ones_like(stretches.values)
        return self._placed(points, stretches.source, size * self.radius * lengths, stretches)

    def on_target(self, stretches: PrincipalStretches, points: Points, size: float = 1.0) -> PlacedGlyphs:
        """The images of the circles: `points` are those of the map; `size` also brings its unit to that of the source."""
        return self._placed(points, stretches.target, size * self.radius * np.abs(stretches.values), stretches)

    def _placed(self, points: Points, lines: Floats, lengths: Floats, stretches: PrincipalStretches) -> PlacedGlyphs:
        axes = np.zeros((*lengths.shape, points.shape[1]), points.dtype)
        # a degenerate simplex has no stretches: its glyph is a point
        axes[:, :, : lines.shape[2]] = np.nan_to_num(lengths[:, :, None] * lines, posinf=0.0, neginf=0.0)
        excess = np.nan_to_num(np.abs(stretches.values) - 1.0)
        signs = np.where(np.abs(excess) > NO_STRETCH, np.sign(excess), 0.0).astype(np.int64)
        return PlacedGlyphs(points[self.triangles].mean(axis=1), axes, signs)


def _area(points: Points, triangles: Integers) -> float:
    first, second = (points[triangles[:, i]] - points[triangles[:, 0]] for i in (1, 2))
    squares = (first * first).sum(axis=1) * (second * second).sum(axis=1) - (first * second).sum(axis=1) ** 2
    return float(0.5 * np.sqrt(np.maximum(squares, 0.0)).sum())
