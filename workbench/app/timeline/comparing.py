"""The window that compares A with B, and who measures for it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from workbench.app.composing.composing import sentence_of
from workbench.app.inspector.latest import Latest
from workbench.app.timeline.compare_window import CompareWindow
from workbench.app.timeline.comparison import Comparison, compare
from workbench.core.mesh import Mesh

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow
    from workbench.app.timeline.time_line import TimeLine


class Comparing(QObject):
    """One window at a time. Where A or B is not marked, the first map and what is shown stand for them."""

    def __init__(self, window: MainWindow, time_line: TimeLine) -> None:
        super().__init__(window)
        self._window, self._time_line = window, time_line
        self._work = Latest(self)
        self._work.done.connect(self._show)
        self._work.failed.connect(self._fail)
        self.dialog: CompareWindow | None = None

    def wait(self) -> None:
        """Let the thread end before the window does."""
        self._work.wait()
        if self.dialog is not None:
            self.dialog.close()

    def ask(self) -> None:
        """Open the window, or let it show what A and B are now."""
        record, marked = self._time_line.recorder.record, self._time_line.dock.slider.marked
        if not len(record):
            return
        if "A" not in marked:
            marked["A"] = record[0]
        if "B" not in marked:
            present = self._time_line.present
            assert present is not None
            marked["B"] = present
        self._time_line.dock.show_place()
        if self.dialog is None:
            window = self._window
            quantity = window.maps[-1].quantity
            self.dialog = CompareWindow(window.quantities, quantity, window.theme, window)
            self.dialog.wanted.connect(self.measure)
            self.dialog.finished.connect(self._forget)
            window.theme_switch.changed.connect(self.dialog.set_theme)
        self.dialog.show()
        self.dialog.raise_()
        self.measure()

    def measure(self) -> None:
        """Bring the window in line with A and B as they are marked now."""
        measurer, marked, dialog = self._time_line.looking.measurer(), self._time_line.dock.slider.marked, self.dialog
        if dialog is None or measurer is None or len(marked) < 2:
            return
        first, second, measure = marked["A"], marked["B"], dialog.quantity.measure
        is_held = self._window.document.session.fixed_boundary
        self._work.ask(lambda: (measurer.mesh, compare(measurer, first, second, measure, is_held=is_held)))

    def _show(self, found: tuple[Mesh, Comparison]) -> None:
        mesh, comparison = found
        if self.dialog is not None and mesh is self._window.document.mesh:
            self.dialog.show_comparison(comparison, mesh.simplices)

    def _fail(self, error: Exception) -> None:
        if self.dialog is not None:
            self.dialog.words.setText(sentence_of(error))

    def close(self) -> None:
        """Another mesh: A and B are of the one before."""
        if self.dialog is not None:
            self.dialog.close()

    def _forget(self) -> None:
        dialog, self.dialog = self.dialog, None
        if dialog is not None:
            dialog.close_view()
            self._window.theme_switch.changed.disconnect(dialog.set_theme)
