"""Filling a closed surface from the window: the dialog, the work on a thread, the solid that is opened."""

from __future__ import annotations

import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from pytestqt.qtbot import QtBot

from workbench.app.filling.fill_dialog import FillDialog
from workbench.app.main_window import MainWindow
from workbench.core.errors import WorkbenchError
from workbench.core.samples import make_sample
from workbench.engine import filling
from workbench.engine.messages import Load


@pytest.fixture
def dialog(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> Iterator[FillDialog]:
    """The dialog with a folder of the test's own, and a closed surface named."""
    window.settings.folder = str(tmp_path)
    window.bridge._worker.commands.clear()
    window.actions_by_name["fill"].trigger()
    dialog = window.commands.filling.dialog
    assert dialog is not None and dialog.isVisible()
    dialog.source.setText("sample:blob")
    yield dialog
    if window.commands.filling.dialog is dialog:
        dialog.close()
    window.commands.filling.wait()
    qtbot.waitUntil(lambda: window.commands.filling._work is None)


def loads(window: MainWindow) -> list[str]:
    return [c.source for c in window.bridge._worker.commands if isinstance(c, Load)]


def test_the_solid_is_written_and_opened(
    dialog: FillDialog, window: MainWindow, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    asked = []

    def fill(surface, options, *, cancelled, tell):
        asked.append((surface.simplex_count, surface.diameter / options.edge_length))
        tell("half of it is done")
        return make_sample("ball", 200)

    monkeypatch.setattr(filling, "fill_surface", fill)
    dialog.parts.setValue(30)
    path = Path(dialog.file.text())
    assert path == tmp_path / "blob-filled.mesh"
    dialog.accept_button.click()
    qtbot.waitUntil(lambda: bool(loads(window)))
    assert loads(window) == [str(path)] and path.exists()
    assert asked == [(make_sample("blob").simplex_count, pytest.approx(30.0))]
    assert window.commands.filling.dialog is None


def test_what_cannot_be_filled_is_said_in_the_dialog(
    dialog: FillDialog, window: MainWindow, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(filling, "can_fill", lambda: True)
    for source, words in (("", "Name the file"), ("nowhere.obj", "no file"), ("sample:fingers", "open")):
        dialog.source.setText(source)
        assert not dialog.error.isVisible()
        dialog.accept_button.click()
        qtbot.waitUntil(dialog.error.isVisible)
        assert words in dialog.error.text() and dialog.accept_button.isEnabled()
    monkeypatch.setattr(filling, "can_fill", lambda: False)
    dialog.source.setText("sample:blob")
    dialog.accept_button.click()
    qtbot.waitUntil(dialog.error.isVisible)
    assert "[fill]" in dialog.error.text()
    dialog.file.setText(str(tmp_path / "solid.stl"))
    dialog.accept_button.click()
    assert ".msh" in dialog.error.text()
    assert not loads(window) and not list(tmp_path.iterdir())


def test_cancel_ends_the_work_and_keeps_the_dialog(
    dialog: FillDialog, window: MainWindow, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fill(surface, options, *, cancelled, tell):
        tell("it takes long")
        while not cancelled():
            time.sleep(0.01)
        raise WorkbenchError("Filling was cancelled.")

    monkeypatch.setattr(filling, "fill_surface", fill)
    dialog.accept_button.click()
    qtbot.waitUntil(lambda: "takes long" in dialog.words.text())
    assert dialog.progress.isVisible() and not dialog.accept_button.isEnabled()
    dialog.cancel_button.click()
    qtbot.waitUntil(dialog.accept_button.isEnabled)
    assert "cancelled" in dialog.error.text() and not dialog.progress.isVisible()
    assert not loads(window)


def test_a_closed_dialog_ends_the_work(
    dialog: FillDialog, window: MainWindow, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    ended = []

    def fill(surface, options, *, cancelled, tell):
        while not cancelled():
            time.sleep(0.01)
        ended.append(True)
        raise WorkbenchError("Filling was cancelled.")

    monkeypatch.setattr(filling, "fill_surface", fill)
    dialog.accept_button.click()
    qtbot.waitUntil(lambda: window.commands.filling._work is not None)
    dialog.close()
    qtbot.waitUntil(lambda: bool(ended) and window.commands.filling._work is None)
    assert not window.error_bar.isVisible()
