"""A view with its title line: what is shown, and how it is coloured."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from workbench.app.theme import Theme
from workbench.app.views.mesh_view import MeshView


class ViewPane(QWidget):
    """Title, choice of colouring, and the view; `add_below` puts a colour bar under it."""

    style_chosen = Signal(str)

    def __init__(self, title: str, styles: dict[str, str], theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._layout = QVBoxLayout(self)
        self._layout.setContentsMargins(0, 0, 0, 0)
        self._layout.setSpacing(0)
        header = QHBoxLayout()
        header.setContentsMargins(10, 4, 6, 4)
        header.setSpacing(6)
        name = QLabel(f"<b>{title}</b>", self)
        self.caption = QLabel("", self)
        self.caption.setObjectName("citation")
        self.caption.setMinimumWidth(10)
        self.style_box = QComboBox(self)
        for id, label in styles.items():
            self.style_box.addItem(label, id)
        self.style_box.setToolTip(f"How the {title.lower()} is coloured")
        self.style_box.activated.connect(lambda _: self.style_chosen.emit(self.style_box.currentData()))
        header.addWidget(name)
        header.addWidget(self.caption, 1)
        header.addWidget(self.style_box)
        self._layout.addLayout(header)
        self.view = MeshView(theme, self)
        self._layout.addWidget(self.view, 1)

    def add_below(self, widget: QWidget) -> None:
        self._layout.addWidget(widget)

    def set_style(self, id: str) -> None:
        self.style_box.setCurrentIndex(self.style_box.findData(id))
