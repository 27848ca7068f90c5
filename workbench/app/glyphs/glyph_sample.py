"""Which triangles of a view carry a glyph, and what is drawn there of a map."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from workbench.app.views.geometry import Geometry
from workbench.app.views.glyph_layer import GlyphPicture
from workbench.core.even_sample import even_sample
from workbench.core.mesh import Mesh
from workbench.core.principal_stretches import PrincipalStretches, StretchProbe

FILLED = 0.42
"""Radius of the circle of a glyph in the source, as a part of the distance between two, at its usual size."""
NO_STRETCH = 1e-3
"""Relative change of length below which a line counts as neither stretched nor squeezed."""
LONGEST = 2.5
"""Times that radius, at which lines in the source end: there a stretch is a length beside others, no image of anything."""


class GlyphSample:
    """An even choice among what is drawn of a source; it holds for every map of it.

    The glyph of a tetrahedron stands in the middle of its face that is seen.
    """

    def __init__(self, mesh: Mesh, source: Geometry, count: int) -> None:
        self.faces = source.faces
        triangles = source.triangles
        centres = source.points[triangles].mean(axis=1)
        centres[~np.isfinite(centres)] = 0.0
        self.rows = even_sample(centres, count)
        owners = self.faces.simplices
        self._triangles = triangles[self.rows]
        self._probe = StretchProbe(mesh, self.rows if owners is None else owners[self.rows])
        self._spacing = (_area(source.points, triangles) / max(len(self.rows), 1)) ** 0.5

    def stretches(self, target: Geometry) -> PrincipalStretches:
        """Those of the map that a geometry shows; in single precision, which is enough for a picture."""
        columns = len(target.frame.centre)
        return self._probe.at(target.vertices[:, :columns].astype(np.float64) / target.frame.scale)

    def on_target(
        self, stretches: PrincipalStretches, source: Geometry, target: Geometry, size: float, as_lines: bool
    ) -> GlyphPicture:
        """Images of equal circles, or their half axes."""
        radius = size * FILLED * self._spacing * target.frame.scale / source.frame.scale
        return self._picture(target, stretches.target, radius * np.abs(stretches.values), stretches, as_lines)

    def on_source(self, stretches: PrincipalStretches, source: Geometry, size: float, as_lines: bool) -> GlyphPicture:
        """The circles themselves, or lines as long as they are stretched."""
        radius = size * FILLED * self._spacing
        lengths = np.minimum(np.abs(stretches.values), LONGEST) if as_lines else np.ones_like(stretches.values)
        return self._picture(source, stretches.source, radius * lengths, stretches, as_lines)

    def _picture(
        self,
        geometry: Geometry,
        lines: NDArray[np.float64],
        lengths: NDArray[np.float64],
        stretches: PrincipalStretches,
        as_lines: bool,
    ) -> GlyphPicture:
        axes = np.zeros((*lengths.shape, 3), np.float32)
        axes[:, :, : lines.shape[2]] = np.nan_to_num(lengths[:, :, None] * lines, posinf=0.0, neginf=0.0)
        centres = geometry.points[self._triangles].mean(axis=1)
        excess = np.abs(stretches.values) - 1.0
        signs = np.where(np.abs(excess) > NO_STRETCH, np.sign(excess), 0.0)
        return GlyphPicture(centres, axes, np.nan_to_num(signs).astype(np.int64), as_lines)


def _area(points: NDArray[np.float32], triangles: NDArray[np.int64]) -> float:
    first, second = (points[triangles[:, i]] - points[triangles[:, 0]] for i in (1, 2))
    return float(0.5 * np.linalg.norm(np.cross(first, second), axis=1).sum())
