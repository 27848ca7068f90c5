"""The README in the window: every chapter, its pictures, search, and the chapter of what is in use."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from email.message import Message
from fnmatch import fnmatch
from importlib import metadata
from pathlib import Path

import pytest
from PySide6.QtCore import QEvent, Qt, QUrl
from PySide6.QtGui import QDesktopServices, QTextDocument
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QFileDialog
from pytestqt.qtbot import QtBot

from workbench.app.appearance.theme import DARK, LIGHT
from workbench.app.help.chapters import cut_into_chapters, read_chapters, with_fences
from workbench.app.help.help_desk import AT_FIRST, CHAPTER_OF
from workbench.app.help.help_window import HelpWindow
from workbench.app.help.page import is_code
from workbench.app.main_window import MainWindow


@pytest.fixture(scope="module")
def kept_help(qapp: QApplication) -> Iterator[HelpWindow]:
    window = HelpWindow(LIGHT)
    yield window
    window.close()
    window.deleteLater()
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)


@pytest.fixture
def help(kept_help: HelpWindow, qtbot: QtBot) -> HelpWindow:
    kept_help.show()
    kept_help.search.clear()
    return kept_help


def blocks(document: QTextDocument) -> list:
    found, block = [], document.begin()
    while block.isValid():
        found.append(block)
        block = block.next()
    return found


def test_chapters_are_the_whole_readme(project_root: Path) -> None:
    text = (project_root / "README.md").read_text(encoding="utf-8")
    chapters = read_chapters()
    lines = [line for line in text.splitlines() if line.strip()]
    assert [line for chapter in chapters for line in chapter.text.splitlines() if line.strip()] == lines
    assert set(CHAPTER_OF.values()) <= {chapter.title for chapter in chapters}, "context help leads to no chapter"


def test_a_sign_in_code_is_no_heading() -> None:
    chapters = cut_into_chapters("# A\n\n    # a remark\n    run\n\n## B\ntext\n")
    assert [(c.title, c.level) for c in chapters] == [("A", 1), ("B", 2)]
    assert with_fences("a\n\n    one\n\n    two\n\nb\n") == "a\n\n```\none\n\ntwo\n```\n\nb\n"
    assert with_fences("1. a list\n    goes on\n") == "1. a list\n    goes on\n"


def test_without_the_file_it_is_that_of_the_metadata(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    found = metadata.metadata("distortion-workbench")
    titles = {chapter.title for chapter in read_chapters(tmp_path)}
    assert {"Start", "The first minute"} <= titles or not found.get_payload()
    monkeypatch.setattr(metadata, "metadata", lambda name: Message())
    assert "missing" in read_chapters(tmp_path)[0].text


def test_every_picture_is_found_and_fits_the_page(help: HelpWindow) -> None:
    count = 0
    for chapter in help.chapters:
        for part in chapter.text.split("](")[1:]:
            name = part.partition(")")[0]
            if name.endswith(".png"):
                image = help.page.loadResource(QTextDocument.ResourceType.ImageResource.value, QUrl(name))
                assert not image.isNull(), name
                assert image.deviceIndependentSize().width() <= help.page.viewport().width()
                count += 1
    assert count
    for name in ("https://example.org/a.png", "../../secret.png", "file:///etc/passwd"):
        image = help.page.loadResource(QTextDocument.ResourceType.ImageResource.value, QUrl(name))
        assert image is None or image.isNull(), "nothing is read from outside the program's folder"


def test_search_lists_the_chapters_that_hold_the_words_and_marks_them(help: HelpWindow) -> None:
    QTest.keyClicks(help.search, "ctrl+z")
    titles = [item.text(0) for item in help._items.values()]
    assert titles == [c.title for c in help.chapters if "ctrl+z" in c.text.casefold()] and titles
    assert help.title in titles
    assert {mark.cursor.selectedText().casefold() for mark in help.page.extraSelections()} == {"ctrl+z"}
    help.search.setText("no such words anywhere")
    assert help.nothing.isVisible() and not help.contents.isVisible()
    help.search.clear()
    assert help.contents.topLevelItemCount() > 5


def test_back_and_forth(help: HelpWindow) -> None:
    help.show_chapter("Sessions")
    help.show_chapter("Files")
    help.back.click()
    assert help.title == "Sessions"
    help.forth.click()
    assert help.title == "Files" and not help.forth.isEnabled()


def test_code_stands_on_the_ground_of_the_theme(help: HelpWindow) -> None:
    for theme in (DARK, LIGHT):
        help.set_theme(theme)
        help.show_chapter("Write a solver")
        code = [block for block in blocks(help.page.document()) if is_code(block)]
        assert len(code) > 20
        assert {block.blockFormat().background().color().name() for block in code} == {theme.window}


def test_links_open_by_a_click_only(help: HelpWindow, monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []
    monkeypatch.setattr(QDesktopServices, "openUrl", lambda url: opened.append(url.toString()))
    help.page.anchorClicked.emit(QUrl("file:///etc/passwd"))
    assert not opened
    help.page.anchorClicked.emit(QUrl("https://example.org/"))
    assert opened == ["https://example.org/"]


def test_f1_opens_the_chapter_of_what_is_in_use(window: MainWindow, qtbot: QtBot) -> None:
    QTest.keyClick(window, Qt.Key.Key_F1)
    qtbot.waitUntil(lambda: window.help.help is not None and window.help.help.isVisible())
    assert window.help.help.title in {AT_FIRST, *CHAPTER_OF.values()}
    window.help.help.close()
    window.activateWindow()
    QTest.qWaitForWindowActive(window)


def test_the_wheel_takes_the_readme_and_its_pictures_along(project_root: Path) -> None:
    project = tomllib.loads((project_root / "pyproject.toml").read_text(encoding="utf-8"))
    wheel = project["tool"]["hatch"]["build"]["targets"]["wheel"]
    assert project["project"]["readme"] == "README.md", "then it is the description in the metadata"
    assert wheel["sources"]["assets"] == "workbench/assets"
    pictures = {p.relative_to(project_root).as_posix() for p in (project_root / "assets").rglob("*.png")}
    assert pictures and not any(fnmatch(name, pattern) for name in pictures for pattern in wheel["exclude"])


def test_f1_in_a_dialog_opens_its_chapter(window: MainWindow, qtbot: QtBot) -> None:
    window.commands.ask_save()
    dialog = window.findChildren(QFileDialog)[-1]
    qtbot.waitUntil(lambda: QApplication.focusWidget() is not None and QApplication.focusWidget().window() is dialog)
    QTest.keyClick(QApplication.focusWidget(), Qt.Key.Key_F1)
    qtbot.waitUntil(lambda: window.help.help is not None and window.help.help.isVisible())
    assert window.help.help.title == "Files"
    window.help.help.close()
    dialog.close()
    window.activateWindow()
    QTest.qWaitForWindowActive(window)
