"""`compare`: the numbers of `solve`, one start for all, outputs that are whole and the same again; what is refused."""

from __future__ import annotations

import csv
import json
import os
import re

import numpy as np
import pytest

from tests.cli.conftest import strict_json, write_obj
from workbench.cli.compare import PRESET_IDS
from workbench.core.status import Status
from workbench.engine.contestants import PRESETS
from workbench.io.write import write_map

FILES = {
    "table.csv", "table.json", "history.csv", "curves.svg", "curves.pdf", "curves.png", "sheet.png", "sheet.pdf",
}  # fmt: skip
TIMES = {"seconds"}


def rows_of(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


@pytest.fixture
def anchors_file(tmp_path):
    path = tmp_path / "anchors.csv"
    path.write_text("vertex,x,y\n0,0,0\n48,1.3,1.2\n")
    return path


def test_table_history_curves_and_sheet(cli, square_file, anchors_file, tmp_path):
    out = tmp_path / "race"
    solvers = "projected-newton,fast=aqp:eta=50,plain=aqp:accelerate=no"
    result = cli("compare", square_file, "--solvers", solvers, "--anchors", anchors_file, "--out", out)
    assert result.status == 0, result.err
    assert {path.name for path in out.iterdir()} == FILES
    table, history = rows_of(out / "table.csv"), rows_of(out / "history.csv")
    assert [row["contestant"] for row in table] == ["projected-newton", "fast", "plain"]
    assert [row["solver"] for row in table] == ["projected-newton", "aqp", "aqp"]
    for row in table:
        own = [line for line in history if line["contestant"] == row["contestant"]]
        assert len(own) == int(row["iterations"]) + 1
        for name in ("energy", "seconds", "factorisations", "gradient_evaluations", "trials", "inverted", "relative_error"):
            assert own[-1][name] == row[name]
        assert row["status"] == "CONVERGED" and row["locally_injective"] == row["globally_injective"] == "true"
    energies = [float(row["energy"]) for row in table]
    errors = [float(row["relative_error"]) for row in table]
    assert min(errors) == 0.0
    np.testing.assert_allclose(errors, np.array(energies) / min(energies) - 1, atol=1e-12)
    report = strict_json((out / "table.json").read_text())
    assert report["races"][0]["input"]["simplices"] == 72
    assert [row["energy"] for row in report["races"][0]["contestants"]] == energies
    for name in ("projected-newton", "fast", "plain", "CONVERGED"):
        assert name in result.out
    assert result.err == ""


def test_the_numbers_are_those_of_solve(cli, square_file, anchors_file, tmp_path):
    common = [square_file, "--anchors", anchors_file, "--distortion", "mips", "--quiet", "--iterations", 7]
    assert (
        cli("compare", *common, "--solvers", "slim,aqp:eta=10", "--turns", "--no-figures", "--out", tmp_path / "race").status
        == 0
    )
    table = {row["contestant"]: row for row in rows_of(tmp_path / "race" / "table.csv")}
    for label, solver, settings in (("slim", "slim", []), ("aqp:eta=10", "aqp", ["--set", "eta=10"])):
        report, history = tmp_path / "report.json", tmp_path / "history.csv"
        cli(
            "solve",
            *common,
            "--solver",
            solver,
            *settings,
            "--out",
            tmp_path / "map.obj",
            "--report",
            report,
            "--history",
            history,
        )
        alone = strict_json(report.read_text())
        assert float(table[label]["energy"]) == alone["energy"]
        assert int(table[label]["iterations"]) == alone["iterations"] and table[label]["status"] == alone["status"]
        together = [row for row in rows_of(tmp_path / "race" / "history.csv") if row["contestant"] == label]
        for one, other in zip(together, rows_of(history), strict=True):
            assert {n: one[n] for n in other if n not in TIMES} == {n: other[n] for n in other if n not in TIMES}


def test_set_reaches_every_solver_that_has_the_parameter(cli, square_file, anchors_file, tmp_path):
    common = [square_file, "--anchors", anchors_file, "--iterations", 5, "--quiet", "--no-figures"]
    cli("compare", *common, "--solvers", "aqp,own=aqp:eta=3,slim", "--set", "eta=900", "--out", tmp_path / "set")
    cli("compare", *common, "--solvers", "aqp:eta=900,aqp:eta=3,slim", "--out", tmp_path / "each")
    energies = [[row["energy"] for row in rows_of(tmp_path / folder / "table.csv")] for folder in ("set", "each")]
    assert energies[0] == energies[1] and energies[0][0] != energies[0][1]


def test_several_meshes_and_kinds_in_one_table(cli, square_file, dome_file, cube, tmp_path):
    np.savez(tmp_path / "cube.npz", V=cube.vertices, S=cube.simplices, X0=cube.vertices * [1.2, 1.0, 0.9])
    out = tmp_path / "race"
    result = cli(
        "compare", square_file, dome_file, tmp_path / "cube.npz", "--solvers", "slim",
        "--rows", "last", "--out", out,
    )  # fmt: skip
    assert result.status == 0, result.err
    table = rows_of(out / "table.csv")
    assert [row["mesh"] for row in table] == ["square", "dome", "cube"]
    assert {row["mesh"] for row in rows_of(out / "history.csv")} == {"square", "dome", "cube"}
    assert all(row["globally_injective"] == "true" for row in table if row["mesh"] == "cube")
    for mesh in ("square", "dome", "cube"):
        assert {path.name for path in (out / mesh).iterdir()} == {name for name in FILES if name[:5] in ("curve", "sheet")}


@pytest.fixture
def cube_file(cube, tmp_path):
    np.savez(tmp_path / "cube.npz", V=cube.vertices, S=cube.simplices, X0=cube.vertices * [1.2, 1.0, 0.9])
    return tmp_path / "cube.npz"


def test_what_does_not_fit_is_refused_by_name_and_the_rest_goes_on(cli, square_file, cube_file, tmp_path):
    broken = tmp_path / "broken.obj"
    broken.write_text("v 0 0 0\nf 1 2 3\n")
    out = tmp_path / "race"
    solvers = "composite-majorization,slim"
    result = cli("compare", broken, cube_file, square_file, "--solvers", solvers, "--rows", "last", "--out", out)
    assert result.status == 1
    table = rows_of(out / "table.csv")
    assert [(row["mesh"], row["contestant"], row["status"]) for row in table] == [
        ("broken", "composite-majorization", "REFUSED"),
        ("broken", "slim", "REFUSED"),
        ("cube", "slim", "CONVERGED"),
        ("cube", "composite-majorization", "REFUSED"),
        ("square", "composite-majorization", "CONVERGED"),
        ("square", "slim", "CONVERGED"),
    ]
    for row in table:
        assert (row["status"] == "REFUSED") == (row["energy"] == "") == (row["iterations"] == "")
    assert "does not solve volume maps" in table[3]["message"] and table[3]["solver"] == "composite-majorization"
    told = [line for line in result.err.splitlines() if line.startswith("workbench: ")]
    assert [line.split()[1] for line in told] == ["broken:", "cube,"]  # a mesh once, a contestant by name
    assert "composite-majorization" in told[1] and "REFUSED" in result.out
    races = strict_json((out / "table.json").read_text())["races"]
    assert [len(race["contestants"]) for race in races] == [2, 2, 2]
    assert races[0]["refused"] == table[0]["message"] and "refused" not in races[1]
    assert {path.name for path in out.iterdir() if path.is_dir()} == {"cube", "square"}
    assert {row["mesh"] for row in rows_of(out / "history.csv")} == {"cube", "square"}


def test_where_nothing_fits_every_mesh_is_named_and_nothing_is_written(cli, cube_file, tmp_path):
    broken = tmp_path / "broken.obj"
    broken.write_text("v 0 0 0\nf 1 2 3\n")
    result = cli("compare", broken, cube_file, "--solvers", "composite-majorization", "--out", tmp_path / "race")
    assert result.status == 2 and result.out == ""
    assert str(broken) in result.err and str(cube_file) in result.err
    assert not (tmp_path / "race").exists()


def test_a_fault_of_the_command_is_told_once_for_many_meshes(cli, square_file, dome_file, tmp_path):
    result = cli("compare", square_file, dome_file, "--solvers", "slim", "--set", "speed=3", "--out", tmp_path / "race")
    assert result.status == 2 and len(result.err.splitlines()) == 1
    assert "There is no parameter 'speed'" in result.err


def test_a_given_map_takes_part(cli, dome, dome_file, tmp_path):
    flat = dome.vertices[:, :2] * [1.1, 0.95]
    write_map(tmp_path / "other.obj", dome, dome, flat, "parameterize")
    out = tmp_path / "race"
    result = cli(
        "compare", dome_file, "--solvers", "slim", "--given", f"other={tmp_path / 'other.obj'}", "--no-figures", "--out", out
    )
    assert result.status == 0, result.err
    solver, given = rows_of(out / "table.csv")
    assert (given["contestant"], given["status"], given["seconds"], given["solver"]) == ("other", "GIVEN", "0", "")
    assert float(given["energy"]) > float(solver["energy"]) and float(given["relative_error"]) > 0
    measured = cli("measure", tmp_path / "other.obj", "--json").json["measures"]["symmetric-dirichlet"]
    assert float(given["mean_distortion"]) == pytest.approx(measured["area_weighted_mean"], rel=1e-12)


def test_a_preset_brings_its_distortion(cli, square_file, anchors_file, tmp_path):
    written = ["--no-figures", "--quiet", "--out", tmp_path / "race"]
    assert cli("compare", square_file, "--preset", "anderson", "--anchors", anchors_file, *written).status == 0
    assert strict_json((tmp_path / "race" / "table.json").read_text())["distortion"]["id"] == "arap"


def test_a_failure_is_told_and_all_is_written(cli, square, tmp_path):
    path = tmp_path / "turned.npz"
    start = square.vertices.copy()
    start[24] += 0.5  # over its neighbours
    np.savez(path, V=square.vertices, S=square.simplices, X0=start)
    out = tmp_path / "race"
    result = cli("compare", path, "--solvers", "slim,aqp", "--rows", "last", "--out", out)
    assert result.status == 1
    assert {path.name for path in out.iterdir()} == FILES  # of maps that are infinitely distorted, too
    assert {row["status"] for row in rows_of(out / "table.csv")} == {"INVERTED_START"}
    assert result.err.count(Status.INVERTED_START.value) == 2 and "slim" in result.err


def test_the_figures_are_the_same_again_and_bear_no_date(cli, square_file, anchors_file, tmp_path, monkeypatch):
    ticks = iter(range(10**9))
    monkeypatch.setattr("time.perf_counter", lambda: next(ticks) * 1e-3)  # a clock that is the same in every run
    arguments = ["compare", square_file, "--solvers", "slim", "--rows", "0,last", "--anchors", anchors_file, "--quiet"]
    found = []
    for folder in ("one", "two"):
        ticks = iter(range(10**9))
        assert cli(*arguments, "--out", tmp_path / folder).status == 0
        found.append({name: (tmp_path / folder / name).read_bytes() for name in sorted(FILES)})
    assert found[0].keys() == found[1].keys()
    assert [name for name in FILES if found[0][name] != found[1][name]] == []
    svg = found[0]["curves.svg"].decode()
    assert not re.search(r"<dc:date>|20\d\d-\d\d-\d\d", svg)


def test_other_files_in_the_folder_stay(cli, square_file, tmp_path):
    out = tmp_path / "race"
    out.mkdir()
    (out / "notes.txt").write_text("mine")
    (out / "table.csv").write_text("old")
    assert cli("compare", square_file, "--solvers", "slim", "--quiet", "--no-figures", "--out", out).status == 0
    assert (out / "notes.txt").read_text() == "mine" and (out / "table.csv").read_text() != "old"
    assert {path.name for path in tmp_path.iterdir()} == {"square.obj", "race"}  # no folder of parts is left


REFUSED = {
    "There is nobody to compare": ["--out", "OUT"],
    "no solver 'magic'": ["--solvers", "magic", "--out", "OUT"],
    "has no parameter 'speed'": ["--solvers", "aqp:speed=3", "--out", "OUT"],
    "not of the form NAME=VALUE": ["--solvers", "aqp:speed", "--out", "OUT"],
    "Two contestants are called 'aqp'": ["--solvers", "aqp,aqp", "--out", "OUT"],
    "minimises arap": ["--solvers", "local-global", "--out", "OUT"],
    "There is no parameter 'speed'": ["--solvers", "aqp", "--set", "speed=3", "--out", "OUT"],
    "There is no folder": ["--solvers", "aqp", "--out", "no-such-folder/OUT"],
    "is a file": ["--solvers", "aqp", "--out", "square.obj"],
    "is not of the form 0,1,5,last": ["--solvers", "aqp", "--rows", "first", "--out", "OUT"],
    "There is no file": ["--solvers", "aqp", "--given", "no-such-map.obj", "--out", "OUT"],
    "belongs to one mesh": ["square.obj", "--solvers", "aqp", "--given", "square.obj", "--out", "OUT"],
}


@pytest.mark.parametrize("words", REFUSED)
def test_refused_with_one_sentence_and_nothing_written(words, cli, square_file, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = cli("compare", "square.obj", *REFUSED[words])
    assert result.status == 2 and result.out == ""
    assert words in result.err and len(result.err.strip().splitlines()) == 1
    assert os.listdir(tmp_path) == ["square.obj"]


def test_an_interrupt_ends_everyone_with_its_map(cli, square_file, tmp_path, monkeypatch):
    monkeypatch.setattr("workbench.engine.interrupt.InterruptFlag.__call__", lambda self: True)
    out = tmp_path / "race"
    assert cli("compare", square_file, "--solvers", "slim,aqp", "--quiet", "--no-figures", "--out", out).status == 0
    assert {row["status"] for row in rows_of(out / "table.csv")} == {"INTERRUPTED"}
    assert json.loads((out / "table.json").read_text())["races"][0]["contestants"][0]["iterations"] == 0


def test_meshes_of_one_name_are_told_apart(cli, square, square_file, tmp_path):
    (tmp_path / "other").mkdir()
    second = write_obj(tmp_path / "other" / "square.obj", square)
    out = tmp_path / "race"
    assert cli("compare", square_file, second, "--solvers", "slim", "--no-figures", "--quiet", "--out", out).status == 0
    assert [row["mesh"] for row in rows_of(out / "table.csv")] == ["square", "square-2"]


def test_nothing_is_half_written(cli, square_file, tmp_path, monkeypatch):
    def fails(*arguments):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("workbench.cli.compare._draw", fails)
    result = cli("compare", square_file, "--solvers", "slim", "--quiet", "--out", tmp_path / "race")
    assert result.status == 2 and "No space left on device" in result.err
    assert os.listdir(tmp_path) == ["square.obj"]


def test_every_preset_can_be_named():
    assert set(PRESET_IDS) == set(PRESETS)
    assert all(len(preset.contestants()) >= 2 for preset in PRESETS.values())
