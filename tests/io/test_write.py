"""What is written reads back as the same arrays, and is whole or not there."""

from __future__ import annotations

import csv
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest

from workbench.core.errors import WorkbenchError
from workbench.core.fixes import apply_fixes
from workbench.core.kinds import source_for_kind
from workbench.core.mesh import Mesh
from workbench.io.atomic import replacing, write_text
from workbench.io.opening import map_from_file, open_source
from workbench.io.read import read_mesh
from workbench.io.write import write_map, write_mesh

AWKWARD = np.array([1 / 3, 1e-300, -0.1, 123456789.123456789, np.pi, 5e-17])


def awkward(rows: int, columns: int) -> np.ndarray:
    return np.resize(AWKWARD, (rows, columns)) + np.arange(rows)[:, None] * 0.7


def test_parameterize_keeps_vertices_and_faces(tmp_path: Path, dome: Mesh) -> None:
    positions = awkward(dome.vertex_count, 2)
    write_map(tmp_path / "map.obj", dome, dome, positions, "parameterize")
    back = read_mesh(tmp_path / "map.obj").mesh
    np.testing.assert_array_equal(back.vertices, dome.vertices)
    np.testing.assert_array_equal(back.simplices, dome.simplices)
    assert back.texture is not None
    np.testing.assert_array_equal(back.texture.coordinates, positions)
    np.testing.assert_array_equal(back.texture.corners, dome.simplices)
    np.testing.assert_array_equal(map_from_file(tmp_path / "map.obj", dome, "parameterize"), positions)


@pytest.mark.parametrize("z", [None, 0.0, 0.1])
def test_plane_writes_positions_in_the_plane_of_the_file(tmp_path: Path, square: Mesh, z: float | None) -> None:
    column = [] if z is None else [np.full(square.vertex_count, z)]
    file_mesh = Mesh(np.column_stack([square.vertices, *column]), square.simplices)
    positions = awkward(square.vertex_count, 2)
    write_map(tmp_path / "map.obj", file_mesh, source_for_kind(file_mesh, "plane"), positions, "plane")
    back = read_mesh(tmp_path / "map.obj").mesh
    np.testing.assert_array_equal(back.vertices, np.column_stack([positions, np.full(square.vertex_count, z or 0.0)]))
    np.testing.assert_array_equal(back.simplices, square.simplices)
    np.testing.assert_array_equal(map_from_file(tmp_path / "map.obj", square, "plane"), positions)


def test_plane_in_space_goes_back_to_its_plane(tmp_path: Path, square: Mesh) -> None:
    turn, _ = np.linalg.qr(np.array([[2.0, 1, 0.5], [-1, 3, 1], [0.2, -1, 2]]))
    space = np.column_stack([square.vertices, np.zeros(square.vertex_count)]) @ turn + 4.0
    file_mesh = Mesh(space, square.simplices)
    source = source_for_kind(file_mesh, "plane")
    write_map(tmp_path / "rest.obj", file_mesh, source, source.vertices, "plane")
    np.testing.assert_allclose(read_mesh(tmp_path / "rest.obj").mesh.vertices, space, atol=1e-14)
    moved = source.vertices * [2.0, 0.5] + 1.0
    write_map(tmp_path / "moved.obj", file_mesh, source, moved, "plane")
    np.testing.assert_allclose(map_from_file(tmp_path / "moved.obj", source, "plane"), moved, atol=1e-13)


def test_volume_as_faces_of_four_corners(tmp_path: Path, cube: Mesh) -> None:
    positions = awkward(cube.vertex_count, 3)
    write_map(tmp_path / "map.obj", cube, cube, positions, "volume")
    back = read_mesh(tmp_path / "map.obj", tets=True).mesh
    np.testing.assert_array_equal(back.vertices, positions)
    np.testing.assert_array_equal(back.simplices, cube.simplices)
    np.testing.assert_array_equal(map_from_file(tmp_path / "map.obj", cube, "volume"), positions)
    write_mesh(tmp_path / "cube.obj", cube)
    assert open_source(str(tmp_path / "cube.obj"), tets=True).kind == "volume"


def quads(cells: int) -> str:
    """A bent sheet of quadrangles, as the text of an OBJ."""
    side = np.linspace(0, 1, cells + 1)
    lines = [f"v {x!r} {y!r} {x * y!r}" for y in side.tolist() for x in side.tolist()]
    for j in range(cells):
        for i in range(cells):
            a = j * (cells + 1) + i + 1
            lines.append(f"f {a} {a + 1} {a + cells + 2} {a + cells + 1}")
    return "\n".join(lines) + "\n"


