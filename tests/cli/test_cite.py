"""`workbench cite`, and `workbench run --script`: what a session leaves for papers and for scripts."""

from __future__ import annotations

import json
import runpy
from pathlib import Path

import pytest

from workbench.session.text import FORMAT, VERSION


@pytest.fixture
def session(tmp_path: Path, square_file: Path) -> Path:
    path = tmp_path / "s.json"
    plain = {
        "format": FORMAT,
        "version": VERSION,
        "source": {"path": square_file.name},
        "solver": "slim",
        "distortion": "arap-barrier",
    }
    path.write_text(json.dumps(plain | {"anchors": [[0, [0.0, 0.0]], [48, [1.3, 1.1]]], "iterations": 6}))
    return path


def test_a_session_is_cited_with_its_start(cli, session: Path, tmp_path: Path) -> None:
    told = cli("cite", session, "newton-complex")
    assert told.status == 0
    assert [line[2:].partition(":")[0] for line in told.out.splitlines() if line.startswith("% ")] == [
        "arap-barrier", "slim", "rest", "newton-complex",
    ]  # fmt: skip
    for key in ("NNZ21", "SA07", "RPPSH17", "GSC18", "CW17"):
        assert told.out.count(f"{{{key},") == 1
    assert cli("cite", session, "newton-complex", "--out", tmp_path / "used.bib").out == ""
    assert (tmp_path / "used.bib").read_text(encoding="utf-8") == told.out


def test_what_cannot_be_cited_is_refused(cli, session: Path, tmp_path: Path) -> None:
    assert "no-such-method" in cli("cite", "no-such-method").err
    assert cli("cite", "no-such-method").status == cli("cite", tmp_path / "none.dwb").status == 2
    assert cli("cite", "slim", "--out", tmp_path / "none" / "x.bib").status == 2


def test_a_session_becomes_a_script(cli, session: Path, tmp_path: Path) -> None:
    assert cli("run", session, "--script", tmp_path / "again.py", "--out", tmp_path / "out").status == 0
    energy = json.loads((tmp_path / "out" / "report.json").read_text())["energy"]
    assert runpy.run_path(str(tmp_path / "again.py"))["result"].energy == energy
    alone = cli("run", session, "--script", tmp_path / "alone.py")
    assert alone.status == 0 and "alone.py" in alone.out
    assert (tmp_path / "alone.py").read_text() == (tmp_path / "again.py").read_text()


def test_a_run_needs_somewhere_to_write(cli, session: Path, tmp_path: Path) -> None:
    told = cli("run", session)
    assert told.status == 2 and "--out" in told.err
    assert cli("run", session, "--script", tmp_path / "again.txt").status == 2
    assert not (tmp_path / "again.txt").exists()
