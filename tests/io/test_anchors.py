"""Anchor files: what is accepted, and the line of what is not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from workbench.core.errors import WorkbenchError
from workbench.core.mesh import Mesh
from workbench.io.anchor_rows import AnchorTable
from workbench.io.anchors import read_anchors, vertices_after_fixes, vertices_before_fixes, write_anchors


def read(folder: Path, text: str, dimension: int = 2) -> AnchorTable:
    path = folder / "anchors.csv"
    path.write_bytes(text.encode())
    return read_anchors(path, 10, dimension)


def test_plain_and_weighted(tmp_path: Path) -> None:
    plain = read(tmp_path, "vertex,x,y\n3,0.5,-1\n\n0,1e-3,2\n")
    assert plain.vertices.tolist() == [3, 0]
    assert plain.targets.tolist() == [[0.5, -1.0], [0.001, 2.0]]
    assert np.isinf(plain.weights).all()
    weighted = read(tmp_path, "\ufeffVertex, X, Y, Z, Weight\r\n3,1,2,3,inf\r\n4,1,2,3,\r\n5,1,2,3,2.5\r\n", 3)
    assert weighted.weights.tolist() == [np.inf, np.inf, 2.5]
    assert len(read(tmp_path, "vertex,x,y\n").vertices) == 0
    assert read(tmp_path, "vertex,x,y\n").targets.shape == (0, 2)


@pytest.mark.parametrize("weights", [[np.inf, np.inf], [0.1, np.inf]])
def test_reads_back_the_same(tmp_path: Path, weights: list[float]) -> None:
    targets = np.array([[1 / 3, -1e-17], [np.pi, 1e69]])
    path = tmp_path / "anchors.csv"
    write_anchors(path, AnchorTable(np.array([7, 2]), targets, np.array(weights)))
    back = read_anchors(path, 8, 2)
    np.testing.assert_array_equal(back.vertices, [7, 2])
    np.testing.assert_array_equal(back.targets, targets)
    np.testing.assert_array_equal(back.weights, weights)


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("", "empty"),
        ("3,0,0\n", "first line"),
        ("vertex,x,y,z\n3,0,0,0\n", "first line"),
        ("vertex,x,y\n3,0\n", "line 2: it has 2 fields"),
        ("vertex,x,y\n3,0,0\n\n3,1,1\n", "line 4: vertex 3 has an anchor already, in line 2"),
        ("vertex,x,y\n10,0,0\n", "line 2: there is no vertex 10"),
        ("vertex,x,y\n-1,0,0\n", "no vertex -1"),
        ("vertex,x,y\n1.5,0,0\n", "not the number of a vertex"),
        ("vertex,x,y\n1,nan,0\n", "line 2: the coordinate nan"),
        ("vertex,x,y\n1,0,inf\n", "not finite"),
        ("vertex,x,y\n1,0,1e200\n", "too large"),
        ("vertex,x,y\n1,a,0\n", "line 2: 'a' is not a number"),
        ("vertex,x,y,weight\n1,0,0,0\n", "weight '0'"),
        ("vertex,x,y,weight\n1,0,0,-inf\n", "weight"),
        ("vertex,x,y,weight\n1,0,0,nan\n", "weight"),
        pytest.param('vertex,x,y\n1,0,"' + "9" * 200_000, "Line 2", id="a quoted cell without end"),
    ],
)
def test_refusals_name_the_line(tmp_path: Path, text: str, what: str) -> None:
    with pytest.raises(WorkbenchError, match=r"anchors\.csv") as refusal:
        read(tmp_path, text)
    assert what in refusal.value.sentence


def test_groups_and_switches_and_what_spreadsheets_write(tmp_path: Path) -> None:
    found = read(tmp_path, "vertex;x;y;weight;group;on\n3;0,5;-1;;4;on\n7;1;2,25;0,125;;off\n")
    assert found.targets.tolist() == [[0.5, -1.0], [1.0, 2.25]]
    assert found.weights.tolist() == [np.inf, 0.125]
    assert found.groups.tolist() == [4, -1] and found.is_off.tolist() == [False, True]
    assert found.in_force.vertices.tolist() == [3] and found.in_force.groups.tolist() == [4]
    write_anchors(tmp_path / "again.csv", found)
    assert (tmp_path / "again.csv").read_text().splitlines()[0] == "vertex,x,y,weight,group,on"
    again = read_anchors(tmp_path / "again.csv", 10, 2)
    for name in ("vertices", "targets", "weights", "groups", "is_off"):
        np.testing.assert_array_equal(getattr(again, name), getattr(found, name))


def test_vertices_are_those_of_the_mesh_file_whatever_fixes_made_of_it() -> None:
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    # vertices 5 and 0 were dropped, 3 was cut in two
    mesh = Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]]), vertex_origin=np.array([3, 1, 4, 3]))
    vertices = np.array([4, 1])
    after = vertices_after_fixes("a.csv", vertices, mesh)
    assert after.tolist() == [2, 1]
    np.testing.assert_array_equal(vertices_before_fixes(after, mesh), vertices)
    with pytest.raises(WorkbenchError, match="vertex 3 was cut into 2"):
        vertices_after_fixes("a.csv", np.array([1, 3]), mesh)
    with pytest.raises(WorkbenchError, match="vertex 5 was dropped"):
        vertices_after_fixes("a.csv", np.array([5]), mesh)
    with pytest.raises(WorkbenchError, match="Vertex 3 lies on a cut"):
        vertices_before_fixes(np.array([3]), mesh)


def test_tables_of_decimals_are_read(tmp_path: Path) -> None:
    found = read(tmp_path, "vertex,x,y,group\n3.0,0.5,-1.0,4.0\n7.000,1.0,2.25,\n5,1.0,0.0,-1.0\n")
    assert found.vertices.tolist() == [3, 7, 5] and found.groups.tolist() == [4, -1, -1]
    assert read(tmp_path, "vertex;x;y\n3,0;0,5;1,0\n").vertices.tolist() == [3]
    for vertex in ("3.5", "3.", ".0", "3.0.0", "-1.0", "1e0", "12.0"):
        with pytest.raises(WorkbenchError, match="line 2"):
            read(tmp_path, f"vertex,x,y\n{vertex},0,0\n")
