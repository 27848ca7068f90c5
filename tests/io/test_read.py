"""Every other format: what is written by others is read, and nothing broken ends the program."""

from __future__ import annotations

import os
import re
import resource
import sys
import threading
import warnings
from pathlib import Path

import meshio
import numpy as np
import pytest
import scipy.io

from workbench.core.errors import MeshError
from workbench.io import cases
from workbench.io.foreign import silenced
from workbench.io.memory_limit import limited_memory
from workbench.io.read import READABLE, read_mesh

POINTS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0], [1, 1, 1]])
TRIANGLES = np.array([[0, 1, 2], [0, 2, 3], [1, 4, 2]])
QUADS = np.array([[0, 1, 4, 2]])
TETRAHEDRA = np.array([[0, 1, 2, 3], [1, 2, 3, 4]])

FOREIGN = {
    "ascii.ply": ("ply", {"binary": False}),
    "binary.ply": ("ply", {"binary": True}),
    "medit.mesh": ("medit", {}),
    "medit.meshb": ("medit", {}),
    "gmsh41.msh": ("gmsh", {"binary": True}),
    "gmsh22.msh": ("gmsh22", {"binary": False}),
    "ascii.vtk": ("vtk", {"binary": False}),
    "binary.vtk": ("vtk", {"binary": True}),
    "binary.vtu": ("vtu", {"binary": True}),
    "ascii.vtu": ("vtu", {"binary": False}),
}


def write(path: Path, cells: list[tuple[str, np.ndarray]]) -> Path:
    format_name, options = FOREIGN[path.name]
    with silenced():
        meshio.write(str(path), meshio.Mesh(POINTS, cells), file_format=format_name, **options)
    return path


@pytest.mark.parametrize("name", FOREIGN)
def test_triangles(tmp_path: Path, name: str) -> None:
    mesh = read_mesh(write(tmp_path / name, [("triangle", TRIANGLES)])).mesh
    np.testing.assert_allclose(mesh.vertices, POINTS)
    np.testing.assert_array_equal(mesh.simplices, TRIANGLES)


@pytest.mark.parametrize("name", [name for name in FOREIGN if "ply" not in name and "41" not in name])
def test_tetrahedra_come_before_triangles(tmp_path: Path, name: str) -> None:
    found = read_mesh(write(tmp_path / name, [("triangle", TRIANGLES), ("tetra", TETRAHEDRA)]))
    np.testing.assert_array_equal(found.mesh.simplices, TETRAHEDRA)
    assert "triangle" in found.notes[0]


@pytest.mark.parametrize("name", ["ascii.ply", "medit.mesh", "binary.vtk", "binary.vtu"])
def test_quads_are_fanned(tmp_path: Path, name: str) -> None:
    mesh = read_mesh(write(tmp_path / name, [("quad", QUADS)])).mesh
    assert mesh.simplices.tolist() == [[0, 1, 4], [0, 4, 2]]
    assert mesh.polygons is not None
    assert mesh.polygons.tolist() == [0, 0]


@pytest.mark.parametrize("name", FOREIGN)
@pytest.mark.parametrize("part", [0.1, 0.5, 0.8])
def test_cut_short(tmp_path: Path, name: str, part: float, capfd: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path / name, [("triangle", TRIANGLES)])
    data = path.read_bytes()
    path.write_bytes(data[: int(part * len(data))])
    with pytest.raises(MeshError, match=re.escape(name)):
        read_mesh(path)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("ending", READABLE)
