"""A race in a process of its own: maps and rows arrive, time can be scrubbed, a killed process harms nothing."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable, Iterator

import numpy as np
import pytest

from workbench.core.measure import Measure
from workbench.core.mesh import Mesh
from workbench.engine.messages import Pause, Report, Reset, Run, SetAnchors, SetProblem, Step, Watch
from workbench.engine.race_loop import RaceLoop
from workbench.engine.race_messages import (
    LIVE,
    Entrant,
    RaceEnded,
    RaceFrame,
    RacePhase,
    RaceStarted,
    Seek,
    StartRace,
    StartWish,
    Switch,
)
from workbench.engine.race_worker import RaceWorker

NEWTON, AQP = Entrant("Newton", "projected-newton"), Entrant("AQP", "aqp")


def start_of(mesh: Mesh, *entrants: Entrant, serial: int = 1, start=None, reach: float = 0.3, **choices) -> StartRace:
    held = np.array([0, mesh.vertex_count - 1])
    targets = mesh.vertices[held, :2] + np.array([[0.0], [reach]])
    anchors = SetAnchors(held, targets, np.full(2, np.inf))
    start = mesh.vertices if start is None else start
    return StartRace(serial, mesh, "plane", start, entrants, SetProblem(**choices), anchors, Run(tolerance=1e-9))


class Window:
    """What a window keeps of the reports: the newest frame and all rows of each contestant."""

    def __init__(self) -> None:
        self.reports: list[Report] = []
        self.frames: dict[int, RaceFrame] = {}

    def __call__(self, report: Report) -> None:
        self.reports.append(report)
        if isinstance(report, RaceFrame):
            self.frames[report.index] = report.after(self.frames.get(report.index))

    def of(self, kind: type) -> list:
        return [report for report in self.reports if isinstance(report, kind)]


@pytest.fixture
def race(square: Mesh) -> tuple[RaceLoop, Window]:
    """Three on the start line, in this process."""
    window = Window()
    loop = RaceLoop(window)
    loop.handle(start_of(square, NEWTON, AQP, Entrant("given", map=square.vertices * 1.1)))
    return loop, window


def finish(loop: RaceLoop) -> None:
    loop.handle(Run())
    while loop.advance():
        pass


def test_all_rows_arrive_once_and_in_order(race: tuple[RaceLoop, Window]) -> None:
    loop, window = race
    finish(loop)
    assert window.of(RacePhase)[-1] == RacePhase(1, False, True)
    for index in range(2):
        rows = window.frames[index].rows
        assert [row.iteration for row in rows] == list(range(len(rows))) and len(rows) > 3
        assert window.frames[index].phase == "finished" and window.frames[index].status == "CONVERGED"
        assert len(window.frames[index].terms) == len(rows)
    assert window.frames[2].phase == "given" and len(window.frames[2].rows) == 1
    assert window.frames[0].terms[-1] == window.frames[1].terms[-1]


def test_scrubbing_shows_all_maps_of_one_moment(race: tuple[RaceLoop, Window], square: Mesh) -> None:
    loop, window = race
    finish(loop)
    ends = {index: frame.positions for index, frame in window.frames.items()}
    loop.handle(Seek("iteration", 2))
    assert [window.frames[index].iteration for index in (0, 1, 2)] == [2, 2, 0]
    assert not np.array_equal(window.frames[0].positions, ends[0])
    loop.handle(Seek("seconds", 0.0))
    np.testing.assert_array_equal(window.frames[1].positions, square.vertices)
    loop.handle(Seek("seconds", LIVE))
    assert all(np.array_equal(window.frames[index].positions, ends[index]) for index in ends)


def test_while_an_old_moment_is_shown_the_race_goes_on(race: tuple[RaceLoop, Window], square: Mesh) -> None:
    loop, window = race
    loop.handle(Seek("iteration", 0))
    finish(loop)
    assert len(window.frames[0].rows) > 3
    np.testing.assert_array_equal(window.frames[0].positions, square.vertices)


def test_steps_are_everyones(race: tuple[RaceLoop, Window]) -> None:
    loop, window = race
    loop.handle(Step(3))
    while loop.advance():
        pass
    assert [window.frames[index].iteration for index in (0, 1)] == [3, 3]
    assert window.of(RacePhase)[-1] == RacePhase(1, False, False)


def test_a_switch_is_marked_and_one_that_does_not_fit_is_refused(race: tuple[RaceLoop, Window]) -> None:
    loop, window = race
    finish(loop)
    loop.handle(Switch(1, "now mips", problem=SetProblem("mips")))
    assert window.frames[1].phase == "running"
    (marker,) = window.frames[1].markers
    assert marker.sentence == "now mips" and window.frames[1].rows[marker.index].iteration == marker.iteration
    assert window.frames[1].terms[-1] != window.frames[1].terms[0]
    loop.handle(Switch(0, "no", "local-global"))
    assert "arap" in window.reports[-1].sentence
    assert not window.frames[0].markers


def test_anchors_are_switched_and_a_fixed_boundary_stays(square: Mesh) -> None:
    window = Window()
    loop = RaceLoop(window)
    loop.handle(start_of(square, NEWTON, AQP, reach=0.0, fixed_boundary=True))
    inner = np.setdiff1d(np.arange(square.vertex_count), square.topology.boundary_vertices)[:1]
    target = square.vertices[inner, :2] + 0.01
    loop.handle(Switch(1, "pulled", anchors=SetAnchors(inner, target, np.full(1, np.inf))))
    finish(loop)
    rim = square.topology.boundary_vertices
    np.testing.assert_allclose(window.frames[1].positions[inner], target, atol=1e-9)
    np.testing.assert_allclose(window.frames[1].positions[rim], square.vertices[rim, :2], atol=1e-9)
    assert not np.allclose(window.frames[0].positions[inner], target, atol=1e-9)
    loop.handle(Switch(1, "nowhere", anchors=SetAnchors(np.array([10**6]), target, np.full(1, np.inf))))
    assert "vertex" in window.reports[-1].sentence and len(window.frames[1].markers) == 1


def test_one_that_cannot_start_harms_nobody(square: Mesh) -> None:
    window = Window()
    loop = RaceLoop(window)
    loop.handle(start_of(square, NEWTON, Entrant("wrong", "local-global")))
    finish(loop)
    assert window.frames[1].phase == "failed" and "arap" in window.frames[1].message
    assert window.frames[0].status == "CONVERGED"


def test_the_start_is_made_as_the_source_was_opened(square: Mesh) -> None:
    window = Window()
    loop = RaceLoop(window)
    wish = StartWish("", reset=Reset("rest"))
    loop.handle(start_of(square, NEWTON, start=wish))
    np.testing.assert_array_equal(window.of(RaceStarted)[0].start, square.vertices)


# ----------------------------------------------------------------------------------------- the process


class Owner:
    """A window's thread: takes what comes until something holds."""

    def __init__(self) -> None:
        self.window = Window()
        self.worker = RaceWorker(lambda: None)
        self.worker.start()

    def until(self, holds: Callable[[], bool], seconds: float = 200.0) -> None:
        end = time.monotonic() + seconds
        while not holds():
            assert time.monotonic() < end, "the race did not get there"
            for report in self.worker.take():
                self.window(report)
            time.sleep(0.005)


