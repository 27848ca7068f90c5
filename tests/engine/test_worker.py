"""The engine process and its owner: drags, crashes, endless and raising plugins, stale commands."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from tests.conftest import grid
from workbench.core.jacobians import build_elements, determinants
from workbench.core.measure import Measure
from workbench.core.registry import user_plugin_folder
from workbench.core.status import Status
from workbench.engine.command_box import CommandBox
from workbench.engine.corrector import SMALLEST
from workbench.engine.messages import (
    Failure,
    Load,
    Loaded,
    Pause,
    Ready,
    Refused,
    Report,
    Reset,
    Restarted,
    Run,
    SetAnchors,
    SetProblem,
    SetSolver,
    Snapshot,
    Step,
    Watch,
)
from workbench.engine.worker import CRASHES_IN_A_ROW, EngineWorker

PATIENCE = 200.0

LOOPS = '''
from dataclasses import dataclass
from workbench.api import Solver, State, Problem, never

@dataclass(frozen=True)
class Endless(Solver):
    """Never comes back."""
    id = "endless"
    label = "Endless"

    def step(self, problem, state, interrupt=never):
        while True:
            pass
'''

RAISES = '''
from dataclasses import dataclass
from workbench.api import Solver, never

@dataclass(frozen=True)
class Raising(Solver):
    """Raises."""
    id = "raising"
    label = "Raising"

    def step(self, problem, state, interrupt=never):
        raise RuntimeError("Factor is exactly singular")
'''

INVERTS = '''
from dataclasses import dataclass, replace
from workbench.api import Solver, never

@dataclass(frozen=True)
class Inverting(Solver):
    """Breaks the law."""
    id = "inverting"
    label = "Inverting"

    def step(self, problem, state, interrupt=never):
        return replace(state, positions=-state.positions[:, ::-1], iteration=state.iteration + 1)
'''


class Desk:
    """An engine with everything that it has told so far."""

    def __init__(self) -> None:
        self.news = threading.Condition()
        self.reports: list[Report] = []
        self.snapshots: list[Snapshot] = []
        self.worker = EngineWorker(self.wake, on_snapshot=self.see)
        self.worker.start()

    def wake(self) -> None:
        with self.news:
            self.reports += [r for r in self.worker.take() if not isinstance(r, Snapshot)]
            self.news.notify_all()

    def see(self, snapshot: Snapshot) -> None:
        with self.news:
            self.snapshots.append(snapshot)
            self.news.notify_all()

    def until(self, holds: Callable[[], bool]) -> None:
        with self.news:
            assert self.news.wait_for(holds, PATIENCE), (self.reports[-3:], self.snapshots[-1:])

    def told(self, kind: type[Report]) -> list[Report]:
        return [r for r in self.reports if isinstance(r, kind)]

    def open(self, source: str, generation: int = 1) -> Snapshot:
        for command in (Load(source, generation), SetProblem(), SetSolver(), Reset()):
            self.worker.post(command)
        self.until(lambda: bool(self.snapshots) and self.snapshots[-1].generation == generation)
        return self.snapshots[-1]

    def anchor(self, vertices: list[int], targets: np.ndarray, serial: int, dragging: bool = False) -> None:
        weights = np.full(len(vertices), np.inf)
        self.worker.post(SetAnchors(np.array(vertices), np.asarray(targets), weights, serial, dragging))


@pytest.fixture
def desk() -> Iterator[Desk]:
    desk = Desk()
    yield desk
    desk.worker.close()
    assert desk.worker.process_id is None


def write_case(folder: Path, cells: int) -> str:
    mesh = grid(cells)
    path = folder / f"square_{cells}.npz"
    np.savez(path, V=mesh.vertices, S=mesh.simplices)
    return str(path)


@pytest.fixture
def case(tmp_path: Path) -> str:
    return write_case(tmp_path, 12)


@pytest.fixture
def large_case(tmp_path: Path) -> str:
    """Large enough that the corrector's process takes part in a drag."""
    cells = int((SMALLEST / 2) ** 0.5) + 2
    return write_case(tmp_path, cells)


@pytest.fixture
def own_plugins() -> Iterator[Path]:
    folder = user_plugin_folder() / "solvers"
    folder.mkdir(parents=True, exist_ok=True)
    yield folder
    for file in folder.glob("*.py"):
        file.unlink()


