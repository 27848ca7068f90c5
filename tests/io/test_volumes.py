"""Tetrahedra out of every format, as others write them: with boundaries, regions, leftovers, and faults of all kinds."""

from __future__ import annotations

import re
from pathlib import Path

import meshio
import numpy as np
import pytest
import scipy.io

from workbench.core.errors import MeshError
from workbench.core.mesh import Mesh
from workbench.core.quality import simplex_table
from workbench.io.foreign import silenced
from workbench.io.opening import UnsuitableSourceError, map_from_file, open_source
from workbench.io.read import read_mesh
from workbench.io.write import write_map, write_mesh

BY_MESHIO = {
    "medit.mesh": ("medit", {}),
    "medit.meshb": ("medit", {}),
    "gmsh22-text.msh": ("gmsh22", {"binary": False}),
    "gmsh22.msh": ("gmsh22", {"binary": True}),
    "gmsh41-text.msh": ("gmsh", {"binary": False}),
    "gmsh41.msh": ("gmsh", {"binary": True}),
    "text.vtk": ("vtk", {"binary": False}),
    "old.vtk": ("vtk42", {"binary": True}),
    "new.vtk": ("vtk", {"binary": True}),
    "text.vtu": ("vtu", {"binary": False}),
    "binary.vtu": ("vtu", {"binary": True}),
}
QUADRATIC = [name for name in BY_MESHIO if "medit" not in name]
EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))


def write(path: Path, points: np.ndarray, cells: list[tuple[str, np.ndarray]], **data: object) -> Path:
    name, options = BY_MESHIO[path.name]
    with silenced():
        content = meshio.Mesh(points, cells, **data)
        meshio.write(str(path), content, file_format=name, **options)
    return path


