"""Two families of maps that show what inversions do to a distortion (Fig. 12 and Fig. 19), ready to be drawn."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from workbench.core.analysis.barrier_terms import without_barrier
from workbench.core.analysis.density import Density, descending
from workbench.core.arrays import Booleans, Floats, Integers
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.jacobians import build_elements, signed_singular_values
from workbench.core.mesh import Mesh


@dataclass(frozen=True, eq=False)
class PulledVertex:
    """The free centre of a star of triangles, pulled horizontally across it (Fig. 12).

    Parameters
    ----------
    offsets : (k,) float64            abscissa of the centre, the star's radius is 1
    positions : (k, v, 2) float64     vertex 0 is the centre; the source is the star with the centre at 0
    triangles : (m, 3) int64
    energies : (k,) float64           sum of w D as the solvers see it: inf where a barrier meets an inversion
    filtered_energies : (k,) float64  the same with the barrier removed on inverted triangles, always finite
    inverted : (k, m) bool            det <= 0
    """

    offsets: Floats
    positions: Floats
    triangles: Integers
    energies: Floats
    filtered_energies: Floats
    inverted: Booleans


@dataclass(frozen=True, eq=False)
class MirrorPath:
    """A simplex that goes straight to its mirror image, x(t) = (1 - t) y + t ybar (85).

    Parameters
    ----------
    t : (k,) float64
    positions : (k, n+1, n) float64
    energies : (k,) float64    volume times D of the unsigned singular values, its limit at the collapse t = 1/2; may be inf
    chord : (k,) float64       the straight line between the first and the last energy (86)
    violates : bool            whether an energy lies above the chord: then D is not convex in x
    """

    t: Floats
    positions: Floats
    energies: Floats
    chord: Floats
    violates: bool


def pulled_vertex(distortion: Distortion, sides: int = 6, reach: float = 2.2, count: int = 201) -> PulledVertex:
    """Energies of a star of `sides` triangles while its centre moves from 0 to `reach`.

    On an inverted triangle the filtered energy counts the distortion's own formula for those, else its formula without the
    barrier, see `without_barrier`; on the others, and for a distortion that has no barrier, it is the energy itself.
    Raises `WorkbenchError` for less than 3 sides or 2 points.
    """
    if sides < 3 or count < 2 or not math.isfinite(reach):
        raise WorkbenchError("A star has at least 3 sides, and a path at least 2 points and a finite reach.")
    # The right side of the star stands upright, so that one triangle collapses before its neighbours do.
    angles = (np.arange(sides) + 0.5) * 2.0 * np.pi / sides
    star = np.vstack([np.zeros(2), np.column_stack([np.cos(angles), np.sin(angles)])])
    ring = np.arange(1, sides + 1)
    triangles = np.column_stack([np.zeros(sides, dtype=np.int64), ring, np.roll(ring, -1)])
    elements = build_elements(Mesh(star, triangles))
    offsets = np.linspace(0.0, reach, count)
    positions = np.tile(star, (count, 1, 1))
    positions[:, 0, 0] = offsets
    sigma = np.concatenate([signed_singular_values(elements, x) for x in positions])
    values = replace(distortion, formula_on_inverted="").value(sigma)
    inverted = sigma[:, -1] <= 0.0
    filtered = values.copy()
    if distortion.formula_on_inverted:
        bare = Density.of(replace(distortion, formula=distortion.formula_on_inverted, barrier=False), 2)
    else:
        bare = without_barrier(Density.of(distortion, 2))
    filtered[inverted] = bare.signed(sigma[inverted])
    weights = elements.rest_measures
    return PulledVertex(
        offsets=offsets,
        positions=positions,
        triangles=elements.simplices,
        energies=values.reshape(count, sides) @ weights,
        filtered_energies=filtered.reshape(count, sides) @ weights,
        inverted=inverted.reshape(count, sides),
    )


def mirror_path(
    distortion: Distortion,
    dimension: int = 2,
    simplex: ArrayLike | None = None,
    t0: float = 0.0,
    t1: float = 1.0,
    count: int = 201,
) -> MirrorPath:
    """Energies of a simplex on its way from t0 to t1, where 0 is the simplex and 1 its mirror image in the first axis.

    Parameters
    ----------
    simplex : (n+1, n)     the corners y, None: a regular one

    Raises `WorkbenchError` for corners that are not those of a simplex.
    """
    if count < 2 or not (math.isfinite(t0) and math.isfinite(t1)):
        raise WorkbenchError("A path has at least 2 points and finite ends.")
    corners = regular_simplex(dimension) if simplex is None else np.asarray(simplex, dtype=np.float64)
    if corners.shape != (dimension + 1, dimension) or not np.isfinite(corners).all():
        raise WorkbenchError(
            f"A simplex of dimension {dimension} has {dimension + 1} corners with {dimension} coordinates each."
        )
    volume = abs(float(np.linalg.det(corners[1:] - corners[0]))) / math.factorial(dimension)
    if not volume > 0.0:
        raise WorkbenchError("The corners span no simplex: move one of them.")
    t = np.linspace(t0, t1, count)
    mirrored = corners * np.where(np.arange(dimension) == 0, -1.0, 1.0)
    positions = (1.0 - t)[:, None, None] * corners + t[:, None, None] * mirrored
    # The map of the simplex onto x(t) is diag(1 - 2t, 1, ..., 1), whatever the simplex.
    q = np.ones((count, dimension))
    q[:, 0] = 1.0 - 2.0 * t
    energies = volume * extended_values(Density.of(distortion, dimension), q)
    along = np.linspace(0.0, 1.0, count)
    with np.errstate(invalid="ignore"):
        chord = (1.0 - along) * energies[0] + along * energies[-1]
    ends_are_finite = bool(np.isfinite(energies[[0, -1]]).all())
    margin = 1e-9 * (np.abs(energies[0]) + np.abs(energies[-1]) + volume)
    return MirrorPath(t, positions, energies, chord, ends_are_finite and bool((energies > chord + margin).any()))


def extended_values(density: Density, q: Floats) -> Floats:
    """(m, n) signed -> (m,): D extended to vanishing singular values by its limit (80), as far as numbers show it."""
    sigma = descending(np.abs(q))
    values = density(sigma)
    lost = np.flatnonzero(np.isnan(values) & (sigma[:, -1] == 0.0))
    if len(lost):
        near = density(np.maximum(sigma[lost], 1e-12))
        nearer = density(np.maximum(sigma[lost], 1e-14))
        with np.errstate(invalid="ignore"):
            values[lost] = np.where(nearer > 2.0 * np.abs(near) + 1.0, np.inf, nearer)
    return values


def regular_simplex(dimension: int) -> Floats:
    """(n+1, n) corners with all edges of length 1 and the centre at 0, positively oriented."""
    if dimension == 2:
        corners = np.array([[-0.5, 0.0], [0.5, 0.0], [0.0, math.sqrt(0.75)]])
    else:
        corners = np.array([[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]]) / math.sqrt(8.0)
        corners = corners[[0, 2, 1, 3]]
    result: Floats = corners - corners.mean(axis=0)
    return result
