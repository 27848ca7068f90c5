"""What is drawn of a solid, as a value."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from workbench.core.arrays import Floats

Direction = tuple[float, float, float]

AXES: dict[str, Direction] = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
"""Normals of the planes that are offered by name."""


@dataclass(frozen=True)
class VolumeLook:
    """Which tetrahedra are seen, and how.

    Parameters
    ----------
    is_cut : bool            whether a plane cuts the solid
    normal : (3,)            of that plane, a unit vector
    place : float            where it stands, 0 at the end of the solid that `normal` points away from, 1 at the other
    is_flipped : bool        whether the side that `normal` points to is kept, or else the other
    is_exact : bool          whether tetrahedra are cut through, or else drawn whole or not at all
    cuts_target : bool       whether it is a plane of the target, or else one of the source; both show the same tetrahedra
    threshold : float        tetrahedra with less than this of the quantity to peel by are left out; None: none are
    only_marked : bool       whether only brushed tetrahedra are drawn, where there are any
    spread : float           how far tetrahedra are pulled apart: so many times as far as their centroids are from the middle
    ghost : float            opacity of the boundary round what is left of the solid
    is_wired : bool          whether that boundary is drawn as its edges, or else as a veil
    """

    is_cut: bool = False
    normal: Direction = AXES["x"]
    place: float = 0.5
    is_flipped: bool = False
    is_exact: bool = False
    cuts_target: bool = False
    threshold: float | None = None
    only_marked: bool = False
    spread: float = 0.0
    ghost: float = 0.12
    is_wired: bool = False

    @property
    def is_whole(self) -> bool:
        """Whether nothing but the boundary is to be seen."""
        return not (self.takes_away or self.spread > 0)

    @property
    def takes_away(self) -> bool:
        """Whether there may be tetrahedra that are not drawn though they could be seen."""
        return self.is_cut or self.threshold is not None or self.only_marked

    @property
    def follows_map(self) -> bool:
        """Whether other tetrahedra are seen when the map moves."""
        return self.threshold is not None or (self.is_cut and self.cuts_target)

    @property
    def axis(self) -> str:
        """Name of the normal, empty where it has none."""
        return next((name for name, normal in AXES.items() if normal == self.normal), "")

    def whole(self) -> VolumeLook:
        """The same with everything to be seen; how planes cut is kept."""
        return replace(self, is_cut=False, threshold=None, only_marked=False, spread=0.0)

    def heights(self, positions: Floats) -> Floats:
        """(n,): how far vertices (n, 3) lie beyond the plane, on the side that is taken away."""
        along = positions @ np.asarray(self.normal)
        low, high = float(along.min()), float(along.max())
        # never quite at an end: a plane through a whole face of the solid would flicker
        offset = low + min(max(self.place, 1e-6), 1.0 - 1e-6) * (high - low)
        return np.asarray(offset - along if self.is_flipped else along - offset)
