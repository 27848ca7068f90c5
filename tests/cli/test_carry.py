"""`workbench solve --carry`: a surface goes where the map of the volume takes it, and what is said of it is true."""

from __future__ import annotations

import csv
from dataclasses import replace

import meshio
import numpy as np
import pytest

from tests.cli.conftest import strict_json, write_obj
from workbench.core.carried_surface import carry
from workbench.core.jacobians import build_elements
from workbench.core.mesh import Mesh
from workbench.core.quality import simplex_table
from workbench.io.opening import open_source
from workbench.io.read import read_mesh
from workbench.io.write import write_map


@pytest.fixture
def case(tmp_path, cube):
    """The cube with one end turned."""
    ends = np.flatnonzero(np.isin(cube.vertices[:, 0], (0.0, 1.0)))
    targets = cube.vertices[ends].copy()
    turned = targets[:, 0] == 1.0
    targets[turned] = targets[turned][:, [0, 2, 1]] * [1.0, -1.0, 1.0] + [0.2, 1.0, 0.0]
    path = tmp_path / "case.npz"
    write_map(path, cube, cube, cube.vertices, "volume", anchor_vertices=ends, anchor_targets=targets)
    return path


@pytest.fixture
def sheet(dome) -> Mesh:
    """A bent sheet, of which one corner is outside the cube."""
    return replace(dome, vertices=dome.vertices * [0.8, 0.8, 0.8] + [0.3, 0.1, 0.1])


@pytest.mark.parametrize("ending", [".obj", ".npz", ".vtu", ".csv"])
def test_the_surface_goes_with_the_volume(cli, tmp_path, case, cube, sheet, ending):
    out, carried_out, report = tmp_path / "moved.npz", tmp_path / f"sheet{ending}", tmp_path / "report.json"
    surface = write_obj(tmp_path / "sheet-source.obj", sheet)
    outcome = cli("solve", case, "--carry", surface, "--out", out, "--carried-out", carried_out, "--report", report)
    assert outcome.status == 0, outcome.err
    assert "outside the volume" in outcome.err
    carried = carry(sheet, cube)
    moved = carried.at(read_mesh(out).map_positions)
    assert np.abs(moved - sheet.vertices).max() > 0.1
    if ending == ".csv":
        rows = list(csv.DictReader(carried_out.read_text().splitlines()))
        expected = simplex_table(sheet, moved)["symmetric-dirichlet"]
        np.testing.assert_array_equal([float(row["symmetric-dirichlet"]) for row in rows], expected)
    else:
        back = read_mesh(carried_out)
        positions = back.mesh.vertices if ending == ".obj" else back.map_positions
        np.testing.assert_array_equal(positions, moved)
        np.testing.assert_array_equal(back.mesh.simplices, sheet.simplices)
    if ending in (".npz", ".vtu"):
        np.testing.assert_array_equal(back.mesh.vertices, sheet.vertices)
        assert open_source(str(carried_out)).start is None, "a map into space is no start of one to the plane"
        told = cli("signatures", carried_out, "--json").json["maps"][0]
        areas = build_elements(sheet).rest_measures
        expected = simplex_table(sheet, moved)["average-singular-value"] @ areas / areas.sum()
        assert told["mean"] == pytest.approx(expected, rel=1e-9)
    if ending != ".csv":
        of_file = (surface, carried_out) if ending == ".obj" else (carried_out,)
        measured = cli("measure", *of_file, "--json").json
        assert measured["measures"] == strict_json(report.read_text())["carried"]["measures"]
        assert measured["injective"]["local"] is measured["injective"]["global"] is None
    if ending == ".vtu":
        content = meshio.vtu.read(str(carried_out))
        for name, values in simplex_table(sheet, moved).items():
            np.testing.assert_array_equal(content.cell_data[name][0], values)
    told = strict_json(report.read_text())["carried"]
    assert (told["vertices"], told["triangles"]) == (sheet.vertex_count, sheet.simplex_count)
    assert told["outside"] == carried.outside_count > 0
    areas = build_elements(sheet).rest_measures
    own = simplex_table(sheet, moved)["symmetric-dirichlet"] @ areas / areas.sum()
    assert told["measures"]["symmetric-dirichlet"]["area_weighted_mean"] == pytest.approx(own, rel=1e-12)


def test_refusals_write_nothing(cli, tmp_path, case, cube, sheet, square_file):
    solid = tmp_path / "solid.npz"
    write_map(solid, cube, cube, cube.vertices, "volume")
    surface = write_obj(tmp_path / "sheet.obj", sheet)
    for arguments, what in (
        ((case, "--carried-out", tmp_path / "a.obj"), "--carry"),
        ((case, "--carry", solid), "triangles in space"),
        ((case, "--carry", surface, "--carried-out", tmp_path / "a.stl"), "surfaces are written as"),
        ((case, "--carry", surface, "--carried-out", tmp_path / "no" / "a.obj"), "no folder"),
        ((square_file, "--carry", surface), "Only a volume"),
        ((case, "--carry", tmp_path / "missing.obj"), "no file"),
    ):
        outcome = cli("solve", *arguments, "--out", tmp_path / "out.npz")
        assert outcome.status == 2
        assert what in outcome.err
        assert not (tmp_path / "out.npz").exists()
