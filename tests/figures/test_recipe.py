"""Recipes: what is written is read again, and nothing but a recipe is read."""

from __future__ import annotations

import json
import random

import pytest

from workbench.core.errors import WorkbenchError
from workbench.core.run import HistoryRow
from workbench.figures.history_file import read_history, write_history
from workbench.figures.presets import PRESETS, preset_recipe
from workbench.figures.recipe_text import plain_of, read_recipe, recipe_of, write_recipe


def plain(**changes):
    found = {
        "format": "distortion-workbench figure",
        "version": 1,
        "maps": [{"name": "a", "source": "sample:bar", "iterations": 0}],
        "panels": [{"kind": "map", "maps": ["a"]}],
    }
    return found | changes


@pytest.mark.parametrize("id", PRESETS)
def test_a_preset_is_read_as_it_was_written(id, tmp_path):
    recipe = preset_recipe(id)
    write_recipe(tmp_path / "figure.json", recipe)
    again = read_recipe(tmp_path / "figure.json")
    assert plain_of(again) == plain_of(recipe)
    assert (again.page, again.panels) == (recipe.page, recipe.panels)


def test_files_are_named_from_where_the_recipe_is(tmp_path):
    (tmp_path / "recipe.json").write_text(
        json.dumps(plain(maps=[{"name": "a", "source": "mesh.obj", "target": "maps/a.npz"}])), encoding="utf-8"
    )
    recipe = read_recipe(tmp_path / "recipe.json")
    assert recipe.maps[0].session.source == str(tmp_path / "mesh.obj")
    (tmp_path / "deeper").mkdir()
    write_recipe(tmp_path / "deeper" / "recipe.json", recipe)
    assert json.loads((tmp_path / "deeper" / "recipe.json").read_text())["maps"][0]["target"] == "../maps/a.npz"


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"panels": []}, "no panel"),
        ({"panels": [{"maps": ["b"]}]}, "'b'"),
        ({"panels": [{"maps": ["a"], "colour": "symmetric-dirichlet", "script": "x"}]}, "'script'"),
        ({"panels": [{"maps": ["a"], "range": [5, 4]}]}, "the smaller first"),
        ({"panels": [{"maps": ["a"], "span": 4}]}, "columns"),
        ({"panels": [{"kind": "histogram", "maps": ["a"], "colour": "chequered"}]}, "no values"),
        ({"panels": [{"kind": "colour-bar", "scale": "s"}]}, "'s'"),
        ({"panels": [{"maps": ["a"], "scale": "s"}, {"maps": ["a"], "scale": "s", "colour": "det"}]}, "share"),
        ({"panels": [{"maps": ["a"], "view": [[1, 0, 0], [0, 1, 0], [0, 1, 0]]}]}, "right angles"),
        ({"panels": [{"maps": ["a"], "view": [[1, 0], [0, 1]]}]}, "right angles"),
        ({"panels": [{"maps": ["a"], "glyphs": "hedgehogs"}]}, "stretches"),
        ({"panels": [{"maps": ["a"], "glyph_count": 10**9}]}, "glyph_count"),
        ({"panels": [{"maps": ["a"], "look": 3}]}, "an object"),
        ({"panels": [{"maps": ["a"], "look": {"normal": [1, 1, 0]}}]}, "length 1"),
        ({"panels": [{"maps": ["a"], "look": {"normal": [1]}}]}, "normal"),
        ({"panels": [{"maps": ["a"], "look": {"place": "half"}}]}, "place"),
        ({"panels": [{"maps": ["a"], "look": {"script": "x"}}]}, "'script'"),
        ({"panels": [{"maps": ["a"], "carried": {"opacity": 2}}]}, "opacity"),
        ({"panels": [{"maps": ["a"], "carried": {"range": [2, 1]}}]}, "the smaller first"),
        ({"panels": [{"maps": ["a"], "colour": "picture"}]}, "names none"),
        ({"panels": [{"maps": ["a"], "colour": "grid", "texture": {"of": "moon"}}]}, "map, source"),
        ({"panels": [{"maps": ["a"], "colour": "grid", "texture": {"matrix": [[1, 0]]}}]}, "rows"),
        ({"panels": [{"maps": ["a"], "colour": "grid", "texture": {"matrix": [[1, 0], [1]]}}]}, "numbers"),
        ({"panels": [{"maps": ["a"], "colour": "grid", "texture": {"matrix": [[1, 0], [0, 1e300]]}}]}, "matrix"),
        ({"panels": [{"maps": ["a"], "colour": "grid", "texture": {"offset": [1, 2, 3]}}]}, "one for each row"),
        ({"panels": [{"maps": ["a"], "colour": "grid", "texture": {"picture": 5}}]}, "picture"),
        ({"panels": [{"maps": ["a"], "wires": 1}]}, "wires"),
        ({"page": {"width": 1e9}}, "width"),
        ({"page": {"width": 2000, "dpi": 2400}}, "too large"),
        ({"page": {"background": "url(x)"}}, "background"),
        ({"maps": [{"name": "a", "source": "sample:bar"}] * 2}, "same name"),
        ({"maps": [{"name": "a", "source": "sample:bar", "time_limit": 1}]}, "'time_limit'"),
        ({"maps": [{"name": "a", "source": "sample:bar", "iterations": 10**8}]}, "iterations"),
        ({"maps": [{"name": "a"}]}, "source"),
        ({"version": 2}, "newer"),
        ({"format": "distortion-workbench session"}, "no recipe"),
        ({"page": {"title": "two\nlines"}}, "title"),
    ],
)
def test_what_is_wrong_is_said_in_a_sentence(changes, words, tmp_path):
    path = tmp_path / "recipe.json"
    path.write_text(json.dumps(plain(**changes)), encoding="utf-8")
    with pytest.raises(WorkbenchError, match=r"recipe\.json") as caught:
        read_recipe(path)
    assert words in caught.value.sentence


