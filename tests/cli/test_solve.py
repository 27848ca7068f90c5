"""`workbench solve`: the map, the report and the history say the same, whatever the status."""

from __future__ import annotations

import csv
import math
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

from tests.cli.conftest import strict_json, write_obj
from workbench.core.mesh import Mesh

REPORT_FIELDS = {
    "schema", "input", "distortion", "solver", "init", "status", "message", "iterations", "energy", "mean_distortion",
    "initial_energy", "gradient_norm", "inverted", "initial_inverted", "min_det", "max_sigma", "min_sigma", "anchors",
    "injective", "seconds", "threads", "versions",
}  # fmt: skip
HISTORY = "iteration,seconds,energy,mean_distortion,gradient_norm,step_size,inverted,anchor_error"


@pytest.fixture
def solve(cli, tmp_path):
    """`solve(file, ...)` -> (outcome, report, rows of the history), the map is in `out.obj`."""

    def call(file, *options, out="out.obj"):
        report, history = tmp_path / "report.json", tmp_path / "history.csv"
        outcome = cli("solve", file, "--out", tmp_path / out, "--report", report, "--history", history, *options)
        rows = list(csv.DictReader(history.read_text().splitlines()))
        return outcome, strict_json(report.read_text()), rows

    return call


def lines_of(path, keyword):
    return np.array([line.split()[1:] for line in path.read_text().splitlines() if line.startswith(keyword + " ")], float)


def test_a_surface_is_flattened_and_its_file_kept(solve, dome_file, dome, tmp_path):
    outcome, report, _ = solve(dome_file)
    assert outcome.status == 0 and report["status"] == "CONVERGED" and report["inverted"] == 0
    assert report.keys() == REPORT_FIELDS
    assert report["input"]["kind"] == "parameterize" and report["init"] == "tutte"
    assert {"total", "setup", "assemble", "factorise", "solve", "line_search"} <= report["seconds"].keys()
    assert report["injective"] == {"local": True, "global": True}
    np.testing.assert_array_equal(lines_of(tmp_path / "out.obj", "v"), dome.vertices)
    assert len(lines_of(tmp_path / "out.obj", "vt")) == dome.vertex_count


def test_history_and_report_agree(solve, dome_file, tmp_path):
    _, report, rows = solve(dome_file)
    assert (tmp_path / "history.csv").read_text().splitlines()[0] == HISTORY
    assert [int(row["iteration"]) for row in rows] == list(range(report["iterations"] + 1))
    assert float(rows[-1]["energy"]) == report["energy"]
    assert float(rows[0]["energy"]) == report["initial_energy"]
    energies = [float(row["energy"]) for row in rows]
    assert energies == sorted(energies, reverse=True)
    assert (energies[-2] - energies[-1]) / energies[-1] <= 1e-6


def test_solving_and_measuring_give_the_same_numbers(solve, cli, dome_file, tmp_path):
    _, report, _ = solve(dome_file)
    measured = cli("measure", tmp_path / "out.obj", "--json").json
    mean = measured["measures"]["symmetric-dirichlet"]["area_weighted_mean"]
    assert mean == pytest.approx(report["mean_distortion"], rel=1e-12)
    assert measured["min_det"] == pytest.approx(report["min_det"], rel=1e-12)
    apart = cli("measure", dome_file, tmp_path / "out.obj", "--json").json
    assert apart == measured


def test_the_identity_is_the_optimum_at_rest(solve, square_file, square, tmp_path):
    outcome, report, _ = solve(square_file)
    assert outcome.status == 0 and report["input"]["kind"] == "plane" and report["init"] == "rest"
    assert report["mean_distortion"] == pytest.approx(4.0, rel=1e-12)
    np.testing.assert_allclose(lines_of(tmp_path / "out.obj", "v")[:, :2], square.vertices, atol=1e-9)


def test_anchors_of_a_table_are_reached(solve, square_file, tmp_path):
    table = tmp_path / "anchors.csv"
    table.write_text("vertex,x,y\n0,-0.2,0.1\n6,1.1,-0.1\n48,1,1.5\n")
    outcome, report, _ = solve(square_file, "--anchors", table)
    assert outcome.status == 0 and report["anchors"]["count"] == 3 and report["inverted"] == 0
    moved = lines_of(tmp_path / "out.obj", "v")[[0, 6, 48], :2]
    np.testing.assert_allclose(moved, [[-0.2, 0.1], [1.1, -0.1], [1, 1.5]], atol=1e-8)