def test_polygons_are_written_as_they_were(tmp_path: Path) -> None:
    path = tmp_path / "quads.obj"
    path.write_text(quads(4))
    opened = open_source(str(path))
    write_map(tmp_path / "map.obj", opened.file.mesh, opened.mesh, opened.mesh.vertices[:, :2], "parameterize")
    faces = [line.split() for line in (tmp_path / "map.obj").read_text().splitlines() if line.startswith("f")]
    assert [[int(c.split("/")[0]) for c in face[1:]] for face in faces] == [
        [int(c) for c in line.split()[1:]] for line in quads(4).splitlines() if line.startswith("f")
    ]
    back = read_mesh(tmp_path / "map.obj").mesh
    np.testing.assert_array_equal(back.simplices, opened.mesh.simplices)
    np.testing.assert_array_equal(back.polygons, opened.mesh.polygons)


def test_polygons_turned_over_stay_polygons_and_mixed_ones_fall_apart(tmp_path: Path) -> None:
    path = tmp_path / "quads.obj"
    path.write_text(quads(2))
    mesh = read_mesh(path).mesh
    for turned, sizes in (([2, 3], [4, 4, 4, 4]), ([2], [4, 3, 3, 4, 4])):
        simplices = mesh.simplices.copy()
        simplices[turned] = simplices[turned][:, [0, 2, 1]]
        write_mesh(tmp_path / "out.obj", replace(mesh, simplices=simplices))
        lines = (tmp_path / "out.obj").read_text().splitlines()
        assert [len(line.split()) - 1 for line in lines if line.startswith("f")] == sizes
        back = read_mesh(tmp_path / "out.obj").mesh
        assert {tuple(np.roll(row, -row.argmin())) for row in back.simplices} == {
            tuple(np.roll(row, -row.argmin())) for row in simplices
        }


def test_a_cut_surface_keeps_the_vertices_of_its_file(tmp_path: Path) -> None:
    points = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1.0]])
    closed = Mesh(points, np.array([[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]]))
    write_mesh(tmp_path / "closed.obj", closed)
    opened = open_source(str(tmp_path / "closed.obj"), fixes=("cut",))
    positions = awkward(opened.mesh.vertex_count, 2)
    write_map(tmp_path / "map.obj", opened.file.mesh, opened.mesh, positions, "parameterize")
    back = open_source(str(tmp_path / "map.obj"), fixes=("seams",))
    np.testing.assert_array_equal(back.file.mesh.vertices, points)
    np.testing.assert_array_equal(back.file.mesh.simplices, closed.simplices)
    np.testing.assert_array_equal(back.mesh.simplices, opened.mesh.simplices)
    for mesh in (opened.mesh, back.mesh):
        np.testing.assert_array_equal(map_from_file(tmp_path / "map.obj", mesh, "parameterize"), positions)
    with pytest.raises(WorkbenchError, match="--fix seams") as refusal:
        map_from_file(tmp_path / "map.obj", closed, "parameterize")
    assert refusal.value.fixes == ("seams",)


@pytest.mark.parametrize("kind", ["plane", "parameterize"])
def test_only_what_was_kept_is_written(tmp_path: Path, square: Mesh, kind: str) -> None:
    height = np.zeros((square.vertex_count, 1)) if kind == "plane" else square.vertices[:, :1] ** 2
    sheet = np.hstack([square.vertices, height])
    two = Mesh(np.vstack([sheet[:3] + 7, sheet]), np.vstack([[[0, 1, 2]], square.simplices + 3]))
    write_mesh(tmp_path / "two.obj", two)
    opened = open_source(str(tmp_path / "two.obj"), kind=kind, fixes=("largest",))
    positions = awkward(opened.mesh.vertex_count, 2)
    write_map(tmp_path / "map.obj", opened.file.mesh, opened.mesh, positions, opened.kind)
    back = read_mesh(tmp_path / "map.obj").mesh
    np.testing.assert_array_equal(back.simplices, square.simplices)
    if kind == "plane":
        np.testing.assert_array_equal(back.vertices[:, :2], positions)
    else:
        np.testing.assert_array_equal(back.vertices, sheet)
        np.testing.assert_array_equal(map_from_file(tmp_path / "map.obj", opened.mesh, opened.kind), positions)