@pytest.mark.parametrize("size", ["case", "large_case"])
def test_a_drag_keeps_every_map_free_of_inversions_and_arrives(desk: Desk, size: str, request: pytest.FixtureRequest) -> None:
    first = desk.open(request.getfixturevalue(size))
    corner = first.positions.shape[0] - 1
    desk.worker.post(Run())
    elements = build_elements(desk.told(Loaded)[0].mesh)  # type: ignore[attr-defined]
    target = first.positions[[0, corner]].copy()
    for event in range(1, 60):
        t = event / 20
        target = target.copy()
        target[1] = first.positions[corner] + [0.6 * np.sin(3 * t), 0.5 * np.sin(5 * t)]
        desk.anchor([0, corner], target, event, dragging=True)
        time.sleep(1 / 60)
    desk.anchor([0, corner], target, 100)
    desk.until(lambda: desk.snapshots[-1].anchor_serial == 100 and desk.snapshots[-1].phase == "finished")
    last = desk.snapshots[-1]
    assert last.status is Status.CONVERGED
    assert np.abs(last.positions[[0, corner]] - target).max() <= 1e-9 * 2**0.5
    for snapshot in desk.snapshots:
        assert (determinants(elements, snapshot.positions) > 0).all()
        assert not snapshot.inverted.any()
    assert len({s.number for s in desk.snapshots}) == len(desk.snapshots)
    rows = [r for s in desk.snapshots for r in s.rows]
    assert [r.iteration for r in rows] == sorted(r.iteration for r in rows)


def test_a_killed_engine_goes_on_from_the_last_good_map(desk: Desk, case: str) -> None:
    first = desk.open(case)
    desk.worker.post(Run())
    target = first.positions[[0, 5]] + [[0.0, 0.0], [0.1, -0.2]]
    desk.anchor([0, 5], target, 1, dragging=True)
    desk.until(lambda: desk.snapshots[-1].anchor_serial == 1 and desk.snapshots[-1].row.anchor_error == 0.0)
    before = desk.snapshots[-1]
    os.kill(desk.worker.process_id, signal.SIGKILL)  # type: ignore[arg-type]
    desk.until(lambda: bool(desk.told(Restarted)))
    assert "last good map" in desk.told(Restarted)[0].sentence  # type: ignore[attr-defined]
    target = target + [[0.0, 0.0], [0.1, 0.0]]
    desk.anchor([0, 5], target, 2, dragging=True)
    desk.anchor([0, 5], target, 3)
    desk.until(lambda: desk.snapshots[-1].anchor_serial == 3 and desk.snapshots[-1].phase == "finished")
    after = desk.snapshots[-1]
    assert after.number > before.number
    assert after.row.iteration > before.row.iteration
    assert np.abs(after.positions[[0, 5]] - target).max() <= 1e-9


def test_a_drag_goes_on_without_the_corrector(desk: Desk, large_case: str) -> None:
    first = desk.open(large_case)
    desk.worker.post(Run())
    corner = first.positions.shape[0] - 1
    target = first.positions[[0, corner]].copy()
    for event in range(1, 40):
        target = target + [[0.0, 0.0], [-0.01, 0.005]]
        desk.anchor([0, corner], target, event, dragging=True)
        if event == 10:
            os.kill(desk.worker._corrector.pid, signal.SIGKILL)
        time.sleep(1 / 60)
    desk.anchor([0, corner], target, 100)
    desk.until(lambda: desk.snapshots[-1].anchor_serial == 100 and desk.snapshots[-1].phase == "finished")
    assert not desk.told(Restarted)
    assert np.abs(desk.snapshots[-1].positions[[0, corner]] - target).max() <= 1e-9


def test_a_group_of_anchors_follows_the_hand(desk: Desk, large_case: str) -> None:
    first = desk.open(large_case)
    mesh = desk.told(Loaded)[0].mesh  # type: ignore[attr-defined]
    right = np.flatnonzero(mesh.vertices[:, 0] == 1.0)
    left = np.flatnonzero(mesh.vertices[:, 0] == 0.0)
    held = [*left.tolist(), *right.tolist()]
    target = first.positions[held].copy()
    desk.worker.post(Run())

    def least_way() -> float:
        return float(np.linalg.norm(desk.snapshots[-1].positions[right] - first.positions[right], axis=1).min())

    event, until = 0, time.monotonic() + PATIENCE
    while event < 19 or not least_way() > 0.0:  # it moves while the hand does, not only after
        assert time.monotonic() < until
        event += 1
        target = target.copy()
        target[len(left) :] += [0.01, 0.01] if event < 20 else [1e-4, 1e-4]
        desk.anchor(held, target, event, dragging=True)
        time.sleep(1 / 30)
    desk.anchor(held, target, event + 1)
    desk.until(lambda: desk.snapshots[-1].anchor_serial == event + 1 and desk.snapshots[-1].phase == "finished")
    assert np.abs(desk.snapshots[-1].positions[held] - target).max() <= 1e-9


