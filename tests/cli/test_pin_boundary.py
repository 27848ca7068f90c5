"""`workbench solve --pin-boundary`: a solid onto a ball, then the least distortion inside (Fig. 1)."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tests.cli.conftest import strict_json
from workbench.core.samples import make_sample


def test_a_solid_stays_on_the_ball_while_its_distortion_falls(cli, tmp_path: Path) -> None:
    out, report = tmp_path / "map.npz", tmp_path / "report.json"
    result = cli(
        "solve", "sample:blob-3d", "--init", "radial-stretch", "--pin-boundary", "--out", out, "--report", report, "--quiet"
    )  # fmt: skip
    assert result.status == 0, result.err
    said = strict_json(report.read_text())
    mesh = make_sample("blob-3d")
    boundary = mesh.topology.boundary_vertices
    assert said["initial_inverted"] == said["inverted"] == 0
    assert said["injective"] == {"local": True, "global": True}
    assert said["anchors"] == {"count": len(boundary), "max_error": 0.0}
    assert said["energy"] < said["initial_energy"]
    with np.load(out) as case:
        radii = np.linalg.norm(case["X"][boundary], axis=1)
        averages = cli("measure", out, "--json").json["histogram78"]
    assert np.ptp(radii) < 1e-12 * radii.mean() * 10
    edges, counts = np.array(averages["edges"]), np.array(averages["counts"])
    assert counts.sum() == mesh.simplex_count
    assert abs(edges[np.argmax(counts)] - 1.0) < 0.15  # most simplices keep their size (Fig. 1)
