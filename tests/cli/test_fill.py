"""`workbench fill`."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import strict_json
from workbench.core.mesh import Mesh
from workbench.core.samples import make_sample
from workbench.engine import filling
from workbench.engine.filling import can_fill
from workbench.io.write import write_mesh


def test_bad_input_is_refused_and_nothing_is_written(cli, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(filling, "can_fill", lambda: True)
    out = tmp_path / "solid.mesh"
    for arguments, words in (
        (("sample:fingers", "--out", out), "open"),
        (("sample:ball", "--out", out), "tetrahedra already"),
        (("sample:blob", "--out", tmp_path / "solid.csv"), ".msh"),
        (("sample:blob", "--out", tmp_path / "nowhere" / "solid.mesh"), "no folder"),
        (("sample:blob", "--out", out, "--edge-length", "1e-5"), "at least"),
    ):
        result = cli("fill", *arguments)
        assert result.status == 2 and words in result.err
    blob = make_sample("blob", 300)
    turned = blob.simplices.copy()
    turned[7] = turned[7, ::-1]
    surface = tmp_path / "turned.obj"
    write_mesh(surface, Mesh(blob.vertices, turned))
    assert "Add --fix reorient" in cli("fill", surface, "--out", out).err
    surface.unlink()
    monkeypatch.setattr(filling, "can_fill", lambda: False)
    assert "[fill]" in cli("fill", "sample:blob", "--out", out).err
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(not can_fill(), reason="the extra `fill` is not installed")
def test_a_filled_surface_can_be_measured_and_solved_on(cli, tmp_path: Path) -> None:
    surface, solid = tmp_path / "lump.obj", tmp_path / "solid.mesh"
    write_mesh(surface, make_sample("blob", 300))
    report = tmp_path / "report.json"
    result = cli("fill", surface, "--edge-length", "0.7", "--out", solid, "--report", report, "--quiet")
    assert result.status == 0 and result.out == "" and result.err == ""
    facts = strict_json(report.read_text())
    measured = cli("measure", solid, solid, "--json").json
    assert measured["injective"]["local"] is measured["injective"]["global"] is True
    assert sum(measured["histogram78"]["counts"]) == facts["tetrahedra"]
    solved = cli("solve", solid, "--init", "volumetric-harmonic", "--iterations", "1", "--out", tmp_path / "x.npz", "--quiet")
    assert solved.status == 0, solved.err
