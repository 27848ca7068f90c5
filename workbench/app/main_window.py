"""The main window: views, docks, panel, and who tells whom."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtGui import QCloseEvent, QDragEnterEvent, QDropEvent
from PySide6.QtWidgets import QDockWidget, QLabel, QMainWindow, QVBoxLayout, QWidget

from workbench.app.actions import make_actions, set_icons
from workbench.app.anchors.anchor_files import AnchorFiles
from workbench.app.appearance.style import style_sheet
from workbench.app.appearance.theme import Theme, ThemeSwitch
from workbench.app.background import silence_all
from workbench.app.carrying.carried_view import CarriedView
from workbench.app.colouring.colouring import Colouring
from workbench.app.commands import Commands
from workbench.app.docks.colour_map_dock import ColourMapDock
from workbench.app.docks.convergence_dock import ConvergenceDock
from workbench.app.docks.dock_title import DockTitle
from workbench.app.docks.histogram_dock import HistogramDock
from workbench.app.docks.tab_bars import TabBars
from workbench.app.document.document import Document
from workbench.app.document.engine_bridge import EngineBridge, WorkerMaker, engine_worker
from workbench.app.document.history import History
from workbench.app.document.run_curves import RunCurves
from workbench.app.document.switches import Switches
from workbench.app.drawing.drawing_desk import DrawingDesk
from workbench.app.faults.fault_desk import FaultDesk
from workbench.app.glyphs.glyphs import Glyphs
from workbench.app.handling.anchor_desk import AnchorDesk
from workbench.app.handling.anchor_tool import AnchorTool
from workbench.app.handling.handling import Handling
from workbench.app.help.help_desk import HelpDesk
from workbench.app.inspector.inspector_dock import InspectorDock
from workbench.app.late_parts import LateParts
from workbench.app.layouts.layouts import Layouts
from workbench.app.menus import fill_menus, fill_tool_bar
from workbench.app.method_finder import MethodFinder, find_methods
from workbench.app.notices.floating_column import FloatingColumn
from workbench.app.notices.noticing import Noticing
from workbench.app.panel_turns import PanelTurns
from workbench.app.panels.control_panel import ControlPanel
from workbench.app.preferences.preferring import Preferring
from workbench.app.presenter import Presenter
from workbench.app.quantities.quantities import LIVE_QUANTITIES
from workbench.app.quantities.quantity_book import QuantityBook
from workbench.app.readings.readings import Readings
from workbench.app.sessions.autosave import Autosave
from workbench.app.sessions.session_files import SessionFiles
from workbench.app.sessions.undo_dock import UndoDock
from workbench.app.sessions.undoing import Undoing
from workbench.app.settings import Settings
from workbench.app.simplex_brush import SimplexBrush
from workbench.app.splitting.pane_grid import PaneGrid
from workbench.app.splitting.splitting import Splitting
from workbench.app.status.error_bar import ErrorBar
from workbench.app.status.progress_bar import ProgressLine
from workbench.app.status.reporter import Reporter
from workbench.app.status.status_line import StatusLine
from workbench.app.texturing.texture_desk import TextureDesk
from workbench.app.texturing.texturing import Texturing
from workbench.app.timeline.time_line import TimeLine
from workbench.app.view_memory import ViewMemory
from workbench.app.view_states.view_states import ViewStates
from workbench.app.views.pane import ViewPane
from workbench.app.views.textures import PATTERN_LABELS
from workbench.app.volumes.look_tools import LookTools
from workbench.app.volumes.volume_view import VolumeView

TARGET_STYLES = {"plain": PATTERN_LABELS["plain"]} | PATTERN_LABELS
RIGHT, BOTTOM, LEFT = (
    Qt.DockWidgetArea.RightDockWidgetArea,
    Qt.DockWidgetArea.BottomDockWidgetArea,
    Qt.DockWidgetArea.LeftDockWidgetArea,
)


class MainWindow(QMainWindow):
    """Assembles the parts and owns them; what they do stands in the parts."""

    def __init__(
        self,
        theme_switch: ThemeSwitch,
        settings: Settings,
        make_worker: WorkerMaker = engine_worker,
    ) -> None:
        super().__init__()
        self.setWindowTitle("Distortion Workbench")
        self.setAcceptDrops(True)
        self.resize(1560, 940)
        self.setDockNestingEnabled(True)
        self._is_closed = False
        self.theme_switch = theme_switch
        self.settings = settings
        self.bridge = EngineBridge(make_worker)
        self.document = Document(self.bridge)
        self.undoing = Undoing(self.document)
        self.history = History()
        self.switches = Switches(self.document, self.history)
        self.curves = RunCurves(self.document, self.history, self.switches)
        self.undoing.curves = self.curves.kept
        self.brush = SimplexBrush(self)
        self.quantities = QuantityBook(self)
        self.actions_by_name = make_actions(self, self.theme)
        self._make_centre()
        self._make_status()
        self._make_docks()
        self.turns = PanelTurns(self)
        self.texturing = Texturing(self.source.view, self.target.view, self)
        panels = (*self.maps, self.histogram)
        self.colouring = Colouring(self.document, self.quantities, (self.source, self.target), panels, self.texturing)
        self.volume = VolumeView(self.document, self.quantities, self.brush)
        self.presenter = Presenter(
            self.document, self.source, self.target, self.maps, self.colouring, self.turns, self.brush, self.volume
        )
        small = [dock.view for dock in self.maps]
        self.look = LookTools(self.volume, self.quantities, self.source, self.target, small, self.actions_by_name)
        self.carried = CarriedView(self.document, (self.source, self.target), self.target, self)
        self.turns.add(self.histogram.place, self._draw_histogram)
        self.turns.add(self.convergence.place, self.convergence.refresh)
        self.inspector.made.connect(self._inspector_made)
        self._make_tools()
        self.sessions = SessionFiles(self)
        self.autosave = Autosave(self)
        self.time_line = TimeLine(self)
        self.splitting = Splitting(self)
        self.readings = Readings(self)
        self.drawing = DrawingDesk(self)
        self.textures = TextureDesk(self)
        self.glyphs = Glyphs(self)
        self.commands = Commands(self)
        fill_menus(self)
        fill_tool_bar(self)
        self.reporter = Reporter(self)
        self._connect()
        self._apply_theme(self.theme)
        self.preferring = Preferring(self)
        self.layouts = Layouts(self)
        self.view_states = ViewStates(self)
        self.view_memory = ViewMemory(self)
        self._restore_layout()
        self._finder = MethodFinder(self)
        self._finder.found.connect(self._methods_found)
        self._finder.failed.connect(self.reporter.show_exception)
        self._finder.start_after(self.document.snapshot_taken)
        self.late = LateParts((lambda: self.histogram.plot, lambda: self.convergence.plots), self)
        self.late.finished.connect(self.turns.all_stale)
        self.late.start_after(self.document.snapshot_taken)
        for part in (self.document, self.bridge):  # the last to end with the window: its other parts ask them to the end
            part.setParent(self)

    @property
    def theme(self) -> Theme:
        return self.theme_switch.theme

    # ------------------------------------------------------------------------------------------ making

    def _make_centre(self) -> None:
        self.source = ViewPane("Source", PATTERN_LABELS, self.quantities, self.theme, self)
        self.target = ViewPane("Target", TARGET_STYLES, self.quantities, self.theme, self)
        self.grid = PaneGrid(self.source, self.target)
        centre = QWidget(self)
        layout = QVBoxLayout(centre)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        self.error_bar = ErrorBar(self.theme, centre)
        self.progress = ProgressLine(centre)
        layout.addWidget(self.grid.root, 1)
        self.bars = FloatingColumn(centre)
        self.bars.add(self.error_bar)
        self.bars.add(self.progress)
        self.setCentralWidget(centre)

    def _make_docks(self) -> None:
        run_names = ("run", "step", "reset", "stop")
        self.panel = ControlPanel(self.document, [self.actions_by_name[n] for n in run_names], self)
        self.panel.distortion.tools.use_settings(self.settings)
        self.panel_dock = QDockWidget("Choices", self)
        self.panel_dock.setObjectName("choices")
        self.panel_dock.setTitleBarWidget(DockTitle(self.panel_dock, QLabel(self.panel_dock.windowTitle(), self)))
        self.panel_dock.setWidget(self.panel)
        self.maps = [ColourMapDock(self.quantities, quantity.id, self.theme, self) for quantity in LIVE_QUANTITIES]
        self.histogram = HistogramDock(self.quantities, self.brush, self.theme, self)
        self.convergence = ConvergenceDock(self.history, self.switches, self.theme, self)
        for corner, area in (
            (Qt.Corner.TopLeftCorner, LEFT),
            (Qt.Corner.BottomLeftCorner, LEFT),
            (Qt.Corner.TopRightCorner, RIGHT),
            (Qt.Corner.BottomRightCorner, RIGHT),
        ):
            self.setCorner(corner, area)
        self.addDockWidget(LEFT, self.panel_dock)
        for dock in self.maps:
            self.addDockWidget(RIGHT, dock)
        self.addDockWidget(BOTTOM, self.histogram)
        self.addDockWidget(BOTTOM, self.convergence)
        self.splitDockWidget(self.histogram, self.convergence, Qt.Orientation.Horizontal)
        self.resizeDocks([self.panel_dock], [290], Qt.Orientation.Horizontal)
        self.resizeDocks([self.maps[0]], [330], Qt.Orientation.Horizontal)
        self.resizeDocks([self.histogram, self.convergence], [340, 600], Qt.Orientation.Horizontal)
        self.resizeDocks([self.histogram], [230], Qt.Orientation.Vertical)
        self.inspector = InspectorDock(self.document, self.brush, self.theme, self)
        self.inspector.settle(self, self.maps)
        self.steps = UndoDock(self.undoing, self.actions_by_name["undo"], self.actions_by_name["redo"], self)
        self.addDockWidget(LEFT, self.steps)
        self.steps.hide()
        self.anchor_files = AnchorFiles(self)
        self.tabifyDockWidget(self.convergence, self.anchor_files.dock)
        self.anchor_files.dock.hide()
        first: list[QDockWidget] = [self.panel_dock, *self.maps, self.histogram, self.convergence]
        self.docks: list[QDockWidget] = [*first, self.inspector, self.steps, self.anchor_files.dock]
        self.noticing = Noticing(self)
        self.faults = FaultDesk(self)
        self.help = HelpDesk(self)
        self.docks.append(self.noticing.dock)
        self.tab_bars = TabBars(self)

    def _make_status(self) -> None:
        self.status = StatusLine(self)
        self.setStatusBar(self.status)

    def _make_tools(self) -> None:
        document = self.document
        self.desk = AnchorDesk(document)
        self.handling = Handling(self)

        def may_anchor() -> bool:
            return document.positions is not None

        self.source_tool = AnchorTool(self.source.view, is_target=False, may_anchor=may_anchor)
        self.target_tool = AnchorTool(self.target.view, is_target=True, may_anchor=may_anchor)
        for tool in (self.source_tool, self.target_tool):
            self.connect_tool(tool)
        self.inspector.follow_pointer([self.source.view, self.target.view, *(dock.view for dock in self.maps)])

    def connect_tool(self, tool: AnchorTool) -> None:
        """Let a mouse over one of the views set and move anchors."""
        document = self.document
        tool.hovered.connect(self.presenter.hover)
        tool.anchor_wanted.connect(document.add_anchor)
        tool.anchor_selected.connect(document.select)
        tool.taken_up.connect(self.desk.take_up)
        tool.motion_wanted.connect(self.desk.move)
        tool.drag_cancelled.connect(self.desk.cancel)
        self.handling.connect_tool(tool)
        tool.anchor_unwanted.connect(document.remove_anchor)
        document.opened.connect(tool.let_go)

    def _connect(self) -> None:
        self.theme_switch.changed.connect(self._apply_theme)
        self.source.style_chosen.connect(self.set_source_style)
        self.target.style_chosen.connect(self.set_target_style)
        self.curves.begun_again.connect(self.turns.all_stale)
        self.document.opened.connect(lambda: self.histogram.set_mesh(self.document.mesh))
        self.histogram.redraw_wanted.connect(self.turns.all_stale)
        self.panel.distortion.tools.formulas_changed.connect(lambda _: self._list_quantities())

    # ------------------------------------------------------------------------------------------ showing

    def set_target_style(self, style: str) -> None:
        """Colour the target by a quantity, or plain."""
        self.colouring.set_style(self.target, style)

    def set_drawing(self, wanted: bool) -> None:
        """Whether views follow the map at all; without, everything but the pictures goes on."""
        for view in (self.source.view, self.target.view, *(dock.view for dock in self.maps)):
            view.is_drawing = wanted
        self.splitting.set_drawing(wanted)
        self.turns.is_drawing = wanted

    def set_source_style(self, style: str) -> None:
        """Colour the source by a pattern of the map, or by a quantity."""
        self.colouring.set_style(self.source, style)

    def _inspector_made(self) -> None:
        plane = self.inspector.body.plane
        self.turns.add(plane, plane.draw_points, plane.cost)
        self.turns.all_stale()

    def _draw_histogram(self) -> None:
        if self.document.shown is not None:
            self.histogram.show_snapshot(self.document.shown)

    def _list_quantities(self) -> None:
        """The distortions that there are now, formulas of one's own among them."""
        from workbench.core.registry import registry

        found = registry()
        self.quantities.list_distortions(found.distortions.values(), found.own_formulas)
        self.document.watch_again()

    def _methods_found(self, registry: Any) -> None:
        self.panel.set_registry(registry)
        self.panel.distortion.tools.formulas_changed.connect(lambda _: self._list_methods(find_methods()))
        self._list_methods(registry)
        self.reporter.show_plugin_failures(registry)

    def _list_methods(self, registry: Any) -> None:
        self._list_quantities()
        self.inspector.set_registry(registry)

    def _apply_theme(self, theme: Theme) -> None:
        self.setStyleSheet(style_sheet(theme))
        set_icons(self.actions_by_name, theme)
        views: tuple[Any, ...] = (self.source, self.target, self.carried, *self.maps)
        for part in (*views, self.histogram, self.convergence, self.inspector, self.error_bar, self.time_line):
            part.set_theme(theme)
        self.reporter.show_running()

    # ------------------------------------------------------------------------------------------ opening

    def start(self, source: str = "") -> None:
        """Start the engine and open `source`, or the sample to begin with."""
        self.bridge.start()
        if source:
            self.open(source)
        else:
            from workbench.core.samples import sample_ids

            self.document.open_sample(sample_ids()[0])

    def open(self, source: str) -> None:
        """Open a file, or `sample:ID`."""
        if source.startswith("sample:"):
            self.document.open_sample(source.removeprefix("sample:"))
        elif self.anchor_files.takes(source):
            self.anchor_files.read(str(Path(source).expanduser()))
        elif self.sessions.takes(source):
            self.sessions.open(str(Path(source).expanduser()))
        elif self.textures.takes(source):
            self.textures.show_picture(source)
        elif self.commands.binding.takes(source):
            self.commands.binding.open(str(Path(source).expanduser()))
        else:
            self.document.open(str(Path(source).expanduser()))

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:
        if any(url.isLocalFile() for url in event.mimeData().urls()):
            event.acceptProposedAction()

    def dropEvent(self, event: QDropEvent) -> None:
        files = [url.toLocalFile() for url in event.mimeData().urls() if url.isLocalFile()]
        if files:
            event.acceptProposedAction()
            if self.textures.takes(files[0]) and not self.sessions.takes(files[0]):
                self.textures.show_picture(files[0], self.textures.pane_at(event.position().toPoint()))
            else:
                self.open(files[0])

    # ------------------------------------------------------------------------------------------ end

    def _restore_layout(self) -> None:
        self.layouts.restore()
        self.view_memory.restore(self.settings.views())

    def closeEvent(self, event: QCloseEvent) -> None:
        """Timers, engine, threads, views; then Qt's own."""
        if not self._is_closed and self.sessions.keeps_from_closing():
            event.ignore()
            return
        if not self._is_closed:
            self.autosave.end()
            self._is_closed = True
            self.layouts.keep()
            self.settings.save_views(self.view_memory.state())
            self.settings.sync()
            self.late.stop()
            self.turns.stop()
            self.presenter.stop()
            self.look.stop()
            self.readings.stop()
            self.splitting.close()
            self.reporter.stop()
            self.source_tool.let_go()
            self.target_tool.let_go()
            self.desk.forget()
            self.bridge.close()
            self.faults.close()
            self.help.close()
            self.noticing.close()
            self.undoing.wait()
            self.inspector.wait()
            self.commands.wait()
            self.glyphs.wait()
            self.time_line.wait()
            silence_all(self)
            self.theme_switch.changed.disconnect(self._apply_theme)
            for view in (self.source.view, self.target.view, *(dock.view for dock in self.maps)):
                view.close_view()
        super().closeEvent(event)
