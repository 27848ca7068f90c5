"""Help > Cite what this session uses: what is chosen in the window stands in the bibliography."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtGui import QGuiApplication
from pytestqt.qtbot import QtBot

from workbench.app.main_window import MainWindow
from workbench.core.bibliography import SURVEY


def shown(window: MainWindow) -> str:
    window.actions_by_name["cite"].trigger()
    dialog = window.commands.citing.dialog
    assert dialog is not None and dialog.isVisible()
    return dialog.text.toPlainText()


def test_choices_are_cited_copied_and_saved(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    document = window.document
    document.choose(distortion="lam*mips + (1 - lam)*arap", distortion_parameters={"lam": 0.5}, solver="slim")
    text = shown(window)
    for key in (SURVEY, "HG00", "SA07", "RPPSH17"):
        assert f"{{{key}," in text
    citing = window.commands.citing
    citing.dialog.copy()
    assert QGuiApplication.clipboard().text() == text
    citing.save(str(tmp_path / "used.bib"))
    assert (tmp_path / "used.bib").read_text(encoding="utf-8") == text
    citing.save(str(tmp_path / "none" / "used.bib"))
    assert "no folder" in window.error_bar.sentence.text()

    document.choose(solver="aqp")
    again = shown(window)  # the dialog of before gives way to a new one
    assert "{KGL16," in again and "{RPPSH17," not in again
    citing.dialog.reject()
    assert citing.dialog is None
