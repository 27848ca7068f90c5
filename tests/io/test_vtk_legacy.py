"""Legacy VTK files of surfaces, and those of VTK 9: the mesh comes out as it went in, damage ends in a sentence."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.conftest import grid
from workbench.core.arrays import Floats
from workbench.core.errors import MeshError
from workbench.io.read import read_mesh

VERTICES: Floats = np.column_stack([grid(2).vertices, np.arange(9) ** 2 / 8.0])
TRIANGLES = grid(2).simplices.tolist()


def numbers(values: list[float] | list[int] | Floats, kind: str, binary: bool) -> bytes:
    array = np.asarray(values).reshape(-1)
    if binary:
        return array.astype(">" + kind).tobytes() + b"\n"
    return b" ".join(repr(x).encode() for x in array.tolist()) + b"\n"


def cells(word: str, rows: list[list[int]], binary: bool, new: bool) -> bytes:
    flat = [corner for row in rows for corner in row]
    if not new:
        sized = [x for row in rows for x in (len(row), *row)]
        return f"{word} {len(rows)} {len(sized)}\n".encode() + numbers(sized, "i4", binary)
    offsets = np.cumsum([0, *map(len, rows)])
    out = f"{word} {len(offsets)} {len(flat)}\nOFFSETS vtktypeint64\n".encode() + numbers(offsets, "i8", binary)
    return out + b"CONNECTIVITY vtktypeint64\n" + numbers(flat, "i8", binary)


def polydata(rows: list[list[int]], binary: bool, new: bool, word: str = "POLYGONS") -> bytes:
    head = f"# vtk DataFile Version {'5.1' if new else '3.0'}\nany title\n{'BINARY' if binary else 'ASCII'}\nDATASET POLYDATA\n"
    body = b"FIELD FieldData 1\nTIME 1 1 double\n" + numbers([0.5], "f8", binary)
    body += f"POINTS {len(VERTICES)} double\n".encode() + numbers(VERTICES, "f8", binary)
    body += b"METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 1 1\n\n" if new else b""
    body += cells(word, rows, binary, new)
    return head.encode() + body + f"POINT_DATA {len(VERTICES)}\nNORMALS n float\n".encode() + b"0 0 1\n" * len(VERTICES)


@pytest.mark.parametrize("new", [False, True], ids=["3.0", "5.1"])
@pytest.mark.parametrize("binary", [False, True], ids=["text", "binary"])
def test_surfaces_are_read(tmp_path: Path, binary: bool, new: bool) -> None:
    path = tmp_path / "a.vtk"
    path.write_bytes(polydata(TRIANGLES, binary, new))
    mesh = read_mesh(path).mesh
    assert np.array_equal(mesh.vertices, VERTICES) and mesh.simplices.tolist() == TRIANGLES
    path.write_bytes(polydata([[0, 3, 4, 1], [1, 4, 2]], binary, new))
    assert read_mesh(path).mesh.simplices.tolist() == [[0, 3, 4], [0, 4, 1], [1, 4, 2]]
    path.write_bytes(polydata([[0, 3, 1, 4, 2]], binary, new, "TRIANGLE_STRIPS"))
    strip = read_mesh(path).mesh
    assert strip.simplices.shape == (3, 3) and strip.topology.is_consistently_oriented


def test_cells_of_the_new_kind_with_data_in_between_are_read(tmp_path: Path) -> None:
    tetrahedra = [[0, 1, 3, 4], [1, 2, 4, 5]]
    text = polydata(tetrahedra, True, True, "CELLS").replace(b"POLYDATA", b"UNSTRUCTURED_GRID")
    before, after = text.split(b"POINT_DATA")
    path = tmp_path / "a.vtk"
    path.write_bytes(before + b"CELL_TYPES 2\n" + numbers([10, 10], "i4", True) + b"POINT_DATA" + after)
    assert read_mesh(path).mesh.simplices.tolist() == tetrahedra


@pytest.mark.parametrize("new", [False, True], ids=["3.0", "5.1"])
@pytest.mark.parametrize("binary", [False, True], ids=["text", "binary"])
def test_damage_ends_in_a_sentence(tmp_path: Path, binary: bool, new: bool) -> None:
    whole = polydata(TRIANGLES, binary, new)
    end = whole.index(b"POINT_DATA") - 2
    rng = np.random.default_rng(0)
    path = tmp_path / "a.vtk"
    for kept in range(0, end, 23):
        path.write_bytes(whole[:kept])
        with pytest.raises(MeshError, match=r"a\.vtk.+\."):
            read_mesh(path)
    for _ in range(40):
        at = int(rng.integers(0, end - 8))
        path.write_bytes(whole[:at] + rng.bytes(8) + whole[at + 8 :])
        try:
            read_mesh(path)
        except MeshError as error:
            assert error.sentence.endswith(".")
