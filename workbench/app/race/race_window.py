"""The window of a race: the grid, its one colour bar, the curves, the time axis."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QAction, QCloseEvent, QKeyEvent, QKeySequence
from PySide6.QtWidgets import QMainWindow, QSplitter, QToolBar, QVBoxLayout, QWidget

from workbench.app.appearance.icons import icon
from workbench.app.appearance.style import style_sheet
from workbench.app.appearance.theme import Theme
from workbench.app.background import silence_all
from workbench.app.colouring.colour_legend import ColourLegend
from workbench.app.document.engine_bridge import WorkerMaker
from workbench.app.notices.floating_column import FloatingColumn
from workbench.app.notices.noticing import tell_logger
from workbench.app.quantities.quantity_book import QuantityBook
from workbench.app.race.compare_bar import CompareBar
from workbench.app.race.race_bridge import race_worker
from workbench.app.race.race_colours import RaceColours
from workbench.app.race.race_curves import RaceCurves
from workbench.app.race.race_model import RaceModel
from workbench.app.race.race_record import verdict
from workbench.app.race.race_saver import RaceSaver
from workbench.app.race.timeline import Timeline
from workbench.app.race.view_grid import ViewGrid
from workbench.app.status.error_bar import ErrorBar
from workbench.app.status.status_line import ElidedLabel
from workbench.engine.race_messages import StartRace

ACTIONS = (
    ("run", "Run", "Space", "run", "Run or pause all (Space)"),
    ("step", "Step all", ".", "step", "One iteration of everyone (.)"),
    ("restart", "Restart", "Home", "reset", "All from the start once more (Home)"),
    ("stop", "Stop", "Ctrl+.", "stop", "End what hangs; what is shown stays (Ctrl+.)"),
    ("fit", "Fit views", "F", "fit", "Show all of every map (F)"),
)
IN_WORDS = (
    ("set-up", "Contestants…", "", "Another race: other contestants, another distortion or start"),
    ("anchors", "Anchors", "", "All go on with the anchors as they are in the document now; a mark on the curves says so"),
    ("save", "Save…", "Ctrl+S", "The tables and the curves, into a folder (Ctrl+S)"),
)
UNSEEN = (
    ("flip", "Flip", "X"),
    ("live", "Live", "L"),
    ("back", "Back", "Left"),
    ("forth", "Forth", "Right"),
    ("far-back", "Far back", "Shift+Left"),
    ("far-forth", "Far forth", "Shift+Right"),
    ("close", "Close", "Ctrl+W"),
)
HOLD_KEY = Qt.Key.Key_Y


class RaceWindow(QMainWindow):
    """Assembles the parts of a race; closing it ends the process in which it runs."""

    set_up_wanted = Signal()
    take_wanted = Signal(int)
    switch_wanted = Signal(int)
    anchors_wanted = Signal()
    closed = Signal()

    def __init__(
        self,
        set_up: StartRace,
        book: QuantityBook,
        quantity: str,
        theme: Theme,
        parent: QWidget,
        make_worker: WorkerMaker = race_worker,
    ) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle("Race")
        self.resize(1560, 940)
        self._is_closed = False
        self.theme = theme
        self.model = RaceModel(set_up, make_worker, self)
        self.colours = RaceColours(self.model, book, quantity, self)
        self.grid = ViewGrid(self.model, self.colours, theme, self)
        self.legend = ColourLegend(self.colours.range, self)
        self.curves = RaceCurves(self.model, theme, self)
        self.timeline = Timeline(self.model, self)
        self.compare = CompareBar(self.model, book, quantity, self)
        self.error_bar = ErrorBar(theme, self)
        self.error_bar.told.connect(tell_logger)
        self.saver = RaceSaver(self.model, self)
        self.sentence = ElidedLabel(self)
        self.statusBar().addWidget(self.sentence, 1)
        self._make_tool_bar()
        self._lay_out()
        self._connect()
        self.set_theme(theme)
        self.curves.make_curves()

    # ------------------------------------------------------------------------------------------ making

    def _make_tool_bar(self) -> None:
        bar = QToolBar("Race", self)
        bar.setMovable(False)
        bar.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        self.actions_by_name: dict[str, QAction] = {}
        for name, text, keys, _, tip in ACTIONS:
            action = QAction(text, self)
            action.setShortcut(QKeySequence(keys))
            action.setToolTip(tip)
            bar.addAction(action)
            self.actions_by_name[name] = action
        bar.addSeparator()
        for name, text, keys, tip in IN_WORDS:
            action = self.actions_by_name[name] = QAction(text, self)
            action.setShortcut(QKeySequence(keys))
            action.setToolTip(tip)
            bar.addAction(action)
        for name, text, keys in UNSEEN:
            action = self.actions_by_name[name] = QAction(text, self)
            action.setShortcut(QKeySequence(keys))
            self.addAction(action)
        self.tool_bar = bar
        self.addToolBar(bar)

    def _lay_out(self) -> None:
        left = QWidget(self)
        layout = QVBoxLayout(left)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self.compare)
        layout.addWidget(self.grid, 1)
        layout.addWidget(self.legend)
        splitter = QSplitter(Qt.Orientation.Horizontal, self)
        splitter.addWidget(left)
        splitter.addWidget(self.curves)
        splitter.setChildrenCollapsible(False)
        splitter.setStretchFactor(0, 1)
        splitter.setSizes([1090, 470])
        centre = QWidget(self)
        outer = QVBoxLayout(centre)
        outer.setContentsMargins(0, 0, 0, 0)
        outer.setSpacing(0)
        outer.addWidget(splitter, 1)
        FloatingColumn(self.grid).add(self.error_bar)
        outer.addWidget(self.timeline)
        self.setCentralWidget(centre)

    def _connect(self) -> None:
        model = self.model
        for name, deed in {
            "run": model.toggle,
            "step": model.step,
            "restart": model.restart,
            "stop": model.stop,
            "fit": self.grid.fit,
            "set-up": self.set_up_wanted.emit,
            "anchors": self.anchors_wanted.emit,
            "save": self.saver.ask,
            "flip": self.compare.flip_button.toggle,
            "live": model.go_live,
            "back": lambda: self.timeline.move(-1),
            "forth": lambda: self.timeline.move(1),
            "far-back": lambda: self.timeline.move(-10),
            "far-forth": lambda: self.timeline.move(10),
            "close": self.close,
        }.items():
            self.actions_by_name[name].triggered.connect(lambda _=False, d=deed: d())
        self.compare.chooser.chosen.connect(self.colours.show_quantity)
        self.compare.mode_chosen.connect(self.colours.show_mode)
        self.compare.flipped.connect(self.grid.flip)
        for box in (*self.compare.boxes, self.timeline.axis):
            box.activated.connect(lambda _: self.grid.setFocus())  # a list keeps letters to itself: keys go to the window
        self.colours.restyled.connect(lambda: self.legend.show_range(self.colours.range))
        self.colours.fitted.connect(lambda: self.legend.show_values(self.colours.values))
        self.timeline.axis_chosen.connect(self.curves.show_axis)
        self.timeline.scale_chosen.connect(self.curves.set_logarithmic)
        self.grid.switch_wanted.connect(self.switch_wanted)
        self.grid.take_wanted.connect(self.take_wanted)
        model.phase_changed.connect(self._show_phase)
        model.told.connect(lambda _: self._say_how_it_stands())
        model.said.connect(lambda sentence, details: self.error_bar.show_message(sentence, (), details))
        model.progress.connect(self.say)
        model.started.connect(self.error_bar.dismiss)
        self.saver.saved.connect(self.say)
        self.saver.failed.connect(self.error_bar.show_message)

    # ------------------------------------------------------------------------------------------ running

    def open(self, *, run: bool = False) -> None:
        """Show the window and bring everyone to the start."""
        self.show()
        self.model.watch([self.colours.quantity])
        self.model.open(run=run)

    def begin(self, set_up: StartRace, *, run: bool = False) -> None:
        """Another race in the same window; where it has another distortion, the colours follow."""
        distortion = set_up.problem.distortion
        if distortion != self.model.set_up.problem.distortion and self.compare.chooser.findData(distortion) >= 0:
            self.compare.chooser.show_choice(distortion)
            self.colours.show_quantity(distortion)
        self.model.begin(set_up, run=run)
        self.grid.make_panes()
        self.curves.make_curves()
        self.compare.list_contestants()
        self.colours.begin_anew()

    def say(self, sentence: str) -> None:
        self.sentence.setText(sentence)

    def _show_phase(self) -> None:
        model, run = self.model, self.actions_by_name["run"]
        run.setText("Pause" if model.is_running else "Run")
        run.setIcon(icon("pause" if model.is_running else "run", self.theme))
        for name in ("run", "step"):
            self.actions_by_name[name].setEnabled(model.is_ready and not (model.is_over and not model.is_running))
        for name in ("anchors", "save"):
            self.actions_by_name[name].setEnabled(model.is_ready)
        self._say_how_it_stands()

    def _say_how_it_stands(self) -> None:
        frames = [record.frame for record in self.model.records]
        running = sum(frame is not None and frame.phase == "running" for frame in frames)
        if not self.model.is_ready:
            return
        if self.model.is_over:
            self.say(verdict(self.model.records, self.model.mesh))
            return
        state = "Running" if self.model.is_running else "Paused"
        left = f"{running} of {len(frames)} have steps to take"
        self.say(f"{state}: {left}. They take turns on one engine; each is charged its own seconds only.")

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        self.setStyleSheet(style_sheet(theme))
        for part in (self.grid, self.legend, self.curves, self.error_bar):
            part.set_theme(theme)  # type: ignore[attr-defined]
        for name, _, _, picture, _ in ACTIONS:
            self.actions_by_name[name].setIcon(icon(picture, theme))
        self._show_phase()

    # ------------------------------------------------------------------------------------------ keys, end

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == HOLD_KEY and not event.isAutoRepeat():
            self.compare.hold(True)
        super().keyPressEvent(event)

    def keyReleaseEvent(self, event: QKeyEvent) -> None:
        if event.key() == HOLD_KEY and not event.isAutoRepeat():
            self.compare.hold(False)
        super().keyReleaseEvent(event)

    def closeEvent(self, event: QCloseEvent) -> None:
        """Timers, process, views; then Qt's own."""
        if not self._is_closed:
            self._is_closed = True
            self.colours.stop()
            self.curves.stop()
            silence_all(self)
            self.model.close()
            self.grid.close_views()
            self.closed.emit()
        super().closeEvent(event)