def test_the_plain_recipe_of_these_tests_is_one():
    assert recipe_of(plain()).panels[0].maps == ("a",)


def test_damaged_recipes_are_refused_and_nothing_worse(tmp_path):
    whole = json.dumps(plain_of(preset_recipe("before-after")))
    dice = random.Random(5)
    path = tmp_path / "recipe.json"
    for _ in range(300):
        text = list(whole)
        for _ in range(dice.randint(1, 4)):
            place = dice.randrange(len(text))
            text[place] = dice.choice(["", "0", "9" * 30, '"', "{", "]", "null", "-", "\x00", "é", "[" * 2000])
        path.write_text("".join(text), encoding="utf-8")
        try:
            read_recipe(path)
        except WorkbenchError as error:
            assert error.sentence


def test_a_history_is_read_as_it_was_written(tmp_path):
    rows = tuple(HistoryRow(k, 0.1 * k, 1 / 3 + k, 1.5, 1e-300, 1.0, k, 0.0) for k in range(3))
    write_history(tmp_path / "history.csv", rows)
    assert read_history(tmp_path / "history.csv") == rows


@pytest.mark.parametrize("text", ["", "a,b\n1,2\n", "iteration,energy,gradient_norm,inverted\n1,x,2,3\n", "\x00", "1\n" * 9])
def test_what_is_no_history_is_refused(text, tmp_path):
    (tmp_path / "history.csv").write_text(text)
    with pytest.raises(WorkbenchError, match=r"history\.csv"):
        read_history(tmp_path / "history.csv")


def test_a_look_into_a_solid_is_read_as_it_was_written():
    panel = {
        "kind": "map",
        "maps": ["a"],
        "look": {"is_cut": True, "normal": [0.0, 0.6, 0.8], "place": 0.3, "peel_by": "det", "threshold": 0.5, "marked": [1, 4]},
    }
    assert plain_of(recipe_of(plain(panels=[panel])))["panels"] == [panel]


def test_a_carried_surface_is_named_from_where_the_recipe_is(tmp_path):
    carried = {"colour": "det", "range": [0.5, 2.0], "logarithmic": True, "opacity": 0.1}
    maps = [{"name": "a", "source": "sample:bar-3d", "iterations": 0, "carried": "figure.obj"}]
    panels = [{"kind": "map", "maps": ["a"], "carried": carried}]
    (tmp_path / "recipe.json").write_text(json.dumps(plain(maps=maps, panels=panels)), encoding="utf-8")
    recipe = read_recipe(tmp_path / "recipe.json")
    assert recipe.maps[0].session.carried == str(tmp_path / "figure.obj")
    assert plain_of(recipe)["panels"] == panels
