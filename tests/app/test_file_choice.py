"""Files are asked for in one way everywhere: nothing stops, the last folder is remembered, a drop does what a choice does."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import QApplication, QFileDialog, QWidget
from pytestqt.qtbot import QtBot

import workbench.app
from workbench.app.binding.equation_dialog import FILTER
from workbench.app.composing.figure_presets import FigurePresets
from workbench.app.files.file_choice import MAP_FILTERS, ask_file, ask_files, ask_folder
from workbench.app.files.file_drops import FileDrops
from workbench.app.files.new_file import ask_new_file, endings_of
from workbench.app.filling.fill_dialog import FillDialog
from workbench.app.main_window import MainWindow


def open_dialog(window: QWidget) -> QFileDialog:
    """The one file dialog that is open."""
    dialogs = [d for d in window.findChildren(QFileDialog) if d.isVisible()]
    assert len(dialogs) == 1
    return dialogs[0]


def drop(widget: QWidget, *paths: Path) -> bool:
    """Let files go over a widget; whether it took them."""
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path)) for path in paths])
    copy, left, none = Qt.DropAction.CopyAction, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    enter = QDragEnterEvent(QPoint(3, 3), copy, data, left, none)
    enter.ignore()
    QApplication.sendEvent(widget, enter)
    if enter.isAccepted():
        QApplication.sendEvent(widget, QDropEvent(QPointF(3, 3), copy, data, left, none))
    return enter.isAccepted()


@pytest.fixture
def folder(window: MainWindow, tmp_path: Path) -> Iterator[Path]:
    """The folder that the window was used with last."""
    (tmp_path / "last").mkdir()
    (tmp_path / "other").mkdir()
    window.settings.folder = str(tmp_path / "last")
    yield tmp_path
    for dialog in window.findChildren(QFileDialog):
        dialog.close()


def asks(window: MainWindow, take: Callable[[object], object]) -> dict[str, Callable[[QWidget], None]]:
    return {
        "file": lambda parent: ask_file(parent, "One", MAP_FILTERS, take),
        "files": lambda parent: ask_files(parent, "Some", MAP_FILTERS, take),
        "folder": lambda parent: ask_folder(parent, "Folder", take),
        "new": lambda parent: ask_new_file(parent, "New", window.settings.folder, "Text (*.txt)", "txt", take),
    }


@pytest.mark.parametrize("kind", ["file", "files", "folder", "new"])
def test_every_question_begins_where_the_last_one_ended(window: MainWindow, folder: Path, kind: str, qtbot: QtBot) -> None:
    taken: list[object] = []
    chosen = folder / "other" if kind == "folder" else folder / "other" / "a.obj"
    if kind != "folder":
        chosen.write_text("v 0 0 0\n")
    asks(window, taken.append)[kind](window.panel)  # a part of the window knows its folder, too
    dialog = open_dialog(window)
    assert Path(dialog.directory().absolutePath()) == folder / "last" and dialog.isModal()
    dialog.fileSelected.emit(str(chosen))
    dialog.filesSelected.emit([str(chosen)])
    assert taken == [[str(chosen)] if kind == "files" else str(chosen)]
    assert Path(window.settings.folder) == folder / "other"
    dialog.close()
    qtbot.waitUntil(lambda: not window.findChildren(QFileDialog))


def test_a_folder_that_is_gone_is_not_begun_in(window: MainWindow, folder: Path) -> None:
    window.settings.folder = str(folder / "gone")
    ask_file(window, "One", "", lambda path: None)
    assert Path(open_dialog(window).directory().absolutePath()) != folder / "gone"


def test_who_leaves_the_question_is_told(window: MainWindow, folder: Path) -> None:
    left: list[bool] = []
    ask_file(window, "One", "", lambda path: None, place=str(folder / "other"), leave=lambda: left.append(True))
    dialog = open_dialog(window)
    assert Path(dialog.directory().absolutePath()) == folder / "other"
    dialog.reject()
    assert left == [True]


def test_no_other_place_makes_file_dialogs() -> None:
    root = Path(workbench.app.__file__).parent
    makers = {
        path.name
        for path in root.rglob("*.py")
        if re.search(r"QFileDialog\(|getOpenFileName|getSaveFileName", path.read_text())
    }
    assert makers == {"file_choice.py", "new_file.py"}


def test_a_drop_on_a_dialog_is_a_choice_there(window: MainWindow, tmp_path: Path) -> None:
    dialog = FillDialog("", str(tmp_path), window)
    dialog.show()
    fish = tmp_path / "Fish.OBJ"
    assert drop(dialog, fish) and dialog.source.text() == str(fish)
    assert drop(dialog.source, tmp_path / "b.stl") and dialog.source.text() == str(tmp_path / "b.stl"), "no name as text"
    assert not drop(dialog, tmp_path / "b.txt"), "what the question would not show is not taken"
    dialog.close()
    dialog.deleteLater()
    taken: list[list[str]] = []
    widget = QWidget(window)
    FileDrops(widget, MAP_FILTERS, taken.append)
    assert drop(widget, tmp_path / "a.obj", tmp_path / "b.npz", tmp_path / "c.txt")
    assert taken == [[str(tmp_path / "a.obj"), str(tmp_path / "b.npz")]]
    widget.deleteLater()


def test_equations_that_are_dropped_on_the_window_are_shown(window: MainWindow, tmp_path: Path) -> None:
    path = tmp_path / "bound.txt"
    path.write_text("x[12] - x[30] = 0\n")
    assert drop(window, path)
    dialog = window.commands.binding.dialog
    assert dialog is not None and dialog.isVisible() and "x[12]" in dialog.text.toPlainText()
    assert window.document.session.linear_equations == (), "they bind when they are applied"
    path.write_text("y[3] = 1\n")
    assert drop(dialog.text.viewport(), path) and dialog.text.toPlainText().startswith("y[3] = 1")
    dialog.close()


def test_endings_are_those_of_the_first_filter() -> None:
    assert endings_of(FILTER) == {".txt"} and endings_of("") == frozenset()
    assert {".obj", ".mesh", ".vtu"} <= endings_of(MAP_FILTERS)


def test_presets_ask_for_their_folder(window: MainWindow, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[tuple[str, str]] = []
    monkeypatch.setattr(FigurePresets, "make", lambda self, preset, place: made.append((preset, place)))
    window.commands.presets._ask("fig3")
    open_dialog(window).fileSelected.emit(str(folder / "other"))
    assert made == [("fig3", str(folder / "other"))]
