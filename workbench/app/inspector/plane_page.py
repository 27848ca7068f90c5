"""D over two singular values, with the simplices of the map as points that can be chosen."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QTimer
from PySide6.QtGui import QHideEvent, QShowEvent
from PySide6.QtWidgets import QCheckBox, QComboBox, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.docks.axis_numbers import short_number
from workbench.app.document.document import Document
from workbench.app.inspector.gestures import inside
from workbench.app.inspector.latest import Latest
from workbench.app.inspector.page import Page
from workbench.app.inspector.plane_field import PlaneField, PlaneStyle, sample_plane, to_places, to_sigma, with_middle
from workbench.app.inspector.plane_plot import PlanePlot
from workbench.app.inspector.subject import Key, Subject
from workbench.app.simplex_brush import SimplexBrush
from workbench.core.arrays import Booleans, Floats, Integers
from workbench.core.distortion import Distortion

ORIGIN = "inspector"
"""Who brushes, and who watches."""
MOST_POINTS = 20_000
MOST_TESTS = 2_000_000
"""Points times corners of an outline that are tested while the hand still draws it."""
REST = 40
"""Milliseconds after a change of the region before it is sampled."""
REACH = 8.0
"""Pixels from a point within which it is meant."""


class PlanePage(Page):
    """Follows the subject, the map and the brush; samples D on a thread."""

    def __init__(self, subject: Subject, document: Document, brush: SimplexBrush, parent: QWidget | None = None) -> None:
        super().__init__(subject, parent)
        self._document = document
        self._brush = brush
        self._places: Floats = np.empty((0, 2))
        self._inverted: Booleans = np.empty(0, bool)
        self._order: Integers = np.empty(0, np.int64)
        self._is_fitted = False
        self._sampled: Key = ("", (), 0)
        self._latest = Latest(self)
        self._latest.done.connect(self._take_field)
        self._latest.failed.connect(lambda error: self.readout.setText(f"D cannot be drawn: {error}."))
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(REST)
        self._rest.timeout.connect(self._sample)
        self.plot = PlanePlot(self)
        self._make_controls()
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addLayout(self._controls)
        layout.addWidget(self.plot, 1)
        self.readout = _line(self)
        self.note = _line(self)
        self.note.setObjectName("citation")
        layout.addWidget(self.readout)
        layout.addWidget(self.note)
        self.plot.set_logarithmic(True)
        self.plot.show_box(-1.0, 1.0)
        self.plot.region_changed.connect(self._rest.start)
        self.plot.pointed.connect(self._point)
        self.plot.box.outlined.connect(self._choose_inside)
        self.plot.box.clicked.connect(self._choose_near)
        self.plot.box.double_clicked.connect(self.fit)
        brush.changed.connect(self._show_brushed)
        document.opened.connect(self._forget)

    def _make_controls(self) -> None:
        self.axes = _choice(self, ("log axes", True), ("linear axes", False))
        self.axes.activated.connect(lambda _: self._change_axes())
        self.colours = _choice(self, ("log D", True), ("linear D", False))
        self.colours.activated.connect(lambda _: self._rest.start())
        self.tool = _choice(self, ("rectangle", False), ("lasso", True))
        self.tool.setToolTip("What a drag with the left button draws; the simplices inside are marked in every view.")
        self.tool.activated.connect(lambda _: setattr(self.plot.box, "is_lasso", self.tool.currentData()))
        self.mirror = QCheckBox("mirror", self)
        self.mirror.setToolTip("Fill the other half of the plane, where the first value would be the smaller one.")
        self.mirror.toggled.connect(lambda _: self._rest.start())
        self._controls = QHBoxLayout()
        self._controls.setContentsMargins(6, 4, 6, 2)
        self._controls.setSpacing(4)
        for widget in (self.axes, self.colours, self.tool, self.mirror):
            self._controls.addWidget(widget)
        self._controls.addStretch(1)

    # ------------------------------------------------------------------------------------------ to be seen or not

    def showEvent(self, event: QShowEvent) -> None:
        self._document.watch(ORIGIN, (), singular_values=True)
        self._is_stale = True  # the map went on meanwhile
        super().showEvent(event)

    def hideEvent(self, event: QHideEvent) -> None:
        self._document.watch(ORIGIN)
        self._rest.stop()
        super().hideEvent(event)

    def set_theme(self, theme: Theme) -> None:
        self.plot.set_theme(theme)
        super().set_theme(theme)

    def wait(self) -> None:
        self._rest.stop()
        self._latest.wait()

    # ------------------------------------------------------------------------------------------ the field

    def refresh(self) -> None:
        n = self.subject.dimension
        self.plot.set_names("σ₁", "σ₂" if n == 2 else "σ₃")
        self.draw_points()
        if self.subject.distortion is None:
            self._sampled = self.subject.key
            self.plot.show_field(None)
            self.readout.setText("")
        else:
            self._sample()

    def _sample(self) -> None:
        item, plot = self.subject.distortion, self.plot
        if item is None or not self.isVisible():
            return
        key, region, (columns, rows) = self.subject.key, plot.region, plot.cells
        style = PlaneStyle(bool(self.colours.currentData()), self.mirror.isChecked())
        self._latest.ask(lambda: (key, sample_plane(item, key[2], region, style, columns, rows)))

    def _take_field(self, result: tuple[Key, PlaneField]) -> None:
        key, field = result
        if key == self.subject.key and field.region.is_logarithmic == self.plot.is_logarithmic:
            self._sampled = key
            self.plot.show_field(field)

    def _change_axes(self) -> None:
        self.plot.set_logarithmic(bool(self.axes.currentData()))
        self.plot.show_field(None)
        self.draw_points()
        self.fit()
        self._rest.start()

    def fit(self) -> None:
        """Bring nearly all simplices into sight, and the isometry."""
        low, high = 0.2, 5.0
        snapshot = self._document.snapshot
        values = None if snapshot is None else snapshot.singular_values
        if values is not None and len(values):
            size = np.abs(values)
            low = min(low, 0.8 * float(np.quantile(size[:, -1], 0.002)))
            high = max(high, 1.25 * float(np.quantile(size[:, 0], 0.998)))
        if self.plot.is_logarithmic:
            self.plot.show_box(*np.log10(np.clip([low, high], 1e-5, 1e5)).tolist())
        else:
            self.plot.show_box(0.0, min(max(high, 2.5), 1e5))

    # ------------------------------------------------------------------------------------------ the map

    def _forget(self) -> None:
        self._is_fitted = False
        self._order = np.empty(0, np.int64)
        if self.isVisible():
            self.draw_points()

    def draw_points(self) -> None:
        """Take the simplices of the map that is shown."""
        snapshot = self._document.shown
        values = None if snapshot is None else snapshot.singular_values
        if snapshot is None or values is None or values.shape[1] != self.subject.dimension:
            self._places, self._inverted = np.empty((0, 2)), np.empty(0, bool)
        else:
            size = np.abs(values[:, [0, -1]]).astype(np.float64)
            self._places = to_places(size, self.plot.is_logarithmic)
            self._inverted = np.asarray(snapshot.inverted)
        count = len(self._places)
        if len(self._order) != count:
            # a fixed order, so that the same simplices stay in sight while the map moves
            self._order = np.random.default_rng(0).permutation(count)
        rows = self._order if count <= MOST_POINTS else self._order[:MOST_POINTS]
        self.plot.points.set_places(self._places[rows[~self._inverted[rows]]])
        self.plot.inverted.set_places(self._places[np.flatnonzero(self._inverted)[:MOST_POINTS]])
        self._show_brushed()
        self._say_what()
        if count and not self._is_fitted:
            self._is_fitted = True
            self.fit()

    def cost(self) -> float:
        """Seconds that drawing the points took last."""
        return self.plot.seconds

    def _say_what(self) -> None:
        count = len(self._places)
        parts = ["σ₂ is the geometric mean of σ₁ and σ₃."] if self.subject.dimension == 3 else []
        if count > MOST_POINTS:
            parts.append(f"{MOST_POINTS:,} of {count:,} simplices are drawn, all are chosen from.")
        elif count:
            parts.append(f"{count:,} simplices. Drag to mark some, wheel zooms, double click fits.")
        elif self._document.mesh is not None and self._document.mesh.dimension != self.subject.dimension:
            parts.append(f"The simplices of this map have {self._document.mesh.dimension} singular values: not shown here.")
        else:
            parts.append("Simplices appear here with the first map.")
        if self._inverted.any():
            parts.append(f"{int(self._inverted.sum()):,} inverted (yellow), at |σ|.")
        self.note.setText(" ".join(parts))

    # ------------------------------------------------------------------------------------------ choosing

    def _choose_inside(self, corners: Floats, is_done: bool) -> None:
        self.plot.show_outline(None if is_done else corners)
        if not is_done and len(self._places) * len(corners) > MOST_TESTS:
            return
        if len(self._places) and len(corners) > 2:
            self._brush.brush(np.flatnonzero(inside(self._places, corners)), ORIGIN)

    def _choose_near(self, x: float, y: float) -> None:
        row = self._simplex_at(np.array([x, y]))
        self._brush.brush([row] if row >= 0 else [], ORIGIN)

    def _simplex_at(self, place: Floats) -> int:
        """Simplex whose point is under the pointer, -1 where there is none."""
        if not len(self._places):
            return -1
        offset = (self._places - place) / np.asarray(self.plot.pixel_lengths())
        square = np.einsum("ij,ij->i", offset, offset)
        best = int(np.argmin(square))
        return best if square[best] <= REACH * REACH else -1

    def _show_brushed(self) -> None:
        if self.isVisible():
            rows = self._brush.simplices
            rows = rows[rows < len(self._places)]
            self.plot.brushed.set_places(self._places[rows])
            if len(rows) == 1:
                self._read_simplex(int(rows[0]))
            elif self._brush.origin:
                self.readout.setText(f"{len(rows):,} simplices are marked.")

    def _point(self, place: Floats | None) -> None:
        """Tell about the place, or the simplex, under the pointer."""
        row = -1 if place is None else self._simplex_at(place)
        if row >= 0:
            self._read_simplex(row)
        elif place is not None:
            self._read(to_sigma(place, self.plot.is_logarithmic), -1)
        else:
            self.readout.setText("")

    def _read_simplex(self, row: int) -> None:
        self._read(to_sigma(self._places[row], self.plot.is_logarithmic), row)

    def _read(self, sigma: Floats, row: int) -> None:
        """Two singular values (2,) and D there; `row` is the simplex they belong to, or -1."""
        item, n = self.subject.distortion, self.subject.dimension
        high, low = float(sigma.max()), float(sigma.min())
        if item is None or not low > 0:
            self.readout.setText("")
            return
        numbers = [f"σ₁ = {short_number(high)}", f"σ{'₂' if n == 2 else '₃'} = {short_number(low)}"]
        numbers.append(f"D = {self._value(item, high, low, n, row)}")
        if row >= 0:
            numbers.append(f"simplex {row}")
        self.readout.setText("   ".join(numbers))

    def _value(self, item: Distortion, high: float, low: float, n: int, row: int) -> str:
        sigma = with_middle(np.array([high]), np.array([low]), n)
        is_inverted = row >= 0 and bool(self._inverted[row])
        if is_inverted:
            sigma[:, -1] *= -1.0
        value = float(item.value(sigma)[0])
        return "∞" if np.isinf(value) else short_number(value)


def _line(parent: QWidget) -> QLabel:
    label = QLabel("", parent)
    label.setContentsMargins(8, 1, 8, 2)
    label.setWordWrap(True)
    return label


def _choice(parent: QWidget, *entries: tuple[str, bool]) -> QComboBox:
    box = QComboBox(parent)
    for text, value in entries:
        box.addItem(text, value)
    return box
