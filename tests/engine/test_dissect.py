"""The engine takes steps apart, and maps from elsewhere up, without losing its run."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

from workbench.engine.loop import EngineLoop, MapReport
from workbench.engine.messages import Dissect, Dissected, Load, Refused, Report, SetSolver, Step, TakeMap


class Reports(list[Report]):
    """What a loop tells."""

    def of(self, kind: type) -> list:
        return [report for report in self if isinstance(report, kind)]


@pytest.fixture
def engine() -> tuple[EngineLoop, Reports]:
    """A sample on the loop, in this process."""
    reports = Reports()
    loop = EngineLoop(reports.append)
    loop.handle(Load("sample:bar", 1))
    return loop, reports


def take_steps(loop: EngineLoop, count: int) -> None:
    loop.handle(Step(count))
    while loop.advance():
        pass


@pytest.mark.parametrize("solver", ["projected-newton", "l-bfgs"])
def test_the_step_that_was_taken_apart_is_the_one_that_follows(engine: tuple[EngineLoop, Reports], solver: str) -> None:
    loop, reports = engine
    loop.handle(SetSolver(solver))
    start = reports.of(MapReport)[-1].positions
    loop.handle(TakeMap(1, start * [1.4, 0.9]))
    take_steps(loop, 2)
    before = reports.of(MapReport)[-1]
    loop.handle(Dissect())
    (report,) = reports.of(Dissected)
    np.testing.assert_array_equal(report.step.before.positions, before.positions)
    take_steps(loop, 1)
    np.testing.assert_allclose(reports.of(MapReport)[-1].positions, report.step.after.positions, atol=1e-10)
    assert pickle.loads(pickle.dumps(report)).step.slope == report.step.slope  # it crosses a process boundary


def test_a_map_from_elsewhere_is_taken_up_if_it_is_of_this_mesh(engine: tuple[EngineLoop, Reports]) -> None:
    loop, reports = engine
    start = reports.of(MapReport)[-1].positions
    loop.handle(TakeMap(1, start * 1.5))
    last = reports.of(MapReport)[-1]
    np.testing.assert_array_equal(last.positions, start * 1.5)
    assert last.rows[-1].iteration == 0 and last.phase == "idle"
    loop.handle(TakeMap(7, start * 3.0))
    assert reports.of(MapReport)[-1] is last


def test_without_a_map_there_is_nothing_to_take_apart() -> None:
    reports = Reports()
    EngineLoop(reports.append).handle(Dissect())
    assert "open a mesh" in reports.of(Refused)[0].sentence
