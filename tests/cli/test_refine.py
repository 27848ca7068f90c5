"""`refine`: what goes in comes out refined, in every format; the curves of Fig. 20; refusals."""

from __future__ import annotations

import json

import numpy as np
import pytest

from tests.cli.conftest import strict_json, write_obj
from workbench.core.refine import FIGURE_20, SCHEMES, refine
from workbench.io.read import read_mesh
from workbench.io.write import write_map, write_mesh


def flattened(mesh):
    """A map of a surface to the plane: its shadow, stretched."""
    return mesh.vertices[:, :2] * [1.5, 0.9]


@pytest.fixture
def mapped_file(tmp_path, dome):
    """A surface with its map as vt."""
    write_map(tmp_path / "mapped.obj", dome, dome, flattened(dome), "parameterize")
    return tmp_path / "mapped.obj"


@pytest.mark.parametrize("scheme", SCHEMES)
def test_an_obj_is_refined_with_its_texture(scheme, cli, dome, mapped_file, tmp_path):
    out = tmp_path / "out.obj"
    result = cli("refine", mapped_file, "--scheme", scheme, "--levels", 2, "--out", out)
    assert result.status == 0 and "128 -> " in result.out and result.err == ""
    expected = refine(dome, flattened(dome), scheme, 2)
    found = read_mesh(out).mesh
    np.testing.assert_array_equal(found.vertices, expected.mesh.vertices)
    np.testing.assert_array_equal(found.simplices, expected.mesh.simplices)
    there = found.texture.coordinates[found.texture.corners]
    np.testing.assert_allclose(there, expected.positions[expected.mesh.simplices], atol=1e-14)


def test_measures_stay_under_linear_refinement(cli, mapped_file, tmp_path):
    out = tmp_path / "out.obj"
    assert cli("refine", mapped_file, "--levels", 2, "--out", out).status == 0
    before, after = (cli("measure", path, "--json").json for path in (mapped_file, out))
    for id, values in before["measures"].items():
        assert after["measures"][id]["area_weighted_mean"] == pytest.approx(values["area_weighted_mean"], rel=1e-12)


@pytest.mark.parametrize("name", ["square", "dome", "cube"])
def test_a_case_keeps_its_maps_and_anchors(name, cli, request, tmp_path):
    mesh = request.getfixturevalue(name)
    d = mesh.dimension
    start, current = mesh.vertices[:, :d] * 1.25, mesh.vertices[:, :d] * 0.75
    anchors, targets = np.array([3, 0]), np.arange(2.0 * d).reshape(2, d)
    case, out = tmp_path / "case.npz", tmp_path / "out.npz"
    np.savez(case, V=mesh.vertices, S=mesh.simplices, X=current, X0=start, anchors=anchors, targets=targets)
    assert cli("refine", case, "--out", out, "--quiet").out == ""
    with np.load(out, allow_pickle=False) as found:
        assert len(found["S"]) == mesh.simplex_count * 2**d
        np.testing.assert_allclose(found["X"], found["V"][:, :d] * 0.75, atol=1e-15)
        np.testing.assert_allclose(found["X0"], found["V"][:, :d] * 1.25, atol=1e-15)
        np.testing.assert_array_equal(found["anchors"], anchors)
        np.testing.assert_array_equal(found["targets"], targets)
        np.testing.assert_array_equal(found["V"][anchors], mesh.vertices[anchors])
    assert read_mesh(out).mesh.simplex_count == mesh.simplex_count * 2**d


def test_plain_meshes_and_closed_samples_are_refined_alone(cli, square_file, tmp_path):
    for source, count in ((square_file, 72 * 36), ("sample:torus", None), ("sample:ball", None)):
        scheme = "linear" if source == "sample:ball" else "catmull-clark"
        for ending in ("obj", "npz", "vtu"):
            out = tmp_path / f"out.{ending}"
            levels = 2 if count else 1
            assert cli("refine", source, "--scheme", scheme, "--levels", levels, "--out", out).status == 0
            found = read_mesh(out, tets=source == "sample:ball").mesh
            assert count is None or found.simplex_count == count
            assert found.texture is None


