"""Whatever a user does one after another, undo and redo go through the same states again, map and all, to the last bit."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from PySide6.QtCore import QCoreApplication

from tests.app.loop_worker import LoopWorker, garbage_of_this_thread
from tests.conftest import grid
from workbench.app.document.document import Document
from workbench.app.document.engine_bridge import EngineBridge
from workbench.app.sessions.session_desk import Found, SessionDesk
from workbench.app.sessions.undoing import Undoing
from workbench.engine.messages import Refused
from workbench.session.record import SessionRecord
from workbench.session.session import Session

CELLS = 4
FORMULA = "lam*symmetric_dirichlet + (1 - lam)*mips"


def write_grid(path: Path, height: float, flipped: int, cells: int = CELLS) -> str:
    """A grid over the unit square, lifted by a bump; its first `flipped` triangles are turned over."""
    flat = grid(cells)
    x, y = flat.vertices.T
    z = height * x * (1 - x) * y * (1 - y)
    faces = flat.simplices.copy()
    faces[:flipped] = faces[:flipped, ::-1]
    lines = [f"v {a!r} {b!r} {c!r}" for a, b, c in np.c_[x, y, z].tolist()]
    path.write_text("\n".join([*lines, *(f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist())]) + "\n")
    return str(path)


class Bench:
    """A document on the engine's loop, its history, and every state in the order of steps."""

    def __init__(self, sources: tuple[str, ...]) -> None:
        self.sources = sources
        self.bridge = EngineBridge(LoopWorker)
        self.document = Document(self.bridge)
        self.undoing = Undoing(self.document)
        self.refusals: list[Refused] = []
        self.document.refused.connect(self.refusals.append)
        self.document.open(sources[0])
        self.settle()
        self.states: list[tuple[object, ...]] = []

    @property
    def worker(self) -> LoopWorker:
        found = self.bridge._worker
        assert isinstance(found, LoopWorker)
        return found

    @property
    def now(self) -> tuple[object, ...]:
        assert self.document.positions is not None
        return self.document.session, self.document.anchors, self.document.positions.tobytes()

    @property
    def done(self) -> int:
        return self.undoing.history.done

    def settle(self) -> None:
        while self.worker._reports:
            self.bridge._drain()
        QCoreApplication.processEvents()

    def do(self, deed: Callable[[Bench, int], None], value: int) -> None:
        """One more thing, from a state that is remembered."""
        self.remember()
        deed(self, value)
        self.settle()
        del self.states[len(self.undoing.history.names) + 1 :]  # what was undone is forgotten with the next step

    def remember(self) -> None:
        self.states[self.done : self.done + 1] = [self.now]

    def go_to(self, done: int) -> None:
        self.remember()
        self.undoing.go_to(done)
        self.settle()
        assert self.done == done and self.now == self.states[done], self.undoing.history.names

    def end(self) -> None:
        self.undoing.wait()
        QCoreApplication.processEvents()
        self.document.deleteLater()


def anchor(bench: Bench, value: int) -> None:
    bench.document.add_anchor(7 * value % bench.document.mesh.vertex_count)


def drag(bench: Bench, value: int) -> None:
    document = bench.document
    for vertex in document.anchors.vertices[value % 3 :][:1].tolist():
        target = np.array(document.anchors.targets[vertex])
        for part in (0.3, 0.6, 1.0):
            document.move_anchor(vertex, target + 0.02 * part * (value + 1), dragging=part < 1.0)


def weigh(bench: Bench, value: int) -> None:
    anchors = bench.document.anchors
    bench.document.set_anchors(anchors.weighted(anchors.vertices[:2].tolist(), (0.5, 20.0, np.inf)[value % 3]))


def group(bench: Bench, value: int) -> None:
    anchors = bench.document.anchors
    bench.document.set_anchors(anchors.grouped(anchors.vertices[:2]) if value % 2 else anchors.ungrouped(anchors.vertices))


def switch_off(bench: Bench, value: int) -> None:
    anchors = bench.document.anchors
    bench.document.set_anchors(anchors.switched(anchors.vertices[:1].tolist(), on=bool(value % 2)))


def let_go(bench: Bench, value: int) -> None:
    bench.document.clear_anchors()


def choose(bench: Bench, value: int) -> None:
    changes = (
        {"distortion": "mips", "distortion_parameters": {}},
        {"distortion": FORMULA, "distortion_parameters": {"lam": 0.25}},
        {"distortion": FORMULA, "distortion_parameters": {"lam": 0.75}},
        {"solver": "slim", "solver_parameters": {"safety": 0.5}},
        {"solver": "projected-newton", "solver_parameters": {}},
        {"initializer": "harmonic", "initializer_parameters": {}},
        {"fixed_boundary": True},
        {"allow_inversions": True},
        {"linear_equations": ("x[3] - x[8] = 0.0", "2.0*y[1] = 0.125")},
        {"linear_equations": (), "fixed_boundary": False},
    )
    bench.document.choose(**changes[value])


def open_another(bench: Bench, value: int) -> None:
    bench.document.open(bench.sources[value % len(bench.sources)])
    bench.settle()
    if bench.refusals and bench.refusals[-1].fixes:
        bench.refusals.clear()
        bench.document.try_again(("reorient",))


