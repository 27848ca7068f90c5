"""Where panels lie: layouts with names, those of the program and those of the user, and views alone on the whole screen."""

from __future__ import annotations

import binascii
from base64 import b64decode, b64encode
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import QByteArray, QObject, Qt, QTimer
from PySide6.QtWidgets import QDockWidget, QInputDialog, QLineEdit, QMenu, QToolBar

from workbench.app.layouts.screens import bring_on_screen
from workbench.app.layouts.small_screens import make_room
from workbench.core.errors import WorkbenchError

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

DEFAULT = "Default"
SHOWN: dict[str, Callable[[MainWindow], list[QDockWidget]]] = {
    "Drag": lambda window: [window.panel_dock, window.maps[-1]],
    "Analyse": lambda window: [window.panel_dock, window.maps[-1], window.inspector, window.histogram, window.convergence],
    "Views only": lambda window: [],
}
"""Panels that a layout of the program shows, where they lie at first; all others are closed."""
TIPS = {
    DEFAULT: "Every panel where it was at the first start",
    "Drag": "Large views, the choices and one colour map",
    "Analyse": "The inspector, histogram and curves beside one colour map",
    "Views only": "Source and target, and nothing beside them",
}
LONGEST, MOST = 40, 30
"""Letters of a name, and layouts that are kept."""


@dataclass(frozen=True, eq=False)
class Before:
    """How the window was when views were given the screen."""

    state: QByteArray
    how: Qt.WindowState
    bars: list[QToolBar]


