"""Objects, groups, materials and normals of an OBJ file go through a map into the next file, as a modeller needs them."""

from __future__ import annotations

import itertools
import os
from pathlib import Path

import numpy as np
import pytest

from workbench.core.carried_surface import carry
from workbench.core.mesh import Mesh
from workbench.io.opening import map_from_file, open_source
from workbench.io.read import read_mesh
from workbench.io.write import write_map, write_surface

CELLS = 4
LIBRARY = "house paint.mtl"


def roof(*, flips: bool = False) -> str:
    """A folded sheet as modellers write one: two objects, quads, a pentagon and triangles, negative numbers, a seam in `vt`."""
    rows = range(CELLS + 1)
    points = [(x, y, abs(x - 2) * 0.5) for y in rows for x in rows]
    lines = ["# made by hand", f"mtllib {LIBRARY}", "o Left#1"]
    lines += [f"v {x} {y} {z}" for x, y, z in points]
    lines += [f"vt {x / CELLS} {y / CELLS}" for x, y, _ in points]
    lines += ["vn 0.447 0 0.894", "vn -0.447 0 0.894"]
    for x in range(CELLS):
        if x == 2:
            lines += ["o Right", "g slope"]
        lines.append(f"usemtl tiles.{x % 3:03d}")
        lines.append(f"s {x % 2}" if x % 2 else "s off")
        for y in range(CELLS):
            a = y * (CELLS + 1) + x + 1
            ring = [a, a + 1, a + CELLS + 2, a + CELLS + 1]
            if flips and (x, y) == (1, 1):
                ring.reverse()
            normal = 1 if x >= 2 else 2
            if (x, y) == (0, 0):  # without normals, as two triangles
                lines += [
                    f"f {a}/{a} {a + 1}/{a + 1} {a + CELLS + 2}/{a + CELLS + 2}",
                    "f " + " ".join(f"{v}/{v}" for v in (a, *ring[2:])),
                ]
            elif (x, y) == (3, 3):  # counted from the end
                back = len(points) + 1
                lines.append("f " + " ".join(f"{v - back}/{v - back}/{normal - 3}" for v in ring))
            else:
                lines.append("f " + " ".join(f"{v}/{v}/{normal}" for v in ring))
    return "\n".join(lines) + "\n"


def written_roof(folder: Path, **changes: bool) -> Path:
    folder.mkdir(exist_ok=True)
    path = folder / "roof.obj"
    path.write_text(roof(**changes))
    (folder / LIBRARY).write_text("newmtl tiles.000\n")
    return path


def drawn(path: Path) -> list[tuple]:
    """What another program makes of a file, face by face, by a reader of its own: corners, normals, and what is in force."""
    tables: dict[str, list[tuple[float, ...]]] = {"v": [], "vt": [], "vn": []}
    state: dict[str, str] = {}
    faces = []
    for line in path.read_text().splitlines():
        word, _, rest = line.partition(" ")
        if word in tables:
            tables[word].append(tuple(map(float, rest.split())))
        elif word in ("o", "g", "usemtl", "s", "mtllib"):
            state[word] = rest
        elif word == "f":
            corners, normals = [], []
            for corner in rest.split():
                v, t, n = (*corner.split("/"), "", "")[:3]
                for name, number in (("v", v), ("vt", t), ("vn", n)):
                    assert not number or -len(tables[name]) <= int(number) <= len(tables[name])
                corners.append(tables["v"][int(v) - (int(v) > 0)])
                normals.append(tables["vn"][int(n) - (int(n) > 0)] if n else None)
            faces.append((corners, normals, dict(state)))
    return faces


def fanned(faces: list[tuple]) -> list[tuple]:
    """The triangles of faces."""
    return [
        ([values[0], *values[i : i + 2]], [normals[0], *normals[i : i + 2]], state)
        for values, normals, state in faces
        for i in range(1, len(values) - 1)
    ]


def mapped(path: Path, out: Path, *fixes: str) -> np.ndarray:
    """Write some map of a file; its positions."""
    opened = open_source(str(path), kind="parameterize", fixes=fixes)
    positions = opened.mesh.vertices[:, :2] * [1.1, 0.9] + [0.3, 1 / 3]
    write_map(out, opened.file.mesh, opened.mesh, positions, opened.kind)
    np.testing.assert_array_equal(map_from_file(out, opened.mesh, opened.kind), positions)
    return positions


def test_another_program_sees_the_same_faces_under_new_coordinates(tmp_path: Path) -> None:
    path, out = written_roof(tmp_path), tmp_path / "out.obj"
    mapped(path, out)
    before, after = drawn(path), drawn(out)
    assert {len(face[0]) for face in before} == {3, 4}
    assert after == before
    assert {face[2]["usemtl"] for face in after} == {"tiles.000", "tiles.001", "tiles.002"}
    assert {face[2]["o"] for face in after} == {"Left#1", "Right"}
    assert all(line.count("/") == 2 * (len(line.split()) - 1) for line in out.read_text().splitlines()[-10:] if line[0] == "f")


