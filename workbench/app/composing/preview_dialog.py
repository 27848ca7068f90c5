"""What dialogs of figures and of films share: panels and choices at the left, what comes of them at the right."""

from __future__ import annotations

from collections.abc import Sequence

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
    QPushButton,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

from workbench.app.composing.offers import Offer
from workbench.app.composing.panel_table import PanelTable

DELAY = 250
"""Milliseconds after the last change until the preview is drawn."""


class PreviewDialog(QDialog):
    """`preview_wanted` a while after each change, `save_wanted` with a file.

    `room` is the width and height of the preview in pixels, at the most;  `least` those of the list of panels
    """

    preview_wanted = Signal()
    save_wanted = Signal(str)

    def __init__(
        self, title: str, offers: Sequence[Offer], room: tuple[int, int], least: tuple[int, int], parent: QWidget | None
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle(title)
        self._room = room
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(DELAY)
        self._timer.timeout.connect(self.preview_wanted)
        self.panels = PanelTable(offers, self)
        self.panels.setMinimumSize(*least)
        self.picture = QLabel("Drawing…", self)
        self.picture.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.picture.setMinimumSize(room[0] + 20, room[1] + 20)
        self.note = QLabel("", self)
        self.note.setWordWrap(True)
        self.buttons = QDialogButtonBox(self)
        self.save_button: QPushButton = self.buttons.addButton("Save…", QDialogButtonBox.ButtonRole.AcceptRole)
        self.save_button.clicked.connect(self._ask_file)
        self.buttons.addButton(QDialogButtonBox.StandardButton.Close)
        self.buttons.rejected.connect(self.close)

    def _lay_out(self, form: QFormLayout, below: QHBoxLayout | None = None) -> None:
        """Put everything into its place; `below` goes under the preview."""
        left, right, middle = QVBoxLayout(), QVBoxLayout(), QHBoxLayout()
        left.addWidget(self.panels, 1)
        left.addLayout(form)
        right.addWidget(self.picture, 1)
        right.addWidget(self.note)
        if below is not None:
            right.addLayout(below)
        middle.addLayout(left)
        middle.addLayout(right, 1)
        layout = QVBoxLayout(self)
        layout.addLayout(middle, 1)
        layout.addWidget(self.buttons)
        self.panels.changed.connect(self.ask_preview)
        self.ask_preview()

    # ------------------------------------------------------------------------------------------ choices

    def _row(self, *parts: QWidget | str) -> QHBoxLayout:
        """Fields beside each other, with words between them; each asks for a preview when it is changed."""
        row = QHBoxLayout()
        for part in parts:
            if isinstance(part, QWidget):
                row.addWidget(part)
                self._follow(part)
            elif part:
                row.addSpacing(10)
                row.addWidget(QLabel(part, self))
        row.addStretch(1)
        return row

    def _follow(self, field: QWidget) -> None:
        if isinstance(field, QLineEdit):
            field.textEdited.connect(self.ask_preview)
        elif isinstance(field, QSpinBox | QDoubleSpinBox):
            field.valueChanged.connect(self.ask_preview)
        elif isinstance(field, QComboBox):
            field.currentIndexChanged.connect(self.ask_preview)
        elif isinstance(field, QCheckBox):
            field.toggled.connect(self.ask_preview)

    def _list(self, words: dict[str, str | None]) -> QComboBox:
        """A list of these words, by their ids."""
        box = QComboBox(self)
        for id, text in words.items():
            box.addItem(text or id.capitalize(), id)
        return box

    def _tick(self, words: str, *, on: bool = True) -> QCheckBox:
        box = QCheckBox(words, self)
        box.setChecked(on)
        return box

    def ask_preview(self) -> None:
        """Draw anew, once no more is changed."""
        self._timer.start()

    # ------------------------------------------------------------------------------------------ results

    def _show(self, picture: QPixmap) -> None:
        """Show a picture in pixels of the screen, made smaller where it is too large."""
        ratio = self.devicePixelRatioF()
        width, height = (round(side * ratio) for side in self._room)
        if picture.width() > width or picture.height() > height:
            picture = picture.scaled(
                width, height, Qt.AspectRatioMode.KeepAspectRatio, Qt.TransformationMode.SmoothTransformation
            )
        picture.setDevicePixelRatio(ratio)
        self.picture.setPixmap(picture)

    def show_no_preview(self, sentence: str) -> None:
        """Say why there is nothing to save."""
        self.picture.setText(sentence)
        self.picture.setWordWrap(True)
        self.save_button.setEnabled(False)

    def say(self, sentence: str) -> None:
        """A line below the preview."""
        self.note.setText(sentence)

    def _ask_file(self) -> None:
        """Ask where to save, then emit `save_wanted`."""
        raise NotImplementedError

    def closeEvent(self, event: QCloseEvent) -> None:
        self._timer.stop()
        super().closeEvent(event)
