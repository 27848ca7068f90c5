"""What a panel shows of a solid: whole, cut open, peeled, pulled apart, as a window that looks into it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.measure import Measure
from workbench.core.solid_look.drawn_faces import MadePoints
from workbench.figures.mesh_pictures import FINER, Frame, Skin, blended, nearness

if TYPE_CHECKING:
    from workbench.figures.figure_maps import FigureMap
    from workbench.figures.mesh_panel import Scene
    from workbench.figures.recipe import Panel

VEIL = np.array([0.35, 0.40, 0.46])
LAYER = 1e-3
"""How much nearer than what is drawn the veil has to lie, as a part of the depth of the solid."""


def seen_of(map: FigureMap, panel: Panel) -> tuple[Skin, MadePoints | None]:
    """The triangles that a panel shows of a map, and the points that are made for them beside the vertices."""
    look = panel.look
    if look is None or map.mesh.dimension != 3:
        return map.skin, None
    values = None if look.shape.threshold is None else map.values(Measure.of(look.peel_by, look.parameters))
    faces = map.solid.faces(look.shape, map.positions, values, np.array(look.marked, dtype=np.int64))
    assert faces.simplices is not None
    return Skin(faces.triangles, faces.simplices), faces.made


def with_made(vertices: Floats, made: MadePoints | None) -> Floats:
    """Rows (n, c) of the vertices, followed by those of the points that are made of them."""
    return vertices if made is None else np.concatenate([vertices, made.at(vertices)])


def takes_away(scene: Scene) -> bool:
    """Whether a panel leaves out some of a solid, and a veil tells where it was."""
    look = scene.panel.look
    return look is not None and look.shape.takes_away and look.shape.ghost > 0 and scene.map.mesh.dimension == 3


def veiled(image: Floats, scene: Scene, part: Frame) -> Floats:
    """A picture (h, w, 4) with the boundary of a solid as a veil over what lies behind it, where something is gone."""
    look = scene.panel.look
    if look is None or not takes_away(scene):
        return image
    solid = scene.map.mesh.vertices if scene.panel.kind == "source" else scene.map.positions
    points = solid if scene.turn is None else solid @ scene.turn.T
    shell = scene.map.skin
    before = nearness(points, shell, part) - LAYER * float(np.ptp(points[:, 2]))
    is_before = before > nearness(scene.points, scene.skin, part)
    height, width = image.shape[:2]
    amount = look.shape.ghost * is_before.reshape(height, FINER, width, FINER).mean(axis=(1, 3))
    return blended(VEIL, amount, image)
