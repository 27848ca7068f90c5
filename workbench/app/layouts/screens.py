"""A window that was larger than the screen, or on one that is gone, comes to lie on a screen that there is."""

from __future__ import annotations

from PySide6.QtCore import QRect
from PySide6.QtWidgets import QWidget


def fitted(wanted: QRect, available: QRect) -> QRect:
    """`wanted` no larger than `available`, and moved inside it by the shortest way."""
    width, height = min(wanted.width(), available.width()), min(wanted.height(), available.height())
    left = min(max(wanted.left(), available.left()), available.left() + available.width() - width)
    top = min(max(wanted.top(), available.top()), available.top() + available.height() - height)
    return QRect(left, top, width, height)


def bring_on_screen(window: QWidget) -> None:
    """Fit a window, with its frame, to the screen that it is on, unless it fills it by intent."""
    if window.isMaximized() or window.isFullScreen():
        return
    available = window.screen().availableGeometry()
    frame, inner = window.frameGeometry(), window.geometry()
    wanted = fitted(frame, available)
    if wanted != frame:
        offset = inner.topLeft() - frame.topLeft()
        extra = frame.size() - inner.size()
        window.setGeometry(QRect(wanted.topLeft() + offset, wanted.size() - extra))
