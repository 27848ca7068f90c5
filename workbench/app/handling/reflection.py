"""Mirror symmetry: a plane in space, or a line in the plane, and which vertices are each other's mirror images."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from workbench.core.arrays import Floats, Integers

TOLERANCE = 0.75
"""How far from a mirror image its vertex may be, of the distance of its own neighbours from it."""
NEIGHBOURS = 3
"""Itself among them: at a corner those farther off would say little about the mesh there."""


@dataclass(frozen=True, eq=False)
class Reflection:
    """p -> p - 2 (n p - h) n, for a `normal` n (d,) of length 1 and a `height` h of the plane above the origin."""

    normal: Floats
    height: float

    @classmethod
    def across(cls, normal: Floats, through: Floats) -> Reflection:
        """About the plane with a normal (d,) of any length but 0, through a point (d,)."""
        unit = np.asarray(normal, dtype=np.float64) / np.linalg.norm(normal)
        return cls(unit, float(unit @ through))

    def of(self, points: Floats) -> Floats:
        """(k, d) the mirror images of points (k, d)."""
        return np.asarray(points - 2.0 * np.outer(points @ self.normal - self.height, self.normal))


class Twins:
    """Which vertex is the mirror image of which.

    Parameters
    ----------
    vertices : (n, d) float64
    reflection : of them
    """

    def __init__(self, vertices: Floats, reflection: Reflection, tree: scipy.spatial.cKDTree | None = None) -> None:
        self._tree = scipy.spatial.cKDTree(vertices) if tree is None else tree
        self._vertices = vertices
        self.reflection = reflection
        self.count = len(vertices)

    def of(self, vertices: Integers) -> Integers:
        """(k,) int64: the twin of each of `vertices` (k,), -1 where none is near enough."""
        away, found = self._tree.query(self.reflection.of(self._vertices[vertices]))
        spacing = self._tree.query(self._vertices[found], k=min(NEIGHBOURS, len(self._vertices)))[0][:, 1:].mean(axis=1)
        return np.where(away <= TOLERANCE * spacing, found, -1).astype(np.int64)


def planes_of_box(vertices: Floats) -> dict[str, Reflection]:
    """By the name of its normal: the planes across the axes through the centre of the box round vertices (n, d)."""
    centre = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    return {name: Reflection.across(axis, centre) for name, axis in zip("xyz", np.eye(vertices.shape[1]), strict=False)}


def found_plane(vertices: Floats) -> Reflection:
    """The plane about which vertices (n, d) are most alike, of those across the axes of their spread and of the box."""
    centre = vertices.mean(axis=0)
    axes = np.linalg.eigh(np.cov((vertices - centre).T))[1].T
    candidates = [Reflection.across(axis, centre) for axis in axes]
    candidates += [*planes_of_box(vertices).values(), *(Reflection.across(axis, centre) for axis in np.eye(len(centre)))]
    tree = scipy.spatial.cKDTree(vertices)
    some = vertices[:: max(1, len(vertices) // 2000)]
    return min(candidates, key=lambda plane: float(np.mean(tree.query(plane.of(some))[0] ** 2)))


def fitted_reflection(places: Floats, images: Floats) -> Reflection:
    """The one that brings `places` (k, d) nearest to `images` (k, d).

    Its plane goes through the mean of all; its normal is that along which the pairs are farthest apart.
    """
    centre = 0.5 * (places.mean(axis=0) + images.mean(axis=0))
    one, other = places - centre, images - centre
    values, vectors = np.linalg.eigh(one.T @ other + other.T @ one)
    return Reflection.across(vectors[:, int(np.argmin(values))], centre)
