"""The numbers of what is under the pointer."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QRectF, Qt
from PySide6.QtGui import QColor, QGuiApplication, QImage, QPainter
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from tests.app.conftest import Hand
from workbench.app.appearance.theme import LIGHT
from workbench.app.main_window import MainWindow
from workbench.app.views import scale_bar
from workbench.app.views.mesh_view import MeshView
from workbench.core.quality import simplex_table
from workbench.core.round_length import round_length


def point_at(window: MainWindow, view: MeshView, simplex: int, qtbot: QtBot) -> None:
    """Rest over the middle of a simplex."""
    geometry = view.geometry_shown
    x, y = view.project(geometry.points[geometry.simplices[simplex]]).mean(axis=0)
    Hand(view).move(QPoint(2, 2))
    Hand(view).move(QPoint(round(x), round(y)))
    qtbot.waitUntil(lambda: window.readings.panel.isVisible())


@pytest.fixture
def reading(window: MainWindow) -> MainWindow:
    QTest.keyClick(window, Qt.Key.Key_V)
    assert window.readings.is_on
    return window


def test_the_panel_says_what_the_table_says_in_every_kind_of_view(reading: MainWindow, qtbot: QtBot) -> None:
    window = reading
    qtbot.waitUntil(lambda: window.quantities.is_listed)
    window.document.add_anchor(0)
    for view in (window.source.view, window.target.view, window.maps[0].view):
        point_at(window, view, 100, qtbot)
        text = window.readings.panel.text
        assert text.heading[0].startswith("triangle 100")
        table = simplex_table(window.document.mesh, window.document.positions)
        numbers = {name: float(number.replace("−", "-")) for name, number in text.rows if number != "∞"}
        assert numbers["σ₁"] == pytest.approx(table["sigma_1"][100], rel=1e-5)
        assert numbers["SD (32)"] == pytest.approx(table["symmetric-dirichlet"][100], rel=1e-5)
        assert numbers["area"] == pytest.approx(table["area"][100] * table["det"][100], rel=1e-5)
        assert len(numbers) >= 20, "every measure is there"
    window.document.clear_anchors()
    QTest.keyClick(window, Qt.Key.Key_C, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier)
    lines = QGuiApplication.clipboard().text().splitlines()
    assert lines[0].startswith("triangle 100") and all("\t" in line for line in lines[2:])
    QTest.keyClick(window, Qt.Key.Key_V)
    assert not window.readings.panel.isVisible()
    QTest.keyClick(window, Qt.Key.Key_V)
    assert window.readings.panel.isVisible(), "the pointer need not move for it"
    Hand(window.target.view).move(QPoint(2, 2))
    qtbot.waitUntil(lambda: not window.readings.panel.isVisible())
    QTest.keyClick(window, Qt.Key.Key_V)
    assert not window.readings.is_on


def test_in_a_solid_that_is_cut_the_section_is_read(solid_window: MainWindow, qtbot: QtBot) -> None:
    window = solid_window
    QTest.keyClick(window, Qt.Key.Key_V)
    window.look.cut_along("x")
    window.volume.choose(is_exact=True)
    qtbot.wait(50)
    view = window.source.view
    geometry = view.geometry_shown
    made = np.flatnonzero((geometry.triangles >= geometry.vertex_count).all(axis=1))
    assert len(made), "the section has triangles of its own"
    centres = view.project(geometry.points[geometry.triangles[made]].mean(axis=1))
    seen = [at for row, at in zip(made.tolist(), centres, strict=True) if view.triangle_at(tuple(at)) == row]
    x, y = seen[0]
    Hand(view).move(QPoint(2, 2))
    Hand(view).move(QPoint(round(x), round(y)))
    qtbot.waitUntil(lambda: window.readings.panel.isVisible())
    simplex = view.simplex_at((round(x), round(y)))
    assert window.readings.panel.text.heading[0].startswith(f"tetrahedron {simplex} ")
    QTest.keyClick(window, Qt.Key.Key_V)
    window.volume.show_all()


@pytest.mark.parametrize("longest", [1.0, 0.99, 5.0, 4.99, 1e-7, 3.3e8, 0.2])
def test_a_scale_bar_has_a_round_length_that_just_fits(longest: float) -> None:
    length = round_length(longest)
    assert length <= longest * (1 + 1e-9) and longest < 2.5001 * length
    assert f"{length:.6e}"[0] in "125" and set(f"{length:.5e}"[2:7]) == {"0"}


def test_a_scale_bar_is_as_long_as_it_says(window: MainWindow) -> None:
    view = window.source.view
    here, there = view.geometry_shown.points[[0, 20]]
    assert np.ptp(window.document.mesh.vertices[[0, 20], 0]) == pytest.approx(2.0)
    pixels = np.linalg.norm(np.subtract(*view.project(np.array([here, there]))))
    assert pixels == pytest.approx(2.0 * view.pixels_per_unit, rel=1e-6)


@pytest.mark.parametrize("pixels_per_unit", [0.013, 37.0, 4.1e5])
def test_a_scale_bar_is_drawn_as_long_as_it_says(pixels_per_unit: float, monkeypatch: pytest.MonkeyPatch) -> None:
    said: list[float] = []
    monkeypatch.setattr(scale_bar, "round_length", lambda longest: said.append(round_length(longest)) or said[-1])
    image = QImage(300, 200, QImage.Format.Format_RGB32)
    image.fill(LIGHT.view)
    painter = QPainter(image)
    scale_bar.paint_scale_bar(painter, pixels_per_unit, QRectF(0, 0, 300, 200), LIGHT)
    painter.end()
    row = round(200 - scale_bar.MARGIN)
    is_dark = [QColor(image.pixel(x, row)).lightness() < 100 for x in range(300)]
    assert sum(is_dark) == pytest.approx(said[0] * pixels_per_unit, abs=3.0)
    assert is_dark.index(True) + sum(is_dark) == pytest.approx(300 - scale_bar.MARGIN, abs=3.0)
