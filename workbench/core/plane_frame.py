"""Flat surfaces in space: their plane, and coordinates in it."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.mesh import Mesh
from workbench.core.topology import signed_contents

FLAT_RATIO = 1e-7
"""A surface is flat when no vertex is farther from its plane than this part of its diameter (single precision)."""


def is_flat(mesh: Mesh) -> bool:
    """Whether a triangle mesh lies in one plane."""
    return mesh.dimension == 2 and (mesh.vertices.shape[1] == 2 or _flat_normal(mesh) is not None)


def plane_coordinates(mesh: Mesh) -> Floats:
    """Coordinates of the vertices of a flat triangle mesh in its plane, (n, 2) float64; lengths are kept.

    A mesh in a plane of constant z keeps its x and y to the last digit. In any other plane the first axis is the
    direction in it nearest to x (or y), and the normal is such that most of the area is positively oriented.
    """
    if mesh.vertices.shape[1] == 2:
        return mesh.vertices
    normal = _flat_normal(mesh)
    if normal is None:
        raise ValueError("the mesh is not flat")
    if np.ptp(mesh.vertices[:, 2]) <= FLAT_RATIO * mesh.diameter:
        return np.ascontiguousarray(mesh.vertices[:, :2])
    axis = np.eye(3)[int(np.abs(normal[:2]).argmin())]
    first = axis - (axis @ normal) * normal
    first /= np.linalg.norm(first)
    flat = mesh.vertices @ np.column_stack([first, np.cross(normal, first)])
    if signed_contents(flat, mesh.simplices).sum() < 0:
        flat = mesh.vertices @ np.column_stack([first, -np.cross(normal, first)])
    return np.ascontiguousarray(flat)


def into_plane_of(space: Floats, flat: Floats, positions: Floats) -> Floats:
    """Points of the plane back in space.

    Parameters
    ----------
    space : (n, 3) float64        vertices of a flat mesh
    flat : (n, 2) float64         the same by `plane_coordinates`
    positions : (k, 2) float64    points to carry back

    Returns
    -------
    (k, 3) float64
    """
    if np.array_equal(space[:, :2], flat):
        return np.column_stack([positions, np.full(len(positions), space[0, 2])])
    centre_space, centre_flat = space.mean(axis=0), flat.mean(axis=0)
    axes, *_ = np.linalg.lstsq(flat - centre_flat, space - centre_space, rcond=None)
    return np.asarray(centre_space + (positions - centre_flat) @ axes)


def _flat_normal(mesh: Mesh) -> Floats | None:
    """Unit normal of the plane that holds every vertex, or None."""
    centred = mesh.vertices - mesh.vertices.mean(axis=0)
    scale = float(np.abs(centred).max())
    if scale == 0.0:
        return np.array([0.0, 0.0, 1.0])
    _, directions = np.linalg.eigh((centred / scale).T @ (centred / scale))
    normal: Floats = directions[:, 0]
    # Squares lose half of the digits: the distances themselves decide.
    return normal if float(np.ptp(centred @ normal)) <= FLAT_RATIO * mesh.diameter else None
