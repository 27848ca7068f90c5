"""Composing a figure in the window: what is shown there is what the figure, its files and its recipe hold."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QAbstractSpinBox, QApplication, QCheckBox, QComboBox, QLineEdit, QWidget
from pytestqt.qtbot import QtBot

from workbench.app.composing.figure_dialog import FigureDialog
from workbench.app.composing.figure_work import NAME, Order, Subject, draw_preview, save
from workbench.app.composing.offers import Offer, offers_of, subject_of
from workbench.app.main_window import MainWindow
from workbench.app.timeline.film_dialog import FilmDialog
from workbench.app.views.solid_texture import CELLS, OFFSET
from workbench.app.views.textures import pattern_image
from workbench.core.errors import WorkbenchError
from workbench.core.run import HistoryRow
from workbench.core.samples import make_sample
from workbench.figures.composer import compose
from workbench.figures.figure_maps import make_maps
from workbench.figures.mesh_panel import scene_of
from workbench.figures.mesh_pictures import is_inked
from workbench.figures.recipe import PLAIN, Page, Panel
from workbench.figures.recipe_text import read_recipe
from workbench.figures.save import save_figure
from workbench.figures.texture_panel import texture_places
from workbench.session.session import Session


@pytest.fixture
def dialog(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> Iterator[FigureDialog]:
    window.settings.folder = str(tmp_path)
    window.actions_by_name["figure"].trigger()
    composing = window.commands.composing
    dialog = composing.dialog
    assert dialog is not None and dialog.isVisible()
    qtbot.waitUntil(lambda: not dialog.picture.pixmap().isNull())
    yield dialog
    if composing.dialog is dialog:
        dialog.close()
    qtbot.waitUntil(lambda: not composing._works)


def next_preview(dialog: FigureDialog, qtbot: QtBot) -> None:
    before = dialog.picture.pixmap().cacheKey()
    qtbot.waitUntil(lambda: dialog.picture.pixmap().cacheKey() != before)


def test_panels_have_the_quantities_and_ranges_of_the_window(dialog: FigureDialog, window: MainWindow) -> None:
    panels = dialog.chosen
    assert [panel.kind for panel in panels[:2]] == ["source", "map"]
    shown = {dock.quantity for dock in window.maps if dock.isVisible()}
    coloured = [panel for panel in panels if panel.kind == "map" and panel.has_measure]
    assert shown <= {panel.colour for panel in coloured}
    for panel in coloured:
        colours = window.quantities.range_of(panel.colour if panel.colour in window.quantities else "in-force")
        assert panel.range == (colours.low, colours.high)


def test_what_is_changed_is_seen_and_what_is_unticked_is_gone(dialog: FigureDialog, qtbot: QtBot) -> None:
    count = len(dialog.chosen)
    table = dialog.panels.table
    table.item(0, 0).setCheckState(Qt.CheckState.Unchecked)
    table.item(1, 1).setText("mine")
    dialog.width_mm.setValue(85)
    next_preview(dialog, qtbot)
    assert len(dialog.chosen) == count - 1
    assert dialog.chosen[0].caption == "mine"
    assert dialog.page.width == 85
    table.setCurrentCell(1, 0)
    dialog.panels.up.click()
    assert dialog.panels.table.item(0, 1).text() == "mine"
    for row in range(table.rowCount()):
        table.item(row, 0).setCheckState(Qt.CheckState.Unchecked)
    qtbot.waitUntil(lambda: "No panel" in dialog.picture.text())
    assert not dialog.save_button.isEnabled()


def test_files_are_written_and_told(dialog: FigureDialog, qtbot: QtBot, tmp_path: Path) -> None:
    for ending in ("svg", "tiff"):
        dialog.save_wanted.emit(str(tmp_path / f"figure.{ending}"))
        qtbot.waitUntil(lambda: "Saving" not in dialog.note.text())
    assert (tmp_path / "figure.svg").read_bytes().startswith(b"<?xml")
    assert "endings" in dialog.note.text()
    assert not (tmp_path / "figure.tiff").exists()


def test_the_recipe_of_the_window_makes_the_same_file(tmp_path: Path) -> None:
    mesh = make_sample("bar")
    positions = mesh.vertices * [1.2, 0.9] + 0.05 * np.sin(mesh.vertices[:, ::-1])
    rows = tuple(HistoryRow(k, 0.1, 5.0 - k, np.nan, 1.0 / (k + 1), np.nan, 0, np.nan) for k in range(3))
    subject = Subject("bar", Session(source="sample:bar", kind="plane", anchor_vertices=(3,), anchor_targets=((0.0, 0.0),)),
                      mesh, "plane", positions, rows)  # fmt: skip
    panels = (
        Panel("map", (NAME,), "det", bar=True, range=(0.5, 3.0)),
        Panel("histogram", (NAME,), "det"),
        Panel("curves", (NAME,)),
    )
    order = Order(subject, Page(width=100.0, dpi=72), panels)
    for name in ("figure.svg", "figure.json"):
        save(order, tmp_path / name)
    recipe = read_recipe(tmp_path / "figure.json")
    save_figure(compose(recipe, make_maps(recipe.maps)).figure, tmp_path / "again.svg", 72)
    assert (tmp_path / "again.svg").read_bytes() == (tmp_path / "figure.svg").read_bytes()


def test_nothing_chosen_is_no_figure() -> None:
    mesh = make_sample("bar")
    order = Order(Subject("bar", Session(source="sample:bar"), mesh, "plane", mesh.vertices), Page(), ())
    with pytest.raises(WorkbenchError, match="tick one"):
        draw_preview(order, 300)


def test_a_solid_is_seen_as_its_view_is_turned(solid_window: MainWindow) -> None:
    view = solid_window.target.view
    view.set_camera(view.camera.rotated(80.0, 40.0, view.size_in_pixels))
    panel = offers_of(solid_window)[1].panel
    subject = subject_of(solid_window)
    assert subject is not None
    scene = scene_of(subject.map, panel)
    height, width = 400, 600
    there, _ = view.camera.project(subject.positions, (width, height))
    scale = view.camera.pixels_per_unit((width, height))
    here = scene.points[:, :2] * [scale, -scale]
    np.testing.assert_allclose(here - here[0], there - there[0], atol=1e-6)


def test_patterns_lie_on_paper_as_they_do_in_the_views(window: MainWindow, tmp_path: Path) -> None:
    colours = np.zeros((30, 50, 3), np.uint8)
    colours[:15, :25], colours[15:, 25:] = (250, 30, 20), (20, 240, 60)
    Image.fromarray(colours).save(tmp_path / "flag.png")
    window.texturing.take_picture(str(tmp_path / "flag.png"))
    usual = {"size": 1.0, "degrees": 0.0, "of_source": False, "of_unit": False}
    for pattern in ("checkerboard", "grid", "circles", "stripes", "picture"):
        window.colouring.set_style(window.target, pattern)
        for changes in ({}, {"size": 0.6, "degrees": 30.0}, {"of_source": True}, {"of_unit": True}):
            window.texturing.choose(**{**usual, **changes})
            subject = subject_of(window)
            assert subject is not None
            scene = scene_of(subject.map, offers_of(window)[1].panel)
            weights = np.random.default_rng(3).dirichlet(np.ones(3), len(scene.skin.triangles))
            texture = window.texturing.texture(pattern)  # type: ignore[arg-type]
            points = texture.points() if texture.points else None
            assert points is not None
            mixed = weights[:, None] @ texture.coordinates(points)[scene.skin.triangles]  # within triangles, off any edge
            there, ours = mixed[:, 0], (weights[:, None] @ texture_places(scene)[scene.skin.triangles])[:, 0]
            if pattern == "picture":
                np.testing.assert_allclose(ours, there, atol=1e-4)
                assert scene.panel.texture is not None
                assert scene.panel.texture.picture == str(tmp_path / "flag.png")
                continue
            tile, within = pattern_image(pattern, False).astype(int), there - np.floor(there)  # type: ignore[arg-type]
            side = len(tile)
            seen = tile[((1.0 - within[:, 1]) * side).astype(int) % side, (within[:, 0] * side).astype(int) % side, 0]
            dark = seen < 200
            assert (dark == is_inked(ours, scene.panel.colour)).mean() > 0.95, "but for points on the edge of a field"
            assert 0.02 < dark.mean() < 0.98


def test_every_choice_of_both_dialogs_asks_for_a_preview(qtbot: QtBot, qapp: QApplication, tmp_path: Path) -> None:
    offers = [Offer("Target", Panel("map", (NAME,), PLAIN))]
    parent = QWidget()
    qtbot.addWidget(parent)
    for dialog in (
        FigureDialog(offers, "a", str(tmp_path), parent),
        FilmDialog(offers, False, True, tmp_path / "a.gif", parent),
    ):
        fields = [box for kind in (QAbstractSpinBox, QComboBox, QCheckBox, QLineEdit) for box in dialog.findChildren(kind)]
        fields = [box for box in fields if not isinstance(box.parent(), QAbstractSpinBox)]
        assert len(fields) >= 8
        for field in fields:
            dialog._timer.stop()
            if isinstance(field, QAbstractSpinBox):
                field.stepUp()
            elif isinstance(field, QComboBox):
                field.setCurrentIndex((field.currentIndex() + 1) % field.count())
            elif isinstance(field, QCheckBox):
                field.toggle()
            else:
                field.textEdited.emit("words")
            assert dialog._timer.isActive(), field
        dialog.show_no_preview("A sentence.")
        assert dialog.picture.text() == "A sentence." and not dialog.save_button.isEnabled()
        dialog.close()
        assert not dialog._timer.isActive()


def test_patterns_through_solids_lie_on_paper_as_they_do_in_the_views(solid_window: MainWindow, tmp_path: Path) -> None:
    window = solid_window
    Image.new("RGB", (20, 10), "red").save(tmp_path / "flag.png")
    window.texturing.take_picture(str(tmp_path / "flag.png"))
    window.texturing.choose(size=0.7, degrees=25.0)
    try:
        for pattern in ("checkerboard", "grid", "circles", "stripes", "picture"):
            window.colouring.set_style(window.target, pattern)
            subject = subject_of(window)
            assert subject is not None
            scene = scene_of(subject.map, offers_of(window)[1].panel)
            texture = window.texturing.texture(pattern)  # type: ignore[arg-type]
            points = texture.points() if texture.points else None
            assert points is not None
            there = texture.coordinates(points)
            if pattern != "picture":
                there = CELLS[pattern] * texture.coordinates_in_space(points) + OFFSET
            np.testing.assert_allclose(texture_places(scene), there, atol=1e-3)
    finally:
        window.texturing.choose(size=1.0, degrees=0.0)
