"""What a notebook solves is what the command line solves, to the last bit, and can be kept, stopped and gone on with."""

from __future__ import annotations

import json
import re
import signal
import sys
from pathlib import Path

import numpy as np
import pytest

from workbench.api import Anchors, Distortion, Mesh, Problem, Status, WorkbenchError, load, solve, solver
from workbench.cli.main import main
from workbench.core.run import HistoryRow
from workbench.notebook.wording import for_scripts

ANCHORS = {0: (0.1, -0.2), 48: (1.4, 1.1)}

CASES = {
    "plain": ({}, []),
    "formula": (
        {"distortion": "sum(sigma^2) + t/det^2", "parameters": {"t": 0.5}},
        ["--distortion", "sum(sigma^2) + t/det^2", "--set", "t=0.5"],
    ),
    "solver": (
        {"solver": "slim", "parameters": {"safety": 0.7}, "iterations": 12},
        ["--solver", "slim", "--set", "safety=0.7", "--iterations", "12"],
    ),
    "pinned": ({"pin_boundary": True, "tolerance": 1e-9}, ["--pin-boundary", "--tolerance", "1e-9"]),
}


@pytest.fixture
def square_file(square: Mesh, tmp_path: Path) -> Path:
    bent = square.vertices + 0.05 * np.sin(7 * square.vertices[:, ::-1])
    np.savez(tmp_path / "square.npz", V=square.vertices, S=square.simplices, X0=bent)
    return tmp_path / "square.npz"


@pytest.mark.parametrize("case", CASES)
def test_energies_are_those_of_the_command_line(case: str, square_file: Path, tmp_path: Path) -> None:
    wishes, arguments = CASES[case]
    table = "vertex,x,y\n" + "".join(f"{vertex},{x},{y}\n" for vertex, (x, y) in ANCHORS.items())
    (tmp_path / "anchors.csv").write_text(table)
    command = ["solve", str(square_file), "--out", str(tmp_path / "cli.npz"), "--report", str(tmp_path / "cli.json")]
    assert main([*command, "--anchors", str(tmp_path / "anchors.csv"), "--quiet", *arguments]) == 0
    report = json.loads((tmp_path / "cli.json").read_text())
    result = solve(square_file, anchors=ANCHORS, progress=False, **wishes)
    assert (result.energy, result.iterations, result.status.name) == (report["energy"], report["iterations"], report["status"])
    result.save(tmp_path / "ours.npz")
    result.save(tmp_path / "ours.json")
    with np.load(tmp_path / "cli.npz") as theirs, np.load(tmp_path / "ours.npz") as ours:
        assert all(np.array_equal(theirs[name], ours[name]) for name in ("V", "S", "X", "anchors", "targets"))
    own = json.loads((tmp_path / "ours.json").read_text())
    timed = {"seconds", "versions"}
    assert {k: v for k, v in own.items() if k not in timed} == {k: v for k, v in report.items() if k not in timed}


def test_what_is_solved_may_be_given_in_any_form(square: Mesh, square_file: Path) -> None:
    opened = load(square_file)
    held = Anchors(np.array(list(ANCHORS)), np.array(list(ANCHORS.values())))
    wished = {"init": opened.start, "anchors": held, "progress": False}
    energies = {
        solve(square_file, anchors=ANCHORS, progress=False).energy,
        solve(opened, "symmetric-dirichlet", anchors=(list(ANCHORS), list(ANCHORS.values())), progress=False).energy,
        solve(opened.mesh, Distortion.resolve("symmetric-dirichlet"), solver=solver("projected-newton"), **wished).energy,
        solve(opened.problem("symmetric-dirichlet", ANCHORS), init=opened.start, progress=False).energy,
        solve(Problem.create(square, "plane", Distortion.resolve("symmetric-dirichlet"), held), **wished).energy,
    }
    assert len(energies) == 1


def test_the_history_has_a_row_for_each_map(square_file: Path, tmp_path: Path) -> None:
    rows: list[HistoryRow] = []
    result = solve(square_file, anchors=ANCHORS, progress=rows.append)
    assert len(rows) == result.iterations + 1 == len(result.history["energy"])
    np.testing.assert_array_equal(result.history["iteration"], np.arange(len(rows)))
    assert result.history["energy"][-1] == result.energy == result.problem.energy(result.positions)
    result.save_history(tmp_path / "history.csv")
    assert len((tmp_path / "history.csv").read_text().splitlines()) == len(rows) + 1