def test_stop_ends_a_plugin_that_loops_for_ever(desk: Desk, case: str, own_plugins: Path) -> None:
    (own_plugins / "endless.py").write_text(LOOPS)
    desk.open(case)
    old = desk.worker.process_id
    desk.worker.post(SetSolver("endless"))
    desk.worker.post(Run())
    time.sleep(0.3)
    begin = time.perf_counter()
    desk.worker.stop()
    desk.until(lambda: bool(desk.told(Restarted)))
    assert time.perf_counter() - begin < PATIENCE  # a bound, not a measurement
    assert desk.worker.process_id != old
    desk.worker.post(SetSolver())
    desk.worker.post(Run())
    desk.until(lambda: desk.snapshots[-1].phase == "finished")


@pytest.mark.parametrize(("text", "id"), [(RAISES, "raising"), (INVERTS, "inverting")])
def test_a_plugin_that_misbehaves_is_reported_and_the_map_is_kept(
    desk: Desk, case: str, own_plugins: Path, text: str, id: str
) -> None:
    (own_plugins / f"{id}.py").write_text(text)
    first = desk.open(case)
    desk.worker.post(SetSolver(id))
    desk.worker.post(Run())
    desk.until(lambda: bool(desk.told(Failure)))
    failure = desk.told(Failure)[0]
    if id == "raising":
        assert "Factor is exactly singular" in failure.sentence  # type: ignore[attr-defined]
        assert "Traceback" in failure.traceback  # type: ignore[attr-defined]
    assert np.array_equal(desk.snapshots[-1].positions, first.positions)
    desk.worker.post(SetSolver())
    desk.worker.post(Run())
    desk.until(lambda: desk.snapshots[-1].phase == "finished")


def test_refusals_are_sentences_and_nothing_is_lost(desk: Desk, case: str, tmp_path: Path) -> None:
    first = desk.open(case)
    (tmp_path / "empty.obj").write_text("")
    for command in (
        Load(str(tmp_path / "empty.obj"), 2),
        SetProblem("import os"),
        SetSolver("no-such-solver"),
        Reset("no-such-start"),
    ):
        count = len(desk.told(Refused))
        desk.worker.post(command)
        desk.until(lambda count=count: len(desk.told(Refused)) > count)  # type: ignore[misc]
        refusal = desk.told(Refused)[-1]
        assert refusal.command == type(command).__name__  # type: ignore[attr-defined]
        assert refusal.sentence.endswith((".", "?"))  # type: ignore[attr-defined]
    desk.anchor([10**6], np.zeros((1, 2)), 1)
    desk.until(lambda: desk.told(Refused)[-1].command == "SetAnchors")  # type: ignore[attr-defined]
    desk.worker.post(Run())
    desk.until(lambda: desk.snapshots[-1].phase == "finished")
    assert desk.snapshots[-1].generation == first.generation == 1


def test_everything_can_be_changed_while_it_runs(desk: Desk, case: str) -> None:
    first = desk.open(case)
    desk.anchor([0, 12], first.positions[[0, 12]] * 1.4, 1)
    desk.worker.post(SetSolver("gradient-descent"))
    desk.worker.post(SetProblem("arap"))
    desk.worker.post(Run(iterations=100_000, tolerance=0.0))
    desk.until(lambda: desk.snapshots[-1].row.iteration > 5)
    desk.worker.post(SetProblem("sum(sigma^4 + 1/sigma^4)"))
    desk.until(lambda: desk.snapshots[-1].distortion == "sum(sigma^4 + 1/sigma^4)")
    desk.worker.post(SetSolver())
    desk.worker.post(SetProblem(fixed_boundary=True))
    desk.until(lambda: desk.snapshots[-1].solver == "projected-newton")
    desk.until(lambda: desk.snapshots[-1].distortion == "symmetric-dirichlet")
    desk.worker.post(Pause())
    desk.until(lambda: desk.snapshots[-1].phase == "idle")
    paused = desk.snapshots[-1].row.iteration
    desk.worker.post(Step(2))
    desk.until(lambda: desk.snapshots[-1].phase in ("idle", "finished") and desk.snapshots[-1].row.iteration > paused)
    desk.worker.post(Reset())
    desk.until(lambda: desk.snapshots[-1].row.iteration == 0)


