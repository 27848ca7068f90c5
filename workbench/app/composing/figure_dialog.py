"""The dialog that composes a figure: panels and page at the left, what comes of them at the right."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtGui import QCloseEvent, QPixmap
from PySide6.QtWidgets import QDialogButtonBox, QDoubleSpinBox, QFormLayout, QLineEdit, QSpinBox, QWidget

from workbench.app.composing.offers import Offer
from workbench.app.composing.preview_dialog import PreviewDialog
from workbench.app.files.new_file import ask_new_file
from workbench.figures.recipe import BACKGROUNDS, Page, Panel

FILTERS = "PDF (*.pdf);;SVG (*.svg);;PNG (*.png);;Recipe (*.json)"
PREVIEW = (620, 560)
"""Pixels of the preview, at the most."""


class FigureDialog(PreviewDialog):
    """`map_wanted` for the map as it is now."""

    map_wanted = Signal()
    closed = Signal()

    def __init__(self, offers: Sequence[Offer], stem: str, folder: str, parent: QWidget | None = None) -> None:
        super().__init__("Figure", offers, PREVIEW, (400, 260), parent)
        self._stem, self._folder = stem, folder
        self.picture.setObjectName("figure-preview")
        # paper is white whatever the theme, and shows where a transparent page lies on it
        self.picture.setStyleSheet("#figure-preview { background: white; color: #303030; border: 1px solid #a0a0a0; }")
        self.save_button.setToolTip("PDF, SVG or PNG; or a recipe that `workbench figure` makes the figure of")
        renew = self.buttons.addButton("Take the map as it is now", QDialogButtonBox.ButtonRole.ActionRole)
        renew.setAutoDefault(False)
        renew.clicked.connect(self.map_wanted)
        self._lay_out(self._make_form())

    def _make_form(self) -> QFormLayout:
        usual = Page()
        self.title = QLineEdit(self)
        self.title.setMaxLength(300)
        self.width_mm = QDoubleSpinBox(self)
        self.width_mm.setDecimals(0)
        self.width_mm.setRange(20, 1000)
        self.width_mm.setSuffix(" mm")
        self.width_mm.setValue(usual.width)
        self.dpi = QSpinBox(self)
        self.dpi.setRange(36, 1200)
        self.dpi.setValue(usual.dpi)
        self.dpi.setToolTip("Of PNG, and of pictures inside PDF and SVG")
        self.font = QDoubleSpinBox(self)
        self.font.setDecimals(1)
        self.font.setRange(3, 40)
        self.font.setSuffix(" pt")
        self.font.setValue(usual.font_size)
        self.columns = QSpinBox(self)
        self.columns.setRange(1, 8)
        self.columns.setValue(usual.columns)
        self.background = self._list(dict.fromkeys(BACKGROUNDS))
        self.bars, self.anchors = self._tick("Colour bars"), self._tick("Anchors")
        self.letters = self._tick("Letters", on=False)
        form = QFormLayout()
        form.addRow("Title", self.title)
        self._follow(self.title)
        form.addRow("Width", self._row(self.width_mm, "dpi", self.dpi))
        form.addRow("Text", self._row(self.font, "columns", self.columns))
        form.addRow("Background", self._row(self.background))
        form.addRow("Show", self._row(self.bars, "", self.anchors, "", self.letters))
        return form

    # ------------------------------------------------------------------------------------------ choices

    @property
    def page(self) -> Page:
        """The page as it is chosen."""
        return Page(
            width=self.width_mm.value(),
            dpi=self.dpi.value(),
            font_size=self.font.value(),
            background=str(self.background.currentData()),
            columns=self.columns.value(),
            letters=self.letters.isChecked(),
            title=self.title.text().strip(),
        )

    @property
    def chosen(self) -> tuple[Panel, ...]:
        """The panels as they are chosen."""
        shown = self.anchors.isChecked()
        return tuple(replace(panel, anchors=shown) for panel in self.panels.panels(bars=self.bars.isChecked()))

    # ------------------------------------------------------------------------------------------ results

    def show_preview(self, png: bytes) -> None:
        """Show the figure."""
        picture = QPixmap()
        picture.loadFromData(png, "PNG")
        self._show(picture)
        self.save_button.setEnabled(True)

    def _ask_file(self) -> None:
        place = str(Path(self._folder) / f"{self._stem}-figure.pdf")
        ask_new_file(self, "Save the figure", place, FILTERS, "pdf", self.save_wanted.emit, overwrites=True)

    def closeEvent(self, event: QCloseEvent) -> None:
        self.closed.emit()
        super().closeEvent(event)
