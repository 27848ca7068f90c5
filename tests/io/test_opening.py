"""From a path to the source: cases, samples, refusals with their report, maps from files."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest

from workbench.core.errors import MeshError
from workbench.core.mesh import Mesh
from workbench.io.opening import UnsuitableSourceError, map_from_file, open_source
from workbench.io.write import write_mesh


def test_a_flat_file_is_a_plane_of_two_columns(tmp_path: Path, square: Mesh) -> None:
    write_mesh(tmp_path / "square.obj", square)
    opened = open_source(str(tmp_path / "square.obj"))
    assert opened.kind == "plane"
    np.testing.assert_array_equal(opened.mesh.vertices, square.vertices)
    assert opened.file.mesh.vertices.shape[1] == 3
    assert opened.file.format == "OBJ"
    assert len(opened.file.sha256) == 64
    assert "a disc" in " ".join(opened.lines)
    assert open_source(str(tmp_path / "square.obj"), kind="parameterize").mesh.vertices.shape[1] == 3


def test_a_refusal_brings_the_report_and_survives_a_pipe(tmp_path: Path, dome: Mesh) -> None:
    parts = Mesh(np.vstack([dome.vertices, dome.vertices + 3]), np.vstack([dome.simplices, dome.simplices + 81]))
    write_mesh(tmp_path / "two.obj", parts)
    with pytest.raises(UnsuitableSourceError) as refusal:
        open_source(str(tmp_path / "two.obj"))
    for error in (refusal.value, pickle.loads(pickle.dumps(refusal.value))):
        assert error.fixes == ("largest",)
        assert "2 components" in error.sentence
        assert "2 components" in error.lines[0]
    opened = open_source(str(tmp_path / "two.obj"), fixes=("largest",))
    assert any("largest" in note for note in opened.notes)
    assert opened.mesh.vertex_origin is not None


def test_a_refusal_after_some_fixes_names_all_that_are_needed(tmp_path: Path) -> None:
    """A one-sided band: cut open it is a disc whose triangles have yet to be turned; without the cut that does not help."""
    turn = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
    sides = [(2.0 + w * np.cos(turn / 2)) for w in (-0.4, 0.4)]
    band = [
        np.column_stack([r * np.cos(turn), r * np.sin(turn), w * np.sin(turn / 2)])
        for r, w in zip(sides, (-0.4, 0.4), strict=True)
    ]
    low, high = np.arange(12), np.arange(12, 24)
    next_low, next_high = np.append(low[1:], 12), np.append(high[1:], 0)
    triangles = np.vstack([np.column_stack([low, next_low, next_high]), np.column_stack([low, next_high, high])])
    write_mesh(tmp_path / "band.obj", Mesh(np.vstack(band), triangles))
    with pytest.raises(UnsuitableSourceError, match=r"apply --fix cut,reorient\.") as refusal:
        open_source(str(tmp_path / "band.obj"), fixes=("cut",))
    assert refusal.value.fixes == ("reorient",)
    assert open_source(str(tmp_path / "band.obj"), fixes=("cut", "reorient")).mesh.topology.is_disc


def test_cut_edges_lie_on_the_boundary(data_folder: Path) -> None:
    opened = open_source(str(data_folder / "OptCuts/robustness/torus.obj"), fixes=("cut",))
    boundary = set(map(tuple, opened.mesh.topology.boundary_facets.tolist()))
    assert set(map(tuple, opened.cut_edges.tolist())) == boundary


def test_cases_bring_start_and_anchors(data_folder: Path) -> None:
    for name, kind, anchors in (
        ("abcd_elephant_2k", "plane", 412), ("abcd_octopus_6k", "parameterize", 8),
        ("abcd_twisted_bar_30k", "volume", 242), ("aqp_gecko", "plane", 60),
    ):  # fmt: skip
        opened = open_source(str(data_folder / f"cases/{name}.npz"))
        columns = 3 if kind == "volume" else 2
        assert opened.kind == kind
        assert opened.start is not None
        assert opened.start.shape == (opened.mesh.vertex_count, columns)
        assert opened.anchor_vertices is not None
        assert opened.anchor_targets is not None
        assert opened.anchor_targets.shape == (anchors, columns)


def test_the_same_case_in_the_files_of_its_authors(data_folder: Path) -> None:
    """The start stands as positions in one file and as X0 in the case; the texture of the first is its rest."""
    folder = data_folder / "ABCD_Algorithm"
    elephant = open_source(str(folder / "elephant_2K_s.obj"))
    case = data_folder / "cases/abcd_elephant_2k.npz"
    rest = map_from_file(folder / "elephant_2K_s.obj", elephant.mesh, "plane")
    np.testing.assert_array_equal(rest, elephant.mesh.vertices)
    for path in (folder / "elephant_2K_t.obj", case):
        start = map_from_file(path, elephant.mesh, "plane")
        np.testing.assert_allclose(start, open_source(str(case)).start, atol=1e-6)
    octopus = open_source(str(folder / "octupus_6K.obj"))
    start = map_from_file(folder / "octupus_6K_initialization.mat", octopus.mesh, "parameterize")
    np.testing.assert_allclose(start, open_source(str(data_folder / "cases/abcd_octopus_6k.npz")).start)
    texture = map_from_file(folder / "octupus_6K.obj", octopus.mesh, "parameterize")
    assert texture.shape == start.shape
    bar = open_source(str(folder / "twisted_3d_bar_30K_s.mat"))
    start = map_from_file(folder / "twisted_3d_bar_30K_t.mat", bar.mesh, "volume")
    np.testing.assert_allclose(start, open_source(str(data_folder / "cases/abcd_twisted_bar_30k.npz")).start)


def test_maps_that_do_not_fit_are_refused(tmp_path: Path, square: Mesh, dome: Mesh, cube: Mesh) -> None:
    write_mesh(tmp_path / "dome.obj", dome)
    write_mesh(tmp_path / "cube.obj", cube)
    np.savez(tmp_path / "few.npz", X=np.zeros((5, 2)))
    np.savez(tmp_path / "flat.npz", X=np.zeros((cube.vertex_count, 2)))
    np.savez(tmp_path / "none.npz", Y=np.zeros((5, 2)))
    for name, mesh, kind, what in (
        ("dome.obj", dome, "parameterize", "not flat"),
        ("dome.obj", square, "plane", "81 positions"),
        ("cube.obj", dome, "parameterize", "positions"),
        ("few.npz", dome, "parameterize", "5 positions"),
        ("flat.npz", cube, "volume", "three columns"),
        ("none.npz", dome, "parameterize", "no positions"),
    ):
        with pytest.raises(MeshError, match=what):
            map_from_file(tmp_path / name, mesh, kind)  # type: ignore[arg-type]


def test_unknown_samples_name_the_known() -> None:
    samples = pytest.importorskip("workbench.core.samples")
    with pytest.raises(MeshError, match=samples.sample_ids()[0]):
        open_source("sample:nothing")
    opened = open_source(f"sample:{samples.sample_ids()[0]}")
    assert opened.file.path.startswith("sample:")
    assert opened.start is None
