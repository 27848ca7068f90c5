"""Undo and redo of what the user did to the document."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np
from PySide6.QtCore import QObject, Signal

from workbench.app.background import Background
from workbench.app.document.anchor_set import AnchorSet
from workbench.app.document.document import Document
from workbench.app.document.history import Curves
from workbench.app.document.switches import switched
from workbench.app.sessions.restoring import is_on_same_source, with_anchors
from workbench.app.status.reporter import source_name
from workbench.core.arrays import Floats
from workbench.engine.messages import Refused
from workbench.session.session import Session
from workbench.session.undo import UndoHistory

MEMORY = 2**28
"""Bytes of maps that are kept for undoing."""
ANCHOR_BYTES = 250
"""Of an entry in a dictionary, its tuple and the numbers in it."""
PAUSE = 1.0
"""Seconds without a change after which the next one of the same kind is another step: drawing a slider makes one."""
NAMES = {
    "initializer": "Start",
    "start_file": "Start",
    "match_area": "Scale",
    "fixed_boundary": "Boundary",
    "allow_inversions": "Inversions",
    "linear_equations": "Linear equations",
    "distortion": "Distortion",
    "solver": "Solver",
    "carried": "Carried surface",
}
"""What a choice is called where there are no better words."""


@dataclass(frozen=True)
class Chosen:
    """What a step may change: choices, anchors, and whether the solver ran; with the curves that led to the map."""

    session: Session
    anchors: AnchorSet
    runs: bool
    curves: Curves | None = None


def chosen_bytes(moments: Iterable[Chosen]) -> int:
    """What the anchors and curves of moments take, each set and table of them once."""
    sets, tables = dict[int, int](), dict[int, int]()
    for moment in moments:
        sets[id(moment.anchors)] = len(moment.anchors)
        if moment.curves is not None:
            tables[id(moment.curves.table)] = moment.curves.table.nbytes
    return ANCHOR_BYTES * sum(sets.values()) + sum(tables.values())


class Undoing(QObject):
    """Keeps the moment before each step, and brings it back; `changed` tells that the list is another one."""

    changed = Signal()
    gone = Signal()
    """Went back or forth."""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self._document = document
        self.history: UndoHistory[Chosen] = UndoHistory(MEMORY, self._may_round, chosen_bytes)
        self._key, self._is_choice = "", False
        self._came_from = -1
        self._taken_up: tuple[int, int] | None = None
        self._changed_at = 0.0
        self._packing: Background | None = None
        self.curves: Callable[[], Curves | None] = lambda: None
        """Those of the present map, for whoever keeps some."""
        document.changing.connect(self._begin_step)
        document.session_changed.connect(self._name_step)
        document.anchors_changed.connect(self._forget_if_nothing)
        document.refused.connect(self._refused)
        document.opened.connect(self._opened)

    @property
    def _chosen(self) -> Chosen:
        document = self._document
        return Chosen(document.session, document.anchors, document.wants_to_run, self.curves())

    # ------------------------------------------------------------------------------------------ steps

    def _begin_step(self, name: str, key: str) -> None:
        now = time.monotonic()
        is_same = bool(key) and key == self._key and now - self._changed_at < PAUSE
        self._key, self._changed_at = key, now
        self._came_from, self._taken_up = -1, None
        self._is_choice = name in ("Choose", "Open")
        if is_same and self.history.done == len(self.history.names) and self.history.done:
            return
        chosen = self._chosen
        if name in ("Run", "Step"):  # what takes it back shall not run on at once
            chosen = replace(chosen, runs=False)
        self.history.begin_step(name, chosen, self._document.positions)
        self._pack()
        self.changed.emit()

    def _name_step(self) -> None:
        """Call the newest step by what has become of it."""
        last = self.history.last
        if last is None or self.history.redo_name or not self._is_choice:
            return
        before, after = last.choices.session, self._document.session
        if not is_on_same_source(before, after):
            words = f"Open {source_name(after.source)}"
            if before.source == after.source:
                words = f"Fix {', '.join(after.fixes)}" if before.fixes != after.fixes else "Kind of map"
        else:
            words = switched(before, after) or next(
                (name for field, name in NAMES.items() if getattr(before, field) != getattr(after, field)), ""
            )
        if words:
            self.history.rename_last(words)
            self.changed.emit()

    def _opened(self) -> None:
        self._came_from = -1  # the mesh of the moment is there; one that is refused later is another matter
        self._name_step()

    def _forget_if_nothing(self, even_if_held: bool = False) -> None:
        """A drag that was taken back, or a choice that was refused, is no step."""
        last = self.history.last
        if last is None or self.history.redo_name or (self._document.is_held and not even_if_held):
            return
        chosen = self._chosen
        before = last.choices
        is_deed = self.history.undo_name in ("Run", "Step", "Reset", "Take a map", "Start", "Scale", "Open")
        if (before.session, before.anchors) == (chosen.session, chosen.anchors) and not is_deed:
            self.history.forget_last()
            self.changed.emit()

    def _refused(self, report: Refused) -> None:
        if report.command == "Load" and self._came_from >= 0:
            self.history.stay_at(self._came_from)  # the mesh of that moment is not there any longer
            self._came_from = -1
            self.changed.emit()
        elif report.command == "TakeUp" and self._taken_up is not None:
            self._go_past(*self._taken_up)
        else:
            self._forget_if_nothing(even_if_held=True)

    def _go_past(self, came_from: int, done: int) -> None:
        """A moment holds a choice that was refused only after the next step had begun: go on to the one beyond it."""
        self._taken_up = None
        present = self.history.forget_moment(done, came_from)
        self.changed.emit()
        beyond = done - 1 if done < came_from else done
        if beyond != present:
            self.go_to(beyond)

    # ------------------------------------------------------------------------------------------ going back and forth

    def undo(self) -> None:
        """Take the last step back."""
        self.go_to(self.history.done - 1)

    def redo(self) -> None:
        """Do the step again that was taken back last."""
        self.go_to(self.history.done + 1)

    def go_to(self, done: int) -> None:
        """The moment at which the first `done` steps were done. Not while a hand holds an anchor, or a mesh is being read."""
        document = self._document
        if document.is_held or document.opening_source or not 0 <= done <= len(self.history.names):
            return
        self._key, self._is_choice = "", False
        came_from = self.history.done
        moment = self.history.go_to(done, self._chosen, document.positions)
        chosen = moment.choices
        session = with_anchors(chosen.session, chosen.anchors)
        document.restore(session, moment.positions, run=chosen.runs, curves=chosen.curves)
        self._came_from = came_from if document.opening_source else -1
        self._taken_up = None if document.opening_source else (came_from, done)
        self.changed.emit()
        self.gone.emit()

    # ------------------------------------------------------------------------------------------ memory

    def _pack(self) -> None:
        if self._packing is None:
            self._packing = Background(self._tidy, self)
            self._packing.finished.connect(lambda _: self._packed())
            self._packing.failed.connect(lambda _: self._packed())
            self._packing.start()

    def _tidy(self) -> None:
        """On a thread of its own."""
        self.history.pack()
        self.history.trim()

    def _packed(self) -> None:
        self._packing = None
        self.changed.emit()

    def _may_round(self, positions: Floats) -> bool:
        """Whether a map in float32 still has no inverted simplex, on the mesh that is open now."""
        mesh = self._document.mesh
        if mesh is None or positions.shape != (mesh.vertex_count, mesh.dimension):
            return False
        from workbench.core.jacobians import build_elements, determinants

        return bool(np.all(determinants(build_elements(mesh), positions) > 0))

    def set_memory(self, limit: int) -> None:
        """Keep maps of so many bytes at the most."""
        self.history.set_limit(limit)
        self._pack()

    def wait(self) -> None:
        if self._packing is not None:
            self._packing.wait()