@pytest.mark.parametrize("data", [b"", b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR", b"hello\n", b"OFF\n", b"ply\n", b"solid\n"])
def test_what_the_name_promises_is_not_there(
    tmp_path: Path, ending: str, data: bytes, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / f"odd{ending}"
    path.write_bytes(data)
    with pytest.raises(MeshError, match="odd"):
        read_mesh(path)
    assert capfd.readouterr() == ("", "")


def test_promises_of_size_are_not_believed(tmp_path: Path) -> None:
    huge = 4_000_000_000_000
    (tmp_path / "huge.off").write_text(f"OFF\n{huge} 1 0\n0 0 0\n")
    (tmp_path / "huge.ply").write_text(
        f"ply\nformat binary_little_endian 1.0\nelement vertex {huge}\nproperty float x\nproperty float y\n"
        f"property float z\nelement face {huge}\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n"
    )
    (tmp_path / "huge.mesh").write_text(f"MeshVersionFormatted 2\nDimension 3\nVertices\n{huge}\n0 0 0 0\nEnd\n")
    for name in ("huge.off", "huge.ply", "huge.mesh"):
        with pytest.raises(MeshError):
            read_mesh(tmp_path / name)


def test_a_tag_or_count_out_of_all_proportion_is_refused_at_once(tmp_path: Path) -> None:
    points = "1 0 0 0\n2 1 0 0\n{tag} 0 1 0\n"
    texts = {
        "tag.msh": "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 3 1 {tag}\n2 1 0 3\n1\n2\n{tag}\n0 0 0\n1 0 0\n0 1 0\n"
        "$EndNodes\n$Elements\n1 1 1 1\n2 1 2 1\n1 1 2 {tag}\n$EndElements\n",
        "tag2.msh": "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n3\n" + points + "$EndNodes\n$Elements\n1\n"
        "1 2 2 0 1 1 2 {tag}\n$EndElements\n",
        "faces.ply": "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
        "property float z\nelement face {tag}\nproperty list uchar int vertex_indices\nend_header\nabcdefghijkl",
    }
    for name, text in texts.items():
        (tmp_path / name).write_text(text.format(tag=30_000_000_000))
        with pytest.raises(MeshError, match=name):
            read_mesh(tmp_path / name)


def test_places_that_are_no_files(tmp_path: Path) -> None:
    folder = tmp_path / "folder.obj"
    folder.mkdir()
    pipe = tmp_path / "pipe.obj"
    os.mkfifo(pipe)
    for path, what in (
        (folder, "folder"),
        (pipe, "ordinary"),
        (tmp_path / "missing.obj", "no file"),
        (tmp_path / "a\0b.obj", "cannot be read"),
        (tmp_path / ("x" * 300 + ".obj"), "cannot be read"),
    ):
        with pytest.raises(MeshError, match=what):
            read_mesh(path)
    other = tmp_path / "mesh.xyz"
    other.write_text("0 0 0\n")
    with pytest.raises(MeshError, match=r"\.xyz is not known"):
        read_mesh(other)


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="permissions do not bind the superuser")
def test_no_permission(tmp_path: Path) -> None:
    path = tmp_path / "secret.obj"
    path.write_text("v 0 0 0\n")
    path.chmod(0)
    with pytest.raises(MeshError, match="permission"):
        read_mesh(path)


def test_off_with_colours_comments_and_polygons(tmp_path: Path) -> None:
    path = tmp_path / "a.off"
    path.write_text("# made by hand\nCOFF 4 2 0\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1 # red\n\n1 1 0 0 0 0 1\n0 1 0 0 0 0 1\n"
                    "4 0 1 2 3 0.5 0.5 0.5\n3 0 1 2\n")  # fmt: skip
    mesh = read_mesh(path).mesh
    assert mesh.vertices[2].tolist() == [1, 1, 0]
    assert mesh.simplices.tolist() == [[0, 1, 2], [0, 2, 3], [0, 1, 2]]
    assert mesh.polygons is not None
    assert mesh.polygons.tolist() == [0, 0, 1]


@pytest.mark.parametrize("binary", [True, False])
def test_stl_merges_equal_vertices(tmp_path: Path, binary: bool) -> None:
    path = tmp_path / "a.stl"
    with silenced():
        meshio.write(str(path), meshio.Mesh(POINTS, [("triangle", TRIANGLES)]), file_format="stl", binary=binary)
    mesh = read_mesh(path).mesh
    np.testing.assert_array_equal(mesh.vertices[mesh.simplices], POINTS[TRIANGLES])
    assert mesh.vertex_count == 5
    if binary:
        path.write_bytes(b"solid" + path.read_bytes()[5:])
        np.testing.assert_array_equal(read_mesh(path).mesh.simplices, mesh.simplices)


def test_a_broken_number_or_index_in_any_format(tmp_path: Path) -> None:
    for name in FOREIGN:
        bad = POINTS.copy()
        bad[2, 1] = np.nan
        format_name, options = FOREIGN[name]
        path = tmp_path / name
        with silenced():
            meshio.write(str(path), meshio.Mesh(bad, [("triangle", TRIANGLES)]), file_format=format_name, **options)
        with pytest.raises(MeshError):
            read_mesh(path)
    (tmp_path / "a.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n")
    with pytest.raises(MeshError, match="vertex 7"):
        read_mesh(tmp_path / "a.off")


def test_quadratic_elements_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "quadratic.vtu"
    points = np.random.default_rng(0).normal(size=(10, 3))
    with silenced():
        meshio.write(str(path), meshio.Mesh(points, [("tetra10", np.arange(10)[None])]))
    with pytest.raises(MeshError, match="higher order"):
        read_mesh(path)


def save_case(path: Path, **arrays: object) -> Path:
    known = {"V": POINTS, "S": TETRAHEDRA, "X0": POINTS + 1, "anchors": [0, 3], "targets": POINTS[[0, 3]]}
    np.savez(path, **{k: np.asarray(v) for k, v in {**known, **arrays}.items() if v is not None})
    return path


def test_cases(tmp_path: Path) -> None:
    found = read_mesh(save_case(tmp_path / "case.npz", X=POINTS + 2))
    np.testing.assert_array_equal(found.mesh.simplices, TETRAHEDRA)
    assert found.start is not None
    assert found.map_positions is not None
    np.testing.assert_array_equal(found.start, POINTS + 1)
    np.testing.assert_array_equal(found.map_positions, POINTS + 2)
    assert found.anchor_vertices is not None
    assert found.anchor_vertices.tolist() == [0, 3]
    bare = read_mesh(save_case(tmp_path / "bare.npz", X0=None, anchors=None, targets=None))
    assert bare.start is bare.anchor_vertices is bare.anchor_targets is None
    empty = read_mesh(save_case(tmp_path / "empty.npz", anchors=np.empty(0, int), targets=np.empty((0, 3))))
    assert empty.anchor_vertices is not None
    assert not len(empty.anchor_vertices)


@pytest.mark.parametrize(
    ("arrays", "what"),
    [
        ({"V": None}, "V is missing"),
        ({"S": None}, "S is missing"),
        ({"V": np.array([["a", "b"]])}, "numbers"),
        ({"V": POINTS[:, 0]}, "shape"),
        ({"V": np.where(POINTS == 1, np.inf, POINTS)}, "not finite"),
        ({"S": TETRAHEDRA + 1}, "names vertex 5"),
        ({"S": TETRAHEDRA - 1}, "names vertex -1"),
        ({"S": TETRAHEDRA + 0.5}, "whole"),
        ({"S": TETRAHEDRA * 1e30}, "too large"),
        ({"X0": POINTS[:3]}, "X0 has shape"),
        ({"X": POINTS * 1e150, "X0": None}, "beyond"),
        ({"anchors": [0, 9]}, "vertex 9"),
        ({"anchors": [3, 3]}, "twice"),
        ({"targets": POINTS[:1]}, "targets has shape"),
        ({"targets": None}, "only one"),
        ({"V": np.array([{}], dtype=object)}, "cannot be read"),
    ],
)
def test_broken_cases(tmp_path: Path, arrays: dict[str, object], what: str) -> None:
    with pytest.raises(MeshError, match=what):
        read_mesh(save_case(tmp_path / "case.npz", **arrays))


def test_a_small_file_does_not_fill_the_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bomb = tmp_path / "bomb.npz"
    np.savez_compressed(bomb, V=POINTS, S=TETRAHEDRA, other=np.zeros(1_000_000))
    assert read_mesh(bomb).mesh.vertex_count == len(POINTS)  # a few megabytes do no harm
    monkeypatch.setattr(cases, "SMALL_UNPACKED", 2**20)
    with pytest.raises(MeshError, match="unpack"):
        read_mesh(bomb)


def test_two_readers_at_once_leave_console_and_memory_as_they_were() -> None:
    first_in, second_in, first_out = threading.Event(), threading.Event(), threading.Event()

    def first() -> None:
        with silenced(), limited_memory(0):
            first_in.set()
            second_in.wait(0.2)
        first_out.set()

    def second() -> None:
        first_in.wait(10.0)
        with silenced(), limited_memory(0):
            second_in.set()
            first_out.wait(0.2)

    before = sys.stdout, sys.stderr, warnings.filters[:], resource.getrlimit(resource.RLIMIT_AS)
    threads = [threading.Thread(target=deed) for deed in (first, second)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert (sys.stdout, sys.stderr, warnings.filters, resource.getrlimit(resource.RLIMIT_AS)) == before


def test_matlab_counts_from_one(tmp_path: Path) -> None:
    path = tmp_path / "a.mat"
    scipy.io.savemat(path, {"V": POINTS, "T": (TETRAHEDRA + 1).astype(np.uint16), "fV": POINTS + 1})
    found = read_mesh(path)
    np.testing.assert_array_equal(found.mesh.simplices, TETRAHEDRA)
    assert found.start is not None
    np.testing.assert_array_equal(found.start, POINTS + 1)
    scipy.io.savemat(path, {"V": POINTS, "F": TRIANGLES})
    with pytest.raises(MeshError, match="vertex -1"):
        read_mesh(path)
    scipy.io.savemat(path, {"fV": POINTS})
    with pytest.raises(MeshError, match="fV"):
        read_mesh(path)


def test_every_trial_mesh_is_read_or_refused_with_a_sentence(data_folder: Path) -> None:
    refused = set()
    for path in sorted(p for p in data_folder.rglob("*") if p.suffix in READABLE):
        try:
            read_mesh(path)
        except MeshError as error:
            assert str(path) in error.sentence
            refused.add(path.name)
    assert refused == {
        "P2.msh", "bar_30K_anchors.mat", "octupus_6K_initialization.mat", "twisted_3d_bar_30K_t.mat",
    }  # fmt: skip
