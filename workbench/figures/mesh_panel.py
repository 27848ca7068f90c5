"""A mesh in a panel: triangles as vectors where it is flat, else a picture of high resolution inside the vector page."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from workbench.core.arrays import Booleans, Floats
from workbench.core.mesh import Mesh
from workbench.core.solid_look.drawn_faces import MadePoints
from workbench.figures.carried_panel import carried_layer
from workbench.figures.colour_scale import INVERTED
from workbench.figures.figure_maps import FigureMap
from workbench.figures.glyph_panel import draw_glyphs
from workbench.figures.line_panel import EDGE, EDGE_COLOUR, draw_edges, draw_features, draw_wires
from workbench.figures.mesh_pictures import (
    Frame,
    Skin,
    coloured_picture,
    frame_round,
    in_strips,
    view_of,
)
from workbench.figures.picture_sampling import areas
from workbench.figures.recipe import NO_GLYPHS, Panel
from workbench.figures.scale_bar_panel import draw_scale_bar
from workbench.figures.solid_panel import seen_of, veiled, with_made
from workbench.figures.texture_panel import TexturedScene, picture_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable

MOST_VECTORS = 120_000
"""Triangles of all panels of a page that are drawn as vectors; what is beyond them becomes a picture."""
PLAIN_COLOUR = (0.80, 0.86, 0.92)
WIRE_COLOUR = (0.25, 0.32, 0.40)
"""Colours of triangles, and of wires, that show neither a measure nor a texture."""
OUTLINE = 0.45
ANCHOR = 2.4
"""Width of the line round a mesh, size of an anchor, points, at 8 points of text."""
THICKEST = 0.15
"""Part of a mesh's area that the line round it may cover; else it is left out."""
SEAM = 0.25
"""Width of the line in a triangle's own colour that closes the hairline between it and its neighbour, points."""


@dataclass(frozen=True, eq=False)
class Scene:
    """What a panel shows of a map: `points` (p, 2), or (p, 3) turned to the viewer, and the triangles that are seen.

    `turn` (3, 3) is what turned them, as rows to the right, up and to the viewer; `made` makes the points that are drawn
    beside the vertices.
    """

    map: FigureMap
    panel: Panel
    points: Floats
    skin: Skin
    turn: Floats | None = None
    made: MadePoints | None = None

    def drawn(self, vertices: Floats) -> Floats:
        """Rows (n, c) of the vertices -> (p, c) of all points that are drawn."""
        return with_made(vertices, self.made)

    @property
    def is_flat(self) -> bool:
        return self.points.shape[1] == 2

    @property
    def inverted(self) -> Booleans:
        """(k,) of the visible triangles."""
        found: Booleans = self.map.singular_values.inverted[self.skin.simplex]
        return found

    @property
    def is_vector(self) -> bool:
        """Whether its triangles are drawn as paths where there are not too many."""
        return self.panel.wires or (self.is_flat and not self.panel.is_textured)


def scene_of(map: FigureMap, panel: Panel) -> Scene:
    """The source or the target of a map, seen from where it shows itself well."""
    points = map.mesh.vertices if panel.kind == "source" else map.positions
    turn = None
    if points.shape[1] == 3:
        mesh = map.mesh if map.mesh.vertices.shape[1] == 3 else Mesh(points, map.mesh.simplices)
        turn = np.array(panel.view) if panel.view else view_of(mesh)
    skin, made = seen_of(map, panel)
    points = with_made(points, made)
    return Scene(map, panel, points if turn is None else points @ turn.T, skin, turn, made)


