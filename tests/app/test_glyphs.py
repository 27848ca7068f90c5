"""Glyphs on the views: they stand on the same places of source and map, and follow the map."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from pytestqt.qtbot import QtBot
from vtkmodules.util.numpy_support import vtk_to_numpy

from tests.app.conftest import WindowMaker, pixels_of
from workbench.app.glyphs.glyphs import MOST, Glyphs
from workbench.app.main_window import MainWindow
from workbench.app.settings import Settings
from workbench.app.views.mesh_view import MeshView


@pytest.fixture
def glyphs(window: MainWindow, qtbot: QtBot) -> Glyphs:
    window.glyphs.choose(kind="stretches", number=1.0, size=1.0, places=("source", "target"))
    qtbot.waitUntil(lambda: bool(window.glyphs._layers))
    return window.glyphs


def drawn(glyphs: Glyphs, view: MeshView) -> np.ndarray:
    """Points (k, p, 3) of the shapes of a view, p those of a cell."""
    data = glyphs._layers[view]._lines
    ids = vtk_to_numpy(data.GetLines().GetConnectivityArray()).reshape(data.GetNumberOfCells(), -1)
    return vtk_to_numpy(data.GetPoints().GetData()).copy()[ids]


def test_lines_are_as_long_as_the_map_stretches_them(glyphs: Glyphs, window: MainWindow, qtbot: QtBot) -> None:
    document = window.document
    document.pin(np.array([0, 110, 272]))
    document.move_anchor(110, document.positions[110] + [0.15, 0.1], False)
    qtbot.waitUntil(lambda: np.linalg.norm(document.positions[110] - document.mesh.vertices[110]) > 0.1)
    lines, at_rest = (drawn(glyphs, pane.view) for pane in (window.target, window.source))
    chosen = glyphs._places.rows
    corners, images = (points[document.mesh.simplices[chosen]] for points in (document.mesh.vertices, document.positions))
    edges, moved = ((c[:, 1:] - c[:, :1]).transpose(0, 2, 1) for c in (corners, images))
    values = np.linalg.svd(moved @ np.linalg.inv(edges), compute_uv=False)
    assert np.ptp(values) > 0.1
    for view, shapes, points, longest in (
        (window.target.view, lines, images, np.inf),
        (window.source.view, at_rest, corners, 2.5),
    ):
        frame = view.geometry_shown.frame
        ends = shapes.reshape(len(chosen), 2, 2, 3)[..., :2] / frame.scale
        lengths = np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=2)
        radius = lengths[0, 0] / values[0, 0]
        np.testing.assert_allclose(lengths, radius * np.minimum(values, longest), rtol=2e-3)
        np.testing.assert_allclose(ends.mean(axis=(1, 2)) + frame.centre, points.mean(axis=1), atol=1e-4)


def test_ellipses_are_images_of_equal_circles_and_number_and_size_are_chosen(glyphs: Glyphs, window: MainWindow) -> None:
    window.actions_by_name["glyphs-ellipses"].trigger()
    rings = drawn(glyphs, window.source.view)
    radii = np.linalg.norm(rings - rings[:, :-1].mean(axis=1, keepdims=True), axis=2)
    np.testing.assert_allclose(radii, radii.mean(), rtol=1e-4)
    before = len(rings)
    window.actions_by_name["glyphs-larger"].trigger()
    larger = drawn(glyphs, window.source.view)
    np.testing.assert_allclose(np.ptp(larger, axis=1).max(axis=1), 1.5 * np.ptp(rings, axis=1).max(axis=1), rtol=1e-3)
    window.actions_by_name["glyphs-fewer"].trigger()
    assert 0.3 * before < len(drawn(glyphs, window.source.view)) < 0.8 * before
    for _ in range(12):
        window.actions_by_name["glyphs-more"].trigger()
    assert before < len(drawn(glyphs, window.source.view)) <= MOST


def test_source_and_map_are_measured_by_one_unit_though_they_are_drawn_in_two(
    glyphs: Glyphs, window: MainWindow, qtbot: QtBot
) -> None:
    window.open("bumpy")
    views = window.source.view, window.target.view
    qtbot.waitUntil(lambda: window.document.kind == "parameterize" and views[1].geometry_shown is not None)
    frames = [view.geometry_shown.frame for view in views]
    assert frames[0].scale != pytest.approx(frames[1].scale, rel=1e-3)
    ends = [drawn(glyphs, view) / frame.scale for view, frame in zip(views, frames, strict=True)]
    of_source, of_map = (np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1) for lines in ends)
    np.testing.assert_allclose(of_source, of_map, rtol=2e-3)


def test_more_and_larger_are_grey_until_there_are_some(glyphs: Glyphs, window: MainWindow) -> None:
    amounts = [window.actions_by_name[f"glyphs-{name}"] for name in ("more", "fewer", "larger", "smaller")]
    for kind in ("none", "stretches", "none"):
        glyphs.choose(kind=kind)
        assert {action.isEnabled() for action in amounts} == {kind != "none"}


def test_they_are_seen_where_they_are_wanted_and_nowhere_else(glyphs: Glyphs, window: MainWindow, qtbot: QtBot) -> None:
    window.set_source_style("plain")
    with_lines = [pixels_of(pane.view) for pane in (window.source, window.target)]
    window.actions_by_name["glyphs-on-source"].trigger()
    qtbot.wait(30)
    without, still = (pixels_of(pane.view) for pane in (window.source, window.target))
    assert np.abs(without - with_lines[0]).max() > 100
    assert np.abs(still - with_lines[1]).max() < 30
    window.actions_by_name["glyphs-none"].trigger()
    qtbot.wait(30)
    assert np.abs(pixels_of(window.target.view) - still).max() > 100
    assert window.actions_by_name["glyphs-none"].isChecked()
    window.set_source_style("checkerboard")


def test_of_a_solid_they_stand_on_what_is_seen(glyphs: Glyphs, solid_window: MainWindow, qtbot: QtBot) -> None:
    glyphs.choose(kind="ellipses")
    view = solid_window.source.view
    bodies = glyphs._layers[view]._bodies
    whole = vtk_to_numpy(bodies.GetPoints().GetData()).reshape(-1, 66, 3).mean(axis=1)
    solid_window.look.cut_along("x")
    qtbot.waitUntil(lambda: solid_window.volume.look.is_cut)
    qtbot.wait(80)
    cut = vtk_to_numpy(bodies.GetPoints().GetData()).reshape(-1, 66, 3).mean(axis=1)
    assert np.ptp(cut[:, 0]) < 0.8 * np.ptp(whole[:, 0])
    solid_window.volume.show_all()
    glyphs.choose(kind="none")


@pytest.mark.parametrize(
    ("kept", "kind", "number"),
    [
        ({"kind": "ellipses", "number": 2.0, "places": ["target"]}, "ellipses", 2.0),
        ({"kind": 3, "number": 1e9, "places": "x"}, "none", 1.0),
    ],
)
def test_the_choice_is_there_again(
    kept: dict[str, object], kind: str, number: float, make_window: WindowMaker, tmp_path: Path
) -> None:
    settings = Settings(tmp_path / "window.ini")
    settings._store.setValue("views", json.dumps({"glyphs": kept}))
    settings.sync()
    window = make_window()
    assert (window.glyphs.choice.kind, window.glyphs.choice.number) == (kind, number)
    assert window.actions_by_name[f"glyphs-{kind}"].isChecked()
    assert window.view_memory.state()["glyphs"].get("kind", "none") == kind
