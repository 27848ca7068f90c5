"""`workbench run`: sessions without a window."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from workbench.engine.session_file import read_session, source_digest, write_session
from workbench.session.record import SessionRecord
from workbench.session.session import Session
from workbench.session.text import FORMAT, VERSION


def by_hand(path: Path, source: str, **entries: Any) -> Path:
    """A session as someone types it."""
    path.write_text(json.dumps({"format": FORMAT, "version": VERSION, "source": {"path": source}, **entries}))
    return path


def test_a_session_that_was_typed_is_solved_as_the_command_line_does(cli, tmp_path: Path, square_file: Path) -> None:
    anchors = [[0, [0.0, 0.0]], [48, [1.3, 1.1]]]
    formula, values = "lam*symmetric_dirichlet + (1 - lam)*mips", {"lam": 0.3}
    session = by_hand(
        tmp_path / "s.json", square_file.name, solver="slim", distortion=formula, distortion_parameters=values, anchors=anchors
    )
    assert cli("run", session, "--out", tmp_path / "out").status == 0
    (tmp_path / "anchors.csv").write_text("vertex,x,y\n0,0,0\n48,1.3,1.1\n")
    told = cli(
        "solve", square_file, "--solver", "slim", "--distortion", formula, "--set", "lam=0.3",
        "--anchors", tmp_path / "anchors.csv", "--out", tmp_path / "map.npz", "--report", tmp_path / "r.json",
    )  # fmt: skip
    assert told.status == 0
    ours, theirs = (json.loads(path.read_text()) for path in (tmp_path / "out" / "report.json", tmp_path / "r.json"))
    assert ours["energy"] == pytest.approx(theirs["energy"], rel=1e-10)
    assert ours["iterations"] == theirs["iterations"] and ours["status"] == theirs["status"]
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert names == {"map.npz", "map.obj", "report.json", "history.csv", "anchors.csv"}
    rows = (tmp_path / "out" / "history.csv").read_text().splitlines()
    assert len(rows) == ours["iterations"] + 2, "a header, the start, a row an iteration"


def test_a_run_that_fails_is_told_as_the_command_line_does(cli, tmp_path: Path, square_file: Path, square) -> None:
    places = ((vertex, *square.vertices[vertex]) for vertex in square.simplices[0])
    equations = [line for vertex, x, y in places for line in (f"x[{vertex}] = {y}", f"y[{vertex}] = {x}")]  # turned over
    session = by_hand(tmp_path / "s.json", square_file.name, linear_equations=equations)
    (tmp_path / "e.txt").write_text("\n".join(equations))
    ours = cli("run", session, "--out", tmp_path / "out")
    theirs = cli("solve", square_file, "--equations", tmp_path / "e.txt", "--out", tmp_path / "map.npz")
    assert (ours.status, ours.err.splitlines()[-1:]) == (theirs.status, theirs.err.splitlines()[-1:])
    assert ours.status == 1 and ours.err and (tmp_path / "out" / "map.npz").exists()


def test_a_map_that_a_hand_made_is_measured_as_it_is(cli, tmp_path: Path, square_file: Path, square) -> None:
    positions = square.vertices * [1.5, 0.8]
    record = SessionRecord(Session(source=str(square_file), distortion="dirichlet"), map=positions, energy=None)
    write_session(tmp_path / "s.dwb", record)
    assert cli("run", tmp_path / "s.dwb", "--out", tmp_path / "out").status == 0
    with np.load(tmp_path / "out" / "map.npz") as case:
        np.testing.assert_array_equal(case["X"], positions)
    report = json.loads((tmp_path / "out" / "report.json").read_text())
    assert report["energy"] == pytest.approx(1.5**2 + 0.8**2, rel=1e-12)


def test_another_energy_than_the_one_recorded_is_told(cli, tmp_path: Path, square_file: Path, square) -> None:
    record = SessionRecord(Session(source=str(square_file)), map=square.vertices, energy=4.0 * (1 + 1e-8))
    write_session(tmp_path / "s.dwb", record)
    told = cli("run", tmp_path / "s.dwb", "--out", tmp_path / "out")
    assert told.status == 1 and "not the one" in told.err
    assert (tmp_path / "out" / "map.npz").exists()


def test_a_missing_or_changed_mesh_is_asked_for(cli, tmp_path: Path, square_file: Path, square) -> None:
    digest = source_digest(str(square_file))
    write_session(tmp_path / "s.dwb", SessionRecord(Session(source=str(square_file)), digest, square.vertices))
    square_file.write_text(square_file.read_text() + "# another\n")
    told = cli("run", tmp_path / "s.dwb", "--out", tmp_path / "out")
    assert told.status == 2 and "another" in told.err and "--mesh" in told.err and not (tmp_path / "out").exists()
    elsewhere = square_file.rename(tmp_path / "moved.obj")
    told = cli("run", tmp_path / "s.dwb", "--out", tmp_path / "out")
    assert told.status == 2 and "not at" in told.err and not (tmp_path / "out").exists()
    assert cli("run", tmp_path / "s.dwb", "--out", tmp_path / "out", "--mesh", elsewhere).status == 0


@pytest.mark.parametrize(
    "entries",
    [
        {"distortion": "__import__('os').system('touch owned')"},
        {"distortion": "(lambda: 0)()"},
        {"distortion": "sigma.__class__"},
        {"distortion": "open('owned', 'w')"},
        {"solver": "../../evil"},
        {"initializer": "file", "start_file": "/etc/passwd"},
        {"fixes": ["rm"]},
        {"anchors": [[10**9, [0, 0]]]},
        {"anchors": [[10**9, [0, 0], None, -1, "off"]]},
        {"solver_parameters": {"no_such": 1}},
        {"carried": "../../etc/passwd"},
    ],
    ids=str,
)
def test_what_a_session_may_not_say_is_refused_and_nothing_is_written(
    cli, tmp_path: Path, square_file: Path, monkeypatch: pytest.MonkeyPatch, entries: dict[str, Any]
) -> None:
    monkeypatch.chdir(tmp_path)
    session = by_hand(tmp_path / "s.json", square_file.name, **entries)
    before = sorted(tmp_path.rglob("*"))
    told = cli("run", session, "--out", "out")
    assert told.status == 2 and told.err.startswith("workbench: ") and "Traceback" not in told.err
    assert sorted(tmp_path.rglob("*")) == before


def test_nothing_is_written_through_links_in_the_folder(cli, tmp_path: Path, square_file: Path, square) -> None:
    outside = tmp_path / "precious.txt"
    outside.write_text("mine")
    out = tmp_path / "out"
    out.mkdir()
    for name in ("map.npz", "report.json", "history.csv"):
        (out / name).symlink_to(outside)
    write_session(tmp_path / "s.dwb", SessionRecord(Session(source=str(square_file)), map=square.vertices))
    assert cli("run", tmp_path / "s.dwb", "--out", out).status == 0
    assert outside.read_text() == "mine" and not (out / "report.json").is_symlink()


def test_a_session_reads_back_through_its_own_report(cli, tmp_path: Path, square_file: Path) -> None:
    session = by_hand(tmp_path / "s.json", square_file.name)
    assert read_session(session).session.source == str(square_file)
    told = cli("run", session, "--out", tmp_path / "out", "--quiet")
    assert told.status == 0 and not told.out and not told.err
