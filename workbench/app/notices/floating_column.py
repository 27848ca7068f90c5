"""Bars that lie over the views at their lower edge: what comes and goes pushes nothing about."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtWidgets import QVBoxLayout, QWidget

MARGIN = 10
BELOW = 48
"""Pixels left free at the lower edge, where views say what keys do."""
WIDEST = 900


class FloatingColumn(QWidget):
    """Widgets, one below the other, over `host`; as high as those that are shown, and gone with the last of them."""

    def __init__(self, host: QWidget) -> None:
        super().__init__(host)
        self._host = host
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(4)
        self._parts: list[QWidget] = []
        self.setAttribute(Qt.WidgetAttribute.WA_NoMousePropagation)
        host.installEventFilter(self)
        self.hide()

    def add(self, part: QWidget) -> None:
        """Put a widget below those that are there."""
        self._column.addWidget(part)
        self._parts.append(part)
        part.installEventFilter(self)
        self._place()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        kinds = (QEvent.Type.Resize, QEvent.Type.ShowToParent, QEvent.Type.HideToParent, QEvent.Type.LayoutRequest)
        if event.type() in kinds:
            self._place()
        return False

    def _place(self) -> None:
        has_something = any(not part.isHidden() for part in self._parts)
        self.setVisible(has_something)
        if not has_something:
            return
        width = min(self._host.width() - 2 * MARGIN, WIDEST)
        column = self._column
        height = column.totalHeightForWidth(width) if column.hasHeightForWidth() else column.sizeHint().height()
        height = min(max(height, 1), self._host.height() - MARGIN - BELOW)
        self.setGeometry((self._host.width() - width) // 2, self._host.height() - height - BELOW, width, height)
        for part in self._parts:
            _lay_out(part)
        self.raise_()


def _lay_out(part: QWidget) -> None:
    """Place what stands in a part: the event that shows it comes before Qt tells its layout of a new width."""
    layout = part.layout()
    if layout is not None:
        layout.invalidate()
        layout.activate()
