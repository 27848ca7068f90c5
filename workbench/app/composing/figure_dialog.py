"""The dialog that composes a figure: panels and page at the left, what comes of them at the right."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QCloseEvent, QPixmap
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

from workbench.app.composing.offers import Offer
from workbench.app.composing.panel_table import PanelTable
from workbench.app.new_file import ask_new_file
from workbench.figures.recipe import BACKGROUNDS, Page, Panel

FILTERS = "PDF (*.pdf);;SVG (*.svg);;PNG (*.png);;Recipe (*.json)"
DELAY = 250
"""Milliseconds after the last change until the preview is drawn."""
PREVIEW = (620, 560)
"""Pixels of the preview, at the most."""


class FigureDialog(QDialog):
    """`preview_wanted` a while after each change, `save_wanted` with a file, `map_wanted` for the map as it is now."""

    preview_wanted = Signal()
    save_wanted = Signal(str)
    map_wanted = Signal()
    closed = Signal()

    def __init__(self, offers: Sequence[Offer], stem: str, folder: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Figure")
        self._stem, self._folder = stem, folder
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(DELAY)
        self._timer.timeout.connect(self.preview_wanted)
        self.panels = PanelTable(offers, self)
        self.panels.setMinimumSize(400, 260)
        left = QVBoxLayout()
        left.addWidget(self.panels, 1)
        left.addLayout(self._make_form())
        self.picture = QLabel("Drawing…", self)
        self.picture.setObjectName("figure-preview")
        self.picture.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.picture.setMinimumSize(PREVIEW[0] + 20, PREVIEW[1] + 20)
        # paper is white whatever the theme, and shows where a transparent page lies on it
        self.picture.setStyleSheet("#figure-preview { background: white; color: #303030; border: 1px solid #a0a0a0; }")
        self.note = QLabel("", self)
        self.note.setWordWrap(True)
        right = QVBoxLayout()
        right.addWidget(self.picture, 1)
        right.addWidget(self.note)
        middle = QHBoxLayout()
        middle.addLayout(left)
        middle.addLayout(right, 1)
        layout = QVBoxLayout(self)
        layout.addLayout(middle, 1)
        layout.addWidget(self._make_buttons())
        self.panels.changed.connect(self.ask_preview)
        self.ask_preview()

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
        self.background = QComboBox(self)
        for id in BACKGROUNDS:
            self.background.addItem(id.capitalize(), id)
        self.bars = QCheckBox("Colour bars", self)
        self.bars.setChecked(True)
        self.anchors = QCheckBox("Anchors", self)
        self.anchors.setChecked(True)
        self.letters = QCheckBox("Letters", self)
        form = QFormLayout()
        form.addRow("Title", self.title)
        form.addRow("Width", self._row(self.width_mm, "dpi", self.dpi))
        form.addRow("Text", self._row(self.font, "columns", self.columns))
        form.addRow("Background", self._row(self.background))
        form.addRow("Show", self._row(self.bars, "", self.anchors, "", self.letters))
        self.title.textEdited.connect(self.ask_preview)
        for box in (self.width_mm, self.dpi, self.font, self.columns):
            box.valueChanged.connect(self.ask_preview)
        self.background.currentIndexChanged.connect(self.ask_preview)
        for tick in (self.bars, self.anchors, self.letters):
            tick.toggled.connect(self.ask_preview)
        return form

    def _row(self, *parts: QWidget | str) -> QHBoxLayout:
        row = QHBoxLayout()
        for part in parts:
            if isinstance(part, QWidget):
                row.addWidget(part)
            elif part:
                row.addSpacing(10)
                row.addWidget(QLabel(part, self))
        row.addStretch(1)
        return row

    def _make_buttons(self) -> QDialogButtonBox:
        buttons = QDialogButtonBox(self)
        self.save_button = buttons.addButton("Save…", QDialogButtonBox.ButtonRole.AcceptRole)
        self.save_button.setToolTip("PDF, SVG or PNG; or a recipe that `workbench figure` makes the figure of")
        renew = buttons.addButton("Take the map as it is now", QDialogButtonBox.ButtonRole.ActionRole)
        renew.setAutoDefault(False)
        buttons.addButton(QDialogButtonBox.StandardButton.Close)
        self.save_button.clicked.connect(self._ask_file)
        renew.clicked.connect(self.map_wanted)
        buttons.rejected.connect(self.close)
        return buttons

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

    def ask_preview(self) -> None:
        """Draw anew, once no more is changed."""
        self._timer.start()

    # ------------------------------------------------------------------------------------------ results

    def show_preview(self, png: bytes) -> None:
        """Show the figure."""
        picture, ratio = QPixmap(), self.devicePixelRatioF()
        picture.loadFromData(png, "PNG")
        width, height = (round(side * ratio) for side in PREVIEW)
        if picture.width() > width or picture.height() > height:
            picture = picture.scaled(
                width, height, Qt.AspectRatioMode.KeepAspectRatio, Qt.TransformationMode.SmoothTransformation
            )
        picture.setDevicePixelRatio(ratio)
        self.picture.setPixmap(picture)
        self.save_button.setEnabled(True)

    def show_no_preview(self, sentence: str) -> None:
        """Say why there is no figure."""
        self.picture.setText(sentence)
        self.picture.setWordWrap(True)
        self.save_button.setEnabled(False)

    def say(self, sentence: str) -> None:
        """A line below the preview."""
        self.note.setText(sentence)

    def _ask_file(self) -> None:
        place = str(Path(self._folder) / f"{self._stem}-figure.pdf")
        ask_new_file(self, "Save the figure", place, FILTERS, "pdf", self.save_wanted.emit, overwrites=True)

    def closeEvent(self, event: QCloseEvent) -> None:
        self._timer.stop()
        self.closed.emit()
        super().closeEvent(event)
