"""The place of a plot that is made late: what draws plots takes long to import, and the window is seen before."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import Signal
from PySide6.QtGui import QPalette
from PySide6.QtWidgets import QVBoxLayout, QWidget

from workbench.app.appearance.theme import Theme


class PlotPlace(QWidget):
    """Empty ground until `plot` is asked for, which `make` makes with the place as its parent; `made` tells of it.

    The plot has `set_theme`, and shows nothing yet when it is made.
    """

    made = Signal()

    def __init__(self, make: Callable[[QWidget], Any], least: tuple[int, int], parent: QWidget) -> None:
        super().__init__(parent)
        self._make = make
        self._plot: Any = None
        self._theme: Theme | None = None
        self.setMinimumSize(*least)
        self.setAutoFillBackground(True)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)

    @property
    def is_made(self) -> bool:
        return self._plot is not None

    @property
    def plot(self) -> Any:
        """The plot, made now where it was not before."""
        if self._plot is None:
            self._plot = self._make(self)
            if self._theme is not None:
                self._plot.set_theme(self._theme)
            layout = self.layout()
            assert layout is not None
            layout.addWidget(self._plot)
            self.made.emit()
        return self._plot

    def set_theme(self, theme: Theme) -> None:
        self._theme = theme
        palette = self.palette()
        palette.setColor(QPalette.ColorRole.Window, theme.view)
        self.setPalette(palette)
        if self._plot is not None:
            self._plot.set_theme(theme)
