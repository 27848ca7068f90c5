"""Figures of the presets are made by the command line, of the map as it is in the window."""

from __future__ import annotations

import sys
from itertools import pairwise
from pathlib import Path

import pytest
from PySide6.QtWidgets import QMenu
from pytestqt.qtbot import QtBot

from workbench.app.composing import figure_presets
from workbench.app.main_window import MainWindow
from workbench.figures.presets import PRESETS


@pytest.fixture
def command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A program in the place of Python that notes its arguments; a file `refuse` beside the notes makes it refuse."""
    program, notes = tmp_path / "python", tmp_path / "notes"
    program.write_text(
        f'#!/bin/sh\nprintf "%s\\n" "$@" > {notes}\n'
        f'if [ -e {tmp_path}/refuse ]; then echo "workbench: It is not to be." >&2; exit 2; fi\n'
    )
    program.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(program))
    monkeypatch.setattr(figure_presets, "write", lambda request: request.path.write_bytes(b"map"))
    return notes


def test_the_menu_has_every_preset(window: MainWindow) -> None:
    menu = QMenu(window)
    window.commands.presets.fill_menu(menu)
    assert [action.text() for action in menu.actions()] == [f"{id}…" for id in PRESETS]
    assert all(action.isEnabled() and action.toolTip() != action.text() for action in menu.actions())
    menu.deleteLater()


@pytest.mark.skipif(sys.platform == "win32", reason="the program in the place of Python is a shell script")
def test_source_and_map_are_handed_over(window: MainWindow, command: Path, tmp_path: Path, qtbot: QtBot) -> None:
    presets = window.commands.presets
    presets.make("fig3", str(tmp_path / "out"))
    presets.make("fig3", str(tmp_path / "out"))
    assert window.error_bar.isVisible(), "one at a time"
    qtbot.waitUntil(lambda: "Saved fig3.png" in window.status.sentence.text())
    given = command.read_text().split("\n")
    assert given[:4] == ["-m", "workbench", "figure", "fig3"]
    options = dict(pairwise(given))
    assert options["--mesh"] == window.document.session.source and options["--map"] == window.document.kind
    label, _, file = options["--given"].partition("=")
    assert label == "map" and not Path(file).exists(), "the map was there only as long as it was wanted"
    (tmp_path / "refuse").touch()
    presets.make("fig3", str(tmp_path / "out"))
    qtbot.waitUntil(lambda: window.status.sentence.text() == "No figure was made.")
    assert window.error_bar.isVisible()


def test_a_source_that_is_gone_is_refused(window: MainWindow, tmp_path: Path, qtbot: QtBot) -> None:
    window.commands.presets.make("fig3", str(tmp_path))
    qtbot.waitUntil(lambda: window.status.sentence.text() == "No figure was made.")
    assert window.error_bar.isVisible() and not list(tmp_path.glob("fig3*"))