class Layouts(QObject):
    """Belongs to the window; made once all its panels are where they lie at first."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._first = window.saveState()
        self._before: Before | None = None
        self._kept: tuple[QByteArray, QByteArray] | None = None
        self.dialog: QInputDialog | None = None
        actions = window.actions_by_name
        actions["present"].triggered.connect(self.present)
        actions["save-layout"].triggered.connect(self.ask_name)

    # ------------------------------------------------------------------------------------------ from start to start

    def restore(self) -> None:
        """As the window was when it was closed last, on a screen that there is."""
        kept = self._window.settings.layout()
        if kept is not None:
            self._window.restoreGeometry(kept[0])
            self._window.restoreState(kept[1])
        else:
            make_room(self._window, self._window.screen().availableGeometry().size())
        bring_on_screen(self._window)

    def keep(self) -> None:
        """For the next start; that views have the screen to themselves is over then."""
        self.present(False)
        self._window.settings.save_layout(self._window.saveGeometry(), self._window.saveState())

    def keep_if_changed(self) -> None:
        """The same while the window goes on, should it not end by itself; not while views have the screen."""
        now = self._window.saveGeometry(), self._window.saveState()
        if self._before is None and now != self._kept:
            self._kept = now
            self._window.settings.save_layout(*now)

    # ------------------------------------------------------------------------------------------ layouts

    @property
    def own(self) -> dict[str, QByteArray]:
        """Those that the user saved; what cannot be read is left out."""
        found = {}
        for name, text in self._window.settings.layouts().items():
            if isinstance(text, str) and 0 < len(name) <= LONGEST:
                try:
                    found[name] = QByteArray(b64decode(text, validate=True))
                except (binascii.Error, ValueError):
                    continue
        return found

    def apply(self, name: str) -> None:
        """Arrange the panels as a layout has them."""
        self.present(False)
        window, own = self._window, self.own
        size = window.size()
        QTimer.singleShot(0, self, lambda: window.resize(size))  # panels that change places may push it apart
        if name in own:
            if not window.restoreState(own[name]):
                window.status.say(f"The layout {name} is of another version of the window; save it anew.")
            return
        window.restoreState(self._first)
        if name in SHOWN:
            shown = SHOWN[name](window)
            for dock in sorted(window.docks, key=lambda dock: dock in shown):  # room is made before it is taken
                dock.setVisible(dock in shown)

    def save_as(self, name: str) -> None:
        """Keep the panels as they lie now under a name. Raises `WorkbenchError` where it cannot be used."""
        name = " ".join(name.split())
        others = {other: state for other, state in self.own.items() if other != name}
        if not 0 < len(name) <= LONGEST:
            raise WorkbenchError(f"A layout has a name of 1 to {LONGEST} letters.")
        if name in TIPS:
            raise WorkbenchError(f"{name} is a layout of the program; choose another name.")
        if len(others) >= MOST:
            raise WorkbenchError(f"{MOST} layouts are kept at the most; delete one first.")
        self._keep_own(others | {name: self._window.saveState()})
        self._window.status.say(f"The layout is kept as {name}: View > Layout.")

    def delete(self, name: str) -> None:
        """Forget a layout of the user's."""
        self._keep_own({other: state for other, state in self.own.items() if other != name})

    def _keep_own(self, own: dict[str, QByteArray]) -> None:
        self._window.settings.save_layouts({name: b64encode(state.data()).decode() for name, state in own.items()})

    def ask_name(self) -> None:
        """A small dialog for the name."""
        dialog = QInputDialog(self._window)
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.setWindowTitle("Save the layout")
        dialog.setLabelText("Name of the layout; one that there is already is replaced:")
        dialog.textValueSelected.connect(self._take_name)
        dialog.finished.connect(self._closed)
        self.dialog = dialog
        dialog.open()
        line = dialog.findChild(QLineEdit)
        if line is not None:
            line.setMaxLength(LONGEST)

    def _closed(self) -> None:
        self.dialog = None

    def _take_name(self, name: str) -> None:
        try:
            self.save_as(name)
        except WorkbenchError as error:
            self._window.error_bar.show_message(error.sentence)

    # ------------------------------------------------------------------------------------------ presenting

    @property
    def is_presenting(self) -> bool:
        """Whether the views have the whole screen."""
        return self._before is not None

    def present(self, wanted: bool) -> None:
        """Views alone on the whole screen, and back to how the window was before."""
        window = self._window
        if wanted and self._before is None:
            bars = [bar for bar in window.findChildren(QToolBar) if bar.parent() is window and bar.isVisible()]
            self._before = Before(window.saveState(), window.windowState(), bars)
            window.addActions(list(window.actions_by_name.values()))  # keys of a menu that is hidden would be dead
            for widget in (*window.docks, *bars, window.menuBar(), window.statusBar()):
                widget.hide()
            window.showFullScreen()
        elif not wanted and self._before is not None:
            before, self._before = self._before, None
            for widget in (*before.bars, window.menuBar(), window.statusBar()):
                widget.show()
            window.setWindowState(before.how & ~Qt.WindowState.WindowMinimized)
            window.restoreState(before.state)
        window.actions_by_name["present"].setChecked(self.is_presenting)

    # ------------------------------------------------------------------------------------------ menu

    def fill_menu(self, menu: QMenu) -> None:
        """Layouts of the program, of the user, and what can be done with them."""
        menu.clear()
        menu.setToolTipsVisible(True)
        for name, tip in TIPS.items():
            self._add(menu, f"&{name}", lambda n=name: self.apply(n), tip)
        own = sorted(self.own, key=str.lower)
        if own:
            menu.addSeparator()
        for name in own:
            self._add(menu, name.replace("&", "&&"), lambda n=name: self.apply(n), "A layout of your own")
        menu.addSeparator()
        menu.addAction(self._window.actions_by_name["save-layout"])
        if own:
            gone = menu.addMenu("&Delete")
            for name in own:
                self._add(gone, name.replace("&", "&&"), lambda n=name: self.delete(n), "Forget this layout")
        menu.addAction(self._window.actions_by_name["present"])

    @staticmethod
    def _add(menu: QMenu, text: str, deed: Callable[[], None], tip: str) -> None:
        action = menu.addAction(text)
        action.setToolTip(tip)
        action.triggered.connect(lambda _=False: deed())
