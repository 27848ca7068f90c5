"""Faces of a mesh as lines of an OBJ file: polygons as they were, with the parts, materials and normals of their file."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Integers
from workbench.core.mesh import FaceAttributes
from workbench.io.obj_attributes import NOTHING, naming_lines
from workbench.io.polygons import unfan


def faces_text(
    vertices: Integers,
    polygons: Integers | None = None,
    texture: Integers | None = None,
    attributes: FaceAttributes | None = None,
) -> str:
    """The lines of the faces.

    Parameters
    ----------
    vertices : (m, 3|4) int64                number of the vertex of each corner, from 0
    polygons : (m,) int64, optional          polygon that each triangle was fanned from
    texture : (m, 3) int64, optional         number of the texture coordinate of each corner, from 0
    attributes : FaceAttributes, optional    of the triangles
    """
    if vertices.shape[1] == 4:
        return "".join(f"f {' '.join(map(str, row))}\n" for row in (vertices + 1).tolist())
    normals = None if attributes is None or not len(attributes.normals) else attributes.normal_corners
    corners, words = _corners(vertices, texture, normals)
    faces = unfan(corners, polygons)
    lines = ["f " + " ".join([words[corner] for corner in face]) for face in faces]
    if attributes is not None:
        sizes = np.array([len(face) - 2 for face in faces])
        part = attributes.part[np.cumsum(sizes) - sizes]  # of the first triangle of each face
        last = NOTHING
        for row in np.flatnonzero(np.diff(part, prepend=-1)).tolist():
            now = attributes.parts[int(part[row])]
            lines[row], last = naming_lines(last, now) + lines[row], now
    return "\n".join(lines) + "\n"


def _corners(vertices: Integers, texture: Integers | None, normals: Integers | None) -> tuple[Integers, list[str]]:
    """A number (m, 3) for each corner, alike where all that is said of it is, and what is written for each number."""
    if texture is None and normals is None:
        return vertices, list(map(str, range(1, int(vertices.max()) + 2)))
    numbers = vertices.ravel()
    for column in (texture, normals):
        if column is not None:
            _, numbers = np.unique(numbers * (int(column.max()) + 2) + column.ravel() + 1, return_inverse=True)
    _, first = np.unique(numbers, return_index=True)
    found = [None if column is None else (column.ravel()[first] + 1).tolist() for column in (vertices, texture, normals)]
    vertex, coordinates, normal = found
    assert vertex is not None
    words = list(map(str, vertex))
    if coordinates is not None:
        words = [f"{word}/{t}" for word, t in zip(words, coordinates, strict=True)]
    if normal is not None:
        between = "//" if coordinates is None else "/"
        words = [f"{word}{between}{n}" if n else word for word, n in zip(words, normal, strict=True)]
    return numbers.reshape(vertices.shape), words
