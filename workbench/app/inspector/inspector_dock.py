"""The inspector: a dock with a page for the formula and its properties, and one for each plot."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, QTimer
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import (
    QComboBox,
    QDockWidget,
    QHBoxLayout,
    QLabel,
    QMainWindow,
    QSizePolicy,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from workbench.app.docks.dock_title import DockTitle
from workbench.app.document import Document
from workbench.app.icons import icon
from workbench.app.inspector.curves_page import CurvesPage
from workbench.app.inspector.formula_page import FormulaPage
from workbench.app.inspector.hover_brush import HoverBrush
from workbench.app.inspector.mirror_page import MirrorPage
from workbench.app.inspector.page import Page
from workbench.app.inspector.plane_page import PlanePage
from workbench.app.inspector.star_page import StarPage
from workbench.app.inspector.subject import Subject
from workbench.app.panels.distortion_box import title_of
from workbench.app.simplex_brush import SimplexBrush
from workbench.app.theme import Theme
from workbench.app.views.mesh_view import MeshView
from workbench.core.registry import Registry

WIDTH, LEAST_MAP = 390, 250
"""Width of the dock when it is opened, and what it leaves of the column's height to the colour maps."""
RIGHT = Qt.DockWidgetArea.RightDockWidgetArea


class Heading(Page):
    """Name of the distortion, and the dimension it is looked at in."""

    def __init__(self, subject: Subject, parent: QWidget | None = None) -> None:
        super().__init__(subject, parent)
        self.name = QLabel(self)
        self.name.setTextFormat(Qt.TextFormat.PlainText)
        self.name.setWordWrap(True)
        self.name.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Minimum)
        font = self.name.font()
        font.setBold(True)
        self.name.setFont(font)
        self.dimension = QComboBox(self)
        for n in (2, 3):
            self.dimension.addItem(f"n = {n}", n)
        self.dimension.setToolTip("Triangles or tetrahedra: how many singular values there are.")
        self.dimension.activated.connect(self._choose_dimension)
        self.error = QLabel(self)
        self.error.setObjectName("form-error")
        self.error.setWordWrap(True)
        row = QHBoxLayout()
        row.addWidget(self.name, 1)
        row.addWidget(self.dimension)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 4, 8, 4)
        layout.setSpacing(3)
        layout.addLayout(row)
        layout.addWidget(self.error)

    def refresh(self) -> None:
        item = self.subject.distortion
        self.error.setText(self.subject.sentence)
        self.error.setVisible(bool(self.subject.sentence))
        self.dimension.setCurrentIndex(self.dimension.findData(self.subject.dimension))
        if item is None:
            self.name.setText("")
            return
        self.name.setText("Typed formula" if item.id == item.formula else title_of(item))
        self.name.setToolTip(item.formula)

    def _choose_dimension(self) -> None:
        self.subject.dimension = self.dimension.currentData()


class InspectorDock(QDockWidget):
    """Pages about the distortion in force; nothing is computed while they are not to be seen."""

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
        self._brush = brush
        self._hover: HoverBrush | None = None
        body = QWidget(self)
        self.heading = Heading(self.subject, body)
        self.formula = FormulaPage(self.subject, body)
        self.plane = PlanePage(self.subject, document, brush, body)
        self.curves = CurvesPage(self.subject, body)
        self.star = StarPage(self.subject, body)
        self.mirror = MirrorPage(self.subject, body)
        self.tabs = QTabWidget(body)
        self.tabs.setDocumentMode(True)
        self.tabs.setUsesScrollButtons(True)
        for page, name, tip in (
            (self.formula, "Formula", "The formula and its properties"),
            (self.plane, "Plane", "D over two singular values, with the simplices of the map"),
            (self.curves, "Curves", "D along (s, …, s) and (s, 1/s), beside others"),
            (self.star, "Fig. 12", "A vertex is pulled across its star"),
            (self.mirror, "Fig. 19", "A simplex on its way to its mirror image"),
        ):
            self.tabs.addTab(page, name)
            self.tabs.setTabToolTip(self.tabs.count() - 1, tip)
        layout = QVBoxLayout(body)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self.heading)
        layout.addWidget(self.tabs, 1)
        self.setWidget(body)
        self.setMinimumWidth(300)
        self.set_theme(theme)

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
        self._hover = HoverBrush(self._brush, views, self.plane.isVisible)

    def follow_too(self, view: MeshView) -> None:
        """The same in one more view."""
        if self._hover is not None:
            self._hover.add(view)

    @property
    def pages(self) -> tuple[Page, ...]:
        found = (self.tabs.widget(row) for row in range(self.tabs.count()))
        return (self.heading, *(page for page in found if isinstance(page, Page)))

    def set_theme(self, theme: Theme) -> None:
        self.toggle.setIcon(icon("inspect", theme))
        for page in self.pages:
            page.set_theme(theme)

    def set_registry(self, registry: Registry) -> None:
        self.subject.set_registry(registry)

    def wait(self) -> None:
        """Let threads end before the window does."""
        if self._hover is not None:
            self._hover.stop()
        for page in self.pages:
            page.wait()


def _is_in_column(window: QMainWindow, dock: QDockWidget) -> bool:
    return not dock.isFloating() and not dock.isHidden() and window.dockWidgetArea(dock) == RIGHT
