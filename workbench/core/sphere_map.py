"""A closed surface of genus 0 onto the unit sphere."""

from __future__ import annotations

import numpy as np
import scipy

from workbench.core.arrays import Floats, Integers
from workbench.core.convex_map import cotangent_weights, laplacian
from workbench.core.definite_solve import solve_with_fixed
from workbench.core.errors import WorkbenchError
from workbench.core.jacobians import rest_edges
from workbench.core.mesh import Mesh
from workbench.core.predicates import orientation_3d
from workbench.core.relaxation import relaxed

_CAP = 2.0
"""Each half sphere is solved out to this radius in the plane, the equator being 1: the two overlap."""
_HALVES = 8
_LEAST_HELD = 0.02
"""Part of the area that has to be held, and to be free; else the halves are none, and the alternation would collapse."""
_SMALLEST_WEIGHT = 0.05
"""Weights of edges are at least this part of their median: negative ones could fold the map."""
_CENTRED = 1e-9
_BALANCINGS = 12
_WORTH_IT = 0.9
"""A round that leaves more than this part of the stretch is the last."""
_MOST_CHANGE = 1e4
"""Weights change by at most this factor a round."""


def spherical_map(surface: Mesh) -> Floats:
    """The harmonic map to the unit sphere, outwards, about centred; flipped triangles are relaxed away.

    The surface less one triangle is laid out in the plane by a harmonic map and wrapped round the sphere by the
    stereographic projection, which does too little near that triangle. So the two half spheres are solved in turn, each in
    the stereographic plane of its own pole with the other half held (Schwarz's alternation), then the map is centred by the
    conformal motions of the sphere.
    Arms many times as long as wide shrink to specks, whose triangles may come out flipped.

    Parameters
    ----------
    surface : Mesh     triangles in space: closed, genus 0, one component, oriented outwards

    Returns
    -------
    (n, 3) float64, of unit length

    Raises `WorkbenchError` where a linear system is singular.
    Source: Haker et al. 2000, Gu & Yau 2003 and Choi, Lam & Lui 2015, for the way by the plane.
    """
    weights = _positive(cotangent_weights(surface))
    return without_flips(surface.simplices, _alternated(surface, weights, _layout(surface, weights)))


def balanced_map(surface: Mesh) -> Floats:
    """A map to the unit sphere like `spherical_map`, whose arms do not shrink to specks: weights are lowered where it shrinks.

    The weights stay positive; of some rounds the map with the fewest flipped triangles and the least stretch from the sphere
    back to the surface is taken.

    Parameters
    ----------
    surface : Mesh     as there

    Returns
    -------
    (n, 3) float64, of unit length

    Source: Yoshizawa, Belyaev & Seidel 2004, for the weights, on discs.
    """
    weights = _positive(cotangent_weights(surface))
    sphere = _alternated(surface, weights, _layout(surface, weights))
    best, least = sphere, (np.inf, np.inf)
    for _ in range(_BALANCINGS):
        stretches = _stretches_back(surface, sphere)
        flips = len(flipped_triangles(surface.simplices, sphere))
        now = (flips, float(stretches.max() if not np.isfinite(stretches).all() else (stretches**2).mean()))
        gains = flips < least[0] or (flips == least[0] and now[1] < _WORTH_IT * least[1])
        if now < least:
            best, least = sphere, now
        if not gains:
            break
        weights = weights / np.clip(stretches / np.median(stretches), 1.0 / _MOST_CHANGE, _MOST_CHANGE)[:, None]
        plane = (sphere @ np.array([1.0, 1j, 0.0])) / np.maximum(1.0 - sphere[:, 2], 1e-12)
        try:
            sphere = _alternated(surface, weights, plane)
        except WorkbenchError:  # too uneven to be solved
            break
    return without_flips(surface.simplices, best)


def _alternated(surface: Mesh, weights: Floats, plane: Floats) -> Floats:
    """The centred map to the sphere as the alternation from `plane` gives it: the round with the fewest flipped triangles."""
    matrix = laplacian(surface.simplices, weights, surface.vertex_count)
    areas = _vertex_areas(surface)
    plane = _balanced(plane, areas)
    best, fewest = _upright(surface.simplices, _centred(_wrapped(plane), areas))
    for _ in range(_HALVES):
        held_area = float(areas[np.abs(plane) >= _CAP].sum())
        if not _LEAST_HELD < held_area < 1.0 - _LEAST_HELD:
            break
        plane = _solved_half(matrix, plane, surface.elimination_order)
        sphere, flips = _upright(surface.simplices, _centred(_wrapped(plane), areas))
        if flips <= fewest:
            best, fewest = sphere, flips
        plane = _balanced(1.0 / np.conj(_off_origin(plane)), areas)
    return best


