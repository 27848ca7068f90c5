"""Fig. 19: a simplex on its straight way to its mirror image; energies above the chord show that E is not convex."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QSlider, QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.docks.axis_numbers import short_number
from workbench.app.inspector.path_page import PathPage
from workbench.app.inspector.path_plot import PathPlot
from workbench.app.inspector.plane_field import colour_ends, scale_shares
from workbench.app.inspector.simplex_picture import Scene, framed
from workbench.app.inspector.subject import Subject
from workbench.core.arrays import Floats

ENDS = {"t from 0 to 1": (0.0, 1.0), "t from -1 to 2": (-1.0, 2.0)}
STEPS = 300
"""Of the slider, between the ends."""
LOOK = np.array([[0.92, -0.22], [0.30, 0.30], [0.0, 0.95]])
"""Directions of the axes of space in the picture of a tetrahedron."""
FACES = np.array([[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]])
LARGE_RATIO = 60.0
"""Of energies, above which they are drawn on a logarithmic scale."""


class MirrorPage(PathPage):
    """A slider, the marker in the plot, or the picture itself moves t."""

    def __init__(self, subject: Subject, parent: QWidget | None = None) -> None:
        super().__init__(subject, PathPlot("t", "E(x(t))", ("E along x(t)", "chord (86)")), parent)
        self.t = 0.25
        self.slider = QSlider(Qt.Orientation.Horizontal, self)
        self.slider.setRange(0, STEPS)
        self.slider.valueChanged.connect(lambda step: self.move_to(self._ends[0] + step / STEPS * np.ptp(self._ends)))
        self.ends = QComboBox(self)
        for text, pair in ENDS.items():
            self.ends.addItem(text, pair)
        self.ends.setToolTip("0 is the simplex, 1 its mirror image; the chord joins the ends.")
        self.ends.activated.connect(lambda _: self.touch())
        self.reading = QLabel("", self)
        self.reading.setMinimumWidth(self.fontMetrics().horizontalAdvance("t = -0.00 "))
        row = QHBoxLayout()
        row.setContentsMargins(8, 3, 8, 3)
        for widget in (self.ends, self.slider, self.reading):
            row.addWidget(widget)
        self.rows.insertLayout(0, row)
        self.picture.setToolTip("The simplex, dashed itself and its mirror image. Drag the blue corner. Yellow: inverted.")
        self.picture.dragged.connect(self._drag)
        self.plot.moved.connect(self.move_to)

    @property
    def _ends(self) -> tuple[float, float]:
        found: Any = self.ends.currentData()
        return (float(found[0]), float(found[1]))

    def set_theme(self, theme: Theme) -> None:
        self.plot.set_theme(theme, (theme.curves[0], theme.curves[1]))
        super().set_theme(theme)

    def work(self) -> Callable[[], Any]:
        item, dimension, (t0, t1) = self.subject.distortion, self.subject.dimension, self._ends
        assert item is not None

        def path() -> Any:
            from workbench.core.analysis.paths import mirror_path

            return mirror_path(item, dimension, t0=t0, t1=t1)

        return path

    def move_to(self, t: float) -> None:
        """Show the simplex at t."""
        self.t = min(max(t, self._ends[0]), self._ends[1])
        if self.path is not None:
            self._show_place()

    def _drag(self, x: float) -> None:
        """The blue corner shall have this abscissa in the picture."""
        corner = int(np.argmax(np.abs(self._corners_at(0.0)[:, 0] - self._corners_at(1.0)[:, 0])))
        begin, end = self._corners_at(0.0)[corner, 0], self._corners_at(1.0)[corner, 0]
        if begin != end:
            self.move_to(float((x - begin) / (end - begin)))

    # ------------------------------------------------------------------------------------------ showing

    def show_path(self) -> None:
        path = self.path
        finite = path.energies[np.isfinite(path.energies)]
        # near zero a logarithm hides more than it shows
        self._is_logarithmic = bool(len(finite) and finite.min() > 0 and finite.max() > LARGE_RATIO * finite.min())
        self.plot.show_curves(path.t, (path.energies, path.chord), self._is_logarithmic)
        self.plot.getPlotItem().setLabel("left", "E(x(t))")
        self.move_to(self.t)

    def _show_place(self) -> None:
        path = self.path
        row = int(np.argmin(np.abs(path.t - self.t)))
        self.slider.blockSignals(True)
        self.slider.setValue(round((self.t - self._ends[0]) / np.ptp(self._ends) * STEPS))
        self.slider.blockSignals(False)
        self.reading.setText(f"t = {path.t[row]:.2f}")
        energy, chord = float(path.energies[row]), float(path.chord[row])
        self.plot.mark(float(path.t[row]), (energy, chord), self._is_logarithmic)
        self.picture.show_scene(self._scene(row))
        self.sentence.setText(f"{verdict(path)} Here E = {_told(energy)}, the chord {_told(chord)}.")

    def _corners_at(self, t: float) -> Floats:
        """Corners (n+1, 2) in the picture at any t: the path is straight."""
        path = self.path
        first, last = path.positions[0], path.positions[-1]
        share = (t - path.t[0]) / (path.t[-1] - path.t[0])
        return flattened((1.0 - share) * first + share * last)

    def _scene(self, row: int) -> Scene:
        path = self.path
        points = flattened(path.positions[row])
        triangles = FACES if path.positions.shape[2] == 3 else FACES[:1]
        # the factor by which the first axis is stretched is 1 - 2t
        is_inverted = bool(path.t[row] >= 0.5)
        is_logarithmic = bool((path.energies > 0).all())
        share = scale_shares(path.energies[row : row + 1], *colour_ends(path.energies, is_logarithmic), is_logarithmic)
        begin, end = self._corners_at(0.0), self._corners_at(1.0)
        corner = int(np.argmax(np.abs(begin[:, 0] - end[:, 0])))
        return Scene(
            points,
            triangles,
            np.repeat(share, len(triangles)),
            np.repeat(is_inverted, len(triangles)),
            framed(np.concatenate([flattened(path.positions[0]), flattened(path.positions[-1]), begin, end])),
            grip=points[corner],
            track=np.stack([flattened(path.positions[0])[corner], flattened(path.positions[-1])[corner]]),
            ghosts=np.concatenate([begin[triangles], end[triangles]]),
        )


def flattened(corners: Floats) -> Floats:
    """Corners (..., 2 or 3) in the plane of the picture (..., 2)."""
    return corners if corners.shape[-1] == 2 else np.asarray(corners @ LOOK)


def verdict(path: Any) -> str:
    """What a path says about convexity, in one sentence."""
    if not np.isfinite(path.energies[[0, -1]]).all():
        return "E is infinite at an end: there is no chord."
    if not path.violates:
        return "E lies nowhere above the chord: convex along this path, as far as it shows."
    excess = path.energies - path.chord
    worst = int(np.nanargmax(excess))
    where = f"at t = {path.t[worst]:.2f} E = {_told(float(path.energies[worst]))} lies above the chord"
    return f"Not convex: {where} ({_told(float(path.chord[worst]))})."


def _told(value: float) -> str:
    return "∞" if np.isinf(value) else short_number(value)
