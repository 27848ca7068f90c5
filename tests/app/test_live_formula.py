"""A formula and its sliders on a map that the real engine is at."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from tests.app.conftest import WindowMaker
from workbench.app.document.document import Document
from workbench.app.document.engine_bridge import engine_worker

BLEND = "lam*symmetric_dirichlet + (1 - lam)*exp(condition_number)"


def rest(document: Document, qtbot: QtBot) -> None:
    """Until no map has come for half a second: the last value of a slider may be on its way when the one before is done."""
    numbers = [-1]
    while numbers[-1] != document.snapshot.number or document.snapshot.phase != "finished":
        numbers.append(document.snapshot.number)
        qtbot.wait(500)


def test_a_slider_moves_the_running_map_and_what_does_not_suit_it_is_refused(make_window: WindowMaker, qtbot: QtBot) -> None:
    window = make_window(engine_worker, source="")
    document, box = window.document, window.panel.distortion
    qtbot.waitUntil(lambda: len(document.anchors) > 0 and box.combo.count() > 1)
    vertex = int(document.anchors.vertices[-1])
    reach = 0.4 * np.ptp(document.positions, axis=0)
    document.move_anchor(vertex, document.anchors.targets[vertex] + reach, False)
    document.run()
    box.edit.setFocus()
    box.edit.selectAll()
    QTest.keyClicks(box.edit, BLEND)
    QTest.keyClick(box.edit, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: document.snapshot.distortion == BLEND and document.snapshot.phase == "finished")

    iterations, energies, inverted = [], [], []
    document.snapshot_taken.connect(lambda: iterations.append(document.snapshot.row.iteration))
    document.snapshot_taken.connect(lambda: energies.append(document.snapshot.row.energy))
    document.snapshot_taken.connect(lambda: inverted.append(int(document.snapshot.inverted.sum())))
    before = document.positions
    row = box.form.rows["lam"]
    row.slider.setSliderDown(True)
    for tick in range(row.slider.value(), row.range.ticks, 10):
        row.slider.setValue(tick)
        qtbot.wait(10)
    row.slider.setValue(row.range.ticks)
    qtbot.waitUntil(lambda: len(iterations) > 3)  # maps come before the hand lets go
    row.slider.setSliderDown(False)
    last = len(iterations)
    qtbot.waitUntil(lambda: len(iterations) > last and document.snapshot.phase == "finished")
    assert iterations == sorted(iterations) and iterations[0] > 1, "it goes on, and does not start over"
    assert document.session.distortion_parameters == {"lam": 1.0}
    assert not any(inverted)
    assert np.abs(document.positions - before).max() > 1e-3 * np.ptp(before)

    rest(document, qtbot)
    here = document.positions
    box.edit.selectAll()
    QTest.keyClicks(box.edit, "log(1.4 - sigma1/sigma2) + sum(sigma^2)")  # finite at ordinary values, not on this map
    QTest.keyClick(box.edit, Qt.Key.Key_Return)
    qtbot.waitUntil(window.error_bar.isVisible)
    assert "finite number" in box.error.text()
    assert document.session.distortion == BLEND
    np.testing.assert_allclose(document.positions, here)
