"""The start that is shown is the one that comes, whatever solver is chosen."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest

from tests.app.fake_engine import FakeWorker, grid_mesh, let_reports_arrive
from workbench.app.document.document import Document
from workbench.app.document.engine_bridge import EngineBridge
from workbench.app.document.first_start import start_in_force
from workbench.app.main_window import MainWindow
from workbench.app.sessions.undoing import Undoing
from workbench.core.registry import registry
from workbench.engine.messages import Load, Loaded, Refused, Reset
from workbench.engine.reports import loaded_report
from workbench.io.opening import open_source
from workbench.session.session import Session

NO_EDGES = np.empty((0, 2), np.int64)


class Room:
    """A document with an engine that answers at once, its history, and no window."""

    def __init__(self, source: str) -> None:
        self.bridge = EngineBridge(FakeWorker)
        self.document = Document(self.bridge)
        self.undoing = Undoing(self.document)
        self.document.open(source)
        let_reports_arrive()

    def sent(self, kind: type) -> list[object]:
        return [command for command in self.bridge._worker.commands if isinstance(command, kind)]  # type: ignore[attr-defined]

    @property
    def start(self) -> str:
        return start_in_force(self.document.session, self.document.loaded)


@pytest.fixture
def room(qapp: object) -> Room:
    return Room("bumpy")


def test_no_solver_changes_the_start(room: Room) -> None:
    """Of every two solvers, one after the other; the map is not made anew, and Home makes the start that was shown."""
    document = room.document
    assert room.start == "auto", "as the solver of the window wishes"
    ids = sorted(registry().solvers)
    assert {registry().solvers[id].initializer for id in ids} >= {"", "auto"}, "or there is nothing to hold"
    for first, second in itertools.permutations(ids, 2):
        document.session = Session(source="bumpy", solver=first)
        shown = room.start
        document.choose(solver=second)
        assert (room.start, document.session.solver) == (shown, second)
    assert not room.sent(Reset)
    document.session = Session(source="bumpy")
    document.choose(solver="slim")
    document.reset()
    assert room.sent(Reset)[-1].initializer == "auto"  # type: ignore[attr-defined]


def test_a_solver_that_is_taken_back_or_refused_leaves_no_trace_at_the_start(room: Room) -> None:
    before = room.document.session
    room.document.choose(solver="slim")
    assert room.undoing.history.names == (registry().solvers["slim"].label,)
    room.undoing.undo()
    let_reports_arrive()
    assert room.document.session == before
    room.document.choose(solver="slim")
    room.bridge.refused.emit(Refused(room.document.generation, "SetSolver", "It does not minimise this."))
    assert room.document.session == before and room.undoing.history.names == (), "what was refused is no step"


def test_a_start_that_was_chosen_stays(room: Room) -> None:
    room.document.choose(initializer="lscm")
    for solver in ("slim", "fast"):
        room.document.choose(solver=solver)
        assert room.document.session.initializer == "lscm"
    room.document.choose(solver="slim", initializer="")
    assert room.start == "tutte", "whoever names both gets both"


def test_a_case_begins_with_its_own_start_and_the_panel_says_so(window: MainWindow, tmp_path: Path) -> None:
    mesh = grid_mesh()
    path = tmp_path / "grid.npz"
    np.savez(path, V=mesh.vertices, S=mesh.simplices, X0=mesh.vertices * 2.0)
    report = loaded_report(Load(source=str(path), generation=1), open_source(str(path)))
    assert report.has_start
    document, panel = window.document, window.panel
    own = document.loaded
    assert own is not None and not own.has_start and panel.start.combo.currentData() == "rest"
    document.loaded = Loaded(own.generation, mesh, "plane", (), NO_EDGES, str(path), has_start=True)
    try:
        panel.show_session()
        assert panel.start.combo.currentData() == "file" and "case" in panel.file_button.text()
        document.choose(solver="slim")
        assert document.session.initializer == "", "it is the case's still"
        document.choose(initializer="rest")
        panel.start.chosen.emit("file", {})
        assert document.session.initializer == "", "nobody is asked for a file that is there"
    finally:
        document.loaded = own
