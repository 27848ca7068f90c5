"""The histogram under a real mouse: brushing, weights, scales; and choosing what views show."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from workbench.app.colouring.range_menu import EndsDialog
from workbench.app.docks.histogram_dock import BINS
from workbench.app.main_window import MainWindow
from workbench.app.quantities.formula_dialog import FormulaDialog
from workbench.app.quantities.quantity_chooser import FORMULA
from workbench.core.jacobians import simplex_measures
from workbench.engine.messages import Watch


@pytest.fixture
def bent(window: MainWindow, qtbot: QtBot) -> MainWindow:
    """A window with a map that stretches, so that the bins differ."""
    document = window.document
    document.set_anchors(document.anchors)
    for vertex, shift in ((0, (0.0, 0.0)), (272, (0.3, 0.2))):
        document.add_anchor(vertex)
        document.move_anchor(vertex, document.mesh.vertices[vertex] + shift, False)
    window.histogram.set_weighted(False)
    window.histogram.set_logarithmic_counts(False)
    window.histogram.show_quantity("average-singular-value")
    qtbot.waitUntil(lambda: np.count_nonzero(window.histogram.counts) > 5)
    QTest.qWait(150)
    return window


def place(window: MainWindow, bin: float) -> QPoint:
    """Pixel of the plot in the middle of the height, at a bin's place."""
    axis = window.histogram.range
    low, high = np.log10(axis.low), np.log10(axis.high)
    view = window.histogram.plot.getPlotItem().getViewBox()
    top = view.viewRange()[1][1]
    scene = view.mapViewToScene(QPointF(low + bin / BINS * (high - low), 0.5 * top))
    return window.histogram.plot.mapFromScene(scene)


def drag(window: MainWindow, begin: QPoint, end: QPoint) -> None:
    port = window.histogram.plot.viewport()
    QTest.mousePress(port, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, begin)
    for step in range(1, 6):
        QTest.mouseMove(port, begin + (end - begin) * step / 5)
    QTest.mouseRelease(port, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, end)


def test_dragging_across_bars_brushes_their_simplices_and_a_click_clears(bent: MainWindow, qtbot: QtBot) -> None:
    dock = bent.histogram
    values = bent.document.snapshot.fields["average-singular-value"]
    drag(bent, place(bent, 34.5), place(bent, 63.5))
    edge = dock.range.value_at(34 / BINS)
    np.testing.assert_array_equal(bent.brush.simplices, np.flatnonzero(values >= edge * (1 - 1e-6)))
    assert bent.brush.origin == "histogram" and len(bent.brush.simplices)
    assert dock.brushed_counts[:34].sum() == 0
    np.testing.assert_array_equal(dock.brushed_counts[34:], dock.counts[34:])
    drag(bent, place(bent, 20), place(bent, 20))
    assert not len(bent.brush.simplices) and dock.brushed_counts.sum() == 0


def test_simplices_brushed_elsewhere_are_a_part_of_the_bars(bent: MainWindow) -> None:
    chosen = np.arange(0, 480, 7)
    bent.brush.brush(chosen, "elsewhere")
    dock = bent.histogram
    assert dock.brushed_counts.sum() == len(chosen) and (dock.brushed_counts <= dock.counts).all()
    bent.brush.clear()


def test_areas_and_logarithms(bent: MainWindow, qtbot: QtBot) -> None:
    dock = bent.histogram
    assert dock.counts.sum() == 480
    dock.set_weighted(True)
    total = simplex_measures(bent.document.mesh).sum()
    qtbot.waitUntil(lambda: bool(np.isclose(dock.counts.sum(), total)))
    dock.set_logarithmic_counts(True)
    qtbot.waitUntil(lambda: dock.plot.getPlotItem().getAxis("left").logMode)
    tops = dock.plot.bars.opts["y0"] + dock.plot.bars.opts["height"]
    filled = dock.counts > 0
    np.testing.assert_allclose(10.0 ** tops[filled], dock.counts[filled])
    assert (dock.plot.bars.opts["height"][~filled] == 0).all()
    dock.range.set_logarithmic(False)
    qtbot.waitUntil(lambda: not dock.plot.getPlotItem().getAxis("bottom").logMode)
    dock.range.set_logarithmic(True)


