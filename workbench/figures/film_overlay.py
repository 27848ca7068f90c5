"""What lies over the triangles of a film: wires, seams, boundaries, glyphs, scale bars, drawn as figures draw them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from workbench.figures.film_page import DPI
from workbench.figures.film_shading import Pixels
from workbench.figures.line_panel import draw_features, draw_wires
from workbench.figures.mesh_panel import draw_on_top
from workbench.figures.mesh_pictures import Frame
from workbench.figures.recipe import NO_GLYPHS, Panel

if TYPE_CHECKING:
    from workbench.core.arrays import Floats
    from workbench.figures.mesh_panel import Scene

USUAL_TEXT = 8.0
"""Points of text at which lines have their usual width."""


def has_overlay(panel: Panel) -> bool:
    """Whether anything lies over the triangles of a panel."""
    return panel.wires or panel.seams or panel.boundary or panel.scale_bar or panel.glyphs != NO_GLYPHS


def draw_overlay(scene: Scene, frame: Frame, colours: Floats, picture: Pixels, font_size: int, ink: str, paper: str) -> None:
    """Draw it over `picture` (h, w, 3), which shows `frame`; `colours` (k, 3) are those of wires.

    `font_size` in pixels;  `ink` and `paper` are colours of lines and of the ground
    """
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    height, width = picture.shape[:2]
    size = font_size * 72 / DPI / USUAL_TEXT
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        figure = Figure(figsize=(width / DPI, height / DPI), dpi=DPI, facecolor="none")
        canvas = FigureCanvasAgg(figure)
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.set_axis_off()
        if scene.panel.wires:
            draw_wires(axes, scene, colours, size, as_vectors=True)
        draw_features(axes, scene, frame, size, ink)
        draw_on_top(axes, scene, frame, size, ink, paper)
        left, right, bottom, top = frame.extent
        axes.set(xlim=(left, right), ylim=(bottom, top))
        canvas.draw()
        drawn = np.asarray(canvas.buffer_rgba())[:height, :width].astype(np.float64)
    amount = drawn[..., 3:] / 255.0
    picture[:] = np.rint(amount * drawn[..., :3] + (1.0 - amount) * picture).astype(np.uint8)