def quadratic(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Points and rows of ten: the corners, then the middles of the edges, numbered before the corners."""
    ends = np.sort(mesh.simplices[:, EDGES].reshape(-1, 2), axis=1)
    edges, number = np.unique(ends, axis=0, return_inverse=True)
    points = np.vstack([mesh.vertices[edges].mean(axis=1), mesh.vertices])
    return points, np.hstack([mesh.simplices + len(edges), number.reshape(-1, 6)])


@pytest.mark.parametrize("name", [name for name in BY_MESHIO if "41" not in name])
def test_tetrahedra_with_their_boundary_are_the_tetrahedra(tmp_path: Path, name: str, cube: Mesh) -> None:
    faces = cube.topology.boundary_facets
    first, last = cube.simplices[:20], cube.simplices[20:]
    tables = [("triangle", faces), ("tetra", first), ("tetra", last)]
    opened = open_source(str(write(tmp_path / name, cube.vertices, tables)))
    assert opened.kind == "volume"
    np.testing.assert_array_equal(opened.mesh.vertices, cube.vertices)
    np.testing.assert_array_equal(opened.mesh.simplices, cube.simplices)
    assert any("left out: triangle" in note for note in opened.notes)


def test_a_gmsh_file_with_points_curves_surfaces_and_bodies(tmp_path: Path) -> None:
    """As Gmsh 4.1 writes it: blocks an entity, tags that do not begin at 1, a point that belongs to no tetrahedron."""
    (tmp_path / "gmsh.msh").write_text(
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
        '$PhysicalNames\n2\n2 1 "skin"\n3 2 "body"\n$EndPhysicalNames\n'
        "$Entities\n1 0 1 2\n1 0 0 0 0\n1 0 0 0 1 1 1 1 1 0\n"
        "1 0 0 0 1 1 1 1 2 0\n2 0 0 0 1 1 1 1 2 0\n$EndEntities\n"
        "$Nodes\n3 6 11 30\n0 1 0 1\n30\n7 7 7\n2 1 0 3\n11\n12\n13\n0 0 0\n1 0 0\n0 1 0\n"
        "3 1 0 2\n20\n21\n0 0 1\n1 1 1\n$EndNodes\n"
        "$Elements\n4 4 1 4\n0 1 15 1\n1 30\n2 1 2 1\n2 11 12 13\n3 1 4 1\n3 11 12 13 20\n3 2 4 1\n4 12 13 20 21\n"
        "$EndElements\n"
    )
    opened = open_source(str(tmp_path / "gmsh.msh"), fixes=("unreferenced",))
    corners = opened.mesh.vertices[opened.mesh.simplices]
    expected = [[[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]]]
    np.testing.assert_array_equal(corners, expected)


@pytest.mark.parametrize("name", QUADRATIC)
def test_quadratic_tetrahedra_are_refused_or_linearised_on_request(tmp_path: Path, name: str, cube: Mesh) -> None:
    points, rows = quadratic(cube)
    path = str(write(tmp_path / name, points, [("tetra10", rows)]))
    with pytest.raises(MeshError, match="higher order") as refusal:
        open_source(path)
    assert refusal.value.fixes == ("linearise",)
    opened = open_source(path, fixes=refusal.value.fixes)
    np.testing.assert_array_equal(opened.mesh.vertices, cube.vertices)
    np.testing.assert_array_equal(opened.mesh.simplices, cube.simplices)
    assert any(f"{len(points) - cube.vertex_count} vertices between corners" in note for note in opened.notes)
    np.testing.assert_array_equal(map_from_file(path, opened.mesh, "volume"), cube.vertices)


def test_vertices_that_were_of_no_element_are_not_dropped_with_the_middles(tmp_path: Path, cube: Mesh) -> None:
    points, rows = quadratic(cube)
    path = str(write(tmp_path / "new.vtk", np.vstack([points, [[9.0, 9.0, 9.0]]]), [("tetra10", rows)]))
    with pytest.raises(UnsuitableSourceError, match="in no tetrahedron"):
        open_source(path, fixes=("linearise",))
    assert open_source(path, fixes=("linearise", "unreferenced")).mesh.vertex_count == cube.vertex_count


def test_regions_are_one_mesh_and_it_is_said(tmp_path: Path, cube: Mesh) -> None:
    marks = [np.repeat([1, 2, 7], cube.simplex_count // 3)]
    for name, key in (("medit.mesh", "medit:ref"), ("gmsh22.msh", "gmsh:physical")):
        path = write(tmp_path / name, cube.vertices, [("tetra", cube.simplices)], cell_data={key: marks})
        found = read_mesh(path)
        np.testing.assert_array_equal(found.mesh.simplices, cube.simplices)
        assert "3 regions" in found.notes[0]


def test_leftover_points_and_negative_tetrahedra(tmp_path: Path, cube: Mesh) -> None:
    points = np.vstack([[[5.0, 5.0, 5.0]], cube.vertices])
    turned = cube.simplices.copy()
    turned[:7] = turned[:7][:, [1, 0, 2, 3]]
    path = str(write(tmp_path / "medit.mesh", points, [("tetra", turned + 1)]))
    with pytest.raises(UnsuitableSourceError) as refusal:
        open_source(path)
    assert refusal.value.fixes == ("unreferenced",)
    opened = open_source(path, fixes=("unreferenced",))
    assert "7 tetrahedra are negatively oriented" in " ".join(opened.lines)
    mended = open_source(path, fixes=("unreferenced", "reorient"))
    assert not len(mended.mesh.topology.negative)
    np.testing.assert_array_equal(mended.mesh.vertices, cube.vertices)


def test_indices_counted_from_the_wrong_end_are_named(tmp_path: Path, cube: Mesh) -> None:
    np.savez(tmp_path / "one.npz", V=cube.vertices, S=cube.simplices + 1)
    with pytest.raises(MeshError, match="subtract 1"):
        read_mesh(tmp_path / "one.npz")
    scipy.io.savemat(tmp_path / "zero.mat", {"V": cube.vertices, "T": cube.simplices})
    with pytest.raises(MeshError, match="add 1"):
        read_mesh(tmp_path / "zero.mat")
    scipy.io.savemat(tmp_path / "right.mat", {"V": cube.vertices, "T": cube.simplices + 1})
    np.testing.assert_array_equal(read_mesh(tmp_path / "right.mat").mesh.simplices, cube.simplices)
    (tmp_path / "zero.mesh").write_text(
        "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\nTetrahedra\n1\n0 1 2 3 0\nEnd\n"
    )
    with pytest.raises(MeshError, match="vertex -1"):
        read_mesh(tmp_path / "zero.mesh")


def test_what_cannot_be_read_is_called_by_its_name(tmp_path: Path, cube: Mesh) -> None:
    path = write(tmp_path / "binary.vtu", cube.vertices, [("tetra", cube.simplices)])
    path.write_bytes(path.read_bytes().replace(b"vtkZLibDataCompressor", b"vtkLZ4DataCompressor"))
    with pytest.raises(MeshError, match="LZ4"):
        read_mesh(path)
    corners = "".join(f"{x} {y} {z} 0\n" for x, y, z in np.random.default_rng(0).random((10, 3)).tolist())
    (tmp_path / "quadratic.mesh").write_text(
        f"MeshVersionFormatted 2\nDimension 3\nVertices\n10\n{corners}TetrahedraP2\n1\n1 2 3 4 5 6 7 8 9 10 0\nEnd\n"
    )
    with pytest.raises(MeshError, match="higher order"):
        read_mesh(tmp_path / "quadratic.mesh")


def test_an_obj_of_tetrahedra_offers_to_be_read_as_such(tmp_path: Path, cube: Mesh, dome: Mesh) -> None:
    path = tmp_path / "cube.obj"
    write_mesh(path, cube)
    with pytest.raises(UnsuitableSourceError, match="--fix tets") as refusal:
        open_source(str(path))
    assert refusal.value.fixes == ("tets",)
    opened = open_source(str(path), fixes=("tets",))
    assert opened.kind == "volume"
    np.testing.assert_array_equal(opened.mesh.simplices, cube.simplices)
    quads = "".join(f"v {x} {y} {x * y}\n" for y in range(3) for x in range(3))
    quads += "".join(f"f {i} {i + 1} {i + 4} {i + 3}\n" for i in (1, 2, 4, 5))
    (tmp_path / "quads.obj").write_text(quads)
    assert open_source(str(tmp_path / "quads.obj")).kind == "parameterize"


@pytest.mark.parametrize("ending", ["obj", "npz", "vtu", "mesh", "msh"])
def test_maps_of_volumes_come_back_to_the_last_digit(tmp_path: Path, ending: str, cube: Mesh) -> None:
    positions = np.random.default_rng(0).normal(size=cube.vertices.shape) * 10.0 ** np.arange(-9, 18)[:, None]
    path = tmp_path / f"map.{ending}"
    write_map(path, cube, cube, positions, "volume")
    np.testing.assert_array_equal(map_from_file(path, cube, "volume"), positions)
    back = read_mesh(path, tets=True)
    np.testing.assert_array_equal(back.mesh.simplices, cube.simplices)
    if ending in ("npz", "vtu"):  # these hold the source beside the map
        np.testing.assert_array_equal(back.mesh.vertices, cube.vertices)
        np.testing.assert_array_equal(back.map_positions, positions)


def test_every_field_of_a_tetrahedron_is_in_the_vtu(tmp_path: Path, cube: Mesh) -> None:
    """Read back by another reader than wrote it, infinite values of barriers among them."""
    pyvista = pytest.importorskip("pyvista")
    positions = cube.vertices.copy()
    positions[13] += [0.7, 0.2, 0.1]  # the middle, out through a side
    table = simplex_table(cube, positions)
    assert np.isinf(table["symmetric-dirichlet"]).any()
    assert 0 < table["inverted"].sum() < cube.simplex_count
    write_map(tmp_path / "map.vtu", cube, cube, positions, "volume")
    grid = pyvista.read(tmp_path / "map.vtu")
    np.testing.assert_array_equal(grid.points, positions)
    np.testing.assert_array_equal(grid.point_data["source"], cube.vertices)
    np.testing.assert_array_equal(grid.cells.reshape(-1, 5)[:, 1:], cube.simplices)
    assert (
        set(grid.cell_data.keys())
        == set(table)
        >= {"sigma_1", "sigma_2", "sigma_3", "det", "inverted", "volume", "source_volume"}
    )
    for name, values in table.items():
        np.testing.assert_array_equal(grid.cell_data[name], values)
    np.testing.assert_allclose(table["source_volume"].sum(), 1.0)


@pytest.mark.parametrize("name", BY_MESHIO)
def test_no_broken_byte_ends_the_program(tmp_path: Path, name: str, cube: Mesh, capfd: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path / name, cube.vertices, [("tetra", cube.simplices)])
    data = bytearray(path.read_bytes())
    rng = np.random.default_rng(len(data))
    for trial in range(12):
        broken = bytearray(data)
        for place in rng.integers(0, len(data), 1 + trial % 4):
            broken[place] = rng.integers(256)
        if trial % 3 == 0:
            del broken[int(rng.integers(len(data))) :]
        path.write_bytes(bytes(broken) or b" ")
        try:
            read_mesh(path, linearise=bool(trial % 2))
        except MeshError as error:
            assert re.match(rf"{re.escape(str(path))}[ :,]", error.sentence)
    assert capfd.readouterr() == ("", "")


def test_the_quadratic_trial_mesh(data_folder: Path) -> None:
    path = str(data_folder / "polyfem-data/3D/P2.msh")
    opened = open_source(path, fixes=("linearise",))
    assert opened.kind == "volume"
    assert opened.mesh.simplex_count == 30
    assert not len(opened.mesh.topology.unreferenced)
