"""What the pages of Fig. 12 and Fig. 19 have in common: a picture, a plot and a place along a path."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QSplitter, QVBoxLayout, QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.inspector.latest import Latest
from workbench.app.inspector.page import Page
from workbench.app.inspector.path_plot import PathPlot
from workbench.app.inspector.simplex_picture import SimplexPicture
from workbench.app.inspector.subject import Key, Subject
from workbench.core.errors import WorkbenchError


class PathPage(Page):
    """Computes a path on a thread when the subject changes; the place on it follows the mouse."""

    def __init__(self, subject: Subject, plot: PathPlot, parent: QWidget | None = None) -> None:
        super().__init__(subject, parent)
        self.plot = plot
        self.picture = SimplexPicture(self)
        self.sentence = QLabel("", self)
        self.sentence.setWordWrap(True)
        self.sentence.setContentsMargins(8, 3, 8, 4)
        # room for two lines always: the picture must not jump under the hand that drags in it
        self.sentence.setMinimumHeight(2 * self.fontMetrics().lineSpacing() + 8)
        self.sentence.setAlignment(Qt.AlignmentFlag.AlignTop)
        self.path: Any = None
        self._latest = Latest(self)
        self._latest.done.connect(self._take)
        self._latest.failed.connect(self._fail)
        self._halves = QSplitter(Qt.Orientation.Vertical, self)
        self._halves.setChildrenCollapsible(False)
        self._halves.addWidget(self.picture)
        self._halves.addWidget(plot)
        self._halves.setSizes([200, 240])
        self.rows = QVBoxLayout(self)
        self.rows.setContentsMargins(0, 0, 0, 0)
        self.rows.setSpacing(0)
        self.rows.addWidget(self._halves, 1)
        self.rows.addWidget(self.sentence)

    def show_path(self) -> None:
        """Draw `path`, and the place on it."""
        raise NotImplementedError

    def set_theme(self, theme: Theme) -> None:
        self.picture.set_theme(theme)
        super().set_theme(theme)

    def wait(self) -> None:
        self._latest.wait()

    def refresh(self) -> None:
        if self.subject.distortion is None:
            self.show_nothing("")
            return
        key, work = self.subject.key, self.work()
        self._latest.ask(lambda: (key, work()))

    def work(self) -> Any:
        """A function that computes the path, all that it needs taken along."""
        raise NotImplementedError

    def show_nothing(self, sentence: str) -> None:
        """No path, but perhaps a word on why."""
        self.path = None
        self.picture.show_scene(None)
        for curve in self.plot.curves:
            curve.setData([], [])
        self.plot.dots.setData([], [])
        self.sentence.setText(sentence)

    def _take(self, result: tuple[Key, Any]) -> None:
        key, path = result
        if key == self.subject.key:
            self.path = path
            self.show_path()

    def _fail(self, error: Exception) -> None:
        self.show_nothing(error.sentence if isinstance(error, WorkbenchError) else f"The path cannot be computed: {error}.")