def test_a_quantity_is_chosen_in_each_view_and_watched(bent: MainWindow, qtbot: QtBot) -> None:
    snapshot = lambda: bent.document.snapshot  # noqa: E731
    chooser = bent.maps[0].chooser
    row = chooser.findData("det")
    chooser.setCurrentIndex(row)
    chooser.activated.emit(row)
    qtbot.waitUntil(lambda: "det" in snapshot().fields and bool(bent.maps[0].legend.numbers.text()))
    assert bent.maps[0].windowTitle() == "Determinant"
    for pane in (bent.source, bent.target):
        row = pane.chooser.findData("sigma1")
        pane.chooser.setCurrentIndex(row)
        pane.chooser.activated.emit(row)
        assert pane.legend.isVisibleTo(pane) and pane.legend.bar.range is bent.quantities.range_of("sigma1")
    qtbot.waitUntil(lambda: "sigma1" in snapshot().fields)
    bent.set_source_style("checkerboard")
    bent.set_target_style("plain")
    assert not bent.target.legend.isVisibleTo(bent.target)
    qtbot.waitUntil(lambda: "sigma1" not in snapshot().fields)
    bent.maps[0].show_quantity("dirichlet")


def test_a_hidden_panel_watches_nothing(bent: MainWindow, qtbot: QtBot) -> None:
    bent.histogram.hide()
    qtbot.waitUntil(lambda: "average-singular-value" not in bent.document.snapshot.fields)
    bent.histogram.show()
    qtbot.waitUntil(lambda: "average-singular-value" in bent.document.snapshot.fields)


def test_a_formula_is_typed_for_a_view_and_a_bad_one_refused(bent: MainWindow, qtbot: QtBot) -> None:
    chooser = bent.maps[1].chooser
    row = chooser.findData(FORMULA)
    chooser.setCurrentIndex(row)
    chooser.activated.emit(row)
    assert chooser.current == "condition-number", "nothing is chosen before it is typed"
    dialog = bent.findChild(FormulaDialog)
    dialog.formula.setText("sigma1 + nonsense")
    dialog.accept()
    assert "nonsense" in dialog.error.text() and dialog.isVisible()
    dialog.formula.setText("t*(sigma1 - sigma2)")
    dialog.values.setText("t = 2")
    dialog.accept()
    qtbot.waitUntil(lambda: bent.maps[1].quantity == "t*(sigma1 - sigma2) [t=2]")
    posted = [c for c in bent.bridge._worker.commands if isinstance(c, Watch)][-1]
    assert ("t", 2.0) in [p for measure in posted.measures for p in measure.parameters]
    qtbot.waitUntil(lambda: bool(bent.maps[1].legend.numbers.text()))
    bent.maps[1].show_quantity("condition-number")


def test_the_ends_of_a_bar_are_edited_and_shared(bent: MainWindow, qtbot: QtBot) -> None:
    bent.set_target_style("condition-number")
    bar = bent.maps[1].legend.bar
    QTest.mouseDClick(bar, Qt.MouseButton.LeftButton)
    dialog = bent.findChild(EndsDialog)
    dialog.low.setText("3")
    dialog.high.setText("2")
    dialog.accept()
    assert dialog.error.text() and dialog.isVisible()
    dialog.low.setText("1,1")
    dialog.accept()
    assert (bar.range.low, bar.range.high) == (1.1, 2.0) and bar.range.is_locked
    assert bent.target.legend.bar.range is bar.range
    assert bent.target.view.surface._mapper.GetLookupTable().GetRange() == (1.1, 2.0)
    bar.range.hold(False)
    bent.set_target_style("plain")


def test_the_distortion_in_force_is_followed(bent: MainWindow, qtbot: QtBot) -> None:
    qtbot.waitUntil(lambda: bent.quantities.is_listed)
    bent.maps[2].show_quantity("in-force")
    bent.document.choose(distortion="t*sum(sigma^2)", distortion_parameters={"t": 2.0})
    field = bent.maps[2].range.quantity.field
    assert field == "t*sum(sigma^2) [t=2]" and "t*sum(sigma^2)" in bent.maps[2].windowTitle()
    qtbot.waitUntil(lambda: field in bent.document.snapshot.fields)
    bent.document.choose(distortion="mips", distortion_parameters={})
    qtbot.waitUntil(lambda: "mips" in bent.document.snapshot.fields)
    assert bent.maps[2].range.low == pytest.approx(2.0), "it begins where the new one does"
    bent.maps[2].show_quantity("symmetric-dirichlet")


def test_a_held_range_says_so(bent: MainWindow) -> None:
    dock = bent.maps[0]
    dock.range.hold(True)
    assert "held" in dock.legend.numbers.note()
    dock.range.hold(False)
    assert "held" not in dock.legend.numbers.note()
