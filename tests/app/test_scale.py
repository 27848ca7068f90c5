"""What is drawn is where it is picked, at every scale of the screen: run here as it is, and again at 1.5 and 2."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint
from PySide6.QtGui import QImage
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from tests.app.conftest import Hand, pixel_of, pixels_of
from workbench.app.appearance.theme import ANCHOR_SELECTED, LIGHT
from workbench.app.main_window import MainWindow
from workbench.app.views.mesh_view import MeshView

SCALE = "QT_SCALE_FACTOR"
OTHERS = ("1.5", "2")


def drawn_disc(view: MeshView) -> np.ndarray:
    """Middle (x, y), in the view's own units, of what is painted in the colour of a selected anchor."""
    pixels = pixels_of(view)
    wanted = np.array(ANCHOR_SELECTED.getRgb()[:3])
    rows, columns = np.nonzero(np.abs(pixels - wanted).max(axis=2) < 40)
    assert len(rows) > 20, "no anchor is painted"
    return np.array([columns.mean() + 0.5, rows.mean() + 0.5]) * view.width() / pixels.shape[1]


def test_the_scale_is_the_one_asked_for(window: MainWindow) -> None:
    assert window.target.view.devicePixelRatioF() == float(os.environ.get(SCALE, "1"))


def test_an_anchor_is_drawn_where_it_was_set_and_picked_where_it_is_drawn(window: MainWindow, qtbot: QtBot) -> None:
    view = window.target.view
    place = pixel_of(view, 136)
    Hand(view).click(place)
    assert window.document.anchors.vertices.tolist() == [136]
    np.testing.assert_allclose(drawn_disc(view), (place.x(), place.y()), atol=1.5)
    window.document.select(-1)
    Hand(view).click(pixel_of(view, 136) + QPoint(4, -3))
    assert window.document.selected == 136 and len(window.document.anchors) == 1, "a click on its disc selects it"


def test_a_drag_leads_the_disc_to_the_hand(window: MainWindow, qtbot: QtBot) -> None:
    view = window.target.view
    hand = Hand(view)
    begin = pixel_of(view, 272)
    hand.click(begin)
    hand.drag(begin, begin + QPoint(-40, 30))
    QTest.qWait(50)
    np.testing.assert_allclose(drawn_disc(view), (begin.x() - 40, begin.y() + 30), atol=2.0)
    np.testing.assert_allclose(
        window.document.anchors.targets[272], view.position_at((begin.x() - 40.0, begin.y() + 30.0)), atol=0.02
    )


def test_the_mesh_fills_the_view_and_its_picture_has_every_pixel_of_the_screen(window: MainWindow) -> None:
    view, ratio = window.target.view, window.target.view.devicePixelRatioF()
    pixels = pixels_of(view)
    assert pixels.shape[:2] == (round(view.height() * ratio), round(view.width() * ratio))
    is_drawn = np.abs(pixels - 255 * np.array(LIGHT.fill)).max(axis=2) < 6
    columns = np.flatnonzero(is_drawn.any(axis=0)) / pixels.shape[1]
    corners = view.project(view.geometry_shown.points)[:, 0] / view.width()
    np.testing.assert_allclose([columns.min(), columns.max()], [corners.min(), corners.max()], atol=0.02)


def test_a_screenshot_has_every_pixel_of_the_screen(window: MainWindow, tmp_path: Path, qtbot: QtBot) -> None:
    path = tmp_path / "target.png"
    window.commands.save_screenshot(window.target.view, str(path))
    qtbot.waitUntil(path.is_file)
    ratio = window.target.view.devicePixelRatioF()
    assert QImage(str(path)).width() == round(window.target.view.width() * ratio)


@pytest.mark.skipif(SCALE in os.environ, reason="it is one of the others")
@pytest.mark.parametrize("scale", OTHERS)
def test_the_same_at_another_scale(scale: str, project_root: Path) -> None:
    environment = {**os.environ, SCALE: scale}
    call = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", str(Path(__file__))]
    result = subprocess.run(call, cwd=project_root, env=environment, capture_output=True, text=True, timeout=200, check=False)
    assert result.returncode == 0, result.stdout[-4000:] + result.stderr[-1000:]