def test_a_map_in_a_second_file(cli, dome, mapped_file, dome_file, tmp_path):
    out = tmp_path / "out.npz"
    assert cli("refine", dome_file, mapped_file, "--scheme", "loop", "--out", out).status == 0
    with np.load(out, allow_pickle=False) as found:
        np.testing.assert_allclose(found["X"], refine(dome, flattened(dome), "loop", 1).positions, atol=1e-15)


def test_seams_survive_in_obj_and_are_cut_in_a_case(cli, square, tmp_path):
    from dataclasses import replace

    from workbench.core.mesh import TextureCoordinates

    corners = np.arange(square.simplices.size).reshape(-1, 3)
    coordinates = square.vertices[square.simplices].copy()
    coordinates[coordinates[:, :, 0].max(axis=1) > 0.5 + 1e-9] += [10.0, 0.0]
    lifted = np.column_stack([square.vertices, square.vertices[:, 0] ** 2])
    texture = TextureCoordinates(coordinates.reshape(-1, 2), corners)
    write_mesh(tmp_path / "seamed.obj", replace(square, vertices=lifted, texture=texture))
    for ending in ("obj", "npz"):
        out = tmp_path / f"out.{ending}"
        result = cli("refine", tmp_path / "seamed.obj", "--levels", 1, "--out", out)
        assert result.status == 0
        assert ("cut along its texture seams" in result.err) == (ending == "npz")
        before, after = (cli("measure", path, "--json").json for path in (tmp_path / "seamed.obj", out))
        for id in ("arap", "condition-number"):
            wanted = before["measures"][id]["area_weighted_mean"]
            assert after["measures"][id]["area_weighted_mean"] == pytest.approx(wanted, rel=1e-11)
        vertices = read_mesh(out).mesh.vertex_count
        assert vertices == 13 * 13 + (13 if ending == "npz" else 0)


@pytest.mark.parametrize("ending", ["png", "pdf", "svg"])
def test_plots_are_the_same_bytes_each_time(ending, cli, mapped_file, tmp_path):
    plots = [tmp_path / f"{name}.{ending}" for name in ("first", "second")]
    for plot in plots:
        assert cli("refine", mapped_file, "--out", tmp_path / "out.obj", "--plot", plot).status == 0
    content = plots[0].read_bytes()
    assert content == plots[1].read_bytes()
    assert content.startswith({"png": b"\x89PNG", "pdf": b"%PDF", "svg": b"<?xml"}[ending])


def test_the_report_holds_the_curves(cli, dome, mapped_file, tmp_path):
    report = tmp_path / "report.json"
    arguments = ("refine", mapped_file, "--scheme", "loop", "--levels", 2, "--out", tmp_path / "out.obj")
    said = cli(*arguments, "--report", report, "--plot", tmp_path / "p.svg")
    found = strict_json(report.read_text())
    assert (found["schema"], found["scheme"], found["levels"]) == (1, "loop", 2)
    assert set(found["schemes"]) == set(SCHEMES)
    for scheme, factor in (("linear", 4), ("loop", 4), ("catmull-clark", 6)):
        rows = found["schemes"][scheme]
        assert [row["level"] for row in rows] == [0, 1, 2]
        assert [row["simplices"] for row in rows] == [128, 128 * factor, 128 * factor**2]
        assert all(set(row["measures"]) == set(FIGURE_20) and row["inverted"] == 0 for row in rows)
        assert str(128 * factor**2) in said.out
    linear = found["schemes"]["linear"]
    assert linear[2]["measures"] == pytest.approx(linear[0]["measures"], rel=1e-12)
    assert cli(*arguments, "--report", report, "--measure", "sum(sigma^2)", "--measure", "arap").status == 0
    found = json.loads(report.read_text())
    assert list(found["schemes"]) == ["loop"]
    assert list(found["schemes"]["loop"][0]["measures"]) == ["sum(sigma^2)", "arap"]


