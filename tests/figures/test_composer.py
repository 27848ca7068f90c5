"""Figures from recipes: vectors are vectors, scales are common, the same recipe gives the same bytes."""

from __future__ import annotations

import re
import zlib
from dataclasses import replace

import numpy as np
import pytest

from workbench.core.errors import WorkbenchError
from workbench.core.measure import Measure
from workbench.core.solid_look.look import VolumeLook
from workbench.figures.colour_scale import CLIPPED_ABOVE, CLIPPED_BELOW
from workbench.figures.composer import compose
from workbench.figures.figure_maps import make_maps
from workbench.figures.mesh_panel import scene_of
from workbench.figures.mesh_pictures import TEXTURE, is_inked
from workbench.figures.page_layout import Cell, lay_out
from workbench.figures.recipe import (
    CHEQUERED,
    PICTURE,
    PLAIN,
    CarriedLook,
    MapChoice,
    Page,
    Panel,
    Recipe,
    SolidLook,
    TextureLook,
)
from workbench.figures.recipe_text import read_recipe, write_recipe
from workbench.figures.save import save_figure
from workbench.figures.text_fit import LEAST_TEXT, fit_lines, text_width
from workbench.session.session import Session

PLANE = Session(source="sample:bar", solver="projected-newton", iterations=3)
PULLED = replace(PLANE, anchor_vertices=(0, 100), anchor_targets=((-0.5, 0.2), (2.0, 1.4)))
FACTOR = "average-singular-value"


@pytest.fixture(scope="module")
def maps():
    choices = [
        MapChoice("rest", replace(PULLED, iterations=0), label="rest $x_1"),
        MapChoice("pulled", PULLED),
        MapChoice("solid", Session(source="sample:bar-3d", iterations=0, carried="sample:salamander")),
    ]
    return make_maps(choices)


def figure_of(maps, *panels, **page):
    names = {name for panel in panels for name in panel.maps}
    choices = tuple(MapChoice(name, PULLED) for name in sorted(names))
    return compose(Recipe(Page(**{"dpi": 72, **page}), choices, panels), maps)


def paths_in(svg: str) -> int:
    """Paths of the triangles of an SVG."""
    parts = re.findall(r'<g id="triangles">(.*?)</g>', svg, re.DOTALL)
    return sum(part.count("<path ") for part in parts)


def filled_paths(pdf: bytes) -> int:
    """Paths that the pages of a PDF fill and stroke: operators b, B and their kin at the end of a line."""
    streams = re.findall(rb"stream\r?\n(.*?)endstream", pdf, re.DOTALL)
    texts = []
    for stream in streams:
        try:
            texts.append(zlib.decompress(stream))
        except zlib.error:
            continue
    return sum(len(re.findall(rb"^[bB]\*?$", text, re.MULTILINE)) for text in texts)


def test_every_triangle_of_a_flat_map_is_a_path(maps, tmp_path):
    count = maps["pulled"].mesh.simplex_count
    found = figure_of(maps, Panel(maps=("rest",)), Panel(maps=("pulled",), bar=True))
    assert not found.notes
    for ending in (".svg", ".pdf"):
        save_figure(found.figure, tmp_path / f"figure{ending}")
    assert paths_in((tmp_path / "figure.svg").read_text()) == 2 * count
    assert "<image" not in (tmp_path / "figure.svg").read_text()
    assert 2 * count <= filled_paths((tmp_path / "figure.pdf").read_bytes()) <= 2 * count + 400


def test_what_lies_in_space_is_a_picture_in_a_vector_page(maps, tmp_path):
    found = figure_of(maps, Panel(maps=("solid",), bar=True), Panel("source", ("rest",), CHEQUERED))
    assert len(found.notes) == 2
    save_figure(found.figure, tmp_path / "figure.svg")
    text = (tmp_path / "figure.svg").read_text()
    assert paths_in(text) == 0
    assert text.count("<image") >= 2


