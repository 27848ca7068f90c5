"""What the preferences change in the window."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QEvent, QObject, Qt, QTimer
from PySide6.QtGui import QFont
from PySide6.QtWidgets import QApplication, QToolBar

from workbench.app.appearance.style import style_sheet
from workbench.app.preferences.catalogue import BY_NAME
from workbench.app.preferences.environment import set_environment
from workbench.app.preferences.preferences import Preferences
from workbench.app.views import drawing_style

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

ENGINE_REST = 700
"""Milliseconds without a further change until the engine begins anew with other threads or another linear solver."""
TOOL_BARS = {
    "beside": Qt.ToolButtonStyle.ToolButtonTextBesideIcon,
    "pictures": Qt.ToolButtonStyle.ToolButtonIconOnly,
    "words": Qt.ToolButtonStyle.ToolButtonTextOnly,
    "under": Qt.ToolButtonStyle.ToolButtonTextUnderIcon,
}


class Applying(QObject):
    """Puts each value where it belongs, at first all that are not the defaults, then each that changes."""

    def __init__(self, window: MainWindow, preferences: Preferences) -> None:
        super().__init__(window)
        self._window = window
        self._preferences = preferences
        application = QApplication.instance()
        assert isinstance(application, QApplication)
        self._application = application
        self._usual_font = QFont(application.font())
        self._tips: TipSilencer | None = None
        self._engine = QTimer(self)
        self._engine.setSingleShot(True)
        self._engine.setInterval(ENGINE_REST)
        self._engine.timeout.connect(self._begin_engine_anew)
        self._deeds: dict[str, Callable[[Any], None]] = {
            "recent_count": lambda value: setattr(window.settings, "recent_count", value),
            "tool_tips": self._tool_tips,
            "theme": window.theme_switch.choose,
            "font_size": self._font_size,
            "tool_bar": self._tool_bar,
            "anchor_size": self._anchor_size,
            "edge_width": self._edge_width,
            "edges_up_to": lambda value: setattr(drawing_style, "edges_up_to", value),
            "colour_map": self._colour_map,
            "threads": lambda _: self._engine.start(),
            "linear_solver": lambda _: self._engine.start(),
            "autosave": lambda _: self._autosave(),
            "autosave_seconds": lambda _: self._autosave(),
            "undo_megabytes": lambda value: window.undoing.set_memory(value * 2**20),
            "time_line_megabytes": window.time_line.set_memory,
            "panel_rest": lambda value: setattr(window.turns, "rest_factor", value),
        }
        of_window = {"theme", "time_line_megabytes", "threads", "linear_solver", "distortion", "solver"}
        for name, value in preferences.values.items():
            if value != BY_NAME[name].default and name not in of_window:
                self._apply(name)
        self._first_choices()
        preferences.changed.connect(self._apply)

    def _apply(self, name: str) -> None:
        deed = self._deeds.get(name)
        if deed is not None:
            deed(self._preferences[name])

    def end(self) -> None:
        """What belongs to the whole program is as it was before the window."""
        self._engine.stop()
        drawing_style.restore()
        set_environment({})
        if self._tips is not None:
            self._application.removeEventFilter(self._tips)
        if self._application.font() != self._usual_font:
            self._application.setFont(self._usual_font)

    # ------------------------------------------------------------------------------------------ window

    def _tool_tips(self, wanted: bool) -> None:
        if self._tips is None:
            self._tips = TipSilencer(self)
        self._application.removeEventFilter(self._tips)
        if not wanted:
            self._application.installEventFilter(self._tips)

    def _font_size(self, points: int) -> None:
        font = QFont(self._usual_font)
        if points:
            font.setPointSize(points)
        self._application.setFont(font)
        self._window.setStyleSheet(style_sheet(self._window.theme))  # else what it styles keeps its letters

    def _tool_bar(self, style: str) -> None:
        for bar in self._window.findChildren(QToolBar):
            bar.setToolButtonStyle(TOOL_BARS[style])

    # ------------------------------------------------------------------------------------------ views

    def _anchor_size(self, radius: float) -> None:
        drawing_style.anchor_radius = radius
        for overlay in self._overlays():
            overlay.update()

    def _overlays(self) -> list[Any]:
        from workbench.app.views.overlay import Overlay

        return self._window.findChildren(Overlay)

    def _edge_width(self, width: float) -> None:
        drawing_style.edge_width = width
        self._draw_anew()

    def _colour_map(self, name: str) -> None:
        drawing_style.colour_map = name
        for colour_range in self._window.quantities.ranges():
            colour_range.changed.emit()
        self._draw_anew()

    def _draw_anew(self) -> None:
        """Whoever draws takes up colours and widths as with another theme."""
        self._window.theme_switch.changed.emit(self._window.theme)

    # ------------------------------------------------------------------------------------------ work

    def _autosave(self) -> None:
        seconds = self._preferences["autosave_seconds"] if self._preferences["autosave"] else 0
        self._window.autosave.set_interval(seconds)

    def _first_choices(self) -> None:
        """A new window begins with these, where they are still there; nothing is open yet."""
        wanted = {name: self._preferences[name] for name in ("distortion", "solver")}
        wanted = {name: id for name, id in wanted.items() if id != BY_NAME[name].default}
        if wanted:
            from workbench.core.registry import registry  # the methods are found on a thread otherwise

            found = {"distortion": registry().distortions, "solver": registry().solvers}
            document = self._window.document
            document.session = replace(document.session, **{name: id for name, id in wanted.items() if id in found[name]})

    def _begin_engine_anew(self) -> None:
        document = self._window.document
        if not set_environment(self._preferences.values) or document.mesh is None:
            return
        if document.wants_to_run:
            self._window.bridge.restarted.connect(self._run_on, Qt.ConnectionType.SingleShotConnection)
        document.stop()

    def _run_on(self) -> None:
        if not self._window.document.wants_to_run:
            self._window.document.toggle()


class TipSilencer(QObject):
    """Keeps tool tips from being shown."""

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        return event.type() == QEvent.Type.ToolTip