def test_infinite_distortions_are_null_and_plotted_as_words(cli, square, tmp_path):
    folded = square.vertices.copy()
    folded[24] += 0.6
    case, report, plot = tmp_path / "folded.npz", tmp_path / "r.json", tmp_path / "p.svg"
    np.savez(case, V=square.vertices, S=square.simplices, X=folded)
    arguments = ("--out", tmp_path / "o.npz", "--measure", "symmetric-dirichlet", "--report", report, "--plot", plot)
    assert cli("refine", case, *arguments).status == 0
    rows = strict_json(report.read_text())["schemes"]["linear"]
    assert rows[0]["measures"] == {"symmetric-dirichlet": None}
    assert rows[1]["inverted"] == 4 * rows[0]["inverted"] > 0
    assert "infinite: inverted simplices" in plot.read_text()


REFUSED = [
    (["SQUARE"], "--out"),
    (["SQUARE", "--out", "o.off"], ".obj, .npz, .vtu"),
    (["SQUARE", "--out", "o.obj", "--scheme", "butterfly"], "butterfly"),
    (["SQUARE", "--out", "o.obj", "--levels", "-1"], "-1"),
    (["SQUARE", "--out", "o.obj", "--levels", "1000000000"], "50 million"),
    (["SQUARE", "--out", "o.obj", "--plot", "p.gif"], ".svg"),
    (["SQUARE", "--out", "o.obj", "--plot", "p.svg"], "no map"),
    (["SQUARE", "--out", "o.obj", "--report", "o.obj"], "same name"),
    (["SQUARE", "--out", "o.obj", "--map", "volume"], "tetrahedra"),
    (["SQUARE", "no-such-map.obj", "--out", "o.obj"], "no-such-map.obj"),
    (["SQUARE", "SQUARE", "--out", "o.obj", "--measure", "sum(sigma"], "formula"),
    (["no-such-file.obj", "--out", "o.obj"], "no-such-file.obj"),
    (["sample:bar-3d", "--scheme", "loop", "--out", "o.npz"], "linear"),
    (["CASE3D", "--out", "o.obj"], ".npz"),
    (["CASE3D", "--out", "o.msh"], "no map beside"),
]


@pytest.mark.parametrize(("arguments", "words"), REFUSED, ids=lambda item: " ".join(item) if isinstance(item, list) else "")
def test_refused_with_one_sentence_and_nothing_written(arguments, words, cli, square_file, cube, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    np.savez(tmp_path / "cube.npz", V=cube.vertices, S=cube.simplices, X=cube.vertices)
    before = sorted(tmp_path.iterdir())
    given = {"SQUARE": square_file, "CASE3D": tmp_path / "cube.npz"}
    result = cli("refine", *[given.get(item, item) for item in arguments])
    assert result.status == 2 and result.out == ""
    assert words in result.err and "Traceback" not in result.err
    assert len(result.err.strip().splitlines()) == 1
    assert sorted(tmp_path.iterdir()) == before


def test_the_scheme_ids_of_the_command_are_all_there_are():
    from workbench.cli.refine import SCHEME_IDS

    assert tuple(SCHEMES) == SCHEME_IDS


def test_polygons_and_left_out_anchors_are_mentioned(cli, tmp_path, dome):
    quad = tmp_path / "quad.obj"
    quad.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    assert "fanned" in cli("refine", quad, "--out", tmp_path / "o.obj").err
    case = tmp_path / "case.npz"
    np.savez(case, V=dome.vertices, S=dome.simplices, X=flattened(dome), anchors=[1], targets=[[0.0, 0.0]])
    assert "anchors" in cli("refine", case, "--out", tmp_path / "o.obj").err
    write_obj(tmp_path / "plain.obj", dome)
    assert cli("refine", tmp_path / "plain.obj", "--out", tmp_path / "o.obj").err == ""
