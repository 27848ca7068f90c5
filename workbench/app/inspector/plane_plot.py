"""The plot of a distortion over two singular values: image, level lines, colour bar, and points of a map in it."""

from __future__ import annotations

import math
import time

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QWidget

from workbench.app.appearance.theme import BRUSH, BRUSH_CASING, INVERTED, INVERTED_OUTLINE, Theme
from workbench.app.docks.plots import LogarithmicAxis, calm, paint_axes
from workbench.app.inspector.gestures import ChoosingBox
from workbench.app.inspector.plane_field import PlaneField, Region
from workbench.app.inspector.point_cloud import PointCloud
from workbench.app.views.colours import distortion_colours
from workbench.core.arrays import Floats

BAR_STEPS = 256
LINE_ALPHA = 110
DECADES_IN_SIGHT = 12.0


class PlanePlot(pg.GraphicsLayoutWidget):  # type: ignore[misc]
    """Draws; what a gesture means is the page's business."""

    region_changed = Signal()
    pointed = Signal(object)
    """Place (2,) under the pointer, None outside."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setMinimumSize(240, 200)
        self.ci.layout.setContentsMargins(2, 6, 4, 2)
        self.ci.layout.setHorizontalSpacing(8)
        self.box = ChoosingBox()
        self._axes = {side: LogarithmicAxis(side) for side in ("bottom", "left")}
        self.plot: pg.PlotItem = self.addPlot(row=0, col=0, viewBox=self.box, axisItems=self._axes)
        calm(self.plot, self)
        self.plot.setMouseEnabled(True, True)
        self.plot.setAspectLocked(True)
        self.field: PlaneField | None = None
        self.is_logarithmic = True
        self.seconds = 0.0  # that the last painting took
        self._image = pg.ImageItem()
        self._lines = pg.PlotCurveItem(connect="pairs")
        self._diagonal = pg.InfiniteLine(angle=45)
        self._unit = pg.TextItem("+", anchor=(0.5, 0.5))
        self.points, self.inverted, self.brushed = PointCloud(3.0, 5), PointCloud(4.0, 6), PointCloud(4.0, 8)
        self._outline = pg.PlotCurveItem()
        for item, depth in ((self._image, 0), (self._lines, 1), (self._diagonal, 2), (self._unit, 3), (self._outline, 9)):
            item.setZValue(depth)
            self.plot.addItem(item, ignoreBounds=True)
        for cloud in (self.points, self.inverted, self.brushed):
            self.plot.addItem(cloud, ignoreBounds=True)
        self._make_bar()
        self.box.sigRangeChanged.connect(lambda *_: self.region_changed.emit())
        self.scene().sigMouseMoved.connect(self._point)

    def _make_bar(self) -> None:
        self._bar_axis = LogarithmicAxis("right")
        self._bar: pg.PlotItem = self.addPlot(row=0, col=1, axisItems={"right": self._bar_axis})
        calm(self._bar, self)
        self._bar.setFixedWidth(66)
        self._bar.setTitle("D", size="9pt")
        self._bar.showAxis("right")
        for side in ("bottom", "left"):
            self._bar.hideAxis(side)
        self._bar_image = pg.ImageItem()
        self._bar.addItem(self._bar_image)
        self._bar.setXRange(0.0, 1.0, padding=0.0)
        colours = np.concatenate([distortion_colours(), np.ones((len(distortion_colours()), 1))], axis=1)
        self._table = (colours * 255).round().astype(np.uint8)
        self._bar_image.setImage(self._table[np.linspace(0, len(self._table) - 1, BAR_STEPS).astype(int)][None])

    # ------------------------------------------------------------------------------------------ looks

    def set_theme(self, theme: Theme) -> None:
        self.setBackground(theme.view)
        paint_axes(self.plot, theme)
        self._bar.setTitle("D", color=theme.text, size="9pt")
        axis = self._bar_axis
        axis.enableAutoSIPrefix(False)
        axis.setPen(theme.faint)
        axis.setTextPen(theme.text)
        axis.setStyle(tickLength=4, maxTickLevel=0)
        line = QColor("#000000")
        line.setAlpha(LINE_ALPHA)
        self._lines.setPen(pg.mkPen(line, width=1))
        self._diagonal.setPen(pg.mkPen(theme.faint, width=1, style=Qt.PenStyle.DashLine))
        self._unit.setColor("#000000")
        # half transparent: where many lie on each other it is darker
        self.points.set_colours(QColor(12, 16, 26, 120), None)
        self.inverted.set_colours(QColor.fromRgbF(*INVERTED), QColor.fromRgbF(*INVERTED_OUTLINE))
        self.brushed.set_colours(QColor.fromRgbF(*BRUSH), QColor.fromRgbF(*BRUSH_CASING))
        brush = QColor.fromRgbF(*BRUSH)
        self._outline.setPen(pg.mkPen(QColor.fromRgbF(*BRUSH_CASING), width=2))
        self._outline.setShadowPen(pg.mkPen(brush, width=4))

    def set_names(self, first: str, last: str) -> None:
        self.plot.setLabel("bottom", first)
        self.plot.setLabel("left", last)

    def set_logarithmic(self, wanted: bool) -> None:
        self.is_logarithmic = wanted
        for axis in self._axes.values():
            axis.setLogMode(wanted)
        edge = 0.5 * DECADES_IN_SIGHT if wanted else 1e6
        self.box.setLimits(xMin=-edge if wanted else -0.5, yMin=-edge if wanted else -0.5, xMax=edge, yMax=edge)
        at = 0.0 if wanted else 1.0
        self._unit.setPos(at, at)

    # ------------------------------------------------------------------------------------------ what is shown

    def show_box(self, low: float, high: float) -> None:
        """Bring a square of the plane into sight."""
        self.box.setRange(xRange=(low, high), yRange=(low, high), padding=0.02)

    @property
    def region(self) -> Region:
        """What is to be seen now."""
        (left, right), (bottom, top) = self.box.viewRange()
        return Region(left, right, bottom, top, self.is_logarithmic)

    @property
    def cells(self) -> tuple[int, int]:
        """Columns and rows that the screen is worth."""
        size = self.box.size()
        return tuple(int(min(max(length * 0.7, 60), 420)) for length in (size.width(), size.height()))  # type: ignore[return-value]

    def show_field(self, field: PlaneField | None) -> None:
        """Draw D, or nothing."""
        self.field = field
        for item in (self._image, self._lines, self._bar_image):
            item.setVisible(field is not None)
        if field is None:
            return
        shares = field.shares(field.values)
        is_shown = np.isfinite(shares)
        rows = (np.where(is_shown, shares, 0.0) * (len(self._table) - 1)).astype(int)
        pixels = self._table[rows]
        pixels[~is_shown] = 0
        self._image.setImage(pixels, levels=None, autoLevels=False)
        region = field.region
        self._image.setRect(QRectF(region.left, region.bottom, region.right - region.left, region.top - region.bottom))
        ends = field.lines.reshape(-1, 2)
        self._lines.setData(ends[:, 0], ends[:, 1], connect="pairs")
        is_log = field.style.is_logarithmic
        low, high = (math.log10(field.low), math.log10(field.high)) if is_log else (field.low, field.high)
        self._bar_axis.setLogMode(is_log)
        self._bar_image.setRect(QRectF(0.0, low, 1.0, high - low))
        self._bar.setYRange(low, high, padding=0.0)

    def show_outline(self, corners: Floats | None) -> None:
        """The rectangle or the lasso under way."""
        if corners is None:
            self._outline.setData([], [])
        else:
            closed = np.concatenate([corners, corners[:1]])
            self._outline.setData(closed[:, 0], closed[:, 1])

    def pixel_lengths(self) -> tuple[float, float]:
        """Width and height of a pixel in coordinates of the plot."""
        width, height = self.box.viewPixelSize()
        return float(width), float(height)

    def _point(self, where: object) -> None:
        if self.box.sceneBoundingRect().contains(where):
            place = self.box.mapSceneToView(where)
            self.pointed.emit(np.array([place.x(), place.y()]))
        else:
            self.pointed.emit(None)

    def paintEvent(self, event: object) -> None:
        began = time.perf_counter()
        super().paintEvent(event)
        self.seconds = time.perf_counter() - began

    def leaveEvent(self, event: object) -> None:
        super().leaveEvent(event)
        self.pointed.emit(None)
