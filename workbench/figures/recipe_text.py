"""A recipe as JSON: nothing but what is known is read, every value within bounds, and nothing in it is ever executed."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from workbench.core.errors import WorkbenchError
from workbench.figures.look_text import look_of, plain_look
from workbench.figures.recipe import (
    BACKGROUNDS,
    GLYPHS,
    KINDS,
    PICTURE,
    QUANTITIES,
    CarriedLook,
    MapChoice,
    Page,
    Panel,
    Recipe,
    TextureLook,
)
from workbench.figures.texture_text import TEXTURE, texture_of
from workbench.io.atomic import write_text
from workbench.io.file_names import relative_name, renamed
from workbench.io.read import read_bytes
from workbench.session import schema
from workbench.session.session import Session
from workbench.session.text import anchor_rows, differing, only_known, parsed, readable

FORMAT = "distortion-workbench figure"
VERSION = 1
MOST_MAPS = 64
MOST_PANELS = 120
MOST_GLYPHS = 10_000
MOST_STEPS = 100_000
LARGEST_TEXT = 2**25
LONGEST_CAPTION = 300
LARGEST_PAGE = 60e6
"""Pixels of a page with a side as long as its width."""
SESSION_FIELDS = tuple(name for name in schema.CHOICES if name != "time_limit")
"""Choices that a map is solved with; how far a solver comes in a time differs from run to run."""
FILES = ("source", "start_file", "carried")
OWN_FILES = ("target", "history")
"""Fields of a session, and of a map beside it, that name files."""


def read_recipe(path: str | os.PathLike[str]) -> Recipe:
    """The recipe in a file, its paths relative to where the file is. Raises `WorkbenchError`; nothing named is opened."""
    data = read_bytes(Path(path))
    try:
        if len(data) > LARGEST_TEXT:
            raise WorkbenchError("It is too large to be a recipe.")
        recipe = recipe_of(parsed(data.decode("utf-8-sig"), FORMAT, VERSION, "recipe of a figure"))
    except UnicodeDecodeError:
        raise WorkbenchError(f"{path}: It is no recipe: it has to be text in UTF-8.") from None
    except WorkbenchError as error:
        raise WorkbenchError(f"{path}: {error.sentence}") from None
    folder = Path(os.path.abspath(path)).parent
    return with_paths(recipe, lambda name: os.path.normpath(folder / name))


def write_recipe(path: str | os.PathLike[str], recipe: Recipe) -> None:
    """Write a recipe, whole or not at all; its files are named relative to its folder."""
    folder = Path(os.path.realpath(path)).parent
    write_text(path, readable(plain_of(with_paths(recipe, lambda name: relative_name(name, folder)))) + "\n")


def with_paths(recipe: Recipe, change: Callable[[str], str]) -> Recipe:
    """The recipe with the names of its files changed; samples stay."""

    def moved(choice: MapChoice) -> MapChoice:
        places: dict[str, Any] = {field: renamed(getattr(choice.session, field), change) for field in FILES}
        own = {field: renamed(getattr(choice, field), change) for field in OWN_FILES}
        return replace(choice, session=replace(choice.session, **places), **own)

    def laid(panel: Panel) -> Panel:
        texture = panel.texture
        return replace(panel, texture=texture and replace(texture, picture=renamed(texture.picture, change)))

    return replace(
        recipe,
        maps=tuple(moved(choice) for choice in recipe.maps),
        panels=tuple(laid(panel) for panel in recipe.panels),
    )


def plain_of(recipe: Recipe) -> dict[str, Any]:
    """The JSON object of a recipe: what differs from the defaults."""
    return {
        "format": FORMAT,
        "version": VERSION,
        "page": differing(recipe.page, Page(), tuple(PAGE)),
        "maps": [_plain_map(choice) for choice in recipe.maps],
        "panels": [_plain_panel(panel) for panel in recipe.panels],
    }


def _plain_panel(panel: Panel) -> dict[str, Any]:
    own = tuple(name for name in PANEL if name not in ("look", "carried", "texture"))
    plain = {"kind": panel.kind, **differing(panel, Panel(), own)}
    if panel.look is not None:
        plain["look"] = plain_look(panel.look)
    if panel.carried is not None:
        plain["carried"] = differing(panel.carried, CarriedLook(), tuple(CARRIED))
    if panel.texture is not None:
        plain["texture"] = differing(panel.texture, TextureLook(), tuple(TEXTURE))
    return plain


def _plain_map(choice: MapChoice) -> dict[str, Any]:
    plain: dict[str, Any] = {"name": choice.name, "source": choice.session.source}
    plain |= {name: value for name in ("label", *OWN_FILES) if (value := getattr(choice, name))}
    plain |= differing(choice.session, Session(), SESSION_FIELDS)
    return plain | ({"anchors": anchor_rows(choice.session)} if choice.session.anchor_vertices else {})


# ---------------------------------------------------------------------------------------------- reading


def recipe_of(plain: Mapping[str, Any]) -> Recipe:
    """The recipe that a parsed object stands for. Raises `WorkbenchError` naming what is wrong and where."""
    only_known(plain, {"format", "version", "page", "maps", "panels"}, "The recipe")
    page = checked_page(Page(), plain.get("page", {}))
    maps = tuple(_map_of(item, f"map {i + 1}") for i, item in enumerate(schema.rows("maps", plain.get("maps"), MOST_MAPS)))
    names = [choice.name for choice in maps]
    if len(set(names)) < len(names):
        raise WorkbenchError("Two maps have the same name; give each its own.")
    rows = schema.rows("panels", plain.get("panels"), MOST_PANELS)
    panels = tuple(_panel_of(item, f"panel {i + 1}", page, names) for i, item in enumerate(rows))
    if not any(panel.kind != "empty" for panel in panels):
        raise WorkbenchError("The recipe has no panel; a figure needs one at least.")
    _check_scales(panels)
    return Recipe(page, maps, panels)


def checked_page(page: Page, changes: Any) -> Page:
    """The page with some of its values changed. Raises `WorkbenchError` for what is no page."""
    page = replace(page, **schema.checked_object(changes, PAGE, "page"))
    if (page.width / 25.4 * page.dpi) ** 2 > LARGEST_PAGE:
        raise WorkbenchError(f"A page {page.width:g} mm wide at {page.dpi} dpi is too large; take a smaller dpi.")
    return page


def _map_of(plain: Any, what: str) -> MapChoice:
    fixed = {"name": _name, "label": _caption, **dict.fromkeys((*OWN_FILES, "source"), schema.path)}
    checks = fixed | {name: schema.CHOICES[name] for name in SESSION_FIELDS} | {"anchors": schema.anchors, "iterations": _steps}
    found = schema.checked_object(plain, checks, what)
    if not found.get("name") or not found.get("source"):
        raise WorkbenchError(f"{what} needs a name and a source: a mesh file, or sample:ID.")
    anchors = found.pop("anchors", {})
    own = {name: found.pop(name) for name in ("name", "label", *OWN_FILES) if name in found}
    return MapChoice(session=Session(**found, **anchors), **own)


def _panel_of(plain: Any, what: str, page: Page, names: list[str]) -> Panel:
    panel = Panel(**schema.checked_object(plain, PANEL, what))
    unknown = next((name for name in panel.maps if name not in names), None)
    if unknown is not None:
        raise WorkbenchError(f"{what} shows the map {unknown!r}; there are: {', '.join(names) or 'none'}.")
    if panel.is_picture and len(panel.maps) != 1:
        raise WorkbenchError(f"{what} shows {len(panel.maps)} maps; a {panel.kind} shows one.")
    if panel.kind in ("histogram", "curves") and not panel.maps:
        raise WorkbenchError(f"{what} names no maps; {panel.kind} needs one at least.")
    if panel.kind in ("histogram", "colour-bar") and not panel.has_measure:
        raise WorkbenchError(f"{what}: {panel.colour} has no values for a {panel.kind}; name a distortion, or another measure.")
    if panel.colour == PICTURE and panel.is_picture and not (panel.texture and panel.texture.picture):
        raise WorkbenchError(f"{what} shows a picture and names none; name a PNG or JPEG in its texture.")
    if panel.kind == "colour-bar" and not panel.scale:
        raise WorkbenchError(f"{what}: a colour bar of its own belongs to a scale; name the scale of the maps that share it.")
    if panel.span > page.columns:
        raise WorkbenchError(f"{what} takes {panel.span} columns, and the page has {page.columns}.")
    return panel


def _check_scales(panels: tuple[Panel, ...]) -> None:
    """Raise `WorkbenchError` where a scale is shared by two measures, or a colour bar by no map."""
    measures: dict[str, tuple[str, dict[str, float]]] = {}
    for panel in panels:
        if panel.scale and panel.has_measure and panel.kind != "curves":
            first = measures.setdefault(panel.scale, (panel.colour, dict(panel.parameters)))
            if first != (panel.colour, dict(panel.parameters)):
                raise WorkbenchError(f"{first[0]} and {panel.colour} share the scale {panel.scale!r}; give each its own.")
    drawn = {panel.scale for panel in panels if panel.is_picture and panel.has_measure}
    bare = next((panel.scale for panel in panels if panel.kind == "colour-bar" and panel.scale not in drawn), None)
    if bare is not None:
        raise WorkbenchError(f"No map has the scale {bare!r} that a colour bar belongs to; name the scale of a map.")


# ---------------------------------------------------------------------------------------------- values


def _within(lowest: float, highest: float) -> schema.Check:
    return lambda what, value: schema.number(what, value, lowest, highest)


def _whole(lowest: int, highest: int) -> schema.Check:
    return lambda what, value: schema.whole(what, value, lowest, highest)


def _steps(what: str, value: Any) -> int:
    return schema.whole(what, value, 0, MOST_STEPS)


def _caption(what: str, value: Any) -> str:
    return schema.text(what, value, LONGEST_CAPTION)


def _name(what: str, value: Any) -> str:
    return schema.text(what, value, schema.SHOWN)


def _names(what: str, value: Any) -> tuple[str, ...]:
    return tuple(_name(what, name) for name in schema.rows(what, value, MOST_MAPS))


def _range(what: str, value: Any) -> tuple[float, float]:
    ends = [schema.number(what, end) for end in schema.rows(what, value, 2)]
    if len(ends) != 2 or not ends[0] < ends[1]:
        raise schema.refuse(what, value, "two numbers, the smaller first")
    return ends[0], ends[1]


def _carried(what: str, value: Any) -> CarriedLook:
    return CarriedLook(**schema.checked_object(value, CARRIED, what))


CARRIED: dict[str, schema.Check] = {
    "colour": schema.text,
    "parameters": schema.numbers_by_name,
    "range": _range,
    "logarithmic": schema.flag,
    "opacity": _within(0.0, 1.0),
}
PAGE: dict[str, schema.Check] = {
    "width": _within(20.0, 2000.0),
    "dpi": _whole(36, 2400),
    "font_size": _within(3.0, 40.0),
    "background": schema.one_of(BACKGROUNDS),
    "columns": _whole(1, 20),
    "letters": schema.flag,
    "title": _caption,
}
PANEL: dict[str, schema.Check] = {
    "kind": schema.one_of(KINDS),
    "maps": _names,
    "colour": schema.text,
    "parameters": schema.numbers_by_name,
    "scale": _name,
    "range": _range,
    "logarithmic": schema.flag,
    "reversed": schema.flag,
    "clipped": schema.flag,
    "frame": _name,
    "view": schema.axes,
    "bar": schema.flag,
    "caption": _caption,
    "edges": schema.flag,
    "anchors": schema.flag,
    "wires": schema.flag,
    "seams": schema.flag,
    "boundary": schema.flag,
    "scale_bar": schema.flag,
    "texture": texture_of,
    "glyphs": schema.one_of(GLYPHS),
    "glyph_count": _whole(1, MOST_GLYPHS),
    "glyph_size": _within(0.05, 20.0),
    "look": look_of,
    "carried": _carried,
    "quantity": schema.one_of(tuple(QUANTITIES)),
    "bins": _whole(2, 1000),
    "span": _whole(1, 20),
}
assert set(PANEL) == {field.name for field in fields(Panel)}
assert set(CARRIED) == {field.name for field in fields(CarriedLook)}
assert set(PAGE) == {field.name for field in fields(Page)}
