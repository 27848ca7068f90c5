"""What the command line says of maps of solids is what a few lines of linear algebra find."""

from __future__ import annotations

import csv
from pathlib import Path

import meshio
import numpy as np
import pytest

from tests.cli.conftest import Outcome, strict_json
from workbench.core.mesh import Mesh
from workbench.core.refine import refine
from workbench.io.read import read_mesh


@pytest.fixture
def bent(tmp_path: Path, cube: Mesh) -> Path:
    """The unit cube, bent, in a case; one tetrahedron of it is stored with its corners in negative order."""
    x, y, z = cube.vertices.T
    moved = np.column_stack([x + 0.2 * y * z, 1.3 * y - 0.1 * x**2, 0.8 * z + 0.15 * x * y])
    simplices = cube.simplices.copy()
    simplices[5] = simplices[5, [1, 0, 2, 3]]
    np.savez(tmp_path / "bent.npz", V=cube.vertices, S=simplices, X=moved)
    return tmp_path / "bent.npz"


def algebra(path: Path) -> dict[str, np.ndarray]:
    """Jacobians by solving three equations each, singular values by LAPACK."""
    file = read_mesh(path)
    rest, now = (v[file.mesh.simplices] for v in (file.mesh.vertices, file.map_positions))
    before, after = (np.swapaxes(p[:, 1:] - p[:, :1], 1, 2) for p in (rest, now))
    jacobian = after @ np.linalg.inv(before)
    sigma = np.linalg.svd(jacobian, compute_uv=False)
    det = np.linalg.det(jacobian)
    return {"sigma": sigma, "det": det, "volume": np.abs(np.linalg.det(before)) / 6.0}


def formulas(sigma: np.ndarray, det: np.ndarray) -> dict[str, np.ndarray]:
    """Equations (25) to (37), (78) and (84) in three dimensions, written out."""
    s1, s2, s3 = sigma.T
    squares = (sigma**2).sum(axis=1)
    inner, outer = s1 * s2 / s3**2, s1**2 / (s2 * s3)
    mips = squares / (s1 * s2 * s3) ** (2 / 3)
    return {
        "dirichlet": squares,
        "mips": mips,
        "condition-number": s1 / s3,
        "qc-inner": inner,
        "qc-outer": outer,
        "qc-dilatation": np.maximum(inner, outer),
        "volume": np.maximum(np.abs(det), 1 / np.abs(det)),
        "symmetric-dirichlet": squares + (1 / sigma**2).sum(axis=1),
        "arap": ((sigma - 1) ** 2).sum(axis=1),
        "symmetric-arap": (s1 - 1) ** 2 + (1 / s3 - 1) ** 2,
        "amips": np.exp(mips + 0.5 * np.maximum(det, 1 / det)),
        "quasi-isometric": np.maximum(s1, 1 / s3),
        "average-singular-value": sigma.mean(axis=1),
        "spectral": s1,
    }


def test_every_number_of_a_solid(cli, bent: Path, tmp_path: Path) -> None:
    found = cli("measure", bent, "--json", "--simplices", tmp_path / "rows.csv").json
    known = algebra(bent)
    for id, values in formulas(known["sigma"], known["det"]).items():
        numbers = found["measures"][id]
        expected = {
            "mean": values.mean(), "max": values.max(), "min": values.min(),
            "area_weighted_mean": values @ known["volume"] / known["volume"].sum(),
        }  # fmt: skip
        for name, value in expected.items():
            assert numbers[name] == pytest.approx(value, rel=1e-11), (id, name)
    assert found["inverted"] == found["degenerate"] == 0
    assert found["min_det"] == pytest.approx(known["det"].min(), rel=1e-12)
    assert sum(found["histogram78"]["counts"]) == len(known["det"])
    rows = list(csv.DictReader((tmp_path / "rows.csv").read_text().splitlines()))
    columns = {"det": known["det"], "source_volume": known["volume"], "sigma_3": known["sigma"][:, 2]}
    for column, values in (columns | formulas(known["sigma"], known["det"])).items():
        np.testing.assert_allclose([float(row[column]) for row in rows], values, rtol=1e-11)