def test_a_new_mesh_carries_its_generation(desk: Desk, case: str) -> None:
    desk.open(case, 1)
    desk.worker.post(Load("sample:bar", 2))
    desk.until(lambda: desk.snapshots[-1].generation == 2)
    assert desk.told(Loaded)[-1].generation == 2  # type: ignore[attr-defined]
    assert desk.told(Ready)


def test_the_newest_of_a_kind_wins_and_steps_add_up() -> None:
    box = CommandBox()
    for command in (Step(1), SetSolver("a"), Step(2), SetSolver("b"), Pause()):
        box.put(command)
    assert box.take_all() == [Step(3), SetSolver("b"), Pause()]
    assert not box
    box.put(SetAnchors(np.array([0]), np.zeros((1, 2)), np.ones(1)))
    assert not box.interrupts
    box.put(Pause())
    assert box.interrupts


def test_stop_ends_a_hang_however_many_commands_wait(desk: Desk, case: str, own_plugins: Path) -> None:
    (own_plugins / "endless.py").write_text(LOOPS)
    first = desk.open(case)
    desk.worker.post(SetSolver("endless"))
    desk.worker.post(Run())
    time.sleep(0.3)
    for serial in range(1, 1500):  # more than a pipe holds
        desk.anchor([0], first.positions[[0]] + 1e-3 * serial, serial, dragging=True)
        time.sleep(0.001)
    desk.worker.stop()
    desk.until(lambda: bool(desk.told(Restarted)))


DIES = '''
import os
from dataclasses import dataclass
from workbench.api import Solver, never

@dataclass(frozen=True)
class Dying(Solver):
    """Takes the process with it."""
    id = "dying"
    label = "Dying"

    def step(self, problem, state, interrupt=never):
        os._exit(3)
'''


def test_a_solver_that_always_kills_the_process_is_given_up(desk: Desk, case: str, own_plugins: Path) -> None:
    (own_plugins / "dying.py").write_text(DIES)
    first = desk.open(case)
    desk.worker.post(SetSolver("dying"))
    desk.worker.post(Run())
    desk.until(lambda: len(desk.told(Restarted)) == CRASHES_IN_A_ROW + 1)
    desk.until(lambda: desk.snapshots[-1].solver == "projected-newton" and desk.snapshots[-1].phase == "idle")
    assert np.array_equal(desk.snapshots[-1].positions, first.positions)


def test_the_start_of_another_mesh_is_not_taken_over(desk: Desk, case: str, tmp_path: Path) -> None:
    desk.open("sample:bumpy-disc")
    desk.worker.post(Reset("lscm"))
    desk.until(lambda: desk.snapshots[-1].number > 1)
    desk.open(case, 2)
    assert not desk.told(Refused)


def test_a_watch_is_answered_at_rest_and_outlives_the_process(desk: Desk, case: str) -> None:
    first = desk.open(case)
    assert not first.fields and first.singular_values is None
    desk.worker.post(Watch((Measure("det"), Measure("sigma1 - sigma7")), singular_values=True))
    desk.until(lambda: "det" in desk.snapshots[-1].fields)
    answer = desk.snapshots[-1]
    assert np.array_equal(answer.positions, first.positions) and not answer.rows, "nothing was stepped"
    assert answer.singular_values.shape == (len(answer.inverted), 2)
    (refused,) = desk.told(Refused)
    assert refused.command == "Watch" and "sigma7" in refused.sentence
    process = desk.worker.process_id
    assert process is not None
    os.kill(process, signal.SIGKILL)
    desk.until(lambda: bool(desk.told(Restarted)))
    desk.worker.post(Step(1))
    desk.until(lambda: desk.snapshots[-1].number > first.number)
    assert "det" in desk.snapshots[-1].fields
    desk.worker.post(Watch())
    desk.until(lambda: not desk.snapshots[-1].fields)
