"""PLY as programs write it: whatever stands beside vertices and faces changes nothing about the mesh that is read."""

from __future__ import annotations

import struct
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from tests.conftest import grid
from workbench.core.errors import MeshError
from workbench.io.read import read_mesh

VERTICES = np.column_stack([grid(3).vertices, np.arange(16) ** 2 / 8.0])
TRIANGLES = grid(3).simplices
CODES = {"double": "d", "float": "f", "uchar": "B", "int": "i", "ushort": "H"}
FORMATS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}

Row = list[tuple[str, list[float]]]
"""Type and numbers of each property of a row; a list of type `L` has its length before it, as a uchar."""


def row_bytes(row: Row, order: str) -> bytes:
    if not order:
        parts = [[len(v), *v] if kind[0] == "L" else v for kind, v in row]
        return (" ".join(repr(x) for part in parts for x in part) + "\r\n").encode()
    out = b""
    for kind, values in row:
        code = CODES[kind.removeprefix("L ")]
        out += struct.pack(f"{order}B", len(values)) if kind[0] == "L" else b""
        out += struct.pack(f"{order}{len(values)}{code}", *values)
    return out


def ply(form: str, faces: list[list[int]], name: str, beside: bool) -> bytes:
    """The mesh; with things `beside` it: colours, flags, texture coordinates, edges, another element before the vertices."""
    order = FORMATS[form]
    header = [f"ply\nformat {form} 1.0\ncomment element face 3"]
    body = b""
    if beside:
        header.append("element camera 1\nproperty float f\nproperty list uchar int k")
        body += row_bytes([("float", [1.5]), ("L int", [4, 5])], order)
    header.append(f"element vertex {len(VERTICES)}\nproperty double x\nproperty double y\nproperty double z")
    header += ["property uchar red"] if beside else []
    for vertex in VERTICES.tolist():
        body += row_bytes([("double", vertex), *([("uchar", [7])] if beside else [])], order)
    header.append(f"element face {len(faces)}")
    header += ["property uchar flag"] if beside else []
    header.append(f"property list uchar int {name}")
    header += ["property list uchar float texcoord"] if beside else []
    for i, face in enumerate(faces):
        row: Row = [("L int", list(face))]
        if beside:
            row = [("uchar", [3]), *row, ("L float", [0.5] * (6 if i % 2 else 0))]
        body += row_bytes(row, order)
    if beside:
        header.append("element edge 1\nproperty int vertex1\nproperty int vertex2")
        body += row_bytes([("int", [0, 1])], order)
    return "\n".join([*header, "end_header\n"]).replace("\n", "\r\n").encode() + body


@pytest.mark.parametrize(("form", "beside"), list(product(FORMATS, [False, True])))
def test_the_mesh_is_the_same_whatever_stands_beside_it(tmp_path: Path, form: str, beside: bool) -> None:
    for name in ("vertex_indices", "vertex_index"):
        (tmp_path / "a.ply").write_bytes(ply(form, TRIANGLES.tolist(), name, beside))
        mesh = read_mesh(tmp_path / "a.ply").mesh
        assert np.array_equal(mesh.vertices, VERTICES) and np.array_equal(mesh.simplices, TRIANGLES)


@pytest.mark.parametrize("form", FORMATS)
def test_faces_of_several_sizes_are_fanned(tmp_path: Path, form: str) -> None:
    (tmp_path / "a.ply").write_bytes(ply(form, [[0, 4, 5, 1], [1, 5, 2], [4, 8, 9, 6, 5]], "vertex_indices", True))
    file = read_mesh(tmp_path / "a.ply")
    assert file.mesh.simplices.tolist() == [[0, 4, 5], [0, 5, 1], [1, 5, 2], [4, 8, 9], [4, 9, 6], [4, 6, 5]]
    assert file.mesh.polygons is not None and file.mesh.polygons.tolist() == [0, 0, 1, 2, 2, 2]
    assert file.notes == ("2 polygons were fanned into triangles.",)


@pytest.mark.parametrize("form", FORMATS)
def test_wherever_it_is_cut_one_sentence_says_so(tmp_path: Path, form: str) -> None:
    whole = ply(form, [[0, 4, 5, 1], *TRIANGLES.tolist()], "vertex_indices", False)
    for kept in range(0, len(whole) - 2, 7):
        (tmp_path / "cut.ply").write_bytes(whole[:kept])
        with pytest.raises(MeshError, match=r"cut short|empty|damaged|cannot be read"):
            read_mesh(tmp_path / "cut.ply")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b"property double x", b"property string x"),
        (b"format ascii", b"format morse"),
        (b"element face 18", b"element face x"),
        (b"\r\n3 ", b"\r\n-3 "),
        (b"\r\n3 ", b"\r\n99999999999999999999999 "),
        (b"vertex_indices", b"indices"),
        (b"0.0 0.0", b"0.0 abc"),
        pytest.param(b"property double x", b"property double x\n" * 50_000 + b"property double x", id="a header without end"),
    ],
)
def test_what_is_wrong_is_said(tmp_path: Path, old: bytes, new: bytes) -> None:
    whole = ply("ascii", TRIANGLES.tolist(), "vertex_indices", False)
    assert old in whole
    (tmp_path / "bad.ply").write_bytes(whole.replace(old, new, 1))
    with pytest.raises(MeshError, match=r"bad\.ply: .+\."):
        read_mesh(tmp_path / "bad.ply")
