"""The verdict on the present map, and everything that is to blame as a list to walk through."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from workbench.app.background import Background
from workbench.app.document.document import Document
from workbench.core.arrays import Floats, Integers
from workbench.core.injectivity import global_injectivity, local_injectivity
from workbench.core.mesh import Mesh
from workbench.core.verdict import Offenders, Verdict
from workbench.engine.verdict_kernels import compile_verdicts

MOST_LISTED = 500
"""Offenders of one kind that are listed singly; all of them are marked by their heading."""
PLACE = Qt.ItemDataRole.UserRole


class VerdictWindow(QDialog):
    """Judges the map that is there when it is asked; the solver goes on meanwhile.

    `shown` carries the vertices and the simplices of what was chosen in the list, `alone_wanted` whether nothing else is to be
    drawn.
    """

    shown = Signal(object, object)
    alone_wanted = Signal(bool)

    def __init__(self, document: Document, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("Injectivity")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.resize(460, 420)
        self._document = document
        self._mesh: Mesh | None = None
        self._offenders: tuple[Offenders, ...] = ()
        self._work: Background | None = None
        self.words = QLabel("", self)
        self.words.setWordWrap(True)
        self.words.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.list = QTreeWidget(self)
        self.list.setHeaderHidden(True)
        self.list.currentItemChanged.connect(lambda item, _: self._show(item))
        self.again = self._button("Judge the present map", "Look at the map as it is now", self.ask)
        self.back = self._button("Previous", "The place before (Shift+F3)", lambda: self.walk(-1))
        self.next = self._button("Next", "The next place (F3)", lambda: self.walk(1))
        self.alone = QCheckBox("Alone", self)
        self.alone.setToolTip("Draw nothing of the solid but the place that is chosen")
        self.alone.toggled.connect(self.alone_wanted)
        for keys, step in (("F3", 1), ("Shift+F3", -1)):
            QShortcut(QKeySequence(keys), self).activated.connect(lambda s=step: self.walk(s))
        self._lay_out()
        document.opened.connect(self._forget)

    def _button(self, text: str, tip: str, deed: Callable[[], None]) -> QPushButton:
        button = QPushButton(text, self)
        button.setToolTip(tip)
        button.setAutoDefault(False)
        button.clicked.connect(lambda _=False: deed())
        return button

    def _lay_out(self) -> None:
        row = QHBoxLayout()
        for widget in (self.again, self.back, self.next, self.alone):
            row.addWidget(widget)
        layout = QVBoxLayout(self)
        layout.addWidget(self.words)
        layout.addWidget(self.list, 1)
        layout.addLayout(row)

    # ------------------------------------------------------------------------------------------ asking

    def ask(self) -> None:
        """Judge the present map on a thread."""
        mesh, positions = self._document.mesh, self._document.positions
        if mesh is None or positions is None or self._work is not None:
            return
        self.words.setText("Looking at every star and at the boundary …")
        self.again.setEnabled(False)
        self.alone.setVisible(mesh.dimension == 3)
        generation = self._document.generation
        self._work = Background(lambda: (generation, mesh, *judged(mesh, positions)), self)
        self._work.finished.connect(self._take)
        self._work.failed.connect(self._fail)
        self._work.start()

    def _take(self, found: tuple[int, Mesh, str, tuple[Offenders, ...]]) -> None:
        self._end_work()
        generation, mesh, words, offenders = found
        if generation == self._document.generation:
            self.words.setText(words)
            self._list(mesh, offenders)

    def _fail(self, error: Exception) -> None:
        self._end_work()
        self.words.setText(str(getattr(error, "sentence", error)))

    def _end_work(self) -> None:
        self._work = None
        self.again.setEnabled(True)

    def _forget(self) -> None:
        """Another mesh came: what was said holds no longer."""
        self.words.setText("Another mesh is open now.")
        self._list(None, ())
        self.alone.setVisible(self._document.kind == "volume")

    # ------------------------------------------------------------------------------------------ the list

    def _list(self, mesh: Mesh | None, offenders: tuple[Offenders, ...]) -> None:
        self.list.clear()
        self._mesh, self._offenders = mesh, offenders
        for kind, group in enumerate(offenders):
            heading = QTreeWidgetItem([f"{len(group):,} {group.label}"])
            heading.setData(0, PLACE, (kind, -1))
            self.list.addTopLevelItem(heading)
            for row in range(min(len(group), MOST_LISTED)):
                item = QTreeWidgetItem([words_of(group, row)])
                item.setData(0, PLACE, (kind, row))
                heading.addChild(item)
            if len(group) > MOST_LISTED:
                rest = QTreeWidgetItem([f"… {len(group) - MOST_LISTED:,} more"])
                rest.setFlags(Qt.ItemFlag.NoItemFlags)
                heading.addChild(rest)
            heading.setExpanded(kind == 0)
        for button in (self.back, self.next):
            button.setEnabled(bool(offenders))

    def _show(self, item: QTreeWidgetItem | None) -> None:
        place = None if item is None else item.data(0, PLACE)
        if place is None or self._mesh is None:
            return
        kind, row = place
        group = self._offenders[kind]
        chosen = group if row < 0 else replace(group, indices=group.indices[row : row + 1])
        simplices = chosen.simplices(self._mesh)
        vertices = chosen.vertices(self._mesh, 0) if row >= 0 else np.unique(self._mesh.simplices[simplices])
        self.shown.emit(vertices, simplices)

    def walk(self, step: int) -> None:
        """To the next place of the list, or the one before; round at its ends. A first question judges the map."""
        if not self._offenders:
            self.ask()
            return
        places = [(kind, row) for kind, group in enumerate(self._offenders) for row in range(min(len(group), MOST_LISTED))]
        item = self.list.currentItem()
        here = None if item is None else tuple(item.data(0, PLACE) or ())
        number = places.index(here) + step if here in places else 0 if step > 0 else -1  # type: ignore[arg-type]
        kind, row = places[number % len(places)]
        heading = self.list.topLevelItem(kind)
        if heading is not None:
            self.list.setCurrentItem(heading.child(row))

    # ------------------------------------------------------------------------------------------ end

    def done(self, result: int) -> None:
        self.alone.setChecked(False)
        if self._work is not None:
            self._work.wait()
        super().done(result)


def judged(mesh: Mesh, positions: Floats) -> tuple[str, tuple[Offenders, ...]]:
    """What is to be said of a map, and what is to blame."""
    if mesh.dimension == 3:
        compile_verdicts()
    local = local_injectivity(mesh, positions)
    if local.holds is False:
        return f"Not injective, not even locally. {local.reason}", local.offenders
    whole = global_injectivity(mesh, positions)
    return f"{_opening(whole)} {whole.reason}", whole.offenders


def _opening(whole: Verdict) -> str:
    if whole.holds:
        return "Injective, as a whole and so everywhere."
    as_a_whole = "whether as a whole, too, is open" if whole.holds is None else "but not as a whole"
    return f"Locally injective, {as_a_whole}."


def words_of(group: Offenders, row: int) -> str:
    """One offender in words."""
    indices: Integers = group.indices[row]
    if group.kind in ("inverted", "degenerate"):
        return f"simplex {int(indices)}"
    if group.kind == "vertices":
        return f"vertex {int(indices)}"
    sides = ["–".join(str(v) for v in side) for side in np.atleast_2d(indices).tolist()]
    return f"{'edge' if group.kind == 'edges' else 'facets'} {' and '.join(sides)}"
