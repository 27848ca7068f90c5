"""`measure` of what is named besides, a row a simplex, and `signatures` of several maps."""

from __future__ import annotations

import csv

import meshio
import numpy as np
import pytest
from scipy import stats

from workbench.core.mesh import Mesh
from workbench.core.registry import registry


@pytest.fixture
def bent(tmp_path, square: Mesh):
    """Three maps of the unit square in files: bent, the same at three times the scale, stretched."""
    x, y = square.vertices.T
    maps = {
        "bent": np.column_stack([x + 0.2 * y**2, y + 0.1 * x * y]),
        "stretched": square.vertices * [2.0, 0.5],
    }
    maps["large"] = 3.0 * maps["bent"]
    for name, positions in maps.items():
        np.savez(tmp_path / f"{name}.npz", V=square.vertices, S=square.simplices, X=positions)
    return tmp_path


def rows(path) -> list[dict[str, str]]:
    with path.open(newline="") as stream:
        return list(csv.DictReader(stream))


def test_distortions_and_formulas_are_measured_besides(cli, bent):
    formula = "t*sum(sigma^2)"
    found = cli(
        "measure", bent / "stretched.npz", "--json", "--distortion", formula, "--distortion", "det", "--set", "t=2"
    ).json["measures"]
    assert set(registry().distortions) < set(found)
    assert found[f"{formula} [t=2]"]["mean"] == pytest.approx(2 * found["dirichlet"]["mean"])
    assert found["det"]["area_weighted_mean"] == pytest.approx(1.0)


def test_a_row_a_simplex(cli, bent, square: Mesh):
    out = bent / "simplices.csv"
    assert cli("measure", bent / "stretched.npz", "--simplices", out, "--distortion", "max(sigma1, 3)").status == 0
    table = rows(out)
    assert [int(row["simplex"]) for row in table] == list(range(square.simplex_count))
    for row in table:
        assert float(row["sigma_1"]) == pytest.approx(2.0) and float(row["sigma_2"]) == pytest.approx(0.5)
        assert float(row["symmetric-dirichlet"]) == pytest.approx(8.5) and float(row["det"]) == pytest.approx(1.0)
        assert float(row["max(sigma1, 3)"]) == 3.0
        assert float(row["inverted"]) == 0.0
    assert sum(float(row["area"]) for row in table) == pytest.approx(1.0)
    fields = bent / "simplices.vtu"
    assert cli("measure", bent / "stretched.npz", "--simplices", fields, "--distortion", "max(sigma1, 3)").status == 0
    content = meshio.vtu.read(str(fields))
    np.testing.assert_array_equal(content.points[:, :2], square.vertices * [2.0, 0.5])
    assert set(content.cell_data) == set(table[0]) - {"simplex"}
    for name, (values,) in content.cell_data.items():
        np.testing.assert_array_equal(values, [float(row[name]) for row in table])


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--distortion", "sigma1 + nothing"], "nothing"),
        (["--distortion", "sigma1", "--set", "t=2"], "'t'"),
        (["--distortion", "sigma3"], "sigma3"),
        (["--simplices", "nowhere/out.csv"], "nowhere"),
    ],
)
def test_what_cannot_be_measured_is_refused_and_nothing_written(cli, bent, options, said):
    before = sorted(path.name for path in bent.iterdir())
    refused = cli("measure", bent / "bent.npz", *options)
    assert refused.status == 2 and said in refused.err
    assert sorted(path.name for path in bent.iterdir()) == before


def test_signatures_of_three_maps(cli, bent, square: Mesh):
    names = ["bent", "large", "stretched"]
    files = [bent / f"{name}.npz" for name in names]
    found = cli(
        "signatures", *files, "--json", "--bins", 20, "--distances", bent / "d.csv", "--histograms", bent / "h.csv"
    ).json
    assert [item["name"] for item in found["maps"]] == names and len(found["edges"]) == 21
    apart = {(pair["a"], pair["b"]): pair for pair in found["distances"]}
    table = rows(bent / "h.csv")
    assert len(table) == 20
    widths = np.diff(found["edges"])
    for name in names:
        assert np.array([float(row[name]) for row in table]) @ widths == pytest.approx(1.0)
    simplices = {}
    for name in names:
        cli("measure", bent / f"{name}.npz", "--simplices", bent / "s.csv")
        simplices[name] = [[float(row[key]) for row in rows(bent / "s.csv")] for key in ("average-singular-value", "area")]
    for row in rows(bent / "d.csv"):
        a, b = row["a"], row["b"]
        expected = stats.wasserstein_distance(simplices[a][0], simplices[b][0], simplices[a][1], simplices[b][1])
        assert float(row["wasserstein1"]) == pytest.approx(expected) == pytest.approx(apart[a, b]["wasserstein1"])
    assert len(apart) == 3
    assert apart["bent", "large"]["wasserstein1"] > 1.0
    normalised = cli("signatures", *files, "--json", "--normalise", "--log").json
    same = next(pair for pair in normalised["distances"] if {pair["a"], pair["b"]} == {"bent", "large"})
    assert same["wasserstein1"] == pytest.approx(0.0, abs=1e-12) and same["l1"] == pytest.approx(0.0, abs=0.1)
    assert "Wasserstein-1" in cli("signatures", *files).out


def test_a_file_without_a_map_has_no_signature(cli, square_file):
    refused = cli("signatures", square_file)
    assert refused.status == 2 and "holds no map" in refused.err