def test_too_many_triangles_become_a_picture_and_it_is_said(maps):
    recipe = Recipe(Page(dpi=72), (), (Panel(maps=("rest",)), Panel(maps=("pulled",))))
    found = compose(recipe, maps, int(1.5 * maps["pulled"].mesh.simplex_count))
    assert len(found.notes) == 1
    assert "Panel 2" in found.notes[0]


def test_panels_of_one_scale_have_one_colour_for_one_value(maps):
    apart = figure_of(maps, Panel(maps=("rest",), colour="det"), Panel(maps=("pulled",), colour="det"))
    together = figure_of(maps, Panel(maps=("rest",), colour="det", scale="s"), Panel(maps=("pulled",), colour="det", scale="s"))

    def colours(found):
        collections = [axes.collections[0] for axes in found.figure.axes]
        return [collection.get_facecolor() for collection in collections]

    values = maps["pulled"].values(Measure("det"))
    rest, pulled = colours(together)
    nearest = pulled[np.argmin(np.abs(values - 1.0))]
    assert np.abs(rest - nearest).max() < 0.02
    assert np.abs(pulled - nearest).max() > 0.2
    assert len(np.unique(colours(apart)[1], axis=0)) > 10


def test_colours_run_the_other_way_and_mark_what_lies_beyond_where_that_is_asked(maps):
    values = maps["pulled"].values(Measure("dirichlet"))
    low_end, high_end = (float(end) for end in np.quantile(values, (0.25, 0.75)))

    def colours(**ways):
        ways |= {"range": (low_end, high_end), "logarithmic": False}
        found = figure_of(maps, Panel(maps=("pulled",), colour="dirichlet", **ways))
        return found.figure.axes[0].collections[0].get_facecolor()[:, :3]

    usual, other_way, marked = colours(), colours(reversed=True), colours(clipped=True)
    below, above = values < low_end, values > high_end
    assert below.any() and above.any()
    low, high = usual[below][0], usual[above][0]
    np.testing.assert_allclose(other_way[below], np.broadcast_to(high, other_way[below].shape))
    np.testing.assert_allclose(other_way[above], np.broadcast_to(low, other_way[above].shape))
    assert np.abs(marked[below] - CLIPPED_BELOW).max() < 0.01 and np.abs(marked[above] - CLIPPED_ABOVE).max() < 0.01
    np.testing.assert_array_equal(marked[~below & ~above], usual[~below & ~above])


def test_the_same_recipe_gives_the_same_bytes(tmp_path):
    choices = (MapChoice("a", PULLED), MapChoice("b", replace(PULLED, iterations=1)))
    panels = (
        Panel(maps=("a",), bar=True),
        Panel("histogram", ("a", "b"), FACTOR),
        Panel("curves", ("a",)),
        Panel("source", ("a",), CHEQUERED),
    )
    for attempt in ("first", "second"):
        recipe = Recipe(Page(dpi=72, columns=2, letters=True, title="both"), choices, panels)
        found = compose(recipe, make_maps(choices))
        for ending in (".png", ".pdf", ".svg"):
            save_figure(found.figure, tmp_path / f"{attempt}{ending}", 72)
    for ending in (".png", ".pdf", ".svg"):
        first, second = ((tmp_path / f"{attempt}{ending}").read_bytes() for attempt in ("first", "second"))
        assert first == second
        assert b"CreationDate" not in first
        assert b"<dc:date>" not in first


def test_maps_of_one_run_are_where_the_solver_was(maps):
    found = make_maps([MapChoice(str(k), replace(PULLED, iterations=k)) for k in (2, 0, 3)])
    assert [len(found[name].rows) for name in ("0", "2", "3")] == [1, 3, 4]
    np.testing.assert_array_equal(found["3"].positions, maps["pulled"].positions)
    np.testing.assert_array_equal(found["0"].positions, maps["rest"].positions)


def test_text_is_text_and_no_mathematics(maps):
    found = figure_of(maps, Panel(maps=("rest",)), title=r"50 % of $\frac")
    found.figure.draw_without_rendering()
    assert {r"50 % of $\frac", "rest $x_1"} <= {text.get_text() for text in found.figure.texts}


