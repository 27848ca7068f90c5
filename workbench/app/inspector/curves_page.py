"""D along the similarities (s, ..., s) and along (s, 1/s), for the distortion in force and others beside it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QColor, QIcon, QPixmap
from PySide6.QtWidgets import QCheckBox, QHBoxLayout, QLabel, QListWidget, QListWidgetItem, QVBoxLayout, QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.docks.plots import LogarithmicAxis, calm, paint_axes
from workbench.app.inspector.latest import Latest
from workbench.app.inspector.page import Page
from workbench.app.inspector.subject import Key, Subject
from workbench.core.arrays import Floats
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError

COUNT = 241
"""Samples of a curve; s = 1 is one of them."""
REACH = 1.0
"""Decades to either side of s = 1."""
TALLEST = 1e4
"""Values above this multiple of D at the isometry are out of sight at first."""
HUES = (25, 150, 285, 95, 330, 190, 50, 260, 0, 120, 215, 305, 70, 170, 240, 345)
DASHES = (Qt.PenStyle.DashLine, Qt.PenStyle.DotLine, Qt.PenStyle.DashDotLine)


@dataclass(frozen=True, eq=False)
class Curve:
    """One distortion along both lines: `s` (k,), `similar` (k,), `shearing` (k,)."""

    id: str
    s: Floats
    similar: Floats
    shearing: Floats


def sample_curve(distortion: Distortion, dimension: int) -> Curve:
    """D at (s, ..., s) and at (s, 1/s), for n = 3 at (s, 1, 1/s)."""
    s = np.logspace(-REACH, REACH, COUNT)
    high, low = np.maximum(s, 1 / s), np.minimum(s, 1 / s)
    middle = [np.ones(COUNT)] if dimension == 3 else []
    similar = distortion.value(np.repeat(s[:, None], dimension, axis=1))
    return Curve(distortion.id, s, similar, distortion.value(np.stack([high, *middle, low], axis=1)))


class CurvesPage(Page):
    """Two plots and a list of what else to draw."""

    def __init__(self, subject: Subject, parent: QWidget | None = None) -> None:
        super().__init__(subject, parent)
        self._latest = Latest(self)
        self._latest.done.connect(self._take)
        self._latest.failed.connect(self._fail)
        self._curves: list[Curve] = []
        self._key: Key = ("", (), 0)
        self.graphics = pg.GraphicsLayoutWidget(self)
        self.graphics.setMinimumSize(220, 200)
        self.graphics.ci.layout.setContentsMargins(2, 2, 8, 2)
        self.plots: list[pg.PlotItem] = []
        for row in range(2):
            axes = {side: LogarithmicAxis(side) for side in ("left", "bottom")}
            plot = self.graphics.addPlot(row=row, col=0, axisItems=axes)
            calm(plot, self)
            plot.showGrid(x=True, y=True, alpha=0.15)
            plot.setLabel("bottom", "s")
            self.plots.append(plot)
        self.plots[1].setXLink(self.plots[0])
        self.logarithmic = QCheckBox("logarithmic D", self)
        self.logarithmic.setChecked(True)
        self.logarithmic.toggled.connect(lambda _: self._draw())
        self.others = QListWidget(self)
        self.others.setMaximumHeight(104)
        self.others.setIconSize(QSize(22, 10))
        self.others.setToolTip("Distortions to draw beside the one in force, with their own parameters.")
        self.others.itemChanged.connect(lambda _: self.touch())
        self.sentence = QLabel("", self)
        self.sentence.setObjectName("citation")
        self.sentence.setWordWrap(True)
        head = QHBoxLayout()
        head.setContentsMargins(8, 4, 8, 2)
        head.addWidget(QLabel("Beside it:", self))
        head.addStretch(1)
        head.addWidget(self.logarithmic)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(2)
        layout.addWidget(self.graphics, 1)
        layout.addLayout(head)
        layout.addWidget(self.others)
        layout.addWidget(self.sentence)

    def set_theme(self, theme: Theme) -> None:
        self.graphics.setBackground(theme.view)
        for plot in self.plots:
            paint_axes(plot, theme)
            plot.getAxis("bottom").setLabel("s", color=theme.text)
        super().set_theme(theme)
        self._paint_list()

    def wait(self) -> None:
        self._latest.wait()

    # ------------------------------------------------------------------------------------------ the list

    def _fill_list(self) -> None:
        registry = self.subject.registry
        if registry is None or self.others.count():
            return
        self.others.blockSignals(True)
        for item in registry.distortions.values():
            entry = QListWidgetItem(item.label, self.others)
            entry.setData(Qt.ItemDataRole.UserRole, item.id)
            entry.setToolTip(f"D = {item.formula}   {item.citation}")
            entry.setFlags(Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsUserCheckable)
            entry.setCheckState(Qt.CheckState.Unchecked)
        self.others.blockSignals(False)
        self._paint_list()

    @property
    def chosen(self) -> list[str]:
        """Ids of the distortions to draw beside the one in force."""
        entries = [self.others.item(row) for row in range(self.others.count())]
        return [e.data(Qt.ItemDataRole.UserRole) for e in entries if e.checkState() == Qt.CheckState.Checked]

    def _pen(self, id: str) -> object:
        ids = [self.others.item(row).data(Qt.ItemDataRole.UserRole) for row in range(self.others.count())]
        if id not in ids:
            return pg.mkPen(self.theme.curves[0], width=2.6)
        place = ids.index(id)
        colour = QColor.fromHsv(HUES[place % len(HUES)], 190, 235 if self.theme.is_dark else 165)
        return pg.mkPen(colour, width=1.8, style=DASHES[place % len(DASHES)])

    def _paint_list(self) -> None:
        self.others.blockSignals(True)
        for row in range(self.others.count()):
            entry = self.others.item(row)
            swatch = QPixmap(22, 10)
            swatch.fill(self._pen(entry.data(Qt.ItemDataRole.UserRole)).color())  # type: ignore[attr-defined]
            entry.setIcon(QIcon(swatch))
        self.others.blockSignals(False)

    # ------------------------------------------------------------------------------------------ curves

    def refresh(self) -> None:
        self._fill_list()
        item, registry, key = self.subject.distortion, self.subject.registry, self.subject.key
        if item is None or registry is None:
            self._curves = []
            self._draw()
            return
        others = [registry.distortions[id] for id in self.chosen]
        self._latest.ask(_sampling(item, others, key))

    def _take(self, result: tuple[Key, list[Curve], list[str]]) -> None:
        key, curves, failed = result
        if key == self.subject.key:
            self._curves = curves
            self._draw()
            if failed:
                self.sentence.setText(f"Not for n = {key[2]}: {', '.join(failed)}.")

    def _fail(self, error: Exception) -> None:
        self._curves = []
        self._draw()
        self.sentence.setText(f"The curves cannot be drawn: {error}.")

    def _draw(self) -> None:
        n, is_log = self.subject.dimension, self.logarithmic.isChecked()
        line = "(s, 1/s)" if n == 2 else "(s, 1, 1/s)"
        self.sentence.setText("" if n == 2 else "The middle value stays 1 along (s, 1, 1/s).")
        titles = (f"D({', '.join(['s'] * n)})", f"D{line}")
        for plot, title, name in zip(self.plots, titles, ("similar", "shearing"), strict=True):
            plot.clear()
            plot.setTitle(title, color=self.theme.text, size="9pt")
            plot.setLogMode(x=True, y=is_log)
            drawn = []
            for place, curve in reversed(list(enumerate(self._curves))):
                values = getattr(curve, name)
                good = np.isfinite(values) & ((values > 0) if is_log else True)
                pen = self._pen("" if place == 0 else curve.id)
                plot.plot(curve.s, np.where(good, values, np.nan), pen=pen, connect="finite")
                drawn.append(values[good])
            plot.addItem(pg.InfiniteLine(0.0, angle=90, pen=pg.mkPen(self.theme.faint, style=Qt.PenStyle.DotLine)))
            self._fit(plot, np.concatenate(drawn) if drawn else np.empty(0), is_log)
        self.plots[0].setXRange(-REACH, REACH, padding=0.06)

    @staticmethod
    def _fit(plot: pg.PlotItem, values: Floats, is_log: bool) -> None:
        if not len(values):
            return
        least = float(np.quantile(values, 0.02)) if is_log else float(values.min())
        most = min(float(values.max()), TALLEST * max(abs(least), 1e-2)) if is_log else float(np.quantile(values, 0.9))
        ends = np.log10([least, most]) if is_log else np.array([least, most])
        room = max(0.06 * float(ends[1] - ends[0]), 0.02)
        plot.setYRange(ends[0] - room, ends[1] + room, padding=0.0)


def _sampling(item: Distortion, others: list[Distortion], key: Key) -> Callable[[], tuple[Key, list[Curve], list[str]]]:
    """Work for a thread: all curves, that of the subject first; those that have none are named."""

    def sample() -> tuple[Key, list[Curve], list[str]]:
        curves, failed = [sample_curve(item, key[2])], []
        for other in others:
            try:
                curves.append(sample_curve(other, key[2]))
            except WorkbenchError:
                failed.append(other.label)
        return key, curves, failed

    return sample