def test_volumes_are_solved_too(solve, cube, tmp_path):
    case = tmp_path / "cube.npz"
    corner = np.array([0, cube.vertex_count - 1])
    np.savez(case, V=cube.vertices, S=cube.simplices, X0=cube.vertices, anchors=corner, targets=[[0, 0, 0], [1.2, 1.3, 1.4]])
    outcome, report, _ = solve(case, out="out.npz")
    assert outcome.status == 0 and report["input"]["kind"] == "volume" and report["init"] == "file"
    assert report["anchors"]["count"] == 2 and report["inverted"] == 0
    with np.load(tmp_path / "out.npz") as written:
        np.testing.assert_allclose(written["X"][corner], [[0, 0, 0], [1.2, 1.3, 1.4]], atol=1e-8)
        np.testing.assert_array_equal(written["S"], cube.simplices)


def test_settings_reach_the_formula_and_the_solver(solve, square_file):
    options = ("--distortion", "sum(sigma^2) + weight/det^2", "--solver", "gradient-descent")
    settings = ("--set", "weight=0.25", "--set", "growth=3", "--iterations", "20")
    outcome, report, _ = solve(square_file, *options, *settings)
    assert outcome.status == 0
    assert report["distortion"]["parameters"] == {"weight": 0.25}
    assert report["initial_energy"] == pytest.approx(2.25, rel=1e-12)
    assert report["solver"] == "gradient-descent"


def test_limits_of_the_user_are_no_failures(solve, dome_file):
    outcome, report, rows = solve(dome_file, "--iterations", "2", "--tolerance", "0")
    assert outcome.status == 0 and report["status"] == "MAX_ITERATIONS" and report["iterations"] == 2 == len(rows) - 1
    outcome, report, _ = solve(dome_file, "--time-limit", "0")
    assert outcome.status == 0 and report["status"] == "TIME_LIMIT"


def test_an_inverted_start_fails_and_everything_is_written(solve, square, tmp_path):
    folded = square.vertices.copy()
    folded[24] += 0.6  # the middle vertex over its neighbours
    case = tmp_path / "folded.npz"
    np.savez(case, V=square.vertices, S=square.simplices, X0=folded)
    outcome, report, _ = solve(case, out="out.npz")
    assert outcome.status == 1 and outcome.err.count("\n") == 1 and "Inverted start" in outcome.err
    assert report["status"] == "INVERTED_START" and report["initial_inverted"] > 0
    assert report["initial_energy"] is None  # infinite
    with np.load(tmp_path / "out.npz") as written:
        np.testing.assert_array_equal(written["X"], folded)


def test_quiet_is_silent(cli, dome_file, tmp_path):
    outcome = cli("solve", dome_file, "--out", tmp_path / "o.obj", "--quiet")
    assert (outcome.status, outcome.out, outcome.err) == (0, "", "")


def test_a_map_in_a_file_is_a_start(solve, dome_file, tmp_path):
    _, first, _ = solve(dome_file, "--iterations", "3", "--tolerance", "0")
    kept = tmp_path / "out.obj"
    kept.rename(tmp_path / "start.obj")
    _, second, _ = solve(dome_file, "--init", tmp_path / "start.obj")
    assert second["init"] == "file"
    assert second["initial_energy"] == pytest.approx(first["energy"], rel=1e-12)


def test_fields_come_with_tables(cli, dome_file, dome, tmp_path):
    assert cli("solve", dome_file, "--out", tmp_path / "o.csv").status == 0
    rows = list(csv.DictReader((tmp_path / "o.csv").read_text().splitlines()))
    assert len(rows) == dome.simplex_count and all(float(row["det"]) > 0 for row in rows)
    assert {"symmetric-dirichlet", "condition-number", "average-singular-value"} <= rows[0].keys()


def test_the_same_input_gives_the_same_map(solve, dome_file, tmp_path):
    solve(dome_file, "--threads", "1")
    first = (tmp_path / "out.obj").read_bytes()
    _, report, _ = solve(dome_file, "--threads", "1")
    assert (tmp_path / "out.obj").read_bytes() == first
    assert report["threads"] == 1


