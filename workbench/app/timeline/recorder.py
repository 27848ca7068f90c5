"""The maps of the document as they come, with what the user did between them."""

from __future__ import annotations

import time
from dataclasses import dataclass
from weakref import WeakSet

from PySide6.QtCore import QObject, Signal

from workbench.app.document.anchor_set import AnchorSet
from workbench.app.document.document import Document
from workbench.app.sessions.undoing import Undoing
from workbench.core.arrays import Floats
from workbench.session.moments import Moment, MomentRecord
from workbench.session.undo import Moment as Step

FINISHED = "finished"


@dataclass
class Noted:
    """The newest step of undo: `count` is that of the steps with it."""

    step: Step  # type: ignore[type-arg]
    moment: Moment
    name: str
    count: int


class Recorder(QObject):
    """Keeps each new map. Notes come from the steps of undo, from going back and forth, and from runs that end.

    `grown` tells of another moment, `noted` of other notes, `cleared` of another mesh.
    """

    grown = Signal()
    noted = Signal()
    cleared = Signal()

    def __init__(self, document: Document, undoing: Undoing, limit: int) -> None:
        super().__init__(document)
        self._document = document
        self._undoing = undoing
        self.record = MomentRecord(limit)
        self.seconds = 0.0
        """What recording the newest map took."""
        self._last: Floats | None = None
        self._phase = ""
        self._newest: Noted | None = None
        self._known: WeakSet[Step] = WeakSet()  # type: ignore[type-arg]
        document.snapshot_taken.connect(self._take)
        document.opened.connect(self._begin)
        undoing.changed.connect(self._follow_steps)
        undoing.gone.connect(self._note_way)

    def _begin(self) -> None:
        self.record.clear()
        self._last, self._phase, self._newest = None, "", None
        if self._undoing.history.last is not None:
            self._known.add(self._undoing.history.last)
        self.cleared.emit()

    def _take(self) -> None:
        snapshot = self._document.snapshot
        if snapshot is None:
            return
        begin = time.perf_counter()
        positions = snapshot.positions
        is_new = self._last is None or not (positions is self._last or bool((positions == self._last).all()))
        if is_new:
            self._last = positions
            self.record.add(
                positions,
                snapshot.inverted,
                begin,
                iteration=snapshot.row.iteration,
                energy=snapshot.row.energy,
                solver=snapshot.solver,
                distortion=snapshot.distortion,
                belongings=self._document.anchors,
            )
        has_finished = snapshot.phase == FINISHED != self._phase
        self._phase = snapshot.phase
        if has_finished:
            self.record.note(snapshot.status.name.capitalize().replace("_", " "))
        self.seconds = time.perf_counter() - begin
        if is_new:
            self.grown.emit()
        if has_finished:
            self.noted.emit()

    # ------------------------------------------------------------------------------------------ notes

    def _follow_steps(self) -> None:
        """A step was begun, named, or came to nothing."""
        history, newest = self._undoing.history, self._newest
        if history.done != len(history.names) or not len(self.record):
            return
        step, name = history.last, history.undo_name
        if newest is not None and step is newest.step:
            if name == newest.name:
                return
            _replace(newest.moment.notes, newest.name, name)
            newest.name = name
        elif newest is not None and len(history.names) < newest.count:
            _replace(newest.moment.notes, newest.name, "")
            self._newest = None
        elif step is not None and step not in self._known:
            moment = self.record.note(name)
            assert moment is not None
            self._known.add(step)
            self._newest = Noted(step, moment, name, len(history.names))
        else:
            return
        self.noted.emit()

    def _note_way(self) -> None:
        history = self._undoing.history
        self._newest = None
        self.record.note(f"Back to before: {history.redo_name}" if history.redo_name else f"Forth to: {history.undo_name}")
        self.noted.emit()


def anchors_of(moment: Moment) -> AnchorSet:
    """The anchors that the map was made for."""
    return moment.belongings if isinstance(moment.belongings, AnchorSet) else AnchorSet.none()


def _replace(notes: list[str], old: str, new: str) -> None:
    if old in notes:
        place = len(notes) - 1 - notes[::-1].index(old)
        notes[place : place + 1] = [new] if new else []