def draw_scene(
    axes: Axes,
    scene: Scene,
    paint: ScalarMappable | None,
    values: Floats | None,
    frame: Frame,
    *,
    as_vectors: bool,
    size: float,
) -> None:
    """Draw a mesh into axes of the size of `frame`.

    Parameters
    ----------
    values : (k,) float64     of the visible triangles, coloured by `paint`; None for a pattern
    frame : Frame             what is seen; its density is that of a picture
    size : float              factor of the widths of lines, 1 at 8 points of text
    """
    left, right, bottom, top = frame.extent
    axes.set(xlim=(left, right), ylim=(bottom, top), xticks=[], yticks=[], autoscale_on=False)
    axes.spines[:].set_visible(False)
    carried = carried_layer(scene)

    def whole(image: Floats, part: Frame) -> Floats:
        return veiled(image if carried is None else carried.below(image, scene, part), scene, part)

    if scene.panel.wires:
        draw_wires(axes, scene, colours_of(scene, paint, values, WIRE_COLOUR), size, as_vectors=as_vectors)
    elif scene.panel.is_textured:
        texture = TexturedScene(scene, frame, picture_of(scene.panel))
        _picture(axes, in_strips(lambda part: whole(texture.draw(part), part), frame), frame)
    else:
        colours = colours_of(scene, paint, values)
        if as_vectors:
            _triangles(axes, scene, colours, size)
        else:
            on_top = scene.inverted

            def draw(part: Frame) -> Floats:
                return whole(coloured_picture(scene.points, scene.skin, colours, part, on_top), part)

            _picture(axes, in_strips(draw, frame), frame)
    if scene.panel.edges and not (as_vectors or scene.panel.wires) and len(scene.skin.triangles) <= MOST_VECTORS:
        draw_edges(axes, scene, frame, size)
    draw_features(axes, scene, frame, size)
    if scene.is_flat and scene.map.mesh.dimension == 2:
        _outline(axes, scene, size)
        if scene.panel.anchors and len(scene.map.anchors):
            places = scene.points[scene.map.anchors]
            axes.plot(*places.T, "o", ms=ANCHOR * size, color="#0072b2", mec="black", mew=0.3 * size, zorder=4)
    draw_on_top(axes, scene, frame, size)


def draw_on_top(axes: Axes, scene: Scene, frame: Frame, size: float, ink: str = "#222222", paper: str = "white") -> None:
    """The glyphs and the scale bar that a panel asks for."""
    if scene.panel.glyphs != NO_GLYPHS:
        draw_glyphs(axes, scene, frame, size)
    if scene.panel.scale_bar:
        draw_scale_bar(axes, frame, size, ink, paper)


def frame_in(points: Floats, half: tuple[float, float], width: float, height: float, dpi: int) -> Frame:
    """The frame about points that fills a box of `width` by `height` mm and shows `half` at least."""
    scale = min(width / (2 * half[0]), height / (2 * half[1]))  # mm a unit
    centre = frame_round(points).centre
    return Frame(centre, (0.5 * width / scale, 0.5 * height / scale), scale / 25.4 * dpi)


def colours_of(
    scene: Scene, paint: ScalarMappable | None, values: Floats | None, plain: tuple[float, float, float] = PLAIN_COLOUR
) -> Floats:
    """(k, 3) of the visible triangles: those of their values, or one for all."""
    if paint is None or values is None:
        colours: Floats = np.tile(np.array(plain), (len(scene.skin.triangles), 1))
    else:
        colours = paint.to_rgba(np.clip(values, *_beyond(paint)))[:, :3]
    colours[scene.inverted] = INVERTED
    return colours


def _beyond(paint: ScalarMappable) -> tuple[float, float]:
    """A value below the colours and one above, which every norm takes: what lies further out is drawn alike."""
    low, high = paint.get_clim()
    return (0.5 * low, 2.0 * high) if low > 0 else (low - (high - low), high + (high - low))


def _picture(axes: Axes, image: Floats, frame: Frame) -> None:
    axes.imshow(image, extent=frame.extent, origin="lower", interpolation="none", aspect="auto")


def _triangles(axes: Axes, scene: Scene, colours: Floats, size: float) -> None:
    from matplotlib.collections import PolyCollection

    order = np.argsort(scene.inverted, kind="stable")  # inverted ones lie on top
    edges: dict[str, Any] = {"edgecolors": EDGE_COLOUR, "linewidths": EDGE * size} if scene.panel.edges else {
        "edgecolors": colours[order], "linewidths": SEAM
    }  # fmt: skip
    corners: Any = scene.points[scene.skin.triangles[order]]  # an array will do for a sequence of polygons
    axes.add_collection(
        PolyCollection(corners, facecolors=colours[order], joinstyle="round", gid="triangles", zorder=1, **edges),
        autolim=False,
    )


def _outline(axes: Axes, scene: Scene, size: float) -> None:
    from matplotlib.collections import LineCollection

    edges = scene.points[scene.map.mesh.topology.boundary_facets]
    (left, right), points = axes.get_xlim(), 72.0 / axes.figure.dpi * axes.get_window_extent().width
    width = OUTLINE * size * (right - left) / points  # in the units of the map
    covered = width * np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1).sum()
    if covered > THICKEST * areas(scene.points, scene.skin.triangles).sum():
        return
    axes.add_collection(LineCollection(list(edges), colors="#222222", linewidths=OUTLINE * size, zorder=3), autolim=False)
