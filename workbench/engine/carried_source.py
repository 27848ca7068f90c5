"""The surface that a solid is to carry, by its name: alike in the window and without one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from workbench.core.carried_surface import CarriedSurface, carry
from workbench.core.mesh import Mesh
from workbench.core.samples import make_sample
from workbench.io.opening import SAMPLE, read_source


def carry_source(source: str, solid: Mesh) -> CarriedSurface:
    """The surface of a file, or `sample:ID`, placed in a solid. Raises `WorkbenchError`.

    A sample lies in the solid bar, and is scaled into the box of any other solid.
    """
    surface = read_source(source).mesh
    return carry(_into_box(surface, solid) if source.startswith(SAMPLE) else surface, solid)


def _into_box(surface: Mesh, solid: Mesh) -> Mesh:
    """A surface that lies in the solid bar, scaled and moved into the middle of the box of another solid."""
    if surface.vertices.shape[1] != 3:
        return surface  # no solid carries it
    box, bar = (np.stack([v.min(axis=0), v.max(axis=0)]) for v in (solid.vertices, make_sample("bar-3d").vertices))
    scale = float((np.ptp(box, axis=0) / np.ptp(bar, axis=0)).min())
    return replace(surface, vertices=box.mean(axis=0) + scale * (surface.vertices - bar.mean(axis=0)))
