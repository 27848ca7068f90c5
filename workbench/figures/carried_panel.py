"""A carried surface in a panel: seen through the solid that takes it along, in the colours of its own map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.measure import DESCRIPTORS, Measure
from workbench.figures.colour_scale import centred_scale, colour_scale
from workbench.figures.mesh_pictures import FINER, Frame, Skin, blended, coloured_picture, nearness

if TYPE_CHECKING:
    from workbench.figures.mesh_panel import Scene


@dataclass(frozen=True, eq=False)
class CarriedLayer:
    """The surface as it is seen: turned `points` (k, 3), all triangles, `colours` (m, 3); `opacity` of the solid round it."""

    points: Floats
    skin: Skin
    colours: Floats
    opacity: float

    def below(self, image: Floats, scene: Scene, part: Frame) -> Floats:
        """The picture (h, w, 4) of the solid as a veil over the surface, but where the surface lies before it."""
        inner = coloured_picture(self.points, self.skin, self.colours, part)
        is_before = nearness(scene.points, scene.skin, part) > nearness(self.points, self.skin, part)
        height, width = image.shape[:2]
        share = is_before.reshape(height, FINER, width, FINER).mean(axis=(1, 3))
        return blended(image[..., :3], self.opacity * share, inner)


def carried_layer(scene: Scene) -> CarriedLayer | None:
    """What a panel shows of a carried surface; None where it shows none."""
    look, carried = scene.panel.carried, scene.map.carried
    if look is None or carried is None:
        return None
    moved = carried.at(scene.map.positions)
    measure = Measure.of(look.colour, look.parameters)
    values = carried.measures(moved, (measure,))[measure.id]
    finite = values[np.isfinite(values)]
    is_centred = look.colour in DESCRIPTORS
    limits, logarithmic = look.range, look.logarithmic
    paint = centred_scale(finite, 1.0, limits, logarithmic) if is_centred else colour_scale(finite, limits, logarithmic)
    low, high = paint.get_clim()
    # what has no area has no value: it is drawn as the least
    colours = paint.to_rgba(np.clip(np.nan_to_num(values, nan=low, posinf=high), low, high))[:, :3]
    vertices = carried.surface.vertices if scene.panel.kind == "source" else moved
    points = vertices if scene.turn is None else vertices @ scene.turn.T
    triangles = carried.surface.simplices
    return CarriedLayer(points, Skin(triangles, np.arange(len(triangles))), colours, look.opacity)