def test_the_page_is_as_wide_as_asked_and_as_transparent(maps, tmp_path):
    from PIL import Image

    found = figure_of(maps, Panel(maps=("rest",)), width=90.0, background="transparent", dpi=100)
    save_figure(found.figure, tmp_path / "figure.png", 100)
    with Image.open(tmp_path / "figure.png") as picture:
        assert picture.width == pytest.approx(90 / 25.4 * 100, abs=1)
        assert picture.getpixel((0, picture.height - 1))[3] == 0


def test_a_histogram_of_nothing_is_refused(maps):
    broken = replace(maps["rest"], positions=maps["rest"].positions * [-1.0, 1.0])
    with pytest.raises(WorkbenchError, match="infinite"):
        figure_of({"rest": broken}, Panel("histogram", ("rest",)))


def test_parts_of_a_page_do_not_overlap():
    cells = [
        Cell(aspect=0.5, caption=2, words=2, has_bar=True),
        Cell(aspect=2.0),
        Cell(has_axes=True),
        Cell(span=2, has_axes=True, caption=1),
        Cell(span=3, is_bar=True),
    ]
    page = lay_out(cells, 150.0, 3, 8.0, has_title=True)
    boxes = [place.whole for place in page.places]
    for i, a in enumerate(boxes):
        assert a.left >= 0
        assert a.left + a.width <= page.width + 1e-9
        assert a.top + a.height <= page.height + 1e-9
        for b in boxes[:i]:
            is_beside = a.left >= b.left + b.width - 1e-9 or b.left >= a.left + a.width - 1e-9
            assert is_beside or a.top >= b.top + b.height - 1e-9 or b.top >= a.top + a.height - 1e-9


def axes_place(axes, tick):
    """Where a tick stands, 0 at the left end of the axes, 1 at the right."""
    return axes.transAxes.inverted().transform(axes.transData.transform((tick.get_position()[0], 0)))[0]


def test_words_of_neighbours_keep_apart(maps):
    long = "factor " * 30
    found = figure_of(
        maps,
        Panel(maps=("pulled",), bar=True, caption=long),
        Panel(maps=("pulled",), colour="sum(sigma^2) + 1/det + 0.25*max(sigma)^2", bar=True, caption=long),
        Panel("curves", ("pulled",), caption=long),
        Panel("curves", ("pulled",), quantity="gradient-norm", caption=long),
        Panel("histogram", ("pulled",), FACTOR, caption=long),
        width=100.0,
        columns=4,
        letters=True,
    ).figure
    found.draw_without_rendering()
    words = [text for text in found.texts if len(text.get_text()) > 1]
    words += [label for axes in found.axes for label in (axes.xaxis.label, axes.yaxis.label)]
    words += [tick for axes in found.axes for tick in axes.get_xticklabels() if -1e-9 <= axes_place(axes, tick) <= 1 + 1e-9]
    boxes = [text.get_window_extent() for text in words if text.get_text()]
    assert len(boxes) >= 8
    assert not any(a.overlaps(b) for i, a in enumerate(boxes) for b in boxes[:i])
    assert all(box.x0 >= -1 and box.x1 <= found.bbox.width + 1 for box in boxes)


def glyphs_in(svg: str) -> int:
    """Paths of the glyphs of an SVG."""
    return sum(part.count("<path ") for part in re.findall(r'<g id="glyphs">(.*?)</g>', svg, re.DOTALL))


@pytest.mark.parametrize(("glyphs", "each"), [("stretches", 4), ("ellipses", 1)])  # a line an axis, white and in colour
def test_glyphs_are_vectors_at_as_many_places_as_are_asked_for(maps, tmp_path, glyphs, each):
    bare = figure_of(maps, Panel(maps=("pulled",)))
    save_figure(bare.figure, tmp_path / "bare.svg", 72)
    found = figure_of(maps, Panel(maps=("pulled",), glyphs=glyphs, glyph_count=20))
    save_figure(found.figure, tmp_path / "glyphs.svg", 72)
    text = (tmp_path / "glyphs.svg").read_text()
    assert glyphs_in((tmp_path / "bare.svg").read_text()) == 0
    assert 10 * each <= glyphs_in(text) <= 20 * each
    assert paths_in(text) == paths_in((tmp_path / "bare.svg").read_text())


