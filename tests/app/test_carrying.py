"""A surface in a solid: it goes with every map in both views, in the colours of its own distortion, and into files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtGui import QImage
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QMenu
from pytestqt.qtbot import QtBot

from tests.app.fake_engine import solid_mesh
from workbench.app.main_window import MainWindow
from workbench.app.menus import fill_carried
from workbench.app.views.mesh_view import MeshView
from workbench.core.carried_surface import carry
from workbench.core.mesh import Mesh
from workbench.core.quality import simplex_table
from workbench.core.samples import make_sample
from workbench.io.read import read_mesh
from workbench.io.write import write_mesh


@pytest.fixture
def ring(tmp_path: Path) -> tuple[Path, Mesh]:
    """A torus inside the solid of the fake engine."""
    torus = make_sample("torus", 500)
    mesh = Mesh(torus.vertices * 0.3 + [1.0, 0.5, 0.5], torus.simplices, "ring.obj")
    write_mesh(tmp_path / "ring.obj", mesh)
    return tmp_path / "ring.obj", mesh


@pytest.fixture
def carrying(solid_window: MainWindow, ring: tuple[Path, Mesh], qtbot: QtBot) -> MainWindow:
    solid_window.carried.read(str(ring[0]))
    qtbot.waitUntil(lambda: solid_window.carried.surface is not None)
    return solid_window


def pixels(view: MeshView) -> np.ndarray:
    QTest.qWait(60)
    image = view.grab().toImage()
    return (
        np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())[:, : 4 * image.width()].copy()
    )


def bend(window: MainWindow, displacement: float) -> None:
    """Hold one corner and pull at the opposite one."""
    last = window.document.mesh.vertex_count - 1
    window.document.add_anchor(last)
    window.document.add_anchor(0)
    window.document.move_anchor(0, np.array([-displacement, 0.0, -displacement]), False)


def shown_points(window: MainWindow) -> list[np.ndarray]:
    """Where the layers of source and target draw the surface, in units of the mesh."""
    frames = [pane.view.geometry_shown.frame for pane in (window.source, window.target)]
    return [layer._points / frame.scale + frame.centre for layer, frame in zip(window.carried._layers, frames, strict=True)]


def test_it_goes_with_every_map(carrying: MainWindow, ring: tuple[Path, Mesh], qtbot: QtBot) -> None:
    document = carrying.document
    expected = carry(ring[1], solid_mesh())
    for displacement in (0.0, 0.4):
        if displacement:
            bend(carrying, displacement)
            qtbot.waitUntil(lambda: document.positions.min() < -0.1)
        moved = expected.at(document.positions)
        in_source, in_target = shown_points(carrying)
        np.testing.assert_allclose(in_source, ring[1].vertices, atol=1e-5)
        np.testing.assert_allclose(in_target, moved, atol=1e-5)
        own = simplex_table(ring[1], moved)["symmetric-dirichlet"]
        for layer in carrying.carried._layers:
            np.testing.assert_allclose(layer._values, own, rtol=1e-6)
    assert own.max() > 4.01
    assert carrying.carried.bar.isVisible()
    assert f"max {own.max():.4g}" in carrying.carried.bar.legend.numbers.text()


def test_it_is_coloured_by_any_of_its_measures(carrying: MainWindow, ring: tuple[Path, Mesh], qtbot: QtBot) -> None:
    bend(carrying, 0.4)
    qtbot.waitUntil(lambda: carrying.document.positions.min() < -0.1)
    table = simplex_table(ring[1], carry(ring[1], solid_mesh()).at(carrying.document.positions))
    bar = carrying.carried.bar
    columns = {"det": "det", "sigma1": "sigma_1", "sigman": "sigma_2"}
    for row in range(bar.chooser.count()):
        bar.chooser.setCurrentIndex(row)
        values = table[columns.get(bar.chooser.currentData(), bar.chooser.currentData())]
        np.testing.assert_allclose(carrying.carried._layers[1]._values, values, rtol=1e-6)
        low, high = carrying.carried.range.low, carrying.carried.range.high
        assert np.mean((values >= low - 1e-9) & (values <= high)) > 0.98, "the range is that of the quantity"
        assert bar.legend.bar.range is carrying.carried.range
    bar.chooser.setCurrentIndex(0)


def test_it_is_seen_through_the_solid_which_is_whole_again_without_it(carrying: MainWindow, qtbot: QtBot) -> None:
    view = carrying.source.view
    through = pixels(view)
    carrying.carried.bar.opacity.setValue(100)
    hidden = pixels(view)
    carrying.carried.let_go()
    without = pixels(view)
    changed = [(picture != without).reshape(len(without), -1, 4).any(axis=2).mean() for picture in (through, hidden)]
    assert changed[0] > 0.05, "a veil lets the surface through"
    assert changed[1] < 0.001, "a solid hides it"
    assert not carrying.carried.bar.isVisible()


def test_a_screenshot_of_a_view_is_opaque(carrying: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    """Pictures without the window behind them, too: background and what is seen through the solid."""
    pixels(carrying.source.view)
    carrying.commands.save_screenshot(carrying.source.view, str(tmp_path / "source.png"))
    qtbot.waitUntil((tmp_path / "source.png").exists)
    image = QImage(str(tmp_path / "source.png")).convertToFormat(QImage.Format.Format_RGBA8888)
    read = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())[
        :, 3 : 4 * image.width() : 4
    ]
    assert read.min() == 255


def test_it_is_saved_where_it_is(carrying: MainWindow, ring: tuple[Path, Mesh], tmp_path: Path, qtbot: QtBot) -> None:
    bend(carrying, 0.3)
    qtbot.waitUntil(lambda: carrying.document.positions.min() < -0.1)
    carrying.carried.save(str(tmp_path / "moved.obj"))
    qtbot.waitUntil(lambda: not carrying.carried.is_busy)
    moved = carry(ring[1], solid_mesh()).at(carrying.document.positions)
    np.testing.assert_allclose(read_mesh(tmp_path / "moved.obj").mesh.vertices, moved, atol=1e-12)
    carrying.carried.save(str(tmp_path / "nowhere" / "moved.obj"))
    qtbot.waitUntil(lambda: carrying.error_bar.isVisible())
    assert "nowhere" in carrying.error_bar.sentence.text()


def test_what_is_no_surface_is_refused_and_what_is_carried_stays(
    carrying: MainWindow, ring: tuple[Path, Mesh], tmp_path: Path, qtbot: QtBot
) -> None:
    far = Mesh(ring[1].vertices + 100.0, ring[1].simplices)
    write_mesh(tmp_path / "far.obj", far)
    for source, what in (("sample:ball", "triangles in space"), (str(tmp_path / "far.obj"), "from the volume")):
        carrying.carried.read(source)
        qtbot.waitUntil(lambda: not carrying.carried.is_busy)
        qtbot.waitUntil(lambda w=what: w in carrying.error_bar.sentence.text())
        assert carrying.carried.surface is not None


def test_another_mesh_lets_it_go(carrying: MainWindow, qtbot: QtBot) -> None:
    actors = [layer.actor for layer in carrying.carried._layers]
    carrying.open("grid")
    qtbot.waitUntil(lambda: carrying.document.kind == "plane")
    assert carrying.carried.surface is None
    for view in (carrying.source.view, carrying.target.view):
        assert not any(view._renderer.HasViewProp(actor) for actor in actors)
    carrying.carried.read("sample:salamander")
    assert not carrying.carried.is_busy, "a plane figure carries nothing"


def test_the_sample_is_scaled_into_any_solid(solid_window: MainWindow, qtbot: QtBot) -> None:
    solid_window.carried.read("sample:salamander")
    qtbot.waitUntil(lambda: solid_window.carried.surface is not None)
    surface = solid_window.carried.surface
    assert surface.outside_count == 0
    assert np.ptp(surface.surface.vertices, axis=0).min() > 0.3


def test_the_menu_offers_what_can_be_done(solid_window: MainWindow, qtbot: QtBot) -> None:
    menu = QMenu(solid_window)
    fill_carried(solid_window, menu)
    assert [action.isEnabled() for action in menu.actions() if action.text()] == [True, True, False, False]
    assert "Salamander" in menu.actions()[1].text()
    solid_window.open("grid")
    qtbot.waitUntil(lambda: solid_window.document.kind == "plane")
    fill_carried(solid_window, menu)
    assert not any(action.isEnabled() for action in menu.actions() if action.text())
    menu.deleteLater()


def test_letting_go_is_undone_and_done_again(carrying: MainWindow, ring: tuple[Path, Mesh], qtbot: QtBot) -> None:
    carried, undoing = carrying.carried, carrying.undoing
    assert carrying.document.session.carried == str(ring[0])
    carried.let_go()
    assert undoing.history.undo_name == "Carried surface" and not carrying.document.session.carried
    undoing.undo()
    qtbot.waitUntil(lambda: carried.surface is not None)
    assert carried.source == str(ring[0])
    undoing.redo()
    qtbot.waitUntil(lambda: carried.surface is None)


def test_a_pane_of_a_split_shows_the_surface_too_and_alone_where_that_is_asked(carrying: MainWindow, qtbot: QtBot) -> None:
    carried, splitting = carrying.carried, carrying.splitting
    pane = splitting.split("target", "below")
    assert pane is not None
    assert len(carried._layers) == 3 and carried._layers[2]._view is pane.view
    np.testing.assert_array_equal(carried._layers[2]._points, carried._layers[1]._points)
    pane.side_chosen.emit("carried")
    alone = splitting.panes[0]
    qtbot.wait(50)
    assert alone.view.surface._actor.GetProperty().GetOpacity() == 0.0
    assert carrying.target.view.surface._actor.GetProperty().GetOpacity() > 0.0
    splitting.close_view(alone.objectName())
    assert len(carried._layers) == 2