def test_cases_come_back(tmp_path: Path, square: Mesh, cube: Mesh) -> None:
    for mesh, kind in ((square, "plane"), (cube, "volume")):
        positions = awkward(mesh.vertex_count, mesh.dimension)
        path = tmp_path / f"{kind}.npz"
        anchors = {"anchor_vertices": [3, 1], "anchor_targets": positions[[3, 1]]}
        write_map(path, mesh, mesh, positions, kind, **anchors)
        with np.load(path, allow_pickle=False) as content:
            assert set(content.files) == {"V", "S", "X", "anchors", "targets"}
        back = open_source(str(path))
        assert back.kind == kind
        for one, other in (
            (back.mesh.vertices, mesh.vertices), (back.mesh.simplices, mesh.simplices), (back.start, positions),
            (back.anchor_vertices, [3, 1]), (back.anchor_targets, positions[[3, 1]]),
        ):  # fmt: skip
            np.testing.assert_array_equal(one, other)
        np.testing.assert_array_equal(map_from_file(path, mesh, kind), positions)


def test_vtu_and_csv_have_the_fields(tmp_path: Path, square: Mesh, cube: Mesh) -> None:
    for mesh, cell in ((square, "triangle"), (cube, "tetra")):
        fields = {"dirichlet": awkward(mesh.simplex_count, 1)[:, 0], "inverted": np.arange(mesh.simplex_count) % 2 == 0}
        positions = awkward(mesh.vertex_count, mesh.dimension)
        kind = "plane" if mesh.dimension == 2 else "volume"
        write_map(tmp_path / "map.vtu", mesh, mesh, positions, kind, fields=fields)
        content = meshio.vtu.read(str(tmp_path / "map.vtu"))
        np.testing.assert_array_equal(content.points[:, : mesh.dimension], positions)
        np.testing.assert_array_equal(content.point_data["source"][:, : mesh.dimension], mesh.vertices)
        np.testing.assert_array_equal(content.cells_dict[cell], mesh.simplices)
        np.testing.assert_array_equal(content.cell_data["dirichlet"][0], fields["dirichlet"])
        np.testing.assert_array_equal(map_from_file(tmp_path / "map.vtu", mesh, kind), positions)
        write_map(tmp_path / "map.csv", mesh, mesh, positions, kind, fields=fields)
        rows = list(csv.DictReader((tmp_path / "map.csv").read_text().splitlines()))
        assert [int(row["simplex"]) for row in rows] == list(range(mesh.simplex_count))
        assert [float(row["dirichlet"]) for row in rows] == fields["dirichlet"].tolist()
        assert [float(row["inverted"]) for row in rows] == fields["inverted"].tolist()


def test_whole_or_not_there(tmp_path: Path) -> None:
    path = tmp_path / "out.txt"
    path.write_text("before")
    with pytest.raises(RuntimeError), replacing(path) as part:
        part.write_text("half")
        raise RuntimeError
    assert path.read_text() == "before"
    write_text(path, "after")
    assert path.read_text() == "after"
    link = tmp_path / "link.txt"
    link.symlink_to(path)
    write_text(link, "through")
    assert link.is_symlink()
    assert path.read_text() == "through"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["link.txt", "out.txt"]


def test_places_that_cannot_be_written(tmp_path: Path, square: Mesh) -> None:
    (tmp_path / "folder.obj").mkdir()
    (tmp_path / "file").write_text("")
    for name in ("folder.obj", "nowhere/map.obj", "file/map.obj", "map.xyz", "map"):
        with pytest.raises(WorkbenchError) as refusal:
            write_map(tmp_path / name, square, square, square.vertices, "plane")
        assert name.split("/")[0] in refusal.value.sentence
    assert sorted(p.name for p in tmp_path.iterdir()) == ["file", "folder.obj"]


def test_the_first_fix_that_changes_nothing_keeps_the_start(tmp_path: Path, square: Mesh) -> None:
    turned = square.simplices.copy()
    turned[2] = turned[2, ::-1]
    np.savez(tmp_path / "case.npz", V=square.vertices, S=turned, X0=square.vertices * 2)
    opened = open_source(str(tmp_path / "case.npz"), fixes=("reorient", "largest", "cut"))
    np.testing.assert_array_equal(opened.start, square.vertices * 2)
    assert apply_fixes(opened.mesh, ("reorient",)).mesh is opened.mesh
