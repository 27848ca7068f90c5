"""MEDIT as remeshers write it: counts on the line of their word, comments, corners and ridges in between."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.conftest import grid, tetrahedral_grid
from workbench.core.errors import MeshError
from workbench.core.mesh import Mesh
from workbench.io.read import read_mesh


def medit(mesh: Mesh) -> str:
    d, name = mesh.vertices.shape[1], "Tetrahedra" if mesh.dimension == 3 else "Triangles"
    rows = [f"MeshVersionFormatted 2 # first\n\nDimension {d}\n# {name}\nVertices {mesh.vertex_count}"]
    rows += [" ".join(map(repr, [*vertex, 0])) for vertex in mesh.vertices.tolist()]
    rows += ["Corners 2\n1\n2", "RequiredVertices\n1\n1", "Edges 1\n1 2 5", "Ridges\n1\n1"]
    rows += [f"{name} {mesh.simplex_count}"]
    rows += [" ".join(map(str, [*(np.array(simplex) + 1), 3])) for simplex in mesh.simplices.tolist()]
    return "\n".join([*rows, "Normals 1\n0 0 1", "NormalAtVertices 1\n1 1", "End\n"])


@pytest.mark.parametrize("mesh", [grid(3), tetrahedral_grid(2)], ids=["plane", "solid"])
def test_the_mesh_comes_out_as_it_went_in(tmp_path: Path, mesh: Mesh) -> None:
    path = tmp_path / "a.mesh"
    path.write_text(medit(mesh))
    found = read_mesh(path).mesh
    assert np.array_equal(found.vertices, mesh.vertices) and np.array_equal(found.simplices, mesh.simplices)


def test_wherever_it_is_cut_one_sentence_says_so(tmp_path: Path) -> None:
    text = medit(grid(2))
    path = tmp_path / "a.mesh"
    end = text.index("Normals") - 12
    for kept in range(0, end, 9):
        path.write_text(text[:kept])
        with pytest.raises(MeshError, match=r"a\.mesh.+\."):
            read_mesh(path)