def test_linear_refinement_changes_no_number_of_a_solid(cli, bent: Path, tmp_path: Path) -> None:
    """Theorem 9.1, for every distortion at once; eight tetrahedra a tetrahedron, volumes an eighth."""
    fine = tmp_path / "fine.npz"
    assert cli("refine", bent, "--scheme", "linear", "--levels", 1, "--out", fine).status == 0
    before, after = (cli("measure", path, "--json").json for path in (bent, fine))
    for id, numbers in before["measures"].items():
        for name in ("area_weighted_mean", "min", "max"):
            assert after["measures"][id][name] == pytest.approx(numbers[name], rel=1e-11), (id, name)
    assert after["injective"] == before["injective"]
    assert read_mesh(fine).mesh.simplex_count == 8 * read_mesh(bent).mesh.simplex_count


@pytest.mark.parametrize("ending", ["obj", "npz", "vtu", "mesh", "msh"])
def test_a_refined_solid_comes_back(cli, tmp_path: Path, cube: Mesh, ending: str) -> None:
    np.savez(tmp_path / "cube.npz", V=cube.vertices, S=cube.simplices)
    out = tmp_path / f"fine.{ending}"
    assert cli("refine", tmp_path / "cube.npz", "--scheme", "linear", "--out", out).status == 0
    fine = read_mesh(out, tets=True).mesh
    expected = refine(cube, None, "linear", 1).mesh
    np.testing.assert_array_equal(fine.vertices, expected.vertices)
    np.testing.assert_array_equal(fine.simplices, expected.simplices)


def test_an_inverted_tetrahedron_is_counted_and_told(cli, cube: Mesh, tmp_path: Path) -> None:
    moved = cube.vertices.copy()
    moved[13] += [0.7, 0.1, 0.05]  # the middle, out through a side
    np.savez(tmp_path / "torn.npz", V=cube.vertices, S=cube.simplices, X=moved)
    found = cli("measure", tmp_path / "torn.npz", "--json").json
    count = int((algebra(tmp_path / "torn.npz")["det"] <= 0).sum())
    assert found["inverted"] == count > 0
    assert found["injective"]["local"] is found["injective"]["global"] is False
    assert found["measures"]["symmetric-dirichlet"]["max"] is None, "infinite"
    assert found["measures"]["dirichlet"]["max"] > 0, "no barrier, no infinity"


def test_report_measure_and_signature_of_a_solved_solid_agree(cli, bent: Path, tmp_path: Path) -> None:
    anchors, out, report = tmp_path / "a.csv", tmp_path / "out.vtu", tmp_path / "r.json"
    anchors.write_text("vertex,x,y,z\n0,0,0,0\n2,0,0,1.4\n24,1.2,1,0\n")
    solved: Outcome = cli("solve", bent, "--anchors", anchors, "--out", out, "--report", report)
    assert solved.status == 0, solved.err
    told = strict_json(report.read_text())
    found = cli("measure", out, "--json").json
    assert told["mean_distortion"] == pytest.approx(found["measures"]["symmetric-dirichlet"]["area_weighted_mean"], rel=1e-12)
    assert told["min_det"] == pytest.approx(found["min_det"], rel=1e-12)
    assert told["injective"] == {name: found["injective"][name] for name in ("local", "global")}
    assert (told["input"]["kind"], told["input"]["simplices"]) == ("volume", 48)
    signature = cli("signatures", out, bent, "--json").json["maps"]
    assert signature[0]["mean"] == pytest.approx(found["measures"]["average-singular-value"]["area_weighted_mean"], rel=1e-12)


@pytest.mark.parametrize(
    ("distortion", "settings", "name"),
    [
        ("sum(sigma^2) + t/det", ["t=0.5"], "sum(sigma^2) + t/det [t=0.5]"),
        ("lp-gauge", ["p=4"], "lp-gauge [p=4]"),
        ("arap", [], "arap"),
    ],
)
def test_what_was_minimised_is_a_field_of_the_file(cli, bent: Path, tmp_path: Path, distortion, settings, name) -> None:
    out, report = tmp_path / "out.vtu", tmp_path / "r.json"
    options = [item for setting in settings for item in ("--set", setting)]
    given = ("solve", bent, "--distortion", distortion, *options, "--iterations", 1, "--out", out, "--report", report)
    assert cli(*given).status in (0, 1)
    fields = meshio.vtu.read(str(out)).cell_data
    energy = fields[name][0] @ fields["source_volume"][0]
    assert energy == pytest.approx(strict_json(report.read_text())["energy"], rel=1e-11)
