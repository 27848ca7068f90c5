"""The title of a dock that says what it shows by a list in which it is chosen."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QSize, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtWidgets import QDockWidget, QHBoxLayout, QToolButton, QWidget

from workbench.app.appearance.icons import drawn


class DockTitle(QWidget):
    """Widgets in the place of a dock's title, and the buttons that every dock has; it is dragged between them."""

    def __init__(self, dock: QDockWidget, *widgets: QWidget) -> None:
        super().__init__(dock)
        self.setObjectName("dock-title")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(6, 2, 4, 2)
        layout.setSpacing(4)
        for widget in widgets:
            layout.addWidget(widget, 1 if widget is widgets[0] else 0)
        layout.addSpacing(14)
        self._buttons = {
            "float": (lambda: dock.setFloating(not dock.isFloating()), "Float, or dock again"),
            "close": (dock.close, "Close; View > Panels shows it again"),
        }
        self._made: list[tuple[QToolButton, str]] = []
        for picture, (deed, tip) in self._buttons.items():
            button = QToolButton(self)
            button.setAutoRaise(True)
            button.setObjectName("dock-button")
            button.setIconSize(QSize(10, 10))
            button.setFixedSize(16, 16)
            button.setToolTip(tip)
            button.clicked.connect(deed)
            layout.addWidget(button)
            self._made.append((button, picture))
        self._set_icons()

    def add(self, widget: QWidget) -> None:
        """Put a widget before the buttons that every dock has."""
        layout = self.layout()
        assert isinstance(layout, QHBoxLayout)
        layout.insertWidget(layout.count() - len(self._made), widget)

    def _set_icons(self) -> None:
        palette = self.palette()
        for button, picture in self._made:
            button.setIcon(drawn(picture, palette.windowText().color(), palette.mid().color()))

    def changeEvent(self, event: QEvent) -> None:
        if event.type() in (QEvent.Type.PaletteChange, QEvent.Type.StyleChange):
            self._set_icons()
        super().changeEvent(event)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        event.ignore()  # the dock's own: it floats
