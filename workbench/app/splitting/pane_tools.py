"""The two buttons at the end of a view's title line: its camera's chain, and its menu."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from PySide6.QtCore import QPoint, QSize, Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QMenu, QToolButton, QWidget

from workbench.app.appearance.icons import icon
from workbench.app.appearance.theme import Theme

LINKED = "Turn, move and zoom together with the other linked views of this kind"


class PaneTools(QWidget):
    """`fill_menu` puts into a menu what can be done to the view; a right click on `line` opens it, too."""

    link_toggled = Signal(bool)

    def __init__(self, fill_menu: Callable[[QMenu], None], theme: Theme, line: QWidget) -> None:
        super().__init__(line)
        self._fill_menu = fill_menu
        self._theme = theme
        self.chain = self._button("chain", LINKED)
        self.chain.setCheckable(True)
        self.chain.toggled.connect(lambda _: self._show_chain())
        self.chain.toggled.connect(self.link_toggled)
        self.more = self._button("split", "Split this view, close it, and what it draws")
        self.more.clicked.connect(lambda: self.open_menu(self.more.mapToGlobal(self.more.rect().bottomLeft())))
        self.menu: QMenu | None = None
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(1)
        layout.addWidget(self.chain)
        layout.addWidget(self.more)
        self.set_theme(theme)
        line.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        line.customContextMenuRequested.connect(lambda where: self.open_menu(line.mapToGlobal(where)))

    def _button(self, name: str, tip: str) -> QToolButton:
        button = QToolButton(self)
        button.setObjectName(name)
        button.setAutoRaise(True)
        button.setIconSize(QSize(14, 14))
        button.setFixedSize(20, 20)
        button.setToolTip(tip)
        return button

    def set_theme(self, theme: Theme) -> None:
        self._theme = theme
        self.more.setIcon(icon("split", theme))
        self._show_chain()

    def _show_chain(self) -> None:
        """In the colour of what is on, as some themes draw a pressed button like any other."""
        theme = self._theme
        self.chain.setIcon(icon("chain", replace(theme, text=theme.accent if self.chain.isChecked() else theme.faint)))

    def open_menu(self, where: QPoint) -> None:
        """The menu at a place of the screen."""
        self.menu = QMenu(self.window())
        self._fill_menu(self.menu)
        self.menu.aboutToHide.connect(self.menu.deleteLater)
        self.menu.popup(where)
