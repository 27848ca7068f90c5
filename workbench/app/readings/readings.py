"""Readings of the window: what is under the pointer in any view, in numbers, while they are wanted."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, QPoint, Qt, QTimer
from PySide6.QtGui import QGuiApplication, QMouseEvent

from workbench.app.quantities.quantities import Quantity
from workbench.app.readings.reading_panel import ReadingPanel
from workbench.app.readings.reading_text import words_of
from workbench.app.splitting.leaf import Leaf
from workbench.core.errors import WorkbenchError
from workbench.core.measure import DESCRIPTORS, Evaluator
from workbench.core.registry import registry

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

PAUSE = 30
"""Milliseconds between two readings while the pointer moves."""
PAUSE_OF_MAPS = 120
"""The same while the map changes below a pointer that rests."""
LONGEST_NAME = 24


class Readings(QObject):
    """Reads one simplex at a time, and only while the panel is wanted."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self.panel = ReadingPanel(window)
        self.panel.set_theme(window.theme)
        self._measures: dict[str, Evaluator] = {}
        self._measures_of: Any = None
        self._under: tuple[Leaf, tuple[float, float]] | None = None
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.timeout.connect(self.read)
        self._toggle, self._copy = (window.actions_by_name[name] for name in ("readings", "copy-readings"))
        self._toggle.toggled.connect(self._wanted)
        self._copy.triggered.connect(lambda _=False: self.copy())
        for leaf in window.splitting.leaves:
            self._follow(leaf)
        window.splitting.pane_made.connect(self._follow)
        window.splitting.pane_gone.connect(self._forget)
        window.document.opened.connect(self.hide)
        window.document.shown_changed.connect(self._map_came)
        window.theme_switch.changed.connect(self.panel.set_theme)

    @property
    def is_on(self) -> bool:
        return self._toggle.isChecked()

    def _follow(self, leaf: Leaf) -> None:
        leaf.view.overlay.moved.connect(partial(self._move, leaf))
        leaf.view.overlay.left.connect(self.hide)

    def _forget(self, leaf: Leaf) -> None:
        self.hide()

    def _wanted(self, on: bool) -> None:
        if on:
            if self._window.document.mesh is not None and self._window.quantities.is_listed:
                self._evaluators(self._window.document.mesh.dimension)  # a tenth of a second, once
            self._window.status.say("Point at a triangle or tetrahedron; Ctrl+Shift+C copies its numbers.")
            self.read()  # who presses the key points at something already
        else:
            self._window.status.say("Readings are off.")
            self._timer.stop()
            self.panel.hide()

    def _move(self, leaf: Leaf, event: QMouseEvent) -> None:
        if event.buttons() != Qt.MouseButton.NoButton:
            self.hide()  # a hand that drags looks elsewhere
            return
        self._under = (leaf, (event.position().x(), event.position().y()))
        if self.is_on and not self._timer.isActive():
            self._timer.start(PAUSE)

    def _map_came(self) -> None:
        if self.is_on and self.panel.isVisible() and not self._timer.isActive():
            self._timer.start(PAUSE_OF_MAPS)

    def hide(self) -> None:
        """Nothing is pointed at."""
        self._timer.stop()
        self._under = None
        self.panel.hide()

    # ------------------------------------------------------------------------------------------ reading

    def read(self) -> None:
        """Show the numbers of what is under the pointer now."""
        document = self._window.document
        mesh, shown = document.mesh, document.shown
        if self._under is None or mesh is None or shown is None:
            self.panel.hide()
            return
        leaf, pixel = self._under
        simplex = leaf.view.simplex_at(pixel)
        if not 0 <= simplex < mesh.simplex_count:
            self.panel.hide()
            return
        from workbench.core.simplex_reading import read_simplex

        reading = read_simplex(mesh, shown.positions, simplex, self._evaluators(mesh.dimension))
        text = words_of(reading, leaf.view.vertex_at(pixel), mesh.simplex_noun(), self._name_of_shown(leaf))
        where = leaf.view.mapTo(self._window, QPoint(round(pixel[0]), round(pixel[1])))
        self.panel.show_text(text, where)

    def _name_of_shown(self, leaf: Leaf) -> str:
        """Name of the quantity that a view is coloured by."""
        id, book = self._window.splitting.shown_in(leaf), self._window.quantities
        return short_name(book[id]) if id in book else ""

    def _evaluators(self, dimension: int) -> dict[str, Evaluator]:
        """Every measure that there is, by its short name; made once as long as they stay the same."""
        quantities = self._window.quantities.quantities
        if self._measures_of != (dimension, quantities):
            self._measures_of, self._measures = (dimension, quantities), {}
            for quantity in quantities:
                if quantity.measure.text in DESCRIPTORS:
                    continue  # they stand above
                try:
                    self._measures[short_name(quantity)] = quantity.measure.prepare(dimension)
                except WorkbenchError:
                    continue  # not one of this dimension
        return self._measures

    def copy(self) -> None:
        """Put the numbers into the clipboard: a line each, for a spreadsheet."""
        if not self.panel.text.rows:
            self._window.status.say("Nothing has been read yet: turn View > Readings on and point at a triangle.")
            return
        QGuiApplication.clipboard().setText(self.panel.text.table())
        self._window.status.say(f"Copied the numbers of {self.panel.text.heading[0].split('   ')[0]}.")

    def stop(self) -> None:
        self._timer.stop()
        self._window.theme_switch.changed.disconnect(self.panel.set_theme)


def short_name(quantity: Quantity) -> str:
    """A quantity in few letters, and where the survey has it."""
    found = registry().distortions.get(quantity.id)
    name = found.short if found is not None and found.short else quantity.label
    name = name if len(name) <= LONGEST_NAME else f"{name[: LONGEST_NAME - 1]}…"
    return f"{name} {quantity.equation}".rstrip()