def run(bench: Bench, value: int) -> None:
    bench.document.run()
    for _ in range(value % 4):
        bench.worker.loop.advance()
    bench.document.pause()


def step(bench: Bench, value: int) -> None:
    bench.document.step()


def reset(bench: Bench, value: int) -> None:
    bench.document.reset()


DEEDS = (anchor, anchor, drag, weigh, group, switch_off, let_go, choose, choose, open_another, run, step, reset)
JUMP = "jump"


@pytest.fixture(autouse=True)
def collected_here(qapp: object) -> Iterator[None]:
    with garbage_of_this_thread():
        yield


@pytest.fixture(scope="module")
def sources(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, ...]:
    folder = tmp_path_factory.mktemp("meshes")
    kinds = (("flat", 0.0, 0, CELLS), ("dome", 3.0, 0, CELLS), ("flipped", 2.0, 3, CELLS), ("small", 3.0, 0, 2))
    return tuple(write_grid(folder / f"{name}.obj", *kind) for name, *kind in kinds)


@example([(open_another, 1), (JUMP, 0), (reset, 0), (anchor, 5), (open_another, 2)])
@settings(max_examples=12, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(st.tuples(st.sampled_from((*DEEDS, JUMP)), st.integers(0, 9)), min_size=4, max_size=12))
def test_every_state_comes_back_to_the_last_bit(qapp: object, sources: tuple[str, ...], deeds: list) -> None:
    bench = Bench(sources)
    for deed, value in deeds:
        if deed is JUMP:
            bench.go_to(value % (len(bench.undoing.history.names) + 1))
        else:
            bench.do(deed, value)
    count = len(bench.undoing.history.names)
    for done in (*range(bench.done, count + 1), *range(count - 1, -1, -1), *range(1, count + 1)):
        bench.go_to(done)
    bench.end()


@pytest.fixture
def bench(qapp: object, sources: tuple[str, ...]) -> Iterator[Bench]:
    bench = Bench(sources)
    yield bench
    bench.end()


def test_a_choice_that_is_refused_after_the_next_step_began_stops_no_undo(bench: Bench) -> None:
    document = bench.document
    bench.do(anchor, 1)
    before = bench.now
    document.choose(distortion="sum(sigma^2) +", distortion_parameters={})
    document.add_anchor(3)  # the engine has not answered yet
    bench.settle()
    after = bench.now
    assert document.session.distortion == "symmetric-dirichlet" and 3 in document.anchors
    bench.undoing.undo()
    bench.settle()
    assert bench.now == before
    bench.undoing.redo()
    bench.settle()
    assert bench.now == after and not bench.undoing.history.redo_name
    assert document.snapshot is not None and document.snapshot.anchor_serial == document.anchor_serial


def test_what_is_done_while_a_mesh_is_read_is_for_that_mesh_or_for_none(bench: Bench) -> None:
    document, loop = bench.document, bench.worker.loop
    bench.do(anchor, 3)
    document.open(bench.sources[3])
    document.add_anchor(20)  # which the other mesh does not have
    document.choose(distortion="mips")
    document.choose(initializer="harmonic")
    document.step()
    document.reset()
    document.run()
    bench.settle()
    assert not bench.refusals and document.session.source == bench.sources[3]
    assert not len(document.anchors) and loop._anchors is not None and not len(loop._anchors.vertices)
    assert document.session.distortion == "mips" == loop._choices.distortion
    assert document.session.initializer == "" == loop._reset.initializer
    assert document.wants_to_run and loop.is_active, "Space had asked for it"


def test_a_mesh_that_is_refused_leaves_the_anchors_that_were_set_meanwhile(bench: Bench) -> None:
    document, loop = bench.document, bench.worker.loop
    document.open(bench.sources[2])
    document.add_anchor(8)
    bench.settle()
    assert bench.refusals and document.session.source == bench.sources[0]
    assert tuple(document.anchors.targets) == (8,) and loop._anchors is not None and loop._anchors.vertices.tolist() == [8]
    assert document.snapshot is not None and document.snapshot.anchor_serial == document.anchor_serial


def test_a_state_that_the_engine_refuses_leaves_all_as_it_was(bench: Bench) -> None:
    document = bench.document
    bench.do(anchor, 3)
    before = bench.now
    document.restore(replace(document.complete_session, solver="no-such", anchor_weights=(2.0,)), document.positions)
    bench.settle()
    assert bench.now == before and bench.refusals
    assert document.snapshot is not None and document.snapshot.anchor_serial == document.anchor_serial


def test_a_session_that_the_engine_refuses_gives_its_name_to_nothing(bench: Bench, tmp_path: Path) -> None:
    desk = SessionDesk(bench.document)
    for source in bench.sources[:2]:  # the mesh that is open, and another one
        session = Session(source=source, linear_equations=("x[999] = 0.0",))
        positions = bench.document.positions if source == bench.sources[0] else None
        desk.open(Found(str(tmp_path / "mine.dwb"), SessionRecord(session, map=positions), ""))
        bench.settle()
        assert bench.refusals.pop().command == "TakeUp" and desk.path == ""
        assert bench.document.session.source == source and not bench.document.session.linear_equations
