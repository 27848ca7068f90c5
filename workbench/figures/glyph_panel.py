"""Glyphs in a panel, as vectors: lines along principal stretches, images of circles, outlines of images of balls."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Booleans, Integers, Points
from workbench.core.errors import WorkbenchError
from workbench.core.glyph_places import GlyphPlaces, PlacedGlyphs
from workbench.core.glyph_shapes import ellipses, stretch_lines
from workbench.figures.glyph_colours import BODY, EQUAL, LONGER, SHORTER
from workbench.figures.mesh_pictures import Frame, nearness

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from workbench.figures.mesh_panel import Scene

INK = (0.11, 0.13, 0.15)
LINE, CASING, RING = 0.55, 1.15, 0.45
"""Widths of lines, of what is white below them, and of ellipses, points, at 8 points of text."""
SUNK = 0.5
"""How far the middle of a glyph may lie behind what is seen there, in radii."""


def draw_glyphs(axes: Axes, scene: Scene, frame: Frame, size: float) -> None:
    """Draw the glyphs that a panel asks for; `size` is a factor of the widths of lines.

    Raises `WorkbenchError` for a map that has no stretches in the sense of glyphs.
    """
    from matplotlib.collections import LineCollection, PolyCollection

    glyphs, radius = _placed(scene)
    glyphs = _chosen(glyphs, _visible(glyphs, scene, frame, radius))
    if scene.panel.glyphs == "stretches":
        ends = stretch_lines(glyphs.centres, glyphs.axes)[..., :2].reshape(-1, 2, 2)
        colours = np.array([SHORTER, EQUAL, LONGER])[glyphs.signs.ravel() + 1]
        for width, colour, order in ((CASING, "white", 5), (LINE, colours, 6)):
            axes.add_collection(
                LineCollection(list(ends), colors=colour, linewidths=width * size, zorder=order, gid="glyphs"), autolim=False
            )
        return
    is_body = glyphs.axes.shape[1] == 3
    if not scene.is_flat:
        glyphs = _chosen(glyphs, np.argsort(glyphs.centres[:, 2], kind="stable"))  # the nearest is drawn last
    rings = ellipses(glyphs.centres[:, :2], _outline_axes(glyphs.axes) if is_body else glyphs.axes[..., :2])
    axes.add_collection(
        PolyCollection(
            list(rings), facecolors=BODY if is_body else "none", edgecolors=INK, linewidths=RING * size, zorder=5, gid="glyphs"
        ),
        autolim=False,
    )


def _placed(scene: Scene) -> tuple[PlacedGlyphs, float]:
    """The glyphs as they are seen, and the radius that they have at rest."""
    map, panel = scene.map, scene.panel
    if map.positions.shape[1] != map.mesh.dimension:
        raise WorkbenchError("Glyphs are drawn of maps to the plane and of solids; this one takes a surface into space.")
    source = scene.drawn(map.mesh.vertices)
    places = map.glyph_places.get(panel.glyph_count) if panel.look is None else None
    if places is None:
        places = GlyphPlaces(map.mesh, source, scene.skin.triangles, scene.skin.simplex, panel.glyph_count)
        if panel.look is None:  # else other faces are seen of another map
            map.glyph_places[panel.glyph_count] = places
    stretches = places.stretches(map.positions)
    if panel.kind == "source":
        found = places.on_source(stretches, source, panel.glyph_size, as_lines=panel.glyphs == "stretches")
    else:
        found = places.on_target(stretches, scene.drawn(map.positions), panel.glyph_size)
    if scene.turn is not None:
        found = PlacedGlyphs(found.centres @ scene.turn.T, found.axes @ scene.turn.T, found.signs)
    return found, panel.glyph_size * places.radius


def _chosen(glyphs: PlacedGlyphs, rows: Booleans | Integers) -> PlacedGlyphs:
    return PlacedGlyphs(glyphs.centres[rows], glyphs.axes[rows], glyphs.signs[rows])


def _visible(glyphs: PlacedGlyphs, scene: Scene, frame: Frame, radius: float) -> Booleans:
    """(k,): those whose middle nothing hides."""
    if scene.is_flat:
        return np.ones(len(glyphs.centres), dtype=bool)
    coarse = Frame(frame.centre, frame.half)
    near = nearness(scene.points, scene.skin, coarse)
    left, right, bottom, top = coarse.extent
    height, width = near.shape
    column = np.floor((glyphs.centres[:, 0] - left) / (right - left) * width).astype(np.int64)
    row = np.floor((glyphs.centres[:, 1] - bottom) / (top - bottom) * height).astype(np.int64)
    inside = (column >= 0) & (column < width) & (row >= 0) & (row < height)
    seen = near[np.clip(row, 0, height - 1), np.clip(column, 0, width - 1)]
    return np.asarray(inside & (glyphs.centres[:, 2] >= seen - SUNK * radius))


def _outline_axes(axes: Points) -> Points:
    """Half axes (k, 2, 2) of the outlines of ellipsoids with half axes (k, 3, 3), seen along the third direction."""
    shadow = (axes.transpose(0, 2, 1) @ axes)[:, :2, :2]
    squares, lines = np.linalg.eigh(shadow)
    return np.asarray(np.sqrt(np.maximum(squares, 0.0))[:, :, None] * lines.transpose(0, 2, 1))
