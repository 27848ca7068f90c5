"""The only door to libigl, which checks little: arguments are cast and validated here, results are checked."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from workbench.core.arrays import Integers
from workbench.core.errors import MeshError
from workbench.core.facets import facet_table


def cut_to_disk(triangles: ArrayLike) -> Integers:
    """Edges along which a surface must be opened to become discs, by libigl's `cut_to_disk` (Gu et al. 2002).

    Parameters
    ----------
    triangles : (m, 3) int64      manifold edges; every vertex number from 0 is used

    Returns
    -------
    (k, 2) int64      edges of the cut, boundary edges among them; none for a sphere

    Raises `MeshError` where triangles repeat a vertex or an edge has more than two of them.
    """
    faces = checked_triangles(triangles)
    if (faces == np.roll(faces, 1, axis=1)).any():
        raise MeshError("A triangle names the same vertex twice; mend the mesh before it is cut.")
    if facet_table(faces).counts.max() > 2:
        raise MeshError("An edge has more than two triangles; mend the mesh before it is cut.")
    import igl

    cuts = igl.cut_to_disk(faces)
    edges = [np.column_stack([cut[:-1], cut[1:]]) for cut in cuts if len(cut) > 1]
    if not edges:
        return np.empty((0, 2), dtype=np.int64)
    return np.concatenate(edges).astype(np.int64)


def checked_triangles(triangles: ArrayLike) -> Integers:
    """`triangles` as a C-contiguous (m, 3) int64 array, m >= 1, that names every vertex from 0 to its largest."""
    faces = np.ascontiguousarray(triangles, dtype=np.int64)
    if faces.ndim != 2 or faces.shape[1] != 3 or not len(faces):
        raise MeshError(f"Triangles of shape {faces.shape} were given; (m, 3) with at least one is needed.")
    if int(faces.min()) < 0:
        raise MeshError(f"A triangle names vertex {int(faces.min())}; numbers start from 0.")
    if np.unique(faces).size != int(faces.max()) + 1:
        raise MeshError("Some vertices are in no triangle; drop them first.")
    return faces
