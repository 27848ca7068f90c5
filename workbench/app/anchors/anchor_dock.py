"""The panel with the table of anchors, its buttons, and how far the map is from the targets."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QGuiApplication, QShowEvent
from PySide6.QtWidgets import QDockWidget, QLabel, QToolButton, QVBoxLayout, QWidget

from workbench.app.anchors.anchor_edits import edited, pasted
from workbench.app.anchors.anchor_table import AnchorTable
from workbench.app.anchors.anchor_table_model import AnchorTableModel
from workbench.app.background import Backgrounds
from workbench.app.docks.dock_title import DockTitle
from workbench.app.document.anchor_set import AnchorSet
from workbench.app.document.document import Document
from workbench.app.one_shot import one_shot
from workbench.app.status.error_bar import ErrorBar
from workbench.core.arrays import Integers
from workbench.core.errors import WorkbenchError

LONG = 200_000
"""Letters of a pasted text from which on it is read on a thread."""
LIVE = 150
"""Milliseconds between two looks at the map while it moves."""


class AnchorDock(QDockWidget):
    """Shows what the document holds, and makes one step of the history of every edit.

    Where it is hidden it does nothing; it looks at the document when it is shown.
    """

    def __init__(self, document: Document, errors: ErrorBar, actions: tuple[QAction, ...], parent: QWidget) -> None:
        super().__init__("Anchors", parent)
        self.setObjectName("anchors")
        self._document = document
        self._errors = errors
        self._fresh = -1
        self._is_choosing = False
        self.works = Backgrounds(self)
        self.model = AnchorTableModel(self)
        self.table = AnchorTable(self.model, self)
        self.summary = QLabel(self)
        self.summary.setObjectName("citation")
        self._make_body(actions)
        self._later = one_shot(self, LIVE, self._show_residuals)
        self._soon = one_shot(self, 0, self._show_anchors)
        self.model.edited.connect(self._edit)
        self.model.modelReset.connect(self._show_choice)  # rows have moved, the table has forgotten which were selected
        self.table.chosen.connect(self._tell_choice)
        self.table.copy_wanted.connect(self.copy)
        self.table.paste_wanted.connect(self.paste)
        self.table.delete_wanted.connect(self.delete)
        document.opened.connect(self._show_mesh)
        document.anchors_changed.connect(self._soon.start)
        document.selection_changed.connect(self._show_choice)
        document.snapshot_taken.connect(lambda: self._later.isActive() or self._later.start())
        self._show_mesh()

    def _make_body(self, actions: tuple[QAction, ...]) -> None:
        body = QWidget(self)
        layout = QVBoxLayout(body)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        self.add_button = _button("Add", "Anchor another vertex; its number is typed into the new row", self.add, self)
        self.delete_button = _button("Delete", "Let the anchors of the selected rows go (Del)", self.delete, self)
        files = [_button(word, a.toolTip(), a.trigger, self) for word, a in zip(("Import", "Export"), actions, strict=True)]
        self.setTitleBarWidget(DockTitle(self, QLabel("Anchors", self), self.add_button, self.delete_button, *files))
        layout.addWidget(self.table, 1)
        self.summary.setContentsMargins(8, 1, 8, 2)
        self.summary.setWordWrap(True)
        layout.addWidget(self.summary)
        self.setWidget(body)

    # ------------------------------------------------------------------------------------------ showing

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._soon.start()

    @property
    def _dimension(self) -> int:
        return 3 if self._document.kind == "volume" else 2

    def _show_mesh(self) -> None:
        mesh, self._fresh = self._document.mesh, -1
        self.model.show_mesh(np.empty((0, 2)) if mesh is None else mesh.vertices, self._dimension)
        self.table.fit_columns()
        self._soon.start()

    def _show_anchors(self) -> None:
        if not self.isVisible():
            return
        if self._document.mesh is not None:
            self.model.show_anchors(self._document.anchors)
        self._show_residuals()
        self._show_choice()

    def _show_residuals(self) -> None:
        positions = self._document.positions
        if not self.isVisible() or self._soon.isActive():
            return
        if positions is not None:
            self.model.show_positions(positions)
        self._summarise()

    def _summarise(self) -> None:
        anchors = self._document.anchors
        count, off, soft = len(anchors), len(anchors.off), len(anchors.weights)
        words = [f"{count} anchor{'s' * (count != 1)}"]
        words += [f"{soft} soft"] * bool(soft) + [f"{off} off"] * bool(off)
        largest, mean = self.model.residual_summary
        residual = f"; from the targets: at most {largest:.3g}, {mean:.3g} in the mean square" if math.isfinite(largest) else ""
        self.summary.setText(f"{', '.join(words)}{residual}" if count else "No anchors yet: click a vertex, or add a row.")

    # ------------------------------------------------------------------------------------------ selection

    def _show_choice(self) -> None:
        if self.isVisible() and not self._is_choosing and not self._soon.isActive():
            chosen = self._document.selection
            self.table.choose_rows(self.model.rows_of(np.array(chosen, dtype=np.int64)))

    def _tell_choice(self) -> None:
        self._is_choosing = True
        self._document.select_all(self.chosen_vertices.tolist())
        self._is_choosing = False

    @property
    def chosen_vertices(self) -> Integers:
        """(k,) vertices of the selected rows."""
        return self.model.vertices_in(self.table.chosen_rows)

    # ------------------------------------------------------------------------------------------ editing

    def _set(self, anchors: AnchorSet, name: str = "") -> None:
        self._document.set_anchors(anchors, name=name)
        self._soon.stop()
        self._show_anchors()

    def _edit(self, row: int, column: str, text: str) -> None:
        """One value for the row, or for all selected ones where it is among them."""
        document, rows = self._document, self.table.chosen_rows
        if document.mesh is None:
            return
        vertices = self.model.vertices_in(rows if row in rows and column != "vertex" else np.array([row]))
        try:
            anchors = edited(document.anchors, column, vertices, text, document.mesh.vertex_count)
        except WorkbenchError as error:
            self._refuse(error)
            return
        if column == "vertex":
            (old,), (new,) = vertices.tolist(), set(anchors.targets) - set(document.anchors.targets) or vertices.tolist()
            if old == self._fresh and document.positions is not None:  # a new row takes its vertex where it is
                anchors = anchors.with_target(new, document.positions[new])
            self._set(anchors, f"Anchor vertex {new}")
            document.select(new)
        else:
            self._set(anchors)
        self._fresh = -1

    def _refuse(self, error: Exception) -> None:
        if not isinstance(error, WorkbenchError):
            raise error
        self._errors.show_message(error.sentence[0].upper() + error.sentence[1:])

    def add(self) -> None:
        """A row for the first vertex that has none, ready for another number to be typed."""
        document = self._document
        if document.mesh is None or document.positions is None:
            return
        free = np.ones(document.mesh.vertex_count, dtype=bool)
        free[document.anchors.vertices] = False
        if not free.any():
            self._errors.show_message("Every vertex has an anchor already.")
            return
        vertex = int(np.argmax(free))
        self._set(document.anchors.with_target(vertex, document.positions[vertex]))
        document.select(vertex)
        self._fresh = vertex
        (row,) = self.model.rows_of(np.array([vertex])).tolist()
        index = self.model.index(row, self.model.place_of("vertex"))
        self.table.setFocus(Qt.FocusReason.OtherFocusReason)
        self.table.setCurrentIndex(index)
        self.table.edit(index)

    def delete(self) -> None:
        """Let the anchors of the selected rows go."""
        vertices = self.chosen_vertices.tolist()
        if vertices:
            self._set(self._document.anchors.without(*vertices))

    # ------------------------------------------------------------------------------------------ clipboard

    def copy(self) -> None:
        """The selected rows with a header, as spreadsheets take them."""
        rows = self.table.chosen_rows
        if len(rows):
            QGuiApplication.clipboard().setText(self.model.text_of_rows(rows))

    def paste(self) -> None:
        """Anchors from a spreadsheet: new ones are added, those that are there get what is pasted.

        A single value goes into the selected rows of the current column.
        """
        document, text = self._document, QGuiApplication.clipboard().text()
        if document.mesh is None:
            return
        index = self.table.currentIndex()
        if index.isValid() and len(text.split()) == 1 and not set(text.strip()) & set("\t;,\n"):
            self._edit(index.row(), self.model.columns[index.column()].key, text)
            return
        before, generation = document.anchors, document.generation
        read = partial(pasted, text, before, document.mesh.vertex_count, self._dimension)
        if len(text) > LONG:  # the window lives while it is read

            def done(found: AnchorSet) -> None:
                if document.generation == generation:
                    self.take(found, "Paste")

            self.works.start(read, done, self._refuse)
            return
        try:
            self.take(read(), "Paste")
        except WorkbenchError as error:
            self._refuse(error)

    def take(self, found: AnchorSet, verb: str) -> None:
        """Anchors from elsewhere as one step: new ones are added, those that are there become as these say."""
        count = len(found)
        self._set(found.joined(self._document.anchors), f"{verb} {count} anchor{'s' * (count != 1)}")
        self._document.select_all(found.targets)


def _button(text: str, tip: str, deed: Callable[[], None], parent: QWidget) -> QToolButton:
    button = QToolButton(parent)
    button.setText(text)
    button.setToolTip(tip)
    button.setAutoRaise(True)
    button.clicked.connect(lambda _=False: deed())
    return button