@pytest.fixture
def owner() -> Iterator[Owner]:
    made = Owner()
    yield made
    made.worker.close()


def test_maps_come_with_the_colours_that_are_watched(owner: Owner, square: Mesh) -> None:
    frames = owner.window.frames
    owner.worker.post(Watch((Measure("dirichlet"),)))
    owner.worker.post(start_of(square, NEWTON, AQP))
    owner.until(lambda: len(frames) == 2)
    owner.worker.post(Run())
    owner.until(lambda: all(frame.phase == "finished" for frame in frames.values()))
    for frame in frames.values():
        assert frame.positions.shape == square.vertices.shape
        assert frame.fields["dirichlet"].dtype == np.float32 and not frame.inverted.any()
    before = frames[0].fields["dirichlet"]
    owner.worker.post(Seek("iteration", 1))
    owner.until(lambda: frames[0].iteration == 1)
    assert not np.array_equal(frames[0].fields["dirichlet"], before)
    owner.worker.post(Watch((Measure("det"),)))
    owner.until(lambda: "det" in frames[0].fields)

    os.kill(owner.worker.process_id, signal.SIGKILL)
    owner.until(lambda: bool(owner.window.of(RaceEnded)))
    assert "killed" in owner.window.of(RaceEnded)[0].sentence
    owner.worker.post(start_of(square, AQP, serial=2))
    owner.until(lambda: frames[0].serial == 2)
    owner.worker.post(Step(1))
    owner.until(lambda: frames[0].iteration == 1)


def test_a_pause_comes_within_a_step_and_a_stop_in_any_case(owner: Owner, square: Mesh) -> None:
    owner.worker.post(start_of(square, Entrant("descent", "gradient-descent")))
    owner.until(lambda: 0 in owner.window.frames)
    owner.worker.post(Run())
    owner.until(lambda: owner.window.frames[0].iteration > 2)
    owner.worker.post(Pause())
    owner.until(lambda: not owner.window.of(RacePhase)[-1].is_running)
    owner.worker.stop()
    owner.until(lambda: bool(owner.window.of(RaceEnded)))
