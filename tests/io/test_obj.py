"""The OBJ reader on files as they are found in the wild, and on broken ones."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from workbench.core.errors import MeshError
from workbench.io.mesh_file import MeshFile
from workbench.io.read import read_mesh

SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


def read(folder: Path, content: str | bytes, *, tets: bool = False) -> MeshFile:
    path = folder / "mesh.obj"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return read_mesh(path, tets=tets)


def refusal(folder: Path, content: str | bytes) -> str:
    with pytest.raises(MeshError) as error:
        read(folder, content)
    sentence = error.value.sentence
    assert "mesh.obj" in sentence
    assert sentence.endswith((".", "?"))
    return sentence


@pytest.mark.parametrize(
    "faces",
    [
        "f 1 2 3\nf 1 3 4\n",
        "f -4 -3 -2\nf -4 -2 -1\n",
        "f 1// 2// 3//\nf 1//7 3//8 4//9\n",
        "f 1 2 3 # first\n\n# f 9 9 9\nf\t1  3\t4   ",
        "f 1 2 \\\n3\nf 1 \\\n 3 \\\n4\n",
        "g part\ns off\nusemtl stone\nf 1 2 3\nl 1 2\no other\nf 1 3 4\n",
    ],
)
def test_ways_to_write_the_same(tmp_path: Path, faces: str) -> None:
    mesh = read(tmp_path, SQUARE + faces).mesh
    assert mesh.simplices.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert mesh.vertices.shape == (4, 3)
    assert mesh.texture is None
    assert mesh.polygons is None


@pytest.mark.parametrize("ending", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "latin-1", "utf-16", "cp1252"])
def test_any_encoding_and_line_end(tmp_path: Path, ending: str, encoding: str) -> None:
    text = ("# größe, façade\no Möbius\n" + SQUARE + "f 1 2 3 4\n").replace("\n", ending)
    mesh = read(tmp_path, text.encode(encoding)).mesh
    assert mesh.simplices.tolist() == [[0, 1, 2], [0, 2, 3]]


def test_negative_indices_count_from_where_they_stand(tmp_path: Path) -> None:
    mesh = read(tmp_path, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nv 6 5 5\nv 5 6 5\nf -3 -2 -1\n").mesh
    assert mesh.simplices.tolist() == [[0, 1, 2], [3, 4, 5]]


def test_polygons_are_fanned_and_remembered(tmp_path: Path) -> None:
    mesh = read(tmp_path, SQUARE + "v 0.5 2 0\nf 1 2 3\nf 1 2 3 5 4\nf 4 3 5\n").mesh
    assert mesh.simplices.tolist() == [[0, 1, 2], [0, 1, 2], [0, 2, 4], [0, 4, 3], [3, 2, 4]]
    assert mesh.polygons is not None
    assert mesh.polygons.tolist() == [0, 1, 1, 1, 2]


def test_seams_are_kept_a_corner(tmp_path: Path) -> None:
    texture = "vt 0 0\nvt 1 0\nvt 1 1 0.5\nvt 0.25\n"
    mesh = read(tmp_path, SQUARE + texture + "f 1/1 2/2/9 3/3\nf 1/4/1 3/-2 4/-1\n").mesh
    assert mesh.texture is not None
    assert mesh.texture.corners.tolist() == [[0, 1, 2], [3, 2, 3]]
    assert mesh.texture.coordinates.tolist() == [[0, 0], [1, 0], [1, 1], [0.25, 0]]


def test_partial_texture_is_left_out_with_a_note(tmp_path: Path) -> None:
    found = read(tmp_path, SQUARE + "vt 0 0\nf 1/1 2/1 3/1\nf 1 3 4\n")
    assert found.mesh.texture is None
    assert "left out" in found.notes[0]


def test_colours_and_two_columns(tmp_path: Path) -> None:
    coloured = read(tmp_path, "v 0 0 0 1 1 1\nv 1 0 0 1 0 0\nv 0 1 0 0 0 1\nf 1 2 3\n").mesh
    assert coloured.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    assert read(tmp_path, "v 0 0\nv 1 0\nv 0 1\nf 1 2 3\n").mesh.vertices.shape == (3, 2)


def test_tetrahedra_on_request(tmp_path: Path) -> None:
    content = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 3 4\n"
    found = read(tmp_path, content, tets=True)
    assert found.mesh.simplices.tolist() == [[0, 1, 2, 3]]
    assert "1 faces" in found.notes[0]
    assert read(tmp_path, content).mesh.dimension == 2
    with pytest.raises(MeshError, match="--tets"):
        read(tmp_path, SQUARE + "f 1 2 3\n", tets=True)


@pytest.mark.parametrize(
    ("content", "what"),
    [
        (SQUARE + "f 1 2 9\n", "line 5: a face names vertex 9, but the file has 4"),
        (SQUARE + "f 1 2 0\n", "line 5: a face names vertex 0"),
        (SQUARE + "f 1 2 -5\n", "line 5: a face names vertex -5"),
        (SQUARE + "f 1 2 99999999999999999999\n", "line 5"),
        (SQUARE + "f 1/7 2/1 3/1\nvt 0 0\n", "line 5: a face names texture coordinate 7, but the file has 1"),
        (SQUARE + "f 1 2\n", "line 5: a face needs three corners"),
        (SQUARE + "f", "line 5: a face needs three corners"),
        ("v 0 0 0\nv\nv 0 1 0\nf 1 2 3\n", "line 2: a vertex needs 3"),
        (SQUARE + "f 1/1 2/a 3/1\nvt 0 0\n", "line 5: '2/a'"),
        (SQUARE + "f 1 f 3\n", "line 5: 'f'"),
        (SQUARE + "f 1/2/3/4 2 3\nf 1 /2 3\n", "line 6: '/2'"),
        (SQUARE + "f 1 two 3\n", "line 5: 'two'"),
        (SQUARE, "no face"),
        ("", "empty"),
        ("\n\n# nothing\n", "no vertex"),
        ("solid cube\nfacet normal 0 0 0\n", "no vertex"),
        ("v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "line 1: a coordinate is not a finite number"),
        ("v 0 0 0\nv 1 0 1e999\nv 0 1 0\nf 1 2 3\n", "line 2: a coordinate is not a finite number"),
        ("v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n", "line 2: a vertex needs 3"),
        ("v 0,5 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "line 1: '0,5' is not a number"),
        ("v 0 0 0\nv 1e101 0 0\nv 0 1 0\nf 1 2 3\n", "vertex 1 (from 0) has a coordinate beyond 1e+70"),
        ("v 2 2 2\nv 2 2 2\nv 2 2 2\nf 1 2 3\n", "same place"),
        (b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR\x00\x00", "binary data"),
    ],
)  # fmt: skip
def test_broken_files_are_refused_with_the_place(tmp_path: Path, content: str | bytes, what: str) -> None:
    assert what in refusal(tmp_path, content)


def test_cut_anywhere_it_is_read_or_refused(tmp_path: Path) -> None:
    content = (SQUARE + "vt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/2\n").encode()
    for length in range(len(content)):
        try:
            mesh = read(tmp_path, content[:length]).mesh
        except MeshError:
            continue
        assert mesh.simplex_count >= 1


def test_large_files_keep_every_digit(tmp_path: Path) -> None:
    random = np.random.default_rng(1)
    vertices = random.normal(size=(3000, 3))
    triangles = random.integers(0, 3000, (5000, 3))
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    lines += ["f {}/{} {}/{} {}/{}".format(*np.repeat(row + 1, 2)) for row in triangles]
    lines += ["vt 0 0"] * 3000
    mesh = read(tmp_path, "\n".join(lines)).mesh
    np.testing.assert_array_equal(mesh.vertices, vertices)
    np.testing.assert_array_equal(mesh.simplices, triangles)
    assert mesh.texture is not None
    np.testing.assert_array_equal(mesh.texture.corners, triangles)
