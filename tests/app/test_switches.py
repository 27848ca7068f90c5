"""Marks on the curves: when something was switched, and what."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPointF, QRectF
from pytestqt.qtbot import QtBot

from tests.app.fake_engine import FakeWorker
from workbench.app.docks.axis_numbers import decade_marks, distinct_numbers
from workbench.app.document import switches as switches_module
from workbench.app.document.document import Document
from workbench.app.document.engine_bridge import EngineBridge
from workbench.app.document.history import History
from workbench.app.document.switches import Switches
from workbench.app.main_window import MainWindow
from workbench.engine.messages import HistoryRow


class Run:
    """A document, a history that is stepped by hand, and its switches."""

    def __init__(self) -> None:
        self.document = Document(EngineBridge(FakeWorker))
        self.history = History()
        self.switches = Switches(self.document, self.history)
        self.iteration = 0
        self.step(0)

    def step(self, count: int) -> None:
        for _ in range(max(count, 1)):
            self.history.extend([HistoryRow(self.iteration, 0.5 * self.iteration, 5.0, 1.0, 0.5, 1.0, 0, 0.0)])
            self.iteration += 1

    @property
    def said(self) -> list[tuple[int, str]]:
        return [(switch.iteration, switch.sentence) for switch in self.switches]


@pytest.fixture
def run(qapp, monkeypatch: pytest.MonkeyPatch) -> Run:  # type: ignore[no-untyped-def]
    monkeypatch.setattr(switches_module.time, "perf_counter", lambda: 100.0)
    return Run()


def test_before_the_first_step_nothing_is_marked(run: Run) -> None:
    run.document.choose(solver="aqp")
    assert not len(run.switches)


def test_what_is_switched_is_marked_where_it_was(run: Run) -> None:
    run.step(4)
    run.document.choose(solver="no-such", solver_parameters={"reach": 2.0})
    run.step(3)
    run.document.choose(distortion="t*mips", distortion_parameters={"t": 0.25})
    run.step(3)
    run.document.choose(fixed_boundary=True)
    assert run.said == [(4, "no-such, reach = 2"), (7, "t*mips, t = 0.25"), (10, "boundary fixed")]
    assert [switch.seconds for switch in run.switches] == [2.0, 3.5, 5.0]


def test_drawing_a_slider_is_one_switch_at_its_beginning(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    run.document.choose(distortion="t*mips", distortion_parameters={"t": 0.0})
    run.step(4)
    for place in range(1, 8):
        run.document.choose(distortion_parameters={"t": 0.1 * place})
        run.step(1)
    assert run.said == [(4, "t = 0.7")]
    monkeypatch.setattr(switches_module.time, "perf_counter", lambda: 200.0)
    run.document.choose(distortion_parameters={"t": 0.1})
    assert run.said == [(4, "t = 0.7"), (11, "t = 0.1")]


def test_what_is_taken_back_at_rest_leaves_no_mark(run: Run) -> None:
    run.step(4)
    first = run.document.session.solver
    for solver in ("aqp", "slim", first):
        before = run.document.session.solver
        run.document.choose(solver=solver)
        assert len(run.switches) == (solver != first), before
    run.document.choose(match_area=False)
    assert not len(run.switches), "the start is no part of the run"


def test_marks_stand_on_the_curves_and_say_what_was_switched(window: MainWindow, qtbot: QtBot) -> None:
    dock = window.convergence
    window.document.history_restarted.emit()
    window.history.extend(HistoryRow(i, 0.1 * i, 5.0 + i, 1.0, 0.5, 1.0, 0, 0.0) for i in range(50))
    window.document.choose(distortion="mips")
    window.history.extend(HistoryRow(i, 0.1 * i, 5.0 + i, 1.0, 0.5, 1.0, 0, 0.0) for i in range(50, 100))
    for abscissa in (0, 1):
        dock.abscissa.setCurrentIndex(abscissa)
        dock.refresh()
        place = 4.9 if abscissa else 49.0
        for plot in dock.plots.plots:
            box = plot.getViewBox()
            height = sum(box.viewRange()[1]) / 2
            at = dock.plots.mapFromScene(box.mapViewToScene(QPointF(place, height)))
            assert "MIPS" in dock.plots.marks.sentence_at(QPointF(at))
            away = dock.plots.mapFromScene(box.mapViewToScene(QPointF(place / 2, height)))
            assert not dock.plots.marks.sentence_at(QPointF(away))
    dock.abscissa.setCurrentIndex(0)
    window.document.history_restarted.emit()
    dock.refresh()
    assert not dock.plots.marks.sentence_at(QPointF(at))


def test_numbers_of_a_narrow_axis_differ() -> None:
    values = [2.66e-15, 2.68e-15, 2.70e-15]
    texts = distinct_numbers(values)
    assert len(set(texts)) == 3
    assert [float(text) for text in texts] == pytest.approx(values)
    assert distinct_numbers([1e-15, 1e10, 5.0]) == ["1e-15", "1e10", "5"]


def test_every_logarithmic_axis_has_two_numbers() -> None:
    """A curve without numbers tells nothing."""
    for low in np.linspace(-3.3, 4.0, 40):
        for span in (1e-3, 0.01, 0.04, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 1.2, 2.5, 9.0):
            for most in (2, 3, 5):
                marks = decade_marks(low, low + span, most)
                assert 2 <= len(marks) <= most + 1
                assert low - 1e-9 <= min(marks) and max(marks) <= low + span + 1e-9


def test_a_number_at_the_end_of_an_axis_with_a_grid_is_written(window: MainWindow, qtbot: QtBot) -> None:
    axis = window.convergence.plots.plots[0].getAxis("left")
    box, bounds = axis.mapRectFromParent(axis.geometry()), axis.boundingRect()
    assert axis.grid is not False
    assert bounds.contains(QRectF(1.0, box.bottom() - 6.0, 10.0, 12.0))


def test_the_plots_stay_inside_a_narrow_dock(window: MainWindow, qtbot: QtBot) -> None:
    dock = window.convergence
    window.document.history_restarted.emit()
    wide, narrow = 1.23456e-15, 1.0
    window.history.extend(HistoryRow(i, 0.1 * i, wide * (1 + 1e-4 * i), wide, 0.5, 1.0, 0, 0.0) for i in range(5))
    dock.refresh()
    dock.setFloating(True)
    dock.resize(300, 200)
    qtbot.waitUntil(lambda: dock.plots.viewport().width() <= 300)
    qtbot.wait(50)
    window.history.clear()
    window.history.extend(HistoryRow(i, 0.1 * i, narrow + i, narrow, 0.5, 1.0, 0, 0.0) for i in range(5))
    dock.refresh()
    qtbot.wait(50)
    dock.refresh()
    right = max(plot.sceneBoundingRect().right() for plot in dock.plots.plots)
    assert right <= dock.plots.viewport().width()
    dock.setFloating(False)
    window.document.history_restarted.emit()
