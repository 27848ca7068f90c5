"""STL, read with own code: many binary files begin with the word `solid`, which meshio takes for text."""

from __future__ import annotations

from itertools import chain
from pathlib import Path

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.errors import MeshError
from workbench.core.mesh import Mesh
from workbench.io.mesh_file import mesh_of_file
from workbench.io.text import decoded

HEADER = 84
RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def read_stl(path: Path, data: bytes) -> tuple[Mesh, tuple[str, ...]]:
    """The mesh in the bytes of an STL file, vertices at the same place merged, and notes.

    Vertices are numbered in the order in which the triangles first name them.
    """
    count = int.from_bytes(data[80:HEADER], "little")
    if len(data) >= HEADER and len(data) == HEADER + RECORD.itemsize * count:
        points = np.frombuffer(data, RECORD, offset=HEADER)["corners"].reshape(-1, 3).astype(np.float64)
    elif data.lstrip()[:5].lower() == b"solid" and b"\0" not in data:
        points = _text_points(path, decoded(path, data))
    else:
        raise MeshError(f"{path}: it cannot be read as STL; it is damaged, cut short, or of another format.")
    if not len(points):
        raise MeshError(f"{path}: there are no triangles in it; save the mesh again.")
    # The sum turns -0 into 0, so that equal places are equal bytes.
    _, first, number = np.unique(points + 0.0, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    triangles = rank[number.reshape(-1)].reshape(-1, 3)
    return mesh_of_file(path, points[first[order]], triangles), ("Vertices at the same place were merged.",)


def _text_points(path: Path, text: str) -> Floats:
    if "endsolid" not in text.lower():
        raise MeshError(f"{path}: its last line, endsolid, is missing; the file is cut short.")
    rows = [words[1:4] for words in map(str.split, text.split("\n")) if words and words[0].lower() == "vertex"]
    try:
        points = np.array(list(map(float, chain.from_iterable(rows)))).reshape(len(rows), 3)
    except ValueError:
        raise MeshError(f"{path}: a vertex of it is not three numbers; the file is damaged.") from None
    if len(points) % 3:
        raise MeshError(f"{path}: it has {len(points)} corners, not three a triangle; the file is damaged.")
    return points
