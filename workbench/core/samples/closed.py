"""Closed surfaces and the solid ball."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.samples.subdivision import subdivide


def blob(triangles: int) -> tuple[Floats, Integers]:
    """Vertices (n, 3) and triangles of a rounded lump: genus 0, no boundary."""
    vertices, simplices = subdivide(*_icosahedron(), max(1, round(np.sqrt(triangles / 20.0))))
    vertices = vertices / np.linalg.norm(vertices, axis=1, keepdims=True)
    return vertices * blob_radius(vertices)[:, None], simplices


def blob_radius(directions: Floats) -> Floats:
    """How far the blob reaches in each direction (k, 3) of unit length."""
    lumps = np.array([(0.9, 0.2, 0.4), (-0.6, 0.7, 0.3), (-0.2, -0.5, 0.85), (0.1, 0.3, -0.95), (0.3, -0.9, -0.3)])
    lumps /= np.linalg.norm(lumps, axis=1, keepdims=True)
    sizes = np.array([0.55, 0.42, 0.48, 0.36, 0.30])
    radius: Floats = 0.8 + np.exp(6.0 * (directions @ lumps.T - 1.0)) @ sizes
    return radius


def torus(triangles: int, tube: float = 0.4) -> tuple[Floats, Integers]:
    """Vertices (n, 3) and triangles of a torus of radius 1: genus 1, no boundary."""
    spacing = np.sqrt(4.0 * np.pi**2 * tube / triangles * 4.0 / np.sqrt(3.0))
    around = max(4, 2 * round(np.pi / (spacing * np.sqrt(0.75))))  # even, so that staggered rows close
    about = max(3, round(2.0 * np.pi * tube / spacing))
    row, column = np.meshgrid(np.arange(around), np.arange(about), indexing="ij")
    u = 2.0 * np.pi * row / around
    v = 2.0 * np.pi * (column + 0.5 * (row % 2)) / about
    radius = 1.0 + tube * np.cos(v)
    vertices = np.stack([radius * np.cos(u), radius * np.sin(u), tube * np.sin(v)], axis=-1).reshape(-1, 3)
    here, beyond = row * about + column, row * about + (column + 1) % about
    up, up_beyond = (here + about) % vertices.shape[0], (beyond + about) % vertices.shape[0]
    even = np.stack([here, up, beyond, beyond, up, up_beyond], axis=-1)
    odd = np.stack([here, up, up_beyond, here, up_beyond, beyond], axis=-1)
    return vertices, np.where((row % 2 == 0)[..., None], even, odd).reshape(-1, 3).astype(np.int64)


def ball(tetrahedra: int) -> tuple[Floats, Integers]:
    """Vertices (n, 3) and tetrahedra of the unit ball: an icosahedron's twenty cones, subdivided, shells made round."""
    corners, faces = _icosahedron()
    vertices = np.vstack([np.zeros((1, 3)), corners])
    simplices = np.column_stack([np.zeros(len(faces), dtype=np.int64), faces + 1])
    vertices, simplices = subdivide(vertices, simplices, max(1, round((tetrahedra / 20.0) ** (1.0 / 3.0))))
    normals = corners[faces].sum(axis=1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    # the gauge of the icosahedron is 1 on its surface: the shell that a vertex lies on
    shell = (vertices @ normals.T).max(axis=1) / (corners[faces[0]] @ normals[0])[0]
    length = np.linalg.norm(vertices, axis=1)
    scale = np.divide(shell, length, out=np.zeros_like(shell), where=length > 1e-12)
    return vertices * scale[:, None], simplices


def _icosahedron() -> tuple[Floats, Integers]:
    golden = (1.0 + np.sqrt(5.0)) / 2.0
    corners = np.array([(0.0, s, t * golden) for s in (-1, 1) for t in (-1, 1)])
    corners = np.vstack([corners, corners[:, [2, 0, 1]], corners[:, [1, 2, 0]]])
    close = np.linalg.norm(corners[:, None] - corners[None], axis=2) < 2.1
    faces = []
    for i in range(12):
        for j in range(i + 1, 12):
            for k in range(j + 1, 12):
                if close[i, j] and close[j, k] and close[i, k]:
                    outward = np.linalg.det(corners[[i, j, k]]) > 0
                    faces.append((i, j, k) if outward else (i, k, j))
    return corners / np.linalg.norm(corners[0]), np.array(faces, dtype=np.int64)