def test_ellipses_at_rest_are_circles_and_balls_seen_from_anywhere_too(maps):
    for name in ("rest", "solid"):
        found = figure_of(maps, Panel(maps=(name,), glyphs="ellipses", glyph_count=12))
        (rings,) = (item for item in found.figure.axes[0].collections if item.get_gid() == "glyphs")
        outlines = [path.vertices[:-1] for path in rings.get_paths()]
        assert outlines
        for outline in outlines:
            radii = np.linalg.norm(outline - outline.mean(axis=0), axis=1)
            np.testing.assert_allclose(radii, radii[0], rtol=1e-6)


def test_glyphs_of_a_solid_that_are_hidden_are_not_drawn(maps):
    panel = Panel(maps=("solid",), glyphs="stretches", glyph_count=200, view=((1, 0, 0), (0, 1, 0), (0, 0, 1)))
    found = figure_of(maps, panel)
    core = [item for item in found.figure.axes[0].collections if item.get_gid() == "glyphs"][-1]
    assert 0 < len(core.get_paths()) < 3 * 100, "those of one side of six"


def test_a_solid_is_drawn_as_it_is_looked_into(maps):
    solid = maps["solid"]

    def drawn(**shape):
        scene = scene_of(solid, Panel(maps=("solid",), look=SolidLook(VolumeLook(**shape), marked=(3, 5))))
        return scene, scene.points[np.unique(scene.skin.triangles)] @ np.linalg.inv(scene.turn.T)

    whole, _ = drawn()
    _, points = drawn(is_cut=True, is_exact=True, normal=(1.0, 0.0, 0.0), place=0.25)
    length = np.ptp(solid.positions[:, 0])
    assert points[:, 0].max() == pytest.approx(solid.positions[:, 0].min() + 0.25 * length)
    marked, _ = drawn(only_marked=True)
    assert set(marked.skin.simplex) == {3, 5}
    apart, _ = drawn(spread=0.5)
    assert len(apart.skin.triangles) == 4 * solid.mesh.simplex_count
    peeled = scene_of(solid, Panel(maps=("solid",), look=SolidLook(VolumeLook(threshold=2.0), peel_by="det")))
    assert not len(peeled.skin.triangles), "at rest every determinant is 1"
    assert len(whole.skin.triangles) == len(solid.mesh.topology.boundary_facets)


