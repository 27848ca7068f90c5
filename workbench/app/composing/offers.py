"""What the window shows now, as panels of a figure."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from workbench.app.composing.figure_work import NAME, Subject
from workbench.app.document.history import COLUMNS
from workbench.app.files.new_file import stem_of
from workbench.app.sessions.restoring import with_anchors
from workbench.app.views.textures import PATTERNS, Pattern
from workbench.core.history_row import HistoryRow
from workbench.core.measure import Measure
from workbench.figures.recipe import CHEQUERED, DEFAULT_MEASURE, NO_GLYPHS, PICTURE, PLAIN, CarriedLook, Panel, SolidLook
from workbench.session.session import Session

if TYPE_CHECKING:
    from workbench.app.colouring.colour_range import ColourRange
    from workbench.app.document.history import History
    from workbench.app.main_window import MainWindow
    from workbench.app.views.mesh_view import MeshView
    from workbench.app.views.pane import ViewPane


@dataclass(frozen=True)
class Offer:
    """A panel that can be had; `words` name it in the list."""

    words: str
    panel: Panel
    is_chosen: bool = True


def subject_of(window: MainWindow) -> Subject | None:
    """The map on the screen, an earlier one while it is looked back at; None while there is none."""
    document = window.document
    loaded, shown = document.loaded, document.shown
    if loaded is None or shown is None:
        return None
    given = with_anchors(document.session, document.shown_anchors)
    session = Session(
        source=given.source,
        kind=loaded.kind,
        fixes=given.fixes,
        anchor_vertices=given.anchor_vertices,
        anchor_targets=given.anchor_targets,
        carried=window.carried.source,
    )
    stem = stem_of(given.source)
    rows, carried = rows_of(window.history), window.carried.surface
    kind, cuts = loaded.kind, loaded.cut_edges
    return Subject(stem, session, loaded.mesh, kind, shown.positions, rows, carried, cuts)  # type: ignore[arg-type]


def rows_of(history: History) -> tuple[HistoryRow, ...]:
    """The rows of the curves."""
    columns = {name: history.column(name).tolist() for name in COLUMNS}
    found = []
    for values in zip(*columns.values(), strict=True):
        row = dict(zip(columns, values, strict=True))
        found.append(HistoryRow(**row | {name: int(row[name]) for name in ("iteration", "inverted")}))
    return tuple(found)


def offers_of(window: MainWindow) -> list[Offer]:
    """The source, the target, each colour map that is open, histogram and curves, with the ranges of the window."""
    found = [
        Offer("Source", _view(window, window.source, "source")),
        Offer("Target", _view(window, window.target, "map")),
    ]
    for pane in window.splitting.panes:
        panel = _view(window, pane, "source" if pane.is_source else "map")
        found.append(Offer(f"{pane.title}, split off: {pane.chooser.currentText()}", panel))
    for dock in window.maps:
        quantity = window.quantities[dock.quantity]
        bare = Panel("map", (NAME,), caption=" ", bar=True, view=_axes(dock.view), look=_look(window), **_lines(dock.view))
        panel = _coloured(window, dock.range, bare)
        is_shown = any(offer.panel.kind == "map" and offer.panel.scale == panel.scale for offer in found)
        found.append(Offer(f"Colour map: {quantity.title}", panel, dock.isVisible() and not is_shown))
    id = window.histogram.quantity
    histogram = _coloured(window, window.histogram.range, Panel("histogram", (NAME,), caption=" "))
    found.append(Offer(f"Histogram: {window.quantities[id].title}", histogram))
    if len(window.history) > 1:
        found.append(Offer("Curve: energy", Panel("curves", (NAME,), caption=" ")))
        found.append(Offer("Curve: gradient norm", Panel("curves", (NAME,), quantity="gradient-norm", caption=" "), False))
    return found


def _view(window: MainWindow, pane: ViewPane, kind: str) -> Panel:
    """A view with its colours, or its pattern."""
    style = window.colouring.style_of(pane)
    caption = "Source" if kind == "source" else "Target"
    panel = Panel(kind, (NAME,), caption=caption, view=_axes(pane.view), look=_look(window), **_lines(pane.view))
    panel = replace(panel, **_glyphs(window, "source" if kind == "source" else "target"))
    panel = replace(panel, carried=_carried(window, pane))
    if style in PATTERNS:
        return replace(panel, **_pattern(window, style))  # type: ignore[arg-type]
    return _coloured(window, window.colouring.range_of(pane), replace(panel, bar=True))


def _pattern(window: MainWindow, style: Pattern) -> dict[str, Any]:
    """A pattern as it lies on every view."""
    is_board = style == "checkerboard" or (style == PICTURE and not window.texturing.has_picture)
    return {"colour": CHEQUERED if is_board else style, "texture": None if style == PLAIN else window.texturing.look(style)}


def _look(window: MainWindow) -> SolidLook | None:
    """How the window looks into its solid; None where there is none, or nothing but its outside is seen."""
    volume = window.volume
    if not volume.is_on or volume.look.is_whole:
        return None
    peel_by = window.quantities[volume.peel_by].measure if volume.peel_by in window.quantities else Measure(DEFAULT_MEASURE)
    marked = tuple(window.brush.simplices.tolist()) if volume.look.only_marked else ()
    return SolidLook(volume.look, peel_by.text, dict(peel_by.parameters), marked)


def _carried(window: MainWindow, pane: ViewPane) -> CarriedLook | None:
    """How a large view shows the surface that its solid carries."""
    if window.carried.surface is None:
        return None
    colours = window.carried.range
    measure = colours.quantity.measure
    ends = (colours.low, colours.high) if colours.low < colours.high else None
    return CarriedLook(measure.text, dict(measure.parameters), ends, colours.is_logarithmic, window.carried.opacity_in(pane))


def _glyphs(window: MainWindow, place: str) -> dict[str, Any]:
    """The glyphs of the views of source or target."""
    choice, mesh = window.glyphs.choice, window.document.mesh
    if mesh is None or choice.kind == NO_GLYPHS or place not in choice.places:
        return {}
    return {"glyphs": choice.kind, "glyph_count": window.glyphs.count(mesh), "glyph_size": choice.size}


def _lines(view: MeshView) -> dict[str, Any]:
    """What a view draws beside its colours."""
    drawing, surface = view.drawing, view.surface
    edges = drawing.edges if drawing.edges is not None else surface is not None and surface.has_edges
    lines = {name: getattr(drawing, name) for name in ("seams", "boundary", "scale_bar")}
    return {"edges": bool(edges), "wires": drawing.wireframe, **lines}


def _axes(view: MeshView) -> tuple[tuple[float, ...], ...]:
    """How the camera of a view is turned."""
    return tuple(tuple(line) for line in view.camera.axes.tolist())


def _coloured(window: MainWindow, colours: ColourRange, panel: Panel) -> Panel:
    quantity = colours.quantity
    is_shared = colours is window.quantities.range_of(quantity.id)
    is_fitted = math.isfinite(colours.low) and math.isfinite(colours.high) and colours.low < colours.high
    return replace(
        panel,
        colour=quantity.measure.text,
        parameters=dict(quantity.measure.parameters),
        scale=quantity.measure.id[:60] if is_shared else "",
        range=(colours.low, colours.high) if is_fitted else None,
        logarithmic=colours.is_logarithmic,
        reversed=colours.is_reversed,
        clipped=colours.is_clipped,
    )
