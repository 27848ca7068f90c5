"""The dialog of the preferences: what is changed in it is seen at once, and Cancel takes it all back."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import QEvent, Qt
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QListWidget,
    QScrollArea,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from workbench.app.preferences.catalogue import PAGES, PREFERENCES
from workbench.app.preferences.preference_field import PreferenceField
from workbench.app.preferences.preferences import Preferences

Buttons = QDialogButtonBox.StandardButton


class PreferencesDialog(QDialog):
    """Pages at the left, the lines of one at the right."""

    def __init__(self, preferences: Preferences, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Preferences")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._preferences = preferences
        self._before = preferences.values
        self.fields: dict[str, PreferenceField] = {}
        self.pages = QListWidget(self)
        self.pages.addItems(list(PAGES))
        self._fit_pages()
        self.stack = QStackedWidget(self)
        for page in PAGES:
            self.stack.addWidget(self._make_page(page))
        self.pages.currentRowChanged.connect(self.stack.setCurrentIndex)
        self.pages.setCurrentRow(0)
        middle = QHBoxLayout()
        middle.addWidget(self.pages)
        middle.addWidget(self.stack, 1)
        layout = QVBoxLayout(self)
        layout.addLayout(middle, 1)
        layout.addWidget(self._make_buttons())
        self.resize(660, 380)
        preferences.changed.connect(self._show)
        for name in self.fields:
            self._show(name)

    def _make_page(self, page: str) -> QWidget:
        body = QWidget(self)
        form = QFormLayout(body)
        form.setHorizontalSpacing(14)
        form.setVerticalSpacing(10)
        for preference in PREFERENCES:
            if preference.page != page:
                continue
            field = PreferenceField(preference, lambda value, n=preference.name: self._preferences.set(n, value), body)
            words = QLabel(f"{preference.parameter.description}.", body)
            words.setObjectName("citation")
            words.setWordWrap(True)
            lines = QVBoxLayout()
            lines.setSpacing(2)
            lines.addWidget(field.widget, 0, Qt.AlignmentFlag.AlignLeft)
            lines.addWidget(words)
            label = QLabel(preference.label, body)
            label.setBuddy(field.widget)
            form.addRow(label, lines)
            self.fields[preference.name] = field
        scroll = QScrollArea(self)
        scroll.setWidgetResizable(True)
        scroll.setFrameShape(QScrollArea.Shape.NoFrame)
        scroll.setWidget(body)
        return scroll

    def _make_buttons(self) -> QDialogButtonBox:
        buttons = QDialogButtonBox(Buttons.Ok | Buttons.Cancel | Buttons.RestoreDefaults, self)
        restore = buttons.button(Buttons.RestoreDefaults)
        restore.setToolTip("The defaults of this page")
        restore.setAutoDefault(False)
        restore.clicked.connect(self.restore_page)
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        return buttons

    def _fit_pages(self) -> None:
        self.pages.setFixedWidth(self.pages.sizeHintForColumn(0) + 28)

    def changeEvent(self, event: QEvent) -> None:
        """Larger letters take more room."""
        super().changeEvent(event)
        if event.type() == QEvent.Type.FontChange:
            self._fit_pages()

    # ------------------------------------------------------------------------------------------

    def show_page(self, page: str) -> None:
        """Turn to a page."""
        self.pages.setCurrentRow(PAGES.index(page))

    def offer(self, name: str, words: Mapping[str, str]) -> None:
        """Choices that were not known when the dialog was made."""
        self.fields[name].offer(words)

    def restore_page(self) -> None:
        """The defaults of the page that is shown."""
        page = PAGES[self.pages.currentRow()]
        self._preferences.restore_defaults(p.name for p in PREFERENCES if p.page == page)

    def _show(self, name: str) -> None:
        self.fields[name].show(self._preferences[name])

    def accept(self) -> None:
        """Keep what is in force."""
        self._preferences.keep()
        super().accept()

    def reject(self) -> None:
        """Everything as it was before the dialog."""
        before: dict[str, Any] = self._before
        self._preferences.set_all(before)
        super().reject()