def _stretches_back(surface: Mesh, sphere: Floats) -> Floats:
    """(m,) root mean square of the singular values from the triangles on the sphere back to those of the surface."""
    edges = rest_edges(Mesh(sphere, surface.simplices))
    areas = np.abs(edges[:, 0, 0] * edges[:, 1, 1])
    back = rest_edges(surface) @ np.linalg.inv(np.where(areas[:, None, None] > 1e-250, edges, np.eye(2)))
    squares = np.einsum("mij,mij->m", back, back)
    result: Floats = np.sqrt(np.where(areas > 1e-250, squares, squares.max()))
    return result


def _upright(triangles: Integers, sphere: Floats) -> tuple[Floats, int]:
    """The map, mirrored where most of its triangles are flipped, and how many are then."""
    flips = len(flipped_triangles(triangles, sphere))
    if 2 * flips <= len(triangles):
        return sphere, flips
    mirrored = sphere * np.array([-1.0, 1.0, 1.0])
    return mirrored, len(flipped_triangles(triangles, mirrored))


def flipped_triangles(triangles: Integers, sphere: Floats) -> Integers:
    """Triangles (k,) that are not seen counter-clockwise from outside, exactly; `sphere` (n, 3)."""
    a, b, c = (np.ascontiguousarray(sphere[triangles[:, i]]) for i in range(3))
    return np.flatnonzero(orientation_3d(np.zeros_like(a), a, b, c) <= 0)


def without_flips(triangles: Integers, sphere: Floats) -> Floats:
    """The map (n, 3) with vertices near flipped triangles moved to the middle of their neighbours, as far as that helps."""

    def flipped(places: Floats) -> Integers:
        return flipped_triangles(triangles, places)

    def on_sphere(means: Floats) -> Floats:
        result: Floats = means / np.maximum(np.linalg.norm(means, axis=1, keepdims=True), 1e-300)
        return result

    return relaxed(triangles, sphere, flipped, on_sphere)


def _positive(weights: Floats) -> Floats:
    return np.maximum(weights, _SMALLEST_WEIGHT * float(np.median(np.abs(weights))))


def _vertex_areas(surface: Mesh) -> Floats:
    corners = surface.vertices[surface.simplices]
    areas = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    shares = np.bincount(surface.simplices.ravel(), np.repeat(areas, 3), surface.vertex_count)
    return shares / shares.sum()


def _layout(surface: Mesh, weights: Floats) -> Floats:
    """The surface less its most regular triangle in the complex plane (n,), by its harmonic map to the triangle."""
    matrix = laplacian(surface.simplices, weights, surface.vertex_count)
    corners = surface.vertices[surface.simplices]
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    left_out = surface.simplices[int(np.argmin(sides.max(axis=1) / sides.min(axis=1)))]
    angle = 2.0 * np.pi * np.arange(3) / 3.0
    places = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    positions = solve_with_fixed(matrix, left_out, places, surface.elimination_order)
    return positions @ np.array([1.0, 1j])


def _balanced(plane: Floats, areas: Floats) -> Floats:
    """Scaled so that half of the area lies within the unit circle, about its middle."""
    size = np.abs(plane)
    order = np.argsort(size, kind="stable")
    median = size[order[np.searchsorted(np.cumsum(areas[order]), 0.5)]]
    return plane / max(float(median), 1e-300)


def _off_origin(plane: Floats) -> Floats:
    return np.where(np.abs(plane) < 1e-12, 1e-12, plane)


def _solved_half(matrix: scipy.sparse.csr_matrix, plane: Floats, order: Integers) -> Floats:
    held = np.flatnonzero(np.abs(plane) >= _CAP)
    places = np.stack([plane[held].real, plane[held].imag], axis=1)
    return solve_with_fixed(matrix, held, places, order) @ np.array([1.0, 1j])


def _wrapped(plane: Floats) -> Floats:
    """Stereographic projection of the complex plane (n,) to the unit sphere (n, 3); the unit circle is the equator."""
    squares = np.abs(plane) ** 2
    points = np.stack([2.0 * plane.real, 2.0 * plane.imag, squares - 1.0], axis=1)
    return points / (squares + 1.0)[:, None]


def _centred(sphere: Floats, areas: Floats) -> Floats:
    """Moved by conformal motions of the sphere until the centre of mass of the surface's area is 0."""
    for _ in range(200):
        centre = areas @ sphere
        size = float(np.linalg.norm(centre))
        if size < _CENTRED:
            break
        shift = centre * (min(size, 0.9) / size)
        apart = sphere - shift
        squares = np.einsum("ij,ij->i", apart, apart)
        sphere = (1.0 - shift @ shift) * apart / np.maximum(squares, 1e-300)[:, None] - shift
        sphere /= np.linalg.norm(sphere, axis=1, keepdims=True)
    return sphere
