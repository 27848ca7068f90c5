"""`check-solver`: registered solvers and files; a solver that hangs, crashes or does not load takes nothing with it."""

from __future__ import annotations

import pytest

from workbench.core.solver_laws import LAWS

HEAD = """
import os, time
from dataclasses import dataclass, replace
from workbench.api import Solver, never

@dataclass(frozen=True)
class Odd(Solver):
    id = "odd"
    label = "Odd"
    nap: float = 0.0

    def step(self, problem, state, interrupt=never):
"""


def solver_file(tmp_path, *lines):
    path = tmp_path / "odd.py"
    path.write_text(HEAD + "".join(f"        {line}\n" for line in lines))
    return path


def test_a_registered_solver_keeps_all(cli):
    result = cli("check-solver", "projected-newton", "--set", "reach=1")
    assert result.status == 0 and result.err == ""
    assert f"{len(LAWS)} of {len(LAWS)} laws hold" in result.out
    assert all(name in result.out for name in LAWS)


def test_one_that_hangs_and_one_that_crashes_are_told_with_their_mesh(cli, tmp_path, monkeypatch):
    monkeypatch.setattr("workbench.engine.law_trial.LAWS", {id: LAWS[id] for id in ("inputs-unchanged", "interrupt")})
    path = solver_file(
        tmp_path,
        "print('noise')",
        "if not interrupt():",  # the law of interrupts is kept up to the first question
        "    time.sleep(60)",
        "if problem.anchors.vertices.size:",
        "    os._exit(3)",
        "return replace(state, positions=state.positions * 1.01)",
    )
    result = cli("check-solver", path, "--time-limit", 1, "--json")
    assert result.status == 1
    (report,) = result.json
    assert report["solver"] == "odd" and report["keeps_all"] is False
    found = {law["law"]: law for law in report["laws"]}
    assert list(found) == ["inputs-unchanged", "interrupt"]
    assert "not done after 1 s" in found["inputs-unchanged"]["sentence"]
    assert "bar" in found["inputs-unchanged"]["case"] and found["inputs-unchanged"]["words"]
    assert not any(law["holds"] for law in found.values())


def test_one_that_ends_its_process_is_told(cli, tmp_path, monkeypatch):
    monkeypatch.setattr("workbench.engine.law_trial.LAWS", {"deterministic": LAWS["deterministic"]})
    result = cli("check-solver", solver_file(tmp_path, "os._exit(3)"))
    assert result.status == 1
    assert "BROKEN  deterministic" in result.out and "it ended its process" in result.out


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        (["raise RuntimeError('nowhere')"], "it raised RuntimeError: nowhere"),
        ([")"], "cannot be used: SyntaxError"),
    ],
)
def test_files_that_raise(lines, words, cli, tmp_path, monkeypatch):
    monkeypatch.setattr("workbench.engine.law_trial.LAWS", {"interrupt": LAWS["interrupt"]})
    result = cli("check-solver", solver_file(tmp_path, *lines))
    assert result.status in (1, 2) and words in result.out + result.err
    assert "Traceback" not in result.err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["magic"], "no solver and no file 'magic'"),
        (["slim", "--set", "speed=3"], "has no parameter 'speed'"),
        (["empty.py"], "defines no Distortion, Initializer or Solver"),
        (["line.py"], "defines no solver"),
    ],
)
def test_refused_with_one_sentence(arguments, words, cli, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "empty.py").write_text("x = 1\n")
    (tmp_path / "line.py").write_text(
        "from workbench.api import Distortion\nd = Distortion(id='d', label='d', formula='sum(sigma)')\n"
    )
    result = cli("check-solver", *arguments)
    assert result.status == 2 and result.out == ""
    assert words in result.err and len(result.err.strip().splitlines()) == 1
