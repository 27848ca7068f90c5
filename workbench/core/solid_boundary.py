"""The boundary of a solid of genus 0, and where it goes on a ball or a cube."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy

from workbench.core.arrays import Floats, Integers
from workbench.core.errors import MeshError
from workbench.core.jacobians import build_elements, determinants
from workbench.core.mesh import Mesh
from workbench.core.relaxation import relaxed
from workbench.core.sphere_map import balanced_map, spherical_map, without_flips
from workbench.core.topology import signed_contents

SolidShape = Literal["ball", "cube"]
SphereMap = Literal["rays", "harmonic", "balanced"]

_BULGE = 0.15
_ROUNDS = 60


@dataclass(frozen=True, eq=False)
class SolidBoundary:
    """The boundary of a solid as a surface of its own.

    Attributes
    ----------
    surface : Mesh             triangles oriented outwards
    vertices : (k,) int64      vertex of the solid that each vertex of the surface is
    centre : (3,) float64      point that sees the surface best
    is_star : bool             whether it sees all of it from inside
    """

    surface: Mesh
    vertices: Integers
    centre: Floats
    is_star: bool


def solid_boundary(mesh: Mesh) -> SolidBoundary:
    """The boundary of a tetrahedral mesh. Raises `MeshError` where that is no single closed surface of genus 0."""
    if mesh.dimension != 3:
        raise MeshError("This start needs tetrahedra, and the mesh has triangles; choose another start.")
    topology = mesh.topology
    vertices, triangles = np.unique(topology.boundary_facets, return_inverse=True)
    surface = Mesh(mesh.vertices[vertices], triangles.reshape(-1, 3), mesh.name)
    found = _not_a_sphere(mesh, surface)
    if found:
        raise MeshError(
            f"This start needs a solid whose boundary is like a sphere, but {found}. Choose the start rest, or another mesh."
        )
    if signed_contents(mesh.vertices, mesh.simplices).sum() < 0.0:
        surface = Mesh(surface.vertices, surface.simplices[:, [1, 0, 2]], mesh.name)
    centre, margin = _seeing_point(surface)
    is_star = margin > 1e-9 * surface.diameter
    return SolidBoundary(surface, vertices, centre if is_star else _centroid(mesh), is_star)


def _not_a_sphere(mesh: Mesh, surface: Mesh) -> str:
    solid, boundary = mesh.topology, surface.topology
    if solid.component_count > 1:
        return f"this one has {solid.component_count} components"
    if not solid.is_consistently_oriented or not boundary.is_consistently_oriented:
        return "its tetrahedra are not oriented alike"
    if not boundary.is_manifold or len(boundary.boundary_vertices):
        return "its boundary is not a manifold"
    if boundary.component_count > 1:
        return f"its boundary has {boundary.component_count} components"
    return f"its boundary has genus {boundary.genus}" if boundary.genus else ""


def boundary_images(mesh: Mesh, boundary: SolidBoundary, shape: SolidShape, by: SphereMap) -> Floats:
    """Image (k, 3) of the boundary on the unit ball or the cube [-1, 1]^3, see `images_on_sphere` and `needed_bulge`."""
    images = images_on_sphere(boundary, by)
    result: Floats = images / gauge(images, shape, needed_bulge(mesh))[:, None]
    return result


def images_on_sphere(boundary: SolidBoundary, by: SphereMap) -> Floats:
    """Image (k, 3) of the boundary on the unit sphere: along rays from the centre, by the harmonic or the balanced map.

    Rays fold a boundary that is not star-shaped; folds are relaxed as far as that goes.
    """
    if by != "rays":
        return spherical_map(boundary.surface) if by == "harmonic" else balanced_map(boundary.surface)
    offsets = boundary.surface.vertices - boundary.centre
    lengths = np.linalg.norm(offsets, axis=1, keepdims=True)
    return without_flips(boundary.surface.simplices, offsets / np.maximum(lengths, 1e-300))


def relaxed_inside(mesh: Mesh, positions: Floats) -> Floats:
    """The map (n, 3) with inner vertices near inverted tetrahedra at the middle of their neighbours, as far as that helps."""
    elements = build_elements(mesh)

    def inverted(places: Floats) -> Integers:
        return np.flatnonzero(~(determinants(elements, np.ascontiguousarray(places)) > 0))

    return relaxed(mesh.simplices, positions, inverted, held=mesh.topology.boundary_vertices, rounds=_ROUNDS)


def gauge(points: Floats, shape: SolidShape, bulge: float = 0.0) -> Floats:
    """(k,) the factor by which the unit ball, or the cube [-1, 1]^3, has to grow to reach each point (k, 3).

    A cube with a `bulge` above 0 is rounder: strictly convex, so that no tetrahedron can lie flat in a face.
    """
    length: Floats = np.linalg.norm(points, axis=1)
    return length if shape == "ball" else (1.0 - bulge) * np.abs(points).max(axis=1) + bulge * length


def needed_bulge(mesh: Mesh) -> float:
    """0 for a mesh whose boundary may go to a cube with flat faces; that of a rounder one where tetrahedra would be flattened.

    Those with all corners on the boundary may end up in one face.
    """
    is_boundary = np.zeros(mesh.vertex_count, dtype=bool)
    is_boundary[mesh.topology.boundary_vertices] = True
    return _BULGE if bool(is_boundary[mesh.simplices].all(axis=1).any()) else 0.0


def _seeing_point(surface: Mesh) -> tuple[Floats, float]:
    """The point farthest inside all planes of the triangles, and how far: above 0 only where the surface is star-shaped."""
    corners = surface.vertices[surface.simplices]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    normals = normals[lengths > 0.0] / lengths[lengths > 0.0, None]
    middle = surface.vertices.mean(axis=0)
    offsets = np.einsum("ij,ij->i", normals, corners[lengths > 0.0, 0] - middle) / surface.diameter
    rows = np.column_stack([normals, np.ones(len(normals))])
    solved = scipy.optimize.linprog(
        [0.0, 0.0, 0.0, -1.0], A_ub=rows, b_ub=offsets, bounds=[(-1.0, 1.0)] * 3 + [(-2.0, 1.0)], method="highs"
    )
    if solved.x is None:
        return middle, -np.inf
    return middle + solved.x[:3] * surface.diameter, float(solved.x[3]) * surface.diameter


def _centroid(mesh: Mesh) -> Floats:
    volumes = np.abs(signed_contents(mesh.vertices, mesh.simplices))
    centres = mesh.vertices[mesh.simplices].mean(axis=1)
    return volumes @ centres / volumes.sum()