def test_an_exact_number_of_steps_is_taken_and_gone_on_from(square_file: Path) -> None:
    first = solve(
        square_file, anchors=ANCHORS, solver="gradient-descent", iterations=7, tolerance=1e9, exactly=True, progress=False
    )
    assert first.iterations == 7
    second = solve(square_file, "arap", anchors=ANCHORS, init=first, iterations=3, exactly=True, progress=False)
    assert second.iterations == 10
    np.testing.assert_array_equal(second.start, first.positions)
    assert list(second.history["iteration"]) == [7, 8, 9, 10]


def test_ctrl_c_ends_with_the_last_map(square_file: Path) -> None:
    def pressed(row: HistoryRow) -> None:
        if row.iteration == 3:
            signal.raise_signal(signal.SIGINT)

    before = signal.getsignal(signal.SIGINT)
    result = solve(square_file, anchors=ANCHORS, solver="gradient-descent", tolerance=0.0, progress=pressed)
    assert result.status is Status.INTERRUPTED
    assert 3 <= result.iterations <= 4
    assert signal.getsignal(signal.SIGINT) == before


def test_progress_is_one_line_and_only_for_people(square_file: Path, capsys, monkeypatch) -> None:
    monkeypatch.setattr("workbench.notebook.progress.INTERVAL", 0.0)
    solve(square_file, anchors=ANCHORS)
    assert capsys.readouterr().out == ""
    monkeypatch.setitem(sys.modules, "ipykernel", object())
    solve(square_file, anchors=ANCHORS)
    written = capsys.readouterr().out
    assert "\n" not in written
    assert "energy" in written
    assert written.rsplit("\r", 2)[-2].strip() == ""  # nothing of it is left


@pytest.mark.parametrize(
    ("wishes", "words"),
    [
        ({"anchors": {999: (0, 0)}}, "999"),
        ({"anchors": {0: (0, 0, 0)}}, "coordinates"),
        ({"anchors": {0.5: (0, 0)}}, "whole numbers"),
        ({"init": np.zeros((3, 2))}, r"\(3, 2\)"),
        ({"init": "no-such-start"}, "no-such-start"),
        ({"solver": "no-such-solver"}, "no-such-solver"),
        ({"parameters": {"speed": 1}}, "speed"),
        ({"distortion": "sum(sigma"}, "."),
        ({"iterations": "many"}, "iterations is 'many'"),
        ({"iterations": -1}, "from 0 on"),
        ({"tolerance": float("nan")}, "tolerance is nan"),
        ({"time_limit": "1 h"}, "time_limit is '1 h'"),
    ],
)
def test_what_does_not_fit_is_refused_with_a_sentence(square_file: Path, wishes: dict, words: str) -> None:
    with pytest.raises(WorkbenchError, match=words):
        solve(square_file, progress=False, **wishes)


@pytest.mark.parametrize(
    "given", [np.zeros((3, 2)), (np.zeros((3, 2)), [[0, 1, 2]]), None, 7], ids=lambda given: type(given).__name__
)
def test_what_is_no_mesh_is_refused_with_a_sentence(given: object) -> None:
    with pytest.raises(WorkbenchError, match=r"Mesh\(vertices, simplices\)"):
        solve(given)


def test_sentences_name_arguments_not_options(square_file: Path) -> None:
    with pytest.raises(WorkbenchError, match=re.escape('parameters={"t": ...}')):
        solve(square_file, "sum(sigma^2) + t/det^2")
    result = solve(square_file, anchors=ANCHORS, iterations=1, progress=False)
    assert result.status is Status.MAX_ITERATIONS
    assert "raise iterations to go on" in result.message
    assert for_scripts("apply --fix largest,cut.") == 'apply fixes="largest,cut".'
    assert not any("--" in for_scripts(status.value) for status in Status)


def test_equations_hold(square_file: Path, tmp_path: Path) -> None:
    line = "x[10] - x[11] = -0.25"
    (tmp_path / "equations.txt").write_text(line)
    found = [solve(square_file, equations=given, progress=False) for given in (line, [line], tmp_path / "equations.txt")]
    for result in found:
        assert result.positions[11, 0] - result.positions[10, 0] == pytest.approx(0.25, abs=1e-9)
        assert result.energy == found[0].energy
    kept = solve(found[0].problem, init=found[0], progress=False)
    assert kept.positions[11, 0] - kept.positions[10, 0] == pytest.approx(0.25, abs=1e-9)
    assert kept.energy == pytest.approx(found[0].energy, rel=1e-6)
