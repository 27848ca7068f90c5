"""Lines in a panel, as vectors: edges, wires, seams, cuts, the boundary of a surface; what is hidden in space is left out."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.boundary_sides import boundary_edges
from workbench.core.refine.edge_table import edges_of_faces
from workbench.core.seams import seam_edges
from workbench.figures.mesh_pictures import FINER, Frame, nearness

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from workbench.figures.mesh_panel import Scene

EDGE_COLOUR = "#303030"
EDGE = 0.12
WIRE = 0.3
SEAM_COLOUR, CUT_COLOUR = (0.66, 0.36, 0.10), (0.10, 0.65, 0.25)
FEATURE = 1.0
"""Widths of edges, of wires, of seams, cuts and boundaries, points, at 8 points of text."""
PIECE = 4.0
"""Pixels of a piece of a line in space, which is seen or is not."""
MOST_PIECES = 4_000_000
MOST_LINES = 60_000
"""Lines of a kind that are vectors; more of them are a picture, as what they lie on."""
TOLERANCE = 0.01
"""How far a line may lie behind what is seen there, as a part of what the panel shows."""


def draw_wires(axes: Axes, scene: Scene, colours: Floats, size: float, *, as_vectors: bool) -> None:
    """The sides of all triangles in their colours (k, 3), the nearest last."""
    from matplotlib.collections import PolyCollection

    corners = scene.points[scene.skin.triangles]
    order = np.arange(len(corners)) if scene.is_flat else np.argsort(corners[..., 2].mean(axis=1), kind="stable")
    wires = PolyCollection(
        list(corners[order, :, :2]), facecolors="none", edgecolors=colours[order], linewidths=WIRE * size,
        joinstyle="round", gid="wires", zorder=1,
    )  # fmt: skip
    wires.set_rasterized(not as_vectors)
    axes.add_collection(wires, autolim=False)


def draw_edges(axes: Axes, scene: Scene, frame: Frame, size: float) -> None:
    """The sides of all triangles over a picture of them."""
    edges = edges_of_faces(scene.skin.triangles, len(scene.points)).ends
    _draw(axes, scene, frame, edges, EDGE_COLOUR, EDGE * size, "edges")


def draw_features(axes: Axes, scene: Scene, frame: Frame, size: float, ink: str = "#222222") -> None:
    """Seams, cuts and the boundary of a surface, as far as its panel shows them; a solid has none."""
    map, panel = scene.map, scene.panel
    if map.mesh.dimension == 3:
        return
    texture = map.mesh.texture
    if panel.boundary:
        _draw(axes, scene, frame, boundary_edges(map.mesh.simplices), ink, FEATURE * size, "boundary")
    if panel.seams and texture is not None:
        _draw(axes, scene, frame, seam_edges(texture, map.mesh.simplices), SEAM_COLOUR, FEATURE * size, "seams")
    if panel.seams:
        _draw(axes, scene, frame, map.cuts, CUT_COLOUR, FEATURE * size, "cuts")


def _draw(axes: Axes, scene: Scene, frame: Frame, edges: Integers, colour: object, width: float, name: str) -> None:
    from matplotlib.collections import LineCollection

    lines = scene.points[edges] if scene.is_flat else _seen(scene, frame, edges)
    if len(lines):
        drawn = LineCollection(list(lines[..., :2]), colors=colour, linewidths=width, capstyle="round", zorder=3, gid=name)
        drawn.set_rasterized(len(lines) > MOST_LINES)
        axes.add_collection(drawn, autolim=False)


def _seen(scene: Scene, frame: Frame, edges: Integers) -> Floats:
    """(p, 2, 2): the parts of edges (e, 2) that nothing hides."""
    coarse = Frame(frame.centre, frame.half)
    near = nearness(scene.points, scene.skin, coarse)
    height, width = near.shape
    left, right, bottom, top = coarse.extent
    scale = np.array([width / (right - left), height / (top - bottom)])
    ends = scene.points[edges]
    pixels = (ends[..., :2] - [left, bottom]) * scale
    counts = np.ceil(np.linalg.norm(pixels[:, 1] - pixels[:, 0], axis=1) / (PIECE * FINER)).astype(np.int64)
    counts = np.clip(counts, 1, max(1, MOST_PIECES // max(len(edges), 1)))
    owner = np.repeat(np.arange(len(edges)), counts)
    step = (np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)) / counts[owner]

    def at(share: Floats) -> Floats:
        found: Floats = ends[owner, 0] + share[:, None] * (ends[owner, 1] - ends[owner, 0])
        return found

    middle = at(step + 0.5 / counts[owner])
    place = np.floor((middle[:, :2] - [left, bottom]) * scale).astype(np.int64)
    seen = near[np.clip(place[:, 1], 0, height - 1), np.clip(place[:, 0], 0, width - 1)]
    is_seen = middle[:, 2] >= seen - TOLERANCE * 2 * max(coarse.half)
    pieces = np.stack([at(step), at(step + 1.0 / counts[owner])], axis=1)
    return np.asarray(pieces[is_seen][..., :2])