def test_a_fix_is_offered_and_works(solve, cli, tmp_path, dome):
    two = np.vstack([dome.vertices, dome.vertices[:3] + 9.0])
    first = dome.vertex_count
    file = write_obj(tmp_path / "two.obj", Mesh(two, np.vstack([dome.simplices, [[first, first + 1, first + 2]]])))
    refused = cli("solve", file, "--out", tmp_path / "o.obj")
    assert refused.status == 2 and "--fix largest" in refused.err and not (tmp_path / "o.obj").exists()
    table = tmp_path / "anchors.csv"
    table.write_text(f"vertex,x,y\n{first},0,0\n")
    dropped = cli("solve", file, "--fix", "largest", "--anchors", table, "--out", tmp_path / "o.obj")
    assert dropped.status == 2 and "dropped" in dropped.err
    outcome, report, _ = solve(file, "--fix", "largest")
    assert outcome.status == 0 and report["input"]["simplices"] == dome.simplex_count


def test_ctrl_c_keeps_the_last_map(project_root, tmp_path):
    out, report = tmp_path / "o.obj", tmp_path / "r.json"
    options = ["--solver", "gradient-descent", "--tolerance", "0", "--iterations", "100000000"]
    command = [
        sys.executable,
        "-m",
        "workbench",
        "solve",
        "sample:bumpy-disc",
        "--out",
        out,
        "--report",
        report,
        *options,
    ]
    process = subprocess.Popen(command, cwd=project_root, stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
    assert process.stderr is not None
    with process.stderr:
        assert "iteration" in process.stderr.readline()  # under way
        process.send_signal(signal.SIGINT)
        process.stderr.read()
        status = process.wait(60)
    assert status == 0
    written = strict_json(report.read_text())
    assert written["status"] == "INTERRUPTED" and written["inverted"] == 0 and written["iterations"] > 0
    assert len(lines_of(out, "vt")) == written["input"]["vertices"]


SOLVER_THAT_RAISES = """
from dataclasses import dataclass, replace
from workbench.api import Solver

@dataclass(frozen=True)
class Broken(Solver):
    id = "broken"
    label = "Broken"

    def step(self, problem, state, interrupt=None):
        if state.iteration == 2:
            raise ZeroDivisionError("by a plugin")
        return replace(state, iteration=state.iteration + 1)
"""


def test_a_plugin_that_raises_fails_with_its_last_map(project_root, tmp_path, dome_file):
    folder = tmp_path / "data" / "distortion-workbench" / "plugins" / "solvers"
    folder.mkdir(parents=True)
    (folder / "broken.py").write_text(SOLVER_THAT_RAISES)
    (folder / "worse.py").write_text("raise RuntimeError('at import')\n")
    environment = {**os.environ, "XDG_DATA_HOME": str(tmp_path / "data")}

    def run(*arguments):
        command = [sys.executable, "-m", "workbench", *map(str, arguments)]
        return subprocess.run(command, cwd=project_root, env=environment, capture_output=True, text=True, check=False)

    report = tmp_path / "r.json"
    done = run("solve", dome_file, "--out", tmp_path / "o.obj", "--solver", "broken", "--tolerance", 0, "--report", report)
    assert done.returncode == 1, done.stderr
    assert done.stderr.strip().splitlines()[-1] == "workbench: Broken failed in step 3: ZeroDivisionError: by a plugin"
    assert strict_json(report.read_text())["status"] == "FAILED" and (tmp_path / "o.obj").exists()
    listed = {entry["id"]: entry for entry in strict_json(run("list", "plugins", "--json").stdout)}
    assert listed["broken.py"]["status"] == "loaded" and listed["worse.py"]["status"] == "failed"
    assert "at import" in run("doctor").stdout


def test_seconds_are_those_of_the_run(solve, dome_file):
    begin = time.perf_counter()
    _, report, rows = solve(dome_file)
    elapsed = time.perf_counter() - begin
    parts = report["seconds"]
    assert all(math.isfinite(value) and value >= 0 for value in parts.values())
    assert parts["setup"] <= parts["total"] <= elapsed
    times = [float(row["seconds"]) for row in rows]
    assert times == sorted(times) and times[-1] <= parts["total"]
