"""`workbench figure` and its list."""

from __future__ import annotations

import json

import numpy as np
import pytest

from workbench.figures.presets import PRESETS


def test_presets_are_listed(cli):
    listed = {entry["id"] for entry in cli("list", "figures", "--json").json}
    assert set(PRESETS) <= listed


def test_a_preset_on_an_own_mesh_and_the_recipe_that_it_leaves(cli, dome_file, tmp_path):
    done = cli("figure", "before-after", "--mesh", dome_file, "--out", tmp_path / "a", "--dpi", 72, "--recipe")
    assert done.status == 0, done.err
    assert {path.name for path in (tmp_path / "a").iterdir()} == {
        f"before-after.{ending}" for ending in ("png", "pdf", "svg", "json")
    }
    again = cli("figure", tmp_path / "a" / "before-after.json", "--out", tmp_path / "b", "--quiet")
    assert again.status == 0, again.err
    for ending in ("png", "pdf", "svg"):
        name = f"before-after.{ending}"
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_maps_from_files_take_the_place_of_a_solver(cli, dome_file, tmp_path):
    assert cli("solve", dome_file, "--iterations", 1, "--out", tmp_path / "map.obj", "--quiet").status == 0
    given = ("--mesh", dome_file, "--given", f"mine={tmp_path / 'map.obj'}")
    for preset in ("fig3", "fig11", "fig1-histograms"):
        done = cli("figure", preset, *given, "--out", tmp_path / "out", "--dpi", 72, "--recipe")
        assert done.status == 0, done.err
        maps = json.loads((tmp_path / "out" / f"{preset}.json").read_text())["maps"]
        assert [item["label"] for item in maps] == ["mine"]
        assert maps[0]["target"] == "../map.obj"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("nothing",), "fig3"),
        (("fig3", "--given", "map.obj"), "name the mesh"),
        (("fig3", "--width", "1"), "width"),
        (("missing.json",), "missing.json"),
        (("missing.json", "--mesh", "sample:bar"), "--mesh"),
        (("fig3", "--mesh", "missing.obj"), "missing.obj"),
    ],
)
def test_what_cannot_be_is_refused_and_nothing_is_written(cli, tmp_path, arguments, words):
    done = cli("figure", *arguments, "--out", tmp_path / "out")
    assert done.status == 2
    assert words in done.err
    assert not (tmp_path / "out").exists()


def test_a_solver_that_fails_is_no_bad_recipe(cli, tmp_path):
    assert cli("solve", "sample:bar", "--iterations", 0, "--out", tmp_path / "map.npz", "--quiet").status == 0
    with np.load(tmp_path / "map.npz") as file:
        arrays = dict(file)
    arrays["X"][0] += 3.0  # the triangles round it are turned over, and the distortion is a barrier
    np.savez(tmp_path / "folded.npz", **arrays)
    recipe = {
        "format": "distortion-workbench figure",
        "version": 1,
        "maps": [{"name": "a", "source": "sample:bar", "initializer": "file", "start_file": "folded.npz"}],
        "panels": [{"kind": "map", "maps": ["a"]}],
    }
    (tmp_path / "recipe.json").write_text(json.dumps(recipe))
    done = cli("figure", tmp_path / "recipe.json", "--out", tmp_path / "out")
    assert done.status == 1
    assert "Map a: The solver failed: Inverted start" in done.err
    assert not (tmp_path / "out").exists()