def test_what_is_cut_away_is_left_as_a_veil(maps):
    def corner(ghost):
        look = SolidLook(VolumeLook(is_cut=True, normal=(1.0, 0.0, 0.0), place=0.25, ghost=ghost))
        found = figure_of(maps, Panel(maps=("solid",), look=look, view=((1, 0, 0), (0, 1, 0), (0, 0, 1)), caption=" "))
        (image,) = found.figure.axes[0].images
        picture = np.asarray(image.get_array())
        return picture[picture.shape[0] // 2, round(0.8 * picture.shape[1])]

    assert corner(0.0)[3] == 0.0
    assert corner(0.3)[3] == pytest.approx(0.3)


@pytest.mark.parametrize("pattern", ["grid", "circles", "stripes"])
def test_other_textures_are_pictures_of_two_colours(maps, pattern):
    found = figure_of(maps, Panel("source", ("pulled",), pattern), dpi=400)
    (image,) = found.figure.axes[0].images
    picture = np.asarray(image.get_array())
    inside = picture[picture[..., 3] == 1.0][:, :3]
    dark = np.linalg.norm(inside - TEXTURE[1], axis=1) < 0.05
    light = np.linalg.norm(inside - TEXTURE[0], axis=1) < 0.05
    assert 0.05 < dark.mean() < 0.7 and 0.2 < light.mean() < 0.95


def test_a_carried_surface_is_seen_through_the_solid_and_before_it(maps):
    def picture(carried):
        found = figure_of(maps, Panel("source", ("solid",), PLAIN, carried=carried, caption=" "))
        (image,) = found.figure.axes[0].images
        return np.asarray(image.get_array())

    bare, veiled, hidden, alone = picture(None), *(picture(CarriedLook("det", opacity=o)) for o in (0.25, 1.0, 0.0))
    covered = alone[..., 3] > 0.99
    assert 0.05 < covered.mean() < 0.6, "without the solid there is nothing but the surface"
    assert np.abs(veiled - bare)[covered].max() > 0.1
    mixed = 0.25 * bare[..., :3] + 0.75 * alone[..., :3]
    is_inside = covered & (np.abs(hidden - bare).max(axis=2) < 1e-9)  # feet and tail come out of the bar
    np.testing.assert_allclose(veiled[is_inside][:, :3], mixed[is_inside], atol=1e-9)
    outside = ~covered & (alone[..., 3] == 0) & (bare[..., 3] == 1)
    np.testing.assert_allclose(veiled[outside][:, 3], 0.25)


def picture_in(axes):
    """The image of a panel: its pixels (h, w, 4), and where their middles are, (h, w, 2)."""
    (image,) = axes.images
    pixels = np.asarray(image.get_array())
    left, right, bottom, top = image.get_extent()
    height, width = pixels.shape[:2]
    x = left + (np.arange(width) + 0.5) / width * (right - left)
    y = bottom + (np.arange(height) + 0.5) / height * (top - bottom)
    return pixels, np.dstack(np.meshgrid(x, y))


@pytest.fixture
def quarters(tmp_path):
    """A picture of four colours: red, green above blue, black."""
    from PIL import Image

    pixels = np.zeros((40, 60, 3), np.uint8)
    pixels[:20, :30, 0] = pixels[:20, 30:, 1] = pixels[20:, :30, 2] = 255
    Image.fromarray(pixels).save(tmp_path / "quarters.png")
    return tmp_path / "quarters.png"


@pytest.mark.parametrize("of", ["map", "source"])
def test_a_picture_lies_where_its_look_says(maps, quarters, of):
    look = TextureLook(of, ((0.5, 0.25), (-0.25, 0.5)), (0.3, 0.6), str(quarters))
    (axes,) = figure_of(maps, Panel(maps=("pulled",), colour=PICTURE, texture=look), dpi=20).figure.axes
    pixels, points = picture_in(axes)
    if of == "source":  # where the points of the map come from: the map is linear in each triangle
        found = maps["pulled"]
        corners = found.positions[found.mesh.simplices]
        points = points.copy()
        for row, column in np.argwhere(pixels[..., 3] == 1.0):
            with np.errstate(all="ignore"):
                weights = np.linalg.solve(
                    np.concatenate([corners.transpose(0, 2, 1), np.ones((len(corners), 1, 3))], axis=1),
                    np.append(points[row, column], 1.0)[None, :, None],
                )[..., 0]
            best = int(weights.min(axis=1).argmax())
            points[row, column] = weights[best] @ found.mesh.vertices[found.mesh.simplices[best]]
    places = points @ np.array(look.matrix).T + look.offset
    within = places - np.floor(places)
    colours = np.array([[0, 0, 1], [0, 0, 0], [1, 0, 0], [0, 1, 0.0]])[
        (2 * (within[..., 1] > 0.5) + (within[..., 0] > 0.5)).astype(int)
    ]
    is_sure = (np.abs(within - 0.5) > 0.06).all(axis=2) & (np.abs(within - 0.5) < 0.44).all(axis=2) & (pixels[..., 3] == 1.0)
    assert is_sure.sum() > 200
    assert len(np.unique(colours[is_sure], axis=0)) == 4
    assert np.abs(pixels[..., :3] - colours)[is_sure].max() < 1e-6


@pytest.mark.parametrize("pattern", ["chequered", "grid", "circles", "stripes"])
def test_a_texture_lies_where_its_look_says(maps, pattern):
    look = TextureLook("map", ((7.0, 3.0), (-3.0, 7.0)), (0.2, 0.7))
    (axes,) = figure_of(maps, Panel(maps=("pulled",), colour=pattern, texture=look), dpi=300).figure.axes
    pixels, points = picture_in(axes)
    inked = is_inked(points @ np.array(look.matrix).T + look.offset, pattern)
    near, far = np.abs(pixels[..., :3] - TEXTURE[1]).max(axis=2) < 1e-9, np.abs(pixels[..., :3] - TEXTURE[0]).max(axis=2) < 1e-9
    pure = (near | far) & (pixels[..., 3] == 1.0)  # off the edges of fields
    assert pure.sum() > 0.4 * (pixels[..., 3] == 1.0).sum()
    assert (near == inked)[pure].mean() > 0.995


def test_pictures_are_the_same_bytes_in_vector_pages_and_headless(maps, quarters, tmp_path):
    look = TextureLook("map", ((0.4, 0.0), (0.0, 0.4)), (0.0, 0.0), str(quarters))
    recipe = Recipe(
        Page(width=60.0, dpi=72), (MapChoice("pulled", PULLED),), (Panel(maps=("pulled",), colour=PICTURE, texture=look),)
    )
    write_recipe(tmp_path / "recipe.json", recipe)
    assert '"quarters.png"' in (tmp_path / "recipe.json").read_text()
    again = read_recipe(tmp_path / "recipe.json")
    assert again.panels[0] == recipe.panels[0]
    for ending in ("png", "pdf", "svg"):
        for name, given in (("a", recipe), ("b", again)):
            save_figure(compose(given, maps).figure, tmp_path / f"{name}.{ending}", 72)
        assert (tmp_path / f"a.{ending}").read_bytes() == (tmp_path / f"b.{ending}").read_bytes()
    svg = (tmp_path / "a.svg").read_text()
    assert "<image" in svg and paths_in(svg) == 0
    assert compose(recipe, maps).notes == ("Panel 1 is a picture of 72 dpi (textured).",)
    quarters.unlink()
    with pytest.raises(WorkbenchError, match=r"quarters\.png"):
        compose(again, maps)


def test_a_picture_seen_from_afar_has_the_colours_of_its_mean(maps, tmp_path):
    from PIL import Image

    rows, columns = np.indices((512, 512))
    Image.fromarray((np.dstack([(rows + columns) % 2] * 3) * 255).astype(np.uint8)).save(tmp_path / "fine.png")
    look = TextureLook("map", ((0.5, 0.0), (0.0, 0.5)), (0.0, 0.0), str(tmp_path / "fine.png"))
    (axes,) = figure_of(maps, Panel(maps=("rest",), colour=PICTURE, texture=look), width=30.0).figure.axes
    pixels, _ = picture_in(axes)
    inner = pixels[pixels[..., 3] == 1.0][:, :3]
    assert np.abs(inner - 0.5).max() < 0.05


@pytest.mark.parametrize("width", [12.0, 20.0, 33.0, 60.0])
@pytest.mark.parametrize("text", ["Symmetric Dirichlet (32)", "Projected Newton, 20", "one", "a b " * 40, "x" * 90])
def test_words_fit_and_break_before_they_are_cut(width, text):
    words, size = fit_lines(text, width, 8.0)
    lines = words.split("\n")
    assert len(lines) <= 3
    assert all(text_width(line, size) <= width * (1 + 1e-6) for line in lines)
    assert LEAST_TEXT * 8.0 - 1e-9 <= size <= 8.0
    if "…" not in words:
        assert " ".join(lines).split() == text.split()
    fits_at_all = text_width(text, LEAST_TEXT * 8.0) <= width
    assert not (fits_at_all and "…" in words), "nothing is cut that would fit"


def test_captions_of_a_page_have_one_size(maps):
    found = figure_of(
        maps,
        *(Panel(maps=("pulled",), caption=words) for words in ("SLIM, 5", "Projected Newton, 20", "L-BFGS")),
        width=50.0,
    ).figure
    shown = [text for text in found.texts if text.get_text()]
    assert {text.get_text().replace("\n", " ") for text in shown} == {"SLIM, 5", "Projected Newton, 20", "L-BFGS"}
    assert len({round(text.get_fontsize(), 6) for text in shown}) == 1