def test_what_was_written_is_read_as_it_was(tmp_path: Path) -> None:
    path, out = written_roof(tmp_path), tmp_path / "out.obj"
    mapped(path, out)
    before, after = read_mesh(path).mesh, read_mesh(out).mesh
    np.testing.assert_array_equal(after.simplices, before.simplices)
    np.testing.assert_array_equal(after.polygons, before.polygons)
    assert before.attributes is not None and after.attributes is not None
    for a, b in itertools.product((before.attributes,), (after.attributes,)):
        assert [a.parts[row] for row in a.part] == [b.parts[row] for row in b.part]
        np.testing.assert_array_equal(a.normals, b.normals)
        np.testing.assert_array_equal(a.normal_corners, b.normal_corners)
    mapped(out, tmp_path / "again.obj")
    assert (tmp_path / "again.obj").read_text().split("vt ")[0] == out.read_text().split("vt ")[0]


def test_faces_keep_what_is_theirs_where_fixes_turn_and_drop_them(tmp_path: Path) -> None:
    path, out = written_roof(tmp_path, flips=True), tmp_path / "out.obj"
    loose = len(drawn(path)[0][0])
    with path.open("a") as stream:  # another piece, that is dropped
        stream.write("o Chimney\nusemtl bricks\nv 9 9 0\nv 10 9 0\nv 9 10 1\nf -3 -2 -1\n")
    mapped(path, out, "reorient", "largest", "unreferenced")
    before, after = drawn(path)[:-1], drawn(out)
    assert loose and len(after) == len(before)
    for (corners, normals, state), (new_corners, new_normals, new_state) in zip(before, after, strict=True):
        assert set(new_corners) == set(corners)
        assert dict(zip(new_corners, new_normals, strict=True)) == dict(zip(corners, normals, strict=True))
        assert new_state == state
    assert "Chimney" not in out.read_text()


def test_a_cut_keeps_the_vertices_and_gives_each_side_its_coordinates(tmp_path: Path) -> None:
    box = ["o Box", "usemtl card"]
    box += [f"v {x} {y} {z}" for z in (0, 1) for y in (0, 1) for x in (0, 1)]
    box += [f"vn {line}" for line in ("0 0 -1", "0 0 1", "0 -1 0", "0 1 0", "-1 0 0", "1 0 0")]
    rings = ((1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6))
    box += ["f " + " ".join(f"{v}//{n}" for v in ring) for n, ring in enumerate(rings, start=1)]
    path, out = tmp_path / "box.obj", tmp_path / "out.obj"
    path.write_text("\n".join(box) + "\n")
    positions = mapped(path, out, "cut")
    assert fanned(drawn(out)) == fanned(drawn(path))  # a polygon across which the cut goes falls apart
    assert len(positions) > 8 and sum(line.startswith("v ") for line in out.read_text().splitlines()) == 8


def test_libraries_are_found_from_where_the_file_is_written(tmp_path: Path) -> None:
    path = written_roof(tmp_path / "models")
    (tmp_path / "out" / "deep").mkdir(parents=True)
    for folder in (tmp_path / "models", tmp_path / "out" / "deep"):
        out = folder / "map.obj"
        mapped(path, out)
        named = out.read_text().splitlines()[0].removeprefix("mtllib ")
        assert os.path.samefile(folder / named, tmp_path / "models" / LIBRARY)
    (tmp_path / "models" / LIBRARY).unlink()  # one that leads nowhere stays as it was named
    mapped(path, out)
    assert out.read_text().startswith(f"mtllib {LIBRARY}\n")


def test_a_flat_figure_and_a_carried_surface_keep_their_parts(tmp_path: Path, cube: Mesh) -> None:
    path = tmp_path / "flat.obj"
    path.write_text("o A\nusemtl red\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 2 0\nvn 0 0 1\n"
                    "f 1//1 2//1 3//1 4//1\nusemtl blue\nf 4//1 3//1 5//1\n")  # fmt: skip
    opened = open_source(str(path), kind="plane")
    write_map(tmp_path / "moved.obj", opened.file.mesh, opened.mesh, opened.mesh.vertices * 0.5, "plane")
    assert [face[1:] for face in drawn(tmp_path / "moved.obj")] == [face[1:] for face in drawn(path)]
    surface = read_mesh(path).mesh
    lowered = Mesh(surface.vertices * 0.3 + 0.2, surface.simplices, attributes=surface.attributes, polygons=surface.polygons)
    write_surface(tmp_path / "carried.obj", lowered, carry(lowered, cube).at(cube.vertices))
    assert [face[2] for face in drawn(tmp_path / "carried.obj")] == [face[2] for face in drawn(path)]
    assert "vn" not in (tmp_path / "carried.obj").read_text()  # they were those of another shape


@pytest.mark.parametrize(
    "normals",
    ["vn 0 0 nan\n", "vn 0 0\n", "vn a b c\n", "vn 0 0 1 1\n", "vn\n", ""],
    ids=["nan", "two", "words", "four", "none", "no"],
)
def test_normals_that_are_none_harm_nothing(tmp_path: Path, normals: str) -> None:
    path = tmp_path / "mesh.obj"
    path.write_text(f"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\n{normals}f 1//1 2//1 3//1\nf 2//-9 4//7 3\n")
    mesh = read_mesh(path).mesh
    assert mesh.simplices.tolist() == [[0, 1, 2], [1, 3, 2]]
    assert mesh.attributes is None


def test_a_file_without_any_of_it_is_written_without(tmp_path: Path) -> None:
    path, out = tmp_path / "bare.obj", tmp_path / "out.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nf 1 2 3\nf 2 4 3\n")
    mapped(path, out)
    assert {line.split()[0] for line in out.read_text().splitlines()} == {"v", "vt", "f"}
