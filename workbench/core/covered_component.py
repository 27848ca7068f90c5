"""Components of a mesh that a map puts inside one another: one rule for figures in the plane and solids."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from workbench.core.arrays import Booleans, Floats, Integers


def covered_component(
    belongs: Integers, boundary: Integers, positions: Floats, is_inside: Callable[[Floats, Booleans], bool]
) -> int:
    """Number of a component that lies inside the image of another one; -1 where there is none.

    The boundaries do not meet but in common vertices and edges, so one point of its own tells for the whole component.

    Parameters
    ----------
    belongs : (b,) int64           component of each boundary facet
    boundary : (b, n) int64        vertices of the facets
    positions : (N, n) float64
    is_inside                      whether a point (n,) lies inside what the facets of a mask (b,) bound
    """
    components = np.unique(belongs)
    for component in components if len(components) > 1 else ():
        own, others = boundary[belongs == component], belongs != component
        alone = own[~np.isin(own, boundary[others])]
        point = positions[alone[0]] if len(alone) else positions[own[0]].mean(axis=0)
        if is_inside(point, others):
            return int(component)
    return -1
