"""A solid bar twisted from the command line: anchors of a table, thirds of a turn one after the other."""

from __future__ import annotations

import csv
import json
import os

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from workbench.core.samples import make_sample

BAR = make_sample("bar-3d", triangles=200)


def write_anchors(path, degrees: float) -> np.ndarray:
    """Both ends held, the right one turned: rows (k, 3) of targets."""
    v = BAR.vertices
    ends = np.flatnonzero((v[:, 0] <= 0.0) | (v[:, 0] >= 4.0))
    turn = Rotation.from_rotvec([np.radians(degrees), 0.0, 0.0])
    targets = np.where(v[ends, :1] > 2.0, turn.apply(v[ends] - [0.0, 0.5, 0.5]) + [0.0, 0.5, 0.5], v[ends])
    rows = [f"{vertex},{x:.17g},{y:.17g},{z:.17g}" for vertex, (x, y, z) in zip(ends, targets, strict=True)]
    path.write_text("vertex,x,y,z\n" + "\n".join(rows) + "\n")
    return ends


@pytest.mark.parametrize("targets", [(90,), (180,), (120, 240, 360)], ids=["quarter", "half", "whole"])
def test_a_bar_is_twisted_without_an_inversion(cli, tmp_path, targets) -> None:
    bar = tmp_path / "bar.npz"
    np.savez(bar, V=BAR.vertices, S=BAR.simplices)
    start: tuple[object, ...] = ()
    mean = 6.0
    for degrees in targets:
        anchors, out = tmp_path / "anchors.csv", tmp_path / f"at_{degrees}.npz"
        ends = write_anchors(anchors, degrees)
        report, history = tmp_path / "report.json", tmp_path / "history.csv"
        options = ("--out", out, "--report", report, "--history", history, "--quiet")
        assert cli("solve", bar, "--anchors", anchors, *start, *options).status == 0
        found = json.loads(report.read_text())
        assert found["status"] == "CONVERGED" and found["anchors"]["max_error"] <= 1e-9 * 4.3
        assert found["mean_distortion"] > mean  # it winds up further and further
        mean = found["mean_distortion"]
        rows = list(csv.DictReader(history.read_text().splitlines()))
        assert len(rows) == found["iterations"] + 1 and all(row["inverted"] == "0" for row in rows)
        start = ("--init", out)
    if targets[-1] == 360:
        with np.load(out) as written:
            assert np.abs(written["X"][ends] - BAR.vertices[ends]).max() < 1e-8


def test_the_linear_solver_can_be_chosen(cli, tmp_path, monkeypatch) -> None:
    monkeypatch.setenv("WORKBENCH_LINEAR_SOLVER", "")  # put back in the end
    anchors, out = tmp_path / "anchors.csv", tmp_path / "out.npz"
    write_anchors(anchors, 45)
    common = ("solve", "sample:bar-3d", "--out", out, "--quiet", "--iterations", "3")
    for name in ("cg", "superlu"):
        assert cli(*common, "--linear-solver", name).status == 0
        assert os.environ["WORKBENCH_LINEAR_SOLVER"] == name
    refused = cli(*common, "--linear-solver", "gauss")
    assert refused.status == 2 and "no linear solver 'gauss'" in refused.err and "cg" in refused.err
