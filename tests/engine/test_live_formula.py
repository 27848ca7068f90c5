"""Another distortion while the solver runs: the map goes on from where it is, or the old one stays in force."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.conftest import grid
from workbench.core.method import Parameter
from workbench.core.named_formulas import NamedFormula
from workbench.core.status import Status
from workbench.engine.loop import EngineLoop
from workbench.engine.messages import Failure, Load, Refused, Report, Run, SetProblem
from workbench.io.formula_store import save_formula

BLEND = "lam*symmetric_dirichlet + (1 - lam)*condition_number"


class Trial:
    """A loop in this process on a square whose start is stretched to four times its width."""

    def __init__(self, folder: Path) -> None:
        self.reports: list[Report] = []
        self.loop = EngineLoop(self.reports.append)
        mesh = grid(8)
        bent = mesh.vertices * [4.0, 1.0] + np.column_stack([np.zeros(mesh.vertex_count), 0.2 * mesh.vertices[:, 0] ** 2])
        np.savez(folder / "case.npz", V=mesh.vertices, S=mesh.simplices, X0=bent)
        self.loop.handle(Load(str(folder / "case.npz"), generation=1))
        self.loop.handle(Run(1000, 0.0))

    def take_steps(self, count: int) -> None:
        for _ in range(count):
            assert self.loop.advance()

    @property
    def state(self):
        return self.loop._state

    @property
    def problem(self):
        return self.loop._problem

    def refusal(self) -> Refused | None:
        return next((r for r in reversed(self.reports) if isinstance(r, Refused)), None)


@pytest.fixture
def trial(tmp_path: Path) -> Trial:
    return Trial(tmp_path)


@pytest.mark.parametrize(
    "command",
    [
        SetProblem(BLEND, {"lam": 0.5}),
        SetProblem("mips"),
        SetProblem("sum(sigma^4 + 1/sigma^4)"),
        SetProblem("symmetric-dirichlet", {}, fixed_boundary=True),
    ],
    ids=str,
)
def test_the_map_goes_on_from_where_it_is(trial: Trial, command: SetProblem) -> None:
    trial.take_steps(2)
    positions, iteration = trial.state.positions, trial.state.iteration
    system, analysis = trial.problem.system, trial.problem.system.solver
    trial.loop.handle(command)
    assert trial.refusal() is None
    np.testing.assert_array_equal(trial.state.positions, positions)
    assert trial.state.energy == pytest.approx(trial.problem.energy(positions))
    trial.take_steps(1)
    assert trial.state.iteration == iteration + 1
    assert trial.problem.system is system and system.solver is analysis, "the symbolic analysis is kept"
    assert trial.state.inverted == 0


def test_many_values_in_a_row_end_where_the_last_one_alone_would(trial: Trial, tmp_path: Path) -> None:
    for number in range(30):
        trial.loop.handle(SetProblem(BLEND, {"lam": 0.3 + 0.02 * number}))
        trial.take_steps(1)
    while trial.loop.advance():
        pass
    alone = Trial(tmp_path)
    alone.loop.handle(SetProblem(BLEND, {"lam": 0.3 + 0.02 * 29}))
    while alone.loop.advance():
        pass
    assert trial.state.energy == pytest.approx(alone.state.energy, rel=1e-6)


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("log(3 - sigma1) + 9", "finite number on 128 triangles"),
        ("1/(3 - max(sigma1, 3)) + sigma1", "dimension"),
        ("sum(sigma^2) + quux", "quux"),
        ("sum(sigma^2", "formula"),
        ("no-such-thing", "no-such-thing"),
    ],
)
def test_what_does_not_suit_the_map_is_refused_and_the_old_one_stays(trial: Trial, text: str, word: str) -> None:
    trial.take_steps(1)
    kept = trial.loop._choices
    problem, state = trial.problem, trial.state
    trial.loop._state = state = type(state)(grid(8).vertices * [4.0, 1.0])  # every triangle has sigma1 = 4
    trial.loop.handle(SetProblem(text, {}, serial=17))
    refusal = trial.refusal()
    assert refusal is not None and refusal.kept == kept and refusal.serial == 17
    if word != "dimension":
        assert word in refusal.sentence
    assert trial.problem is problem and trial.state is state
    assert not any(isinstance(report, Failure) for report in trial.reports)


def test_an_exponential_too_large_for_a_number_is_not_refused(trial: Trial) -> None:
    trial.loop._state = type(trial.state)(grid(8).vertices * [4e3, 1e-3])
    trial.loop.handle(SetProblem("amips", {"alpha": 100.0}))
    assert trial.refusal() is None
    trial.take_steps(1)
    assert trial.state.status is Status.RUNNING


def test_a_named_formula_that_was_changed_is_taken_up(trial: Trial, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    lam = Parameter("lam", float, 0.5, "", 0.0, 1.0)
    save_formula(NamedFormula("own", BLEND, (lam,)))
    trial.loop.handle(SetProblem("own"))
    first = trial.state.energy
    save_formula(NamedFormula("own", f"2*({BLEND})", (lam,)), replaces=True)
    trial.loop.handle(SetProblem("own"))
    assert trial.refusal() is None
    assert trial.state.energy == pytest.approx(2 * first)
