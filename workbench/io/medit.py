"""MEDIT in text where meshio gives up: a sequence of words, whatever lines they stand on and whatever lies in between."""

from __future__ import annotations

import re

import numpy as np

from workbench.core.arrays import Floats
from workbench.io.linear_elements import Blocks

COMMENT = re.compile(rb"#[^\n]*")
KINDS = {
    "triangles": ("triangle", 3),
    "quadrilaterals": ("quad", 4),
    "tetrahedra": ("tetra", 4),
    "hexahedra": ("hexahedron", 8),
    "prisms": ("wedge", 6),
    "pyramids": ("pyramid", 5),
    "edges": ("line", 2),
}
"""Kind of elements and their corners, by the word before their number; each row ends with a mark."""


def read_medit_words(data: bytes) -> tuple[Floats, Blocks]:
    """Points (n, 2|3) and elements; other parts, as corners, ridges, normals, are passed over. Raises `ValueError`."""
    words = COMMENT.sub(b"", data).split()
    if not words or words[0].lower() != b"meshversionformatted":
        raise ValueError("it does not begin as such a file")
    starts = {word.decode().lower(): at + 1 for at, word in enumerate(words) if word.isalpha() and word.isascii()}
    dimension = int(words[starts["dimension"]])

    def table(name: str, columns: int, kind: type) -> np.ndarray:
        count = int(words[starts[name]])
        begin, width = starts[name] + 1, columns + 1
        rows = words[begin : begin + count * width]
        if count < 0 or len(rows) < count * width:
            raise ValueError("it ends too early")
        return np.array([list(map(kind, rows[column::width])) for column in range(columns)]).T

    if dimension not in (2, 3):
        raise ValueError("its dimension is not 2 or 3")
    points: Floats = table("vertices", dimension, float).astype(np.float64)
    found = [(kind, table(name, size, int).astype(np.int64) - 1) for name, (kind, size) in KINDS.items() if name in starts]
    return points, [(kind, rows) for kind, rows in found if len(rows)]
