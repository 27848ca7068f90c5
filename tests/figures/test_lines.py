"""Lines in figures and films: where they are, that hidden ones are not drawn, and that a scale bar measures."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from tests.app.fake_engine import grid_mesh
from workbench.core.mesh import Mesh, TextureCoordinates
from workbench.core.round_length import round_length
from workbench.figures.composer import compose
from workbench.figures.figure_maps import FigureMap
from workbench.figures.film import Film, FilmDrawer, Still
from workbench.figures.line_panel import CUT_COLOUR, SEAM_COLOUR
from workbench.figures.recipe import CHEQUERED, PLAIN, Page, Panel, Recipe
from workbench.figures.save import figure_bytes

NO_ANCHORS = np.empty(0, np.int64)


@pytest.fixture(scope="module")
def seamed() -> Mesh:
    """A flat sheet whose texture jumps across the line x = 1."""
    mesh = grid_mesh(9, 6)
    middle = np.median(mesh.vertices[:, 0])
    is_right = mesh.vertices[mesh.simplices, 0].mean(axis=1) > middle
    both = np.vstack([mesh.vertices, mesh.vertices + [5.0, 0.0]])
    corners = mesh.simplices + np.where(is_right, mesh.vertex_count, 0)[:, None]
    return replace(mesh, texture=TextureCoordinates(both, corners))


def film_of(mesh: Mesh, panel: Panel, **changes: object) -> tuple[FilmDrawer, np.ndarray]:
    still = Still(lambda: mesh.vertices)
    drawer = FilmDrawer(Film((panel,), 400, 300, has_captions=False, **changes), mesh, [still])
    return drawer, drawer.draw(still).astype(int)


def places_of(drawer: FilmDrawer, marked: np.ndarray) -> np.ndarray:
    """Points of the plane that marked pixels (h, w) of a film show."""
    (box,), (frame,) = drawer.page.boxes, drawer._frames_of
    rows, columns = np.nonzero(marked)
    left, _, _, top = frame.extent
    return np.column_stack([left + (columns + 0.5 - box.left) / frame.density, top - (rows + 0.5 - box.top) / frame.density])


def near(pixels: np.ndarray, colour: tuple[float, ...], reach: int = 40) -> np.ndarray:
    return np.abs(pixels - 255.0 * np.array(colour)).max(axis=2) < reach


def figure_of(mesh: Mesh, panel: Panel, positions: np.ndarray | None = None, **page: object) -> str:
    found = FigureMap("", mesh, mesh.vertices if positions is None else positions, NO_ANCHORS)
    recipe = Recipe(Page(**{"dpi": 72, "width": 60.0, **page}), (), (replace(panel, maps=("map",)),))
    return figure_bytes(compose(recipe, {"map": found}).figure, ".svg", 72).decode()


def paths_in(svg: str, name: str) -> int:
    """Paths of a group of an SVG."""
    return sum(part.count("<path ") for part in re.findall(rf'<g id="{name}">(.*?)</g>', svg, re.DOTALL))


def test_seams_and_cuts_of_a_film_are_where_they_are(seamed: Mesh) -> None:
    bare = Panel("map", colour=PLAIN, caption="")
    middle = float(np.median(seamed.vertices[:, 0]))
    drawer, pixels = film_of(seamed, replace(bare, seams=True), cuts=np.array([[0, 1]]))
    places = places_of(drawer, near(pixels, SEAM_COLOUR))
    assert np.abs(places[:, 0] - middle).max() < 2.5 / drawer._frames_of[0].density
    assert np.ptp(places[:, 1]) > 0.95 * np.ptp(seamed.vertices[:, 1])
    cut = places_of(drawer, near(pixels, CUT_COLOUR))
    ends = seamed.vertices[:2]
    assert len(cut) > 5 and (cut >= ends.min(axis=0) - 0.05).all() and (cut <= ends.max(axis=0) + 0.05).all()
    assert not near(film_of(seamed, bare)[1], SEAM_COLOUR).any()


def test_a_boundary_goes_round_and_wires_leave_triangles_empty(seamed: Mesh) -> None:
    bare = Panel("map", colour=PLAIN, caption="")
    _, plain = film_of(seamed, bare)
    drawer, framed = film_of(seamed, replace(bare, boundary=True))
    low, high = seamed.vertices.min(axis=0), seamed.vertices.max(axis=0)
    places = places_of(drawer, (framed != plain).any(axis=2))
    aside = np.minimum(np.abs(places - low), np.abs(places - high)).min(axis=1)
    assert aside.max() < 2.5 / drawer._frames_of[0].density
    assert (np.ptp(places, axis=0) > 0.99 * (high - low)).all()
    _, wired = film_of(seamed, replace(bare, wires=True))
    covered, lines = (plain != 255).any(axis=2).sum(), (wired != 255).any(axis=2).sum()
    assert 0.05 * covered < lines < 0.5 * covered


@pytest.mark.parametrize("stretch", [1.0, 37.0, 0.004])
def test_a_scale_bar_is_as_long_as_it_says(stretch: float) -> None:
    mesh = grid_mesh(8, 6)
    mesh = replace(mesh, vertices=mesh.vertices * stretch)
    panel = Panel("map", colour="det", caption="", range=(0.5, 2.0), anchors=False)
    drawer, bare = film_of(mesh, panel)
    _, pixels = film_of(mesh, replace(panel, scale_bar=True))
    frame = drawer._frames_of[0]
    dark = (pixels < 60).all(axis=2) & (bare != pixels).any(axis=2)
    row = dark.sum(axis=1).argmax()
    wide = np.ptp(np.flatnonzero(dark[row])) + 1
    length = round_length(0.3 * 2 * frame.half[0])
    assert wide == pytest.approx(length * frame.density, abs=2.5)
    svg = figure_of(mesh, replace(panel, scale_bar=True), width=90.0)
    assert f">{length:.6g}</text>" in svg or f"<!-- {length:.6g} -->" in svg


def test_glyphs_of_a_film_are_those_of_the_map() -> None:
    mesh = grid_mesh(8, 6)
    panel = Panel("map", colour=PLAIN, caption="", glyphs="ellipses", glyph_count=12, anchors=False)
    bare = replace(panel, glyphs="none")
    stills = [Still(lambda x=x: mesh.vertices * [1.0, x]) for x in (1.0, 0.5)]
    heights = []
    drawers = [FilmDrawer(Film((each,), 400, 300, has_captions=False), mesh, stills) for each in (panel, bare)]
    for still in stills:
        drawn, empty = (drawer.draw(still).astype(int) for drawer in drawers)
        marked = (drawn != empty).any(axis=2)
        assert 200 < marked.sum() < 0.3 * (empty != 255).any(axis=2).sum()
        rows = np.flatnonzero(marked.any(axis=1))
        runs = np.split(rows, np.flatnonzero(np.diff(rows) > 1) + 1)  # a row of glyphs each, where none meet
        heights.append(np.mean([len(run) for run in runs]))
    assert heights[1] < 0.75 * heights[0]


def test_lines_that_are_hidden_in_space_are_not_drawn() -> None:
    sheet = grid_mesh(4, 3)
    large = np.column_stack([sheet.vertices, np.ones(sheet.vertex_count)])
    small = np.column_stack(
        [sheet.vertices.mean(axis=0) + 0.5 * (sheet.vertices - sheet.vertices.mean(axis=0)), 0.0 * large[:, 0]]
    )
    alone = Mesh(large, sheet.simplices)
    both = Mesh(np.vstack([large, small]), np.vstack([sheet.simplices, sheet.simplices + len(large)]))

    def lines(mesh: Mesh, side: float) -> int:
        turn = ((side, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, side))
        panel = Panel("source", colour="det", caption=" ", boundary=True, view=turn, anchors=False)
        return paths_in(figure_of(mesh, panel, mesh.vertices[:, :2]), "boundary")

    assert lines(both, 1.0) == lines(alone, 1.0) > 50  # the small one lies behind the large one
    assert lines(both, -1.0) == pytest.approx(1.5 * lines(alone, -1.0), rel=0.1)


def test_figures_have_their_lines_as_vectors(seamed: Mesh) -> None:
    edges = len(np.unique(np.sort(seamed.simplices[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0))
    textured = Panel("map", colour=CHEQUERED, caption=" ", edges=True, seams=True, anchors=False)
    svg = figure_of(seamed, textured)
    assert paths_in(svg, "edges") == edges
    middle = np.median(seamed.vertices[:, 0])
    assert paths_in(svg, "seams") == (seamed.vertices[:, 0] == middle).sum() - 1
    wires = figure_of(seamed, Panel("map", colour="det", caption=" ", wires=True, anchors=False))
    assert paths_in(wires, "wires") == seamed.simplex_count
    assert not paths_in(wires, "triangles")
    assert figure_of(seamed, textured) == svg


def test_too_many_lines_are_a_picture(seamed: Mesh, monkeypatch: pytest.MonkeyPatch) -> None:
    textured = Panel("map", colour=CHEQUERED, caption=" ", edges=True, anchors=False)
    assert paths_in(figure_of(seamed, textured), "edges") > 50
    monkeypatch.setattr("workbench.figures.line_panel.MOST_LINES", 50)
    svg = figure_of(seamed, textured)
    assert paths_in(svg, "edges") == 0
    assert svg.count("<image") == 2
