"""One chapter as a page: code on a ground of its own, pictures as wide as the page, links that wait for a click."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt, QTimer, QUrl
from PySide6.QtGui import (
    QColor,
    QDesktopServices,
    QFontDatabase,
    QImage,
    QResizeEvent,
    QTextBlock,
    QTextBlockFormat,
    QTextCharFormat,
    QTextCursor,
    QTextDocument,
    QTextFormat,
    QTextTable,
)
from PySide6.QtWidgets import QTextBrowser, QTextEdit, QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.help.chapters import Chapter, with_fences

WIDEST_PICTURE = 900
OPENED = ("http", "https")
"""Kinds of links that a click opens in the browser; nothing is fetched without one."""


class HelpPage(QTextBrowser):
    """Shows chapters whose pictures lie below `folder`."""

    def __init__(self, folder: Path, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._folder = folder.resolve()
        self._theme = theme
        self._chapter: Chapter | None = None
        self._words = ""
        self.setOpenLinks(False)
        self.setFrameShape(QTextBrowser.Shape.NoFrame)
        self.document().setDocumentMargin(18)
        self.anchorClicked.connect(self._follow)
        self._again = QTimer(self)
        self._again.setSingleShot(True)
        self._again.setInterval(150)
        self._again.timeout.connect(self._show)

    def set_theme(self, theme: Theme) -> None:
        self._theme = theme
        self._show()

    def show_chapter(self, chapter: Chapter, words: str = "") -> None:
        """Put a chapter on the page, `words` marked; the page is at the first of them, or at its beginning."""
        self._chapter, self._words = chapter, words
        self._show()
        self.verticalScrollBar().setValue(0)
        if words:
            self.find_next()

    def find_next(self, *, backwards: bool = False) -> bool:
        """Go to the next place of the words, from the end back to the beginning; false where there is none."""
        first = self._words.split()[0] if self._words.split() else ""
        flags = QTextDocument.FindFlag.FindBackward if backwards else QTextDocument.FindFlag(0)
        if not first or self.find(first, flags):
            return bool(first)
        self.moveCursor(QTextCursor.MoveOperation.End if backwards else QTextCursor.MoveOperation.Start)
        return self.find(first, flags)

    # ------------------------------------------------------------------------------------------ Qt's own

    def loadResource(self, kind: int, name: QUrl) -> Any:
        """Pictures of the README, never larger than the page; nothing from elsewhere."""
        if kind != QTextDocument.ResourceType.ImageResource.value or not name.isRelative():
            return None
        path = (self._folder / name.path()).resolve()
        image = QImage(str(path)) if path.is_relative_to(self._folder) else QImage()
        ratio = self.devicePixelRatioF()
        width = round(min(self.viewport().width() - 52, WIDEST_PICTURE) * ratio)
        if not image.isNull() and image.width() > width > 50:
            image = image.scaledToWidth(width, Qt.TransformationMode.SmoothTransformation)
        image.setDevicePixelRatio(ratio)
        return image

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if event.size().width() != event.oldSize().width():
            self._again.start()

    # ------------------------------------------------------------------------------------------

    def _show(self) -> None:
        if self._chapter is None:
            return
        place = self.verticalScrollBar().value()
        self.document().clear()
        self.setMarkdown(with_fences(self._chapter.text))
        self._dress()
        self._rule_tables()
        self._mark()
        self.verticalScrollBar().setValue(place)

    def _dress(self) -> None:
        """Room between lines, headings in sizes that suit a panel, code on a ground of its own."""
        ground = QColor(self._theme.window)
        fixed = QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont).family()
        cursor = QTextCursor(self.document())
        block = self.document().begin()
        while block.isValid():
            cursor.setPosition(block.position())
            cursor.movePosition(QTextCursor.MoveOperation.EndOfBlock, QTextCursor.MoveMode.KeepAnchor)
            form, characters = QTextBlockFormat(), QTextCharFormat()
            form.setLineHeight(118.0, QTextBlockFormat.LineHeightTypes.ProportionalHeight.value)
            level = block.blockFormat().headingLevel()
            if level:
                form.setBottomMargin(8.0)
                characters.setProperty(QTextFormat.Property.FontSizeAdjustment, {1: 3, 2: 2}.get(level, 1))
                cursor.mergeCharFormat(characters)
            elif is_code(block):
                form.setBackground(ground)
                form.setNonBreakableLines(True)
                form.setLeftMargin(14.0)
                form.setTopMargin(0.0)
                form.setBottomMargin(0.0)
                characters.setFontFamilies([fixed])
                characters.setProperty(QTextFormat.Property.FontSizeAdjustment, -1)
                cursor.mergeCharFormat(characters)
            cursor.mergeBlockFormat(form)
            block = block.next()

    def _rule_tables(self) -> None:
        """Lines of tables in the colour of all lines, and no empty head."""
        for frame in self.document().rootFrame().childFrames():
            if isinstance(frame, QTextTable):
                if not any(frame.cellAt(0, column).firstCursorPosition().block().text() for column in range(frame.columns())):
                    frame.removeRows(0, 1)
                form = frame.format()
                form.setBorderBrush(QColor(self._theme.border))
                form.setBorderCollapse(True)
                form.setCellPadding(5.0)
                frame.setFormat(form)

    def _mark(self) -> None:
        """Every place of every word that is looked for."""
        marks = []
        colour = QColor("#7a5c00" if self._theme.is_dark else "#ffe08a")
        for word in self._words.split():
            cursor = self.document().find(word)
            while not cursor.isNull():
                mark = QTextEdit.ExtraSelection()
                mark.cursor = cursor  # type: ignore[attr-defined]
                mark.format.setBackground(colour)  # type: ignore[attr-defined]
                marks.append(mark)
                cursor = self.document().find(word, cursor)
        self.setExtraSelections(marks)

    def _follow(self, link: QUrl) -> None:
        if link.scheme() in OPENED:
            QDesktopServices.openUrl(link)


def is_code(block: QTextBlock) -> bool:
    """Whether a block is one of code: Markdown marks those by lines that must not break."""
    return block.blockFormat().nonBreakableLines() or block.blockFormat().hasProperty(QTextFormat.Property.BlockCodeFence)
