"""Panels that a small screen has no room for are closed at the first start: else the window would go beyond it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QSize

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow


def make_room(window: MainWindow, available: QSize) -> None:
    """Close panels until the window can be as small as `available`, or the rest is needed; View > Panels has them again."""
    if window.minimumSizeHint().width() > available.width():
        window.convergence.hide()
    for dock in (*window.maps[:-1], window.histogram):
        if window.minimumSizeHint().height() > available.height():
            dock.hide()
