"""The inspector: a dock whose place in the window gives room to it, and whose pages are made when it is first shown."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QAction, QKeySequence, QShowEvent
from PySide6.QtWidgets import QDockWidget, QLabel, QMainWindow, QWidget

from workbench.app.appearance.icons import icon
from workbench.app.appearance.theme import Theme
from workbench.app.docks.dock_title import DockTitle
from workbench.app.document.document import Document
from workbench.app.inspector.hover_brush import HoverBrush
from workbench.app.inspector.subject import Subject
from workbench.app.simplex_brush import SimplexBrush
from workbench.app.views.mesh_view import MeshView
from workbench.core.registry import Registry

if TYPE_CHECKING:
    from workbench.app.inspector.body import InspectorBody

WIDTH, LEAST_MAP = 390, 250
"""Width of the dock when it is opened, and what it leaves of the column's height to the colour maps."""
RIGHT = Qt.DockWidgetArea.RightDockWidgetArea


class InspectorDock(QDockWidget):
    """Pages about the distortion in force; nothing is computed while they are not to be seen.

    They are made when the dock is first shown, or `body` asked for, which `made` tells of.
    """

    made = Signal()

    def __init__(self, document: Document, brush: SimplexBrush, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__("Inspector", parent)
        self.setObjectName("inspector")
        self.setTitleBarWidget(DockTitle(self, QLabel(self.windowTitle(), self)))
        self._maps: Sequence[QDockWidget] = ()
        self._made_room = False
        self._column: list[QDockWidget] = []
        self._before = (0, 0)
        self.toggle = QAction("Inspector", self)
        self.toggle.setCheckable(True)
        self.toggle.setShortcut(QKeySequence("Ctrl+I"))
        self.toggle.setToolTip("Formula, properties and plots of the distortion (Ctrl+I)")
        self.subject = Subject(document)
        self._document = document
        self._brush = brush
        self._hover: HoverBrush | None = None
        self._theme = theme
        self._body: InspectorBody | None = None
        self._page = 0
        self.setMinimumWidth(300)
        self.set_theme(theme)

    @property
    def body(self) -> InspectorBody:
        """The pages, made now where they were not before."""
        if self._body is None:
            from workbench.app.inspector.body import InspectorBody

            self._body = InspectorBody(self.subject, self._document, self._brush, self)
            self._body.set_theme(self._theme)
            if 0 <= self._page < self._body.tabs.count():
                self._body.tabs.setCurrentIndex(self._page)
            self.setWidget(self._body)
            self.made.emit()
        return self._body

    @property
    def page(self) -> int:
        """Number of the page that is on top, or will be."""
        return self._page if self._body is None else self._body.tabs.currentIndex()

    @page.setter
    def page(self, number: int) -> None:
        self._page = number
        if self._body is not None:
            self._body.tabs.setCurrentIndex(number)

    def showEvent(self, event: QShowEvent) -> None:
        self.body.show()
        super().showEvent(event)

    # ------------------------------------------------------------------------------------------ place in the window

    def settle(self, window: QMainWindow, maps: Sequence[QDockWidget]) -> None:
        """Take a place below the colour maps, hidden until it is asked for."""
        self._maps = maps
        window.addDockWidget(RIGHT, self)
        self.hide()
        self.toggle.triggered.connect(lambda is_open: self._open(window) if is_open else self.hide())
        shown = super().toggleViewAction()
        shown.toggled.connect(self.toggle.setChecked)
        # when it begins to float it is hidden for a moment: that is no reason to move others
        shown.toggled.connect(lambda _: QTimer.singleShot(0, self, lambda: self._give_back(window)))

    def toggleViewAction(self) -> QAction:
        """Qt's own would show the dock before there is room for it, and the window would grow."""
        return self.toggle

    def _open(self, window: QMainWindow) -> None:
        self.body.show()
        self._make_room(window)
        self.show()
        if self._made_room:
            self._share_height(window)
        window.resizeDocks([self], [WIDTH], Qt.Orientation.Horizontal)

    def _make_room(self, window: QMainWindow) -> None:
        """Lay the colour maps behind each other: the column then holds one of them and the inspector."""
        column = [dock for dock in self._maps if _is_in_column(window, dock)]
        if self.isFloating() or window.dockWidgetArea(self) != RIGHT or window.tabifiedDockWidgets(self):
            return
        self._column = column
        self._before = (column[0].width() if column else 0, sum(dock.height() for dock in column))
        if column and not any(window.tabifiedDockWidgets(dock) for dock in column):
            # first below the first map: beside docks that lie behind each other it would become one of them
            window.splitDockWidget(column[0], self, Qt.Orientation.Vertical)
            for dock in column[1:]:
                window.tabifyDockWidget(column[0], dock)
            column[0].raise_()
            self._made_room = len(column) > 1

    def _share_height(self, window: QMainWindow) -> None:
        # together no more than there was
        height = self._before[1]
        rest = min(max(LEAST_MAP, height // 3), height // 2)
        window.resizeDocks([self._column[0], self], [rest, height - rest], Qt.Orientation.Vertical)

    def _give_back(self, window: QMainWindow) -> None:
        """Lay the colour maps below each other again, where they still stand as they were put."""
        if not self.isHidden():
            return
        # where it was not opened in this window, it stands as an earlier window left it
        column = self._column or [dock for dock in self._maps if _is_in_column(window, dock)]
        if not self._made_room and self._column:
            return
        self._made_room = False
        if column and all(_is_in_column(window, dock) and window.tabifiedDockWidgets(dock) for dock in column):
            for dock in column[1:]:
                window.addDockWidget(RIGHT, dock, Qt.Orientation.Vertical)
            window.resizeDocks(column, [100] * len(column), Qt.Orientation.Vertical)
            window.resizeDocks(column[:1], [self._before[0] or WIDTH], Qt.Orientation.Horizontal)

    # ------------------------------------------------------------------------------------------ parts

    def follow_pointer(self, views: Sequence[MeshView]) -> None:
        """Mark the triangle under the pointer in these views while the plane is to be seen."""
        self._hover = HoverBrush(self._brush, views, lambda: self._body is not None and self._body.plane.isVisible())

    def follow_too(self, view: MeshView) -> None:
        """The same in one more view."""
        if self._hover is not None:
            self._hover.add(view)

    def set_theme(self, theme: Theme) -> None:
        self._theme = theme
        self.toggle.setIcon(icon("inspect", theme))
        if self._body is not None:
            self._body.set_theme(theme)

    def set_registry(self, registry: Registry) -> None:
        self.subject.set_registry(registry)

    def wait(self) -> None:
        """Let threads end before the window does."""
        if self._hover is not None:
            self._hover.stop()
        if self._body is not None:
            self._body.wait()


def _is_in_column(window: QMainWindow, dock: QDockWidget) -> bool:
    return not dock.isFloating() and not dock.isHidden() and window.dockWidgetArea(dock) == RIGHT
