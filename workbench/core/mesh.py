"""A triangle or tetrahedral mesh."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Floats, Integers, frozen
from workbench.core.errors import MeshError

if TYPE_CHECKING:
    from workbench.core.topology import Topology


@dataclass(frozen=True, eq=False)
class TextureCoordinates:
    """Texture coordinates of a file, with an index a corner so that seams can be told.

    `coordinates` : (t, 2) float64;  `corners` : (m, 3) int64, row of `coordinates` of each corner
    """

    coordinates: Floats
    corners: Integers

    def __post_init__(self) -> None:
        object.__setattr__(self, "coordinates", frozen(self.coordinates))
        object.__setattr__(self, "corners", frozen(self.corners, np.int64))


@dataclass(frozen=True, eq=False)
class FaceAttributes:
    """What a file says of its faces beside where their corners are, so that it can be written again.

    Parameters
    ----------
    parts : tuple of (object, group, material, smoothing)     as the file names them, "" where it does not
    part : (m,) int64                row of `parts` of each triangle
    normals : (k, 3) float64         as the file has them
    normal_corners : (m, 3) int64    row of `normals` of each corner, -1 where it has none
    libraries : tuple of str         files of the materials
    folder : str                     of the file, from where `libraries` are named
    """

    parts: tuple[tuple[str, str, str, str], ...]
    part: Integers = field(repr=False)
    normals: Floats = field(repr=False)
    normal_corners: Integers = field(repr=False)
    libraries: tuple[str, ...] = ()
    folder: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "normals", frozen(self.normals))
        for name in ("part", "normal_corners"):
            object.__setattr__(self, name, frozen(getattr(self, name), np.int64))


@dataclass(frozen=True, eq=False)
class Mesh:
    """Vertices and simplices of one dimension; frozen, derived tables cached.

    Parameters
    ----------
    vertices : (n, 2|3) float64
    simplices : (m, 3|4) int64      triangles or tetrahedra
    name : str                      for titles and reports
    texture : TextureCoordinates    where the file has them for every corner
    polygons : (m,) int64           face of the file that each triangle was fanned from, where faces had more corners
    vertex_origin : (n,) int64      vertex of the file that each vertex comes from, where a fix changed them
    attributes : FaceAttributes     where the file has names, materials or normals of its faces

    Raises `MeshError` for shapes that do not fit, indices out of range and coordinates that are not finite.
    """

    vertices: Floats
    simplices: Integers
    name: str = ""
    texture: TextureCoordinates | None = field(default=None, repr=False)
    polygons: Integers | None = field(default=None, repr=False)
    vertex_origin: Integers | None = field(default=None, repr=False)
    attributes: FaceAttributes | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", frozen(self.vertices))
        object.__setattr__(self, "simplices", frozen(self.simplices, np.int64))
        if self.polygons is not None:
            object.__setattr__(self, "polygons", frozen(self.polygons, np.int64))
        if self.vertex_origin is not None:
            object.__setattr__(self, "vertex_origin", frozen(self.vertex_origin, np.int64))
        self._check()

    def _check(self) -> None:
        if self.vertices.ndim != 2 or self.vertices.shape[1] not in (2, 3):
            raise MeshError(f"The vertices have shape {self.vertices.shape}; (n, 2) or (n, 3) is needed.")
        if self.simplices.ndim != 2 or self.simplices.shape[1] not in (3, 4) or not len(self.simplices):
            raise MeshError(f"The simplices have shape {self.simplices.shape}; at least one triangle or tetrahedron is needed.")
        if self.simplices.shape[1] == 4 and self.vertices.shape[1] == 2:
            raise MeshError("Tetrahedra need vertices with three coordinates; these have two.")
        low, high = int(self.simplices.min()), int(self.simplices.max())
        if low < 0 or high >= len(self.vertices):
            bad = low if low < 0 else high
            raise MeshError(
                f"A simplex names vertex {bad} (from 0), but the mesh has {len(self.vertices)} vertices; "
                "the file is damaged or cut short."
            )
        if not np.isfinite(self.vertices).all():
            row = int(np.flatnonzero(~np.isfinite(self.vertices).all(axis=1))[0])
            raise MeshError(f"Vertex {row} (from 0) has a coordinate that is not a finite number; mend it in the file.")

    @property
    def dimension(self) -> int:
        """Dimension of the simplices: 2 for triangles, 3 for tetrahedra."""
        return int(self.simplices.shape[1]) - 1

    def simplex_noun(self, count: int = 1) -> str:
        """What `count` of its simplices are called."""
        one, many = ("triangle", "triangles") if self.dimension == 2 else ("tetrahedron", "tetrahedra")
        return one if count == 1 else many

    @property
    def vertex_count(self) -> int:
        return len(self.vertices)

    @property
    def simplex_count(self) -> int:
        return len(self.simplices)

    @cached_property
    def diameter(self) -> float:
        """Diagonal of the bounding box."""
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0)))

    @cached_property
    def elimination_order(self) -> Integers:
        """(n,) vertices in an order that keeps the factors of matrices on this mesh sparse; found once, for all of them."""
        from workbench.core.pattern import elimination_order, vertex_graph

        return frozen(elimination_order(vertex_graph(self.simplices, self.vertex_count)), np.int64)

    @cached_property
    def topology(self) -> Topology:
        from workbench.core.topology import analyse_topology

        return analyse_topology(self)
