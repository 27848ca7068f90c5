"""Saving and opening sessions from the window."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, Signal

from workbench.app.background import Background
from workbench.app.document.document import Document
from workbench.core.distortion import Distortion
from workbench.core.registry import registry
from workbench.engine.messages import Refused
from workbench.engine.session_file import (
    is_session_file,
    picture_with_session,
    read_session,
    source_digest,
    source_trouble,
    write_session,
)
from workbench.session.record import SessionRecord
from workbench.session.session import Session
from workbench.session.text import LEG_CHOICES, anchors_agree

FILTERS = "Sessions (*.dwb);;Sessions without their maps (*.json)"


@dataclass(frozen=True)
class Name:
    """What a session is called once its mesh `source` is open: its file, and whether that holds it as it is then."""

    path: str
    is_saved: bool
    source: str


@dataclass(frozen=True, eq=False)
class Found:
    """A session that was read, and what is amiss with its mesh."""

    path: str
    record: SessionRecord
    trouble: str
    keeps_path: bool = True
    """Whether the session is saved to that file again."""


class SessionDesk(QObject):
    """Reads and writes on threads. `path` is the file of the present session; empty where it has none.

    A session counts as modified from the first step on that a save does not hold.
    """

    said = Signal(str)
    failed = Signal(object)
    changed = Signal()
    mesh_wanted = Signal(object)
    """A `Found` whose mesh is missing or another one: the user is asked for it."""
    saved = Signal(str)
    views_found = Signal(object)
    """How the views of a session that is gone to were, as its file has them"""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self._document = document
        self._works: list[Background] = []
        self.views: Callable[[], dict[str, Any] | None] = lambda: None
        self.path = ""
        self.is_modified = False
        self._pending: Name | None = None
        self._left: tuple[str, bool] | None = None
        self._digests: dict[int, str] = {}
        document.changing.connect(self._modify)
        document.opened.connect(self._opened)
        document.refused.connect(self._refused)

    @property
    def has_something(self) -> bool:
        """Whether there is anything to save."""
        return self._document.loaded is not None and self._document.snapshot is not None

    # ------------------------------------------------------------------------------------------ saving

    def record(self) -> SessionRecord:
        """All that the file of the present session holds; the sha256 of its mesh is found while it is written."""
        document = self._document
        snapshot, session = document.snapshot, document.complete_session
        assert snapshot is not None
        legs = document.journal.way_to(snapshot.leg, snapshot.row.iteration)
        is_told = snapshot.anchor_serial == document.anchor_serial and snapshot.distortion == session.distortion
        is_settled = snapshot.phase in ("idle", "finished") and not document.is_held
        if is_told and not is_settled:
            is_told = bool(legs) and _agree(legs[-1].choices, session)
        method = registry().distortions.get(session.distortion)
        if method is not None and method.looks_at_start:  # where its barrier is, whoever repeats the session asks the map anew
            is_told = False
        energy = snapshot.row.energy if is_told else None
        return SessionRecord(session, "", snapshot.positions, legs, energy, self.views())

    def save(self, path: str, *, is_copy: bool = False) -> None:
        """Write the session as it is now, on a thread; a copy leaves name and mark of the window alone."""
        if not self.has_something:
            return
        seal = self.sealer()
        was_modified, self.is_modified = self.is_modified, self.is_modified if is_copy else False

        def work() -> str:
            write_session(path, seal())
            return path

        def done(_: Any) -> None:
            if not is_copy:
                self.path = path
                self.said.emit(f"Saved {path}.")
                self.saved.emit(path)
                self.changed.emit()

        def failed(error: Exception) -> None:
            self.is_modified = self.is_modified or was_modified
            self.failed.emit(error)
            self.changed.emit()

        self._begin(work, done, failed)

    def sealer(self) -> Callable[[], SessionRecord]:
        """What gives the record of this moment with the sha256 of its mesh; for threads."""
        record, generation = self.record(), self._document.generation

        def seal() -> SessionRecord:
            digest = self._digests.get(generation)
            if digest is None:
                digest = self._digests[generation] = source_digest(record.session.source)
            return replace(record, sha256=digest)

        return seal

    def binder(self, path: str | Path) -> Callable[[bytes], bytes]:
        """What makes of a PNG for `path` one that carries the session as it is now; for threads."""
        seal = self.sealer()
        return lambda picture: picture_with_session(picture, path, seal())

    # ------------------------------------------------------------------------------------------ opening

    def read(self, path: str, *, keeps_path: bool = True) -> None:
        """Read a session and go to it; a mesh that is missing or changed is asked for."""

        def work() -> Found:
            record = read_session(path)
            check_choices(record.session)
            return Found(path, record, source_trouble(record), keeps_path)

        def done(found: Found) -> None:
            if found.trouble:
                self.mesh_wanted.emit(found)
            else:
                self.open(found)

        self._begin(work, done, self.failed.emit)

    def open(self, found: Found, mesh: str = "") -> None:
        """Go to a session, on its own mesh or on `mesh`."""
        record = found.record
        session = replace(record.session, source=mesh) if mesh else record.session
        path = found.path if found.keeps_path else ""
        self._pending = Name(path, bool(path) and not (mesh or found.trouble), session.source)
        if self.has_something:
            is_recovered = not found.keeps_path and is_session_file(found.path)
            self._document.changing.emit("Recover" if is_recovered else f"Open {Path(found.path).name}", "")
        self._document.restore(session, record.map)
        self.views_found.emit(record.views)
        if not self._document.opening_source:
            self._left = self.path, self.is_modified
            self._take_name()
            self.said.emit(f"{Path(found.path).name} is open; its mesh was already.")

    # ------------------------------------------------------------------------------------------ name and mark

    def _opened(self) -> None:
        """A name that waits is that of the session on whose mesh the document is now; or it came to nothing."""
        document = self._document
        if self._pending is not None and not (document.is_restoring and document.session.source == self._pending.source):
            self._pending = None
        self._left = ("", False) if self._pending is not None else None
        self._take_name()

    def _take_name(self) -> None:
        name, self._pending = self._pending, None
        self.path = name.path if name is not None else ""
        self.is_modified = name is not None and not name.is_saved
        self.changed.emit()

    def _refused(self, report: Refused) -> None:
        if report.command == "Session":  # its mesh is open without it: that shall not take the place of the file
            self._take_name()
        elif report.command == "TakeUp" and self._left is not None:  # what was there before still is
            (self.path, self.is_modified), self._left = self._left, None
            self.changed.emit()
        elif report.command == "Reset" and self._left is not None:  # the session is there, though not with its start
            self.is_modified, self._left = True, None
            self.changed.emit()

    def _modify(self, name: str, key: str) -> None:
        self._left = None
        if not name.startswith("Open") and not self.is_modified:
            self.is_modified = True
            self.changed.emit()

    def mark_modified(self) -> None:
        """The session is not as its file has it any longer, nor will be once the mesh that is being read is there."""
        self._modify("", "")
        if self._document.opening_source:
            self._pending = Name("", False, self._document.opening_source)

    # ------------------------------------------------------------------------------------------ threads

    def _begin(self, work: Callable[[], Any], done: Callable[[Any], None], failed: Callable[[Any], None]) -> None:
        background = Background(work, self)
        self._works.append(background)

        def end(deed: Callable[[Any], None], result: Any) -> None:
            self._works.remove(background)
            deed(result)

        background.finished.connect(lambda result: end(done, result))
        background.failed.connect(lambda error: end(failed, error))
        background.start()

    @property
    def is_busy(self) -> bool:
        return bool(self._works)

    def wait(self) -> None:
        for work in list(self._works):
            work.wait()


def check_choices(session: Session) -> None:
    """Raises `WorkbenchError` for a formula or a method that there is not, before anything is opened for it."""
    Distortion.resolve(session.distortion, session.distortion_parameters)
    registry().solver(session.solver).configured(dict(session.solver_parameters))
    if session.initializer:
        registry().initializer(session.initializer).configured(dict(session.initializer_parameters))


def _agree(one: Session, other: Session) -> bool:
    return anchors_agree(one, other) and all(getattr(one, name) == getattr(other, name) for name in LEG_CHOICES)
