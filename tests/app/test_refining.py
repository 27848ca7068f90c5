"""Refining the open map: the dialog, the file it writes, the document that is opened from it, the curves."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from workbench.app.main_window import MainWindow
from workbench.app.refining.refine_dialog import RefineDialog
from workbench.app.refining.refine_work import CurveRequest, draw_curves
from workbench.core.mesh import Mesh
from workbench.core.refine import Refined, refine
from workbench.engine.messages import Load


@pytest.fixture
def dialog(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> RefineDialog:
    """The dialog on the grid of the fake engine, two anchors set, with a folder of the test's own."""
    window.settings.folder = str(tmp_path)
    window.document.add_anchor(272)
    window.document.add_anchor(0)
    window.bridge._worker.commands.clear()
    window.actions_by_name["refine"].trigger()
    dialog = window.commands.refining.dialog
    assert dialog is not None and dialog.isVisible()
    yield dialog
    if window.commands.refining.dialog is dialog:
        dialog.close()
    window.commands.refining.wait()
    qtbot.waitUntil(lambda: not window.commands.refining._works)


def loads(window: MainWindow) -> list[Load]:
    return [c for c in window.bridge._worker.commands if isinstance(c, Load)]


def test_the_refined_map_is_written_and_opened_with_its_anchors(dialog: RefineDialog, window: MainWindow, qtbot: QtBot) -> None:
    document = window.document
    mesh, positions, anchors = document.mesh, document.positions, document.anchors
    dialog.scheme.setCurrentIndex(dialog.scheme.findData("loop"))
    dialog.levels.setValue(2)
    assert "7\u2009680 triangles" in dialog.count.text()
    path = Path(dialog.file.text())
    assert path.name == "grid-loop-2.npz"
    dialog.accept_button.click()
    qtbot.waitUntil(lambda: bool(loads(window)))
    assert (loads(window)[0].source, loads(window)[0].kind) == (str(path), "plane")
    expected = refine(mesh, positions, "loop", 2)
    with np.load(path, allow_pickle=False) as case:
        np.testing.assert_array_equal(case["V"], expected.mesh.vertices)
        np.testing.assert_array_equal(case["S"], expected.mesh.simplices)
        np.testing.assert_array_equal(case["X"], expected.positions)
        np.testing.assert_array_equal(case["anchors"], anchors.vertices)
        np.testing.assert_array_equal(case["targets"], anchors.target_array(2))
    qtbot.waitUntil(lambda: document.session.source == str(path))
    assert path.name in window.windowTitle()
    assert window.commands.refining.dialog is None


def test_another_mesh_opened_meanwhile_stays(dialog: RefineDialog, window: MainWindow, qtbot: QtBot) -> None:
    path = Path(dialog.file.text())
    dialog.accept_button.click()
    window.open("bumpy")
    qtbot.waitUntil(lambda: path.exists() and not window.commands.refining._works)
    QTest.qWait(50)
    assert [load.source for load in loads(window)] == ["bumpy"]


def test_the_proposed_name_is_free_and_follows_the_choices(dialog: RefineDialog, tmp_path: Path) -> None:
    (tmp_path / "grid-loop-1.npz").touch()
    dialog.scheme.setCurrentIndex(dialog.scheme.findData("loop"))
    assert Path(dialog.file.text()) == tmp_path / "grid-loop-1-2.npz"
    dialog.file.setText(str(tmp_path / "mine.npz"))
    dialog.file.textEdited.emit(dialog.file.text())
    dialog.levels.setValue(3)
    assert Path(dialog.file.text()) == tmp_path / "mine.npz"
    dialog.levels.setValue(1000)
    assert dialog.levels.value() < 12, "the number of triangles has a limit"


@pytest.mark.parametrize(
    ("name", "words"), [("there.npz", "already"), ("map.obj", ".npz"), ("no/such/folder.npz", "no folder")]
)
def test_a_file_that_will_not_do_is_refused_in_the_dialog(
    name: str, words: str, dialog: RefineDialog, window: MainWindow, tmp_path: Path
) -> None:
    (tmp_path / "there.npz").write_text("kept")
    dialog.file.setText(str(tmp_path / name))
    dialog.accept_button.click()
    assert words in dialog.error.text() and dialog.isVisible()
    assert (tmp_path / "there.npz").read_text() == "kept"
    assert not loads(window)


def test_what_fails_on_the_thread_is_said_in_the_window(
    dialog: RefineDialog, window: MainWindow, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_: object) -> None:
        raise OSError("no space left")

    monkeypatch.setattr("workbench.app.refining.refining.refine_into", fail)
    dialog.accept_button.click()
    qtbot.waitUntil(window.error_bar.isVisible)
    assert "no space left" in window.error_bar.sentence.text()
    assert not loads(window)


def test_curves_are_shown_and_saved(dialog: RefineDialog, window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    assert not dialog.save.isEnabled()
    dialog.curve_levels.setValue(1)
    dialog.measure.click()
    assert not dialog.measure.isEnabled()
    qtbot.waitUntil(dialog.save.isEnabled)
    assert not dialog.picture.pixmap().isNull() and dialog.measure.isEnabled()
    assert dialog.picture.width() >= dialog.picture.pixmap().deviceIndependentSize().width()
    for ending, magic in (("pdf", b"%PDF"), ("svg", b"<?xml"), ("png", b"\x89PNG")):
        dialog.figure_wanted.emit(str(tmp_path / f"curves.{ending}"))
        assert (tmp_path / f"curves.{ending}").read_bytes().startswith(magic)
    dialog.figure_wanted.emit(str(tmp_path / "curves.gif"))
    assert ".svg" in dialog.error.text()


def test_closing_the_dialog_ends_the_measuring(
    dialog: RefineDialog, window: MainWindow, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    def endless(mesh: Mesh, positions: np.ndarray, *_: object) -> Iterator[Refined]:
        while True:
            time.sleep(0.01)
            yield Refined(mesh, positions, "linear", 0)

    monkeypatch.setattr("workbench.core.refine.level_measures.refined_levels", endless)
    dialog.measure.click()
    QTest.qWait(200)
    assert window.commands.refining._works
    dialog.close()
    assert window.commands.refining.dialog is None
    qtbot.waitUntil(lambda: not window.commands.refining._works)
    assert not window.error_bar.isVisible()


def test_volumes_have_curves_of_the_linear_scheme(cube: Mesh) -> None:
    request = CurveRequest(cube, cube.vertices * 1.1, 1, "cube", "sum(sigma^2) + a", {"a": 2.0})
    curves = draw_curves(request)
    panels = [axes for axes in curves.figure.axes if axes.lines]
    assert len(panels) == 4
    assert [line.get_label() for line in panels[0].lines] == ["linear"]
    np.testing.assert_allclose(panels[3].lines[0].get_ydata(), 3 * 1.21 + 2.0, rtol=1e-12)
