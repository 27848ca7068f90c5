"""Linear equations in the window: typed, in force, undone, refused in words."""

from pathlib import Path

import numpy as np
from PySide6.QtCore import Qt
from pytestqt.qtbot import QtBot

from tests.app.conftest import WindowMaker
from workbench.app.document.engine_bridge import engine_worker
from workbench.app.main_window import MainWindow
from workbench.cli import main


def bound(window: MainWindow) -> float:
    """How far vertex 0 and vertex 30 are from one height."""
    positions = window.document.positions
    assert positions is not None
    return float(abs(positions[0, 1] - positions[30, 1]))


def test_equations_bind_the_map_until_they_are_undone(make_window: WindowMaker, qtbot: QtBot, tmp_path: Path) -> None:
    window = make_window(engine_worker)
    document = window.document
    document.open_sample("gingerbread", run=False)
    qtbot.waitUntil(lambda: document.positions is not None and len(document.anchors) > 0)
    far = bound(window)
    assert far > 0.01
    window.actions_by_name["equations"].trigger()
    dialog = window.commands.binding.dialog
    assert dialog is not None
    dialog.text.setFocus()
    qtbot.keyClicks(dialog.text, "y[0] - y[3000000] = 0")
    qtbot.mouseClick(dialog.apply_button, Qt.MouseButton.LeftButton)
    assert "vertex 3000000" in dialog.state.text()
    assert document.session.linear_equations == ()
    dialog.text.selectAll()
    qtbot.keyClicks(dialog.text, "y[0] = y[30]")
    qtbot.waitUntil(lambda: "Not applied" in dialog.state.text())
    qtbot.mouseClick(dialog.apply_button, Qt.MouseButton.LeftButton)
    document.run()
    qtbot.waitUntil(lambda: document.snapshot.phase == "finished")
    assert bound(window) <= 1e-9
    qtbot.waitUntil(lambda: "1 equation in force" in dialog.state.text())
    document.set_anchors(document.anchors.with_target(1, document.positions[1] + [0.1, 0.2]))
    serial = document.anchor_serial
    qtbot.waitUntil(lambda: document.snapshot.anchor_serial == serial and document.snapshot.phase == "finished")
    assert bound(window) <= 1e-9
    path = tmp_path / "bound.dwb"
    window.sessions.desk.save(str(path), is_copy=True)
    qtbot.waitUntil(lambda: path.exists() and not window.sessions.desk.is_busy)
    assert main(["run", str(path), "--out", str(tmp_path / "again")]) == 0
    with np.load(next((tmp_path / "again").glob("*.npz"))) as again:
        assert abs(again["X"][0, 1] - again["X"][30, 1]) <= 1e-9
    for _ in range(8):
        window.undoing.undo()
    assert document.session.linear_equations == ()
    assert dialog.text.toPlainText() == ""


def test_equations_of_a_file_come_back_as_they_were_saved(make_window: WindowMaker, tmp_path: Path) -> None:
    window = make_window()
    window.actions_by_name["equations"].trigger()
    dialog = window.commands.binding.dialog
    dialog.text.setPlainText("x[1] + 2 y[2] = 3 - x[4]  # a remark")
    dialog.save(str(tmp_path / "e.txt"))
    dialog.text.setPlainText("")
    dialog.open(str(tmp_path / "e.txt"))
    assert dialog.text.toPlainText() == "x[1] + 2.0*y[2] + x[4] = 3.0"
    (tmp_path / "bad.txt").write_text("x[1] = 0\nx[] = 1\n")
    dialog.open(str(tmp_path / "bad.txt"))
    assert "line 2" in dialog.state.text()
    assert str(tmp_path / "bad.txt") in dialog.state.text()
