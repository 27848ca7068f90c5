"""What a solver did on its own is repeated to the last digit, whatever was switched on the way."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from workbench.core.errors import WorkbenchError
from workbench.core.registry import registry
from workbench.engine.loop import EngineLoop
from workbench.engine.messages import (
    LegBegun,
    Load,
    Loaded,
    MapReport,
    Refused,
    Report,
    Reset,
    Run,
    SetAnchors,
    SetProblem,
    SetSolver,
    Step,
    TakeUp,
)
from workbench.engine.replay import replay
from workbench.engine.session_commands import leg_of, take_up
from workbench.engine.session_file import read_session, write_session
from workbench.io.opening import open_source
from workbench.session.journal import Journal
from workbench.session.record import SessionRecord
from workbench.session.session import Session


class Desk:
    """An engine in this process, and the journal that a window would keep of it."""

    def __init__(self, source: str) -> None:
        self.journal = Journal()
        self.reports: list[Report] = []
        self.last: MapReport | None = None
        self.source = source
        self.loop = EngineLoop(self._take)
        self.loop.handle(Load(source, 1))
        self.mesh = next(report.mesh for report in self.reports if isinstance(report, Loaded))

    def _take(self, report: Report) -> None:
        self.reports.append(report)
        if isinstance(report, LegBegun):
            self.journal.add(leg_of(report))
        elif isinstance(report, MapReport):
            self.last = report

    def steps(self, count: int) -> None:
        self.loop.handle(Step(count))
        while self.loop.advance():
            pass

    def run(self) -> None:
        self.loop.handle(Run())
        while self.loop.advance():
            pass

    def hold(self, *moves: tuple[float, ...]) -> None:
        """Anchors at the first and last vertices, the last one moved from where it is."""
        assert self.last is not None
        vertices = np.array([0, self.mesh.vertex_count - 1])
        targets = self.last.positions[vertices].copy()
        for move in moves:
            targets[-1] += move
        self.loop.handle(SetAnchors(vertices, targets, np.full(2, np.inf)))

    def record(self, session: Session) -> SessionRecord:
        last = self.last
        assert last is not None
        legs = self.journal.way_to(last.leg, last.rows[-1].iteration)
        return SessionRecord(replace(session, source=self.source), "", last.positions, legs, last.rows[-1].energy)


def switched(desk: Desk) -> Session:
    """Anchors, a formula with a parameter, and another solver, one after the other while the map is on its way."""
    move = (0.2, 0.1, 0.05)[: desk.mesh.dimension]
    desk.steps(2)
    desk.hold(move)
    desk.steps(4)
    formula = "lam*symmetric_dirichlet + (1 - lam)*mips"
    desk.loop.handle(SetProblem(formula, {"lam": 0.3}))
    desk.steps(3)
    desk.loop.handle(SetSolver("l-bfgs"))
    desk.steps(5)
    desk.loop.handle(SetSolver("projected-newton"))
    desk.run()
    fields = vars(desk.journal.way_to(desk.last.leg, desk.last.rows[-1].iteration)[-1].choices)
    return Session(**fields)


@pytest.mark.parametrize("source", ["sample:bar", "sample:bumpy-disc", "sample:bar-3d"])
def test_anchors_a_formula_and_other_solvers_are_repeated(source: str, tmp_path: Path) -> None:
    desk = Desk(source)
    record = desk.record(switched(desk))
    assert len(record.legs) >= 5 and sum(leg.iterations for leg in record.legs) == desk.last.rows[-1].iteration
    write_session(tmp_path / "session.dwb", record)
    found = replay(read_session(tmp_path / "session.dwb"), open_source(source))
    assert found.result.state.energy == pytest.approx(record.energy, rel=1e-10)
    assert found.result.state.iteration == desk.last.rows[-1].iteration
    assert found.farthest <= 1e-9 * desk.mesh.diameter


def test_a_leg_is_not_repeated_under_another_formula() -> None:
    """The check above can fail."""
    desk = Desk("sample:bar")
    record = desk.record(switched(desk))
    legs = (
        *record.legs[:-1],
        replace(record.legs[-1], choices=replace(record.legs[-1].choices, distortion="arap", distortion_parameters={})),
    )
    found = replay(replace(record, legs=legs), open_source("sample:bar"))
    assert found.result.state.energy != pytest.approx(record.energy, rel=1e-10)
    assert found.farthest > 1e-6 * desk.mesh.diameter


def test_a_map_that_was_put_there_begins_the_story_anew() -> None:
    desk = Desk("sample:bar")
    desk.steps(2)
    session = Session(solver="projected-newton", fixed_boundary=True)
    turned = desk.last.positions * [1.2, 0.8]
    desk.loop.handle(take_up(session, turned, 1))
    assert desk.last.leg == 0 and not desk.record(session).legs
    np.testing.assert_array_equal(desk.last.positions, turned)
    desk.run()
    record = desk.record(session)
    assert record.legs[0].origin == "map"
    np.testing.assert_array_equal(record.legs[0].positions, turned)
    assert replay(record, open_source("sample:bar")).result.state.energy == pytest.approx(record.energy, rel=1e-10)
    boundary = desk.mesh.topology.boundary_vertices
    np.testing.assert_array_equal(desk.last.positions[boundary], turned[boundary])


def test_a_start_made_anew_is_made_again_where_no_map_of_it_is_kept() -> None:
    desk = Desk("sample:bumpy-disc")
    desk.loop.handle(Reset("lscm"))
    desk.steps(3)
    session = Session(solver="projected-newton", initializer="lscm")
    record = desk.record(session)
    assert record.legs[0].origin == "start"
    legs = (replace(record.legs[0], positions=None, choices=replace(record.legs[0].choices, initializer="lscm")),)
    found = replay(replace(record, legs=legs), open_source("sample:bumpy-disc"))
    assert found.result.state.energy == pytest.approx(record.energy, rel=1e-10)


def wrong_solver(good: TakeUp) -> TakeUp:
    return replace(good, solver=SetSolver("no-such-solver"))


def wrong_formula(good: TakeUp) -> TakeUp:
    return replace(good, problem=SetProblem("__import__('os')"))


def wrong_anchors(good: TakeUp) -> TakeUp:
    return replace(good, anchors=SetAnchors(np.array([10**6]), np.zeros((1, 2)), np.full(1, np.inf)))


@pytest.mark.parametrize("spoil", [wrong_solver, wrong_formula, wrong_anchors])
def test_what_is_refused_in_part_is_refused_as_a_whole(spoil: Callable[[TakeUp], TakeUp]) -> None:
    desk = Desk("sample:bar")
    before = desk.last
    desk.loop.handle(spoil(take_up(Session(distortion="mips"), before.positions * 2.0, 1)))
    assert desk.last is before
    assert type(desk.reports[-1]).__name__ == "Refused"
    desk.steps(1)
    assert desk.last.distortion == "symmetric-dirichlet"


def test_maps_of_another_mesh_are_refused() -> None:
    record = SessionRecord(Session(source="sample:bar"), map=np.zeros((7, 2)))
    with pytest.raises(WorkbenchError, match="another mesh"):
        replay(record, open_source("sample:bar"))


@pytest.mark.parametrize("solver", sorted(registry().solvers))
def test_every_solver_is_repeated_while_it_follows_anchors_and_another_distortion(solver: str) -> None:
    desk = Desk("sample:gingerbread")
    desk.loop.handle(SetSolver(solver))
    if isinstance(desk.reports[-1], Refused):
        desk.loop.handle(SetProblem("arap"))
        desk.loop.handle(SetSolver(solver))
    desk.steps(1)
    desk.hold((0.2, 0.1))
    desk.steps(5)
    changed = "arap" if desk.last.distortion == "arap" else "symmetric_dirichlet + 0.1*mips"
    desk.loop.handle(SetProblem(changed))
    desk.steps(5)
    last = desk.journal.way_to(desk.last.leg, desk.last.rows[-1].iteration)[-1]
    assert last.choices.solver == solver
    record = desk.record(last.choices)
    found = replay(record, open_source("sample:gingerbread"))
    assert found.result.state.energy == pytest.approx(record.energy, rel=1e-10)
    assert found.result.state.iteration == desk.last.rows[-1].iteration > 1
