"""Fig. 12: a vertex is pulled across its star, and the energy with and without its barrier tells what inversions cost."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from PySide6.QtWidgets import QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.docks.axis_numbers import short_number
from workbench.app.inspector.path_page import PathPage
from workbench.app.inspector.path_plot import PathPlot
from workbench.app.inspector.plane_field import colour_ends, scale_shares
from workbench.app.inspector.simplex_picture import Scene, framed
from workbench.app.inspector.subject import Subject
from workbench.core.arrays import Floats
from workbench.core.distortion import Distortion


@dataclass(frozen=True, eq=False)
class ColouredStar:
    """A `PulledVertex` with the places (k, m) of its triangles on the colour scale."""

    pulled: object
    shares: Floats


def coloured_star(distortion: Distortion) -> ColouredStar:
    """The star of Fig. 12 with D of every triangle along the way, as colours."""
    from workbench.core.analysis.paths import pulled_vertex
    from workbench.core.jacobians import build_elements, signed_singular_values
    from workbench.core.mesh import Mesh

    pulled = pulled_vertex(distortion)
    elements = build_elements(Mesh(pulled.positions[0], pulled.triangles))
    sigma = np.concatenate([signed_singular_values(elements, x) for x in pulled.positions])
    values = distortion.value(np.abs(sigma)).reshape(pulled.inverted.shape)
    upright = np.where(pulled.inverted, np.nan, values)
    # a linear scale on the first half of the values: what happens before the collapse is worth the colours
    low, high = colour_ends(upright, is_logarithmic=False)
    return ColouredStar(pulled, scale_shares(values, low, high, is_logarithmic=False))


class StarPage(PathPage):
    """The hand drags the centre of the star along the dotted line, or the marker in the plot."""

    def __init__(self, subject: Subject, parent: QWidget | None = None) -> None:
        names = ("with its barrier", "barrier removed where inverted")
        super().__init__(subject, PathPlot("place of the vertex", "E", names), parent)
        self.offset = 0.35
        self.picture.setToolTip("Drag the blue vertex along the dotted line. Yellow: inverted.")
        self.picture.dragged.connect(self.pull)
        self.plot.moved.connect(self.pull)

    def set_theme(self, theme: Theme) -> None:
        # blue and red, as printed
        self.plot.set_theme(theme, (theme.curves[0], theme.curves[2]))
        super().set_theme(theme)

    def work(self) -> Callable[[], ColouredStar]:
        item = self.subject.distortion
        assert item is not None
        return lambda: coloured_star(item)

    def pull(self, offset: float) -> None:
        """Bring the vertex to this abscissa."""
        self.offset = offset
        if self.path is not None:
            self._show_place()

    def show_path(self) -> None:
        pulled = self.path.pulled
        self._is_logarithmic = bool(np.nanmin(pulled.filtered_energies) > 0)
        self.plot.show_curves(pulled.offsets, (pulled.energies, pulled.filtered_energies), self._is_logarithmic)
        self._show_place()

    def _show_place(self) -> None:
        pulled = self.path.pulled
        row = int(np.argmin(np.abs(pulled.offsets - self.offset)))
        points, inverted = pulled.positions[row], pulled.inverted[row]
        first, last = pulled.positions[0, 0], pulled.positions[-1, 0]
        scene = Scene(
            points,
            pulled.triangles,
            self.path.shares[row],
            inverted,
            framed(np.concatenate([pulled.positions[0], pulled.positions[-1]])),
            grip=points[0],
            track=np.stack([first, last]),
        )
        self.picture.show_scene(scene)
        energy, filtered = float(pulled.energies[row]), float(pulled.filtered_energies[row])
        self.plot.mark(float(pulled.offsets[row]), (energy, filtered), self._is_logarithmic)
        count = int(inverted.sum())
        told = "∞" if np.isinf(energy) else short_number(energy)
        words = "For triangles, n = 2. " if self.subject.dimension == 3 else ""
        words += f"Vertex at {pulled.offsets[row]:.2f}: E = {told}"
        words += f", without the barrier {short_number(filtered)}" if energy != filtered else ""
        words += f"; {count} of {len(inverted)} triangles inverted." if count else "; no triangle is inverted."
        if not self._has_barrier():
            words += " This distortion has no barrier at inversions: both curves are one."
        self.sentence.setText(words)

    def _has_barrier(self) -> bool:
        return bool((self.path.pulled.energies != self.path.pulled.filtered_energies).any())
