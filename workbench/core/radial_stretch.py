"""A solid onto a ball or a cube: rays from its centre stretched until its boundary is where it belongs."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.mesh import Mesh
from workbench.core.ray_hits import farthest_hits
from workbench.core.solid_boundary import (
    SolidShape,
    SphereMap,
    gauge,
    images_on_sphere,
    needed_bulge,
    solid_boundary,
)


def radial_stretch(mesh: Mesh, shape: SolidShape, by: SphereMap) -> Floats:
    """Every vertex at the part of its ray's image that it has of the ray itself.

    A ray from the centre leaves the solid at a point whose image on the sphere is known; a vertex at half the way out comes to
    lie at half the way to that image. With images along the rays, directions are kept. Where the solid is not star-shaped a ray
    is taken up to where it leaves the solid last, and tetrahedra may come out inverted.

    Parameters
    ----------
    mesh : Mesh        tetrahedra whose boundary is like a sphere

    Returns
    -------
    (n, 3) float64     boundary vertices exactly on the unit sphere, or on the cube [-1, 1]^3

    Raises `MeshError` where the boundary is not like a sphere.
    Source: Nadeem et al. 2018 in the form of the survey, Figs. 1 and 10.
    """
    boundary = solid_boundary(mesh)
    surface, centre = boundary.surface, boundary.centre
    images = images_on_sphere(boundary, by)
    offsets = mesh.vertices - centre
    lengths = np.linalg.norm(offsets, axis=1)
    inner = np.setdiff1d(np.flatnonzero(lengths > 1e-12 * mesh.diameter), boundary.vertices)
    hit, shares, distances = farthest_hits(centre, offsets[inner] / lengths[inner, None], surface.simplices, surface.vertices)
    # shares of the cone instead of the triangle, so that images along the rays give back the ray
    corners = surface.simplices[hit]
    weights = shares * lengths[boundary.vertices][corners]
    directions = np.einsum("ki,kij->kj", weights, images[corners])
    missed = hit < 0
    directions[missed], distances[missed] = offsets[inner][missed], np.inf

    positions = np.zeros_like(mesh.vertices)
    bulge = needed_bulge(mesh)
    reach = np.maximum(gauge(directions, shape, bulge), 1e-300)
    positions[inner] = (lengths[inner] / distances / reach)[:, None] * directions
    positions[boundary.vertices] = images / gauge(images, shape, bulge)[:, None]
    return positions
