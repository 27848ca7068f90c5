"""Anchors on the screen: many look as few do, soft ones and those that are off can be told from hard ones."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPen

from workbench.app.appearance.theme import ANCHOR, LIGHT
from workbench.app.views import stamps
from workbench.app.views.anchor_paint import HOLLOW, paint_anchors
from workbench.app.views.stamps import stamp_discs


def painted(deed: object, ratio: float = 1.0) -> np.ndarray:
    """(height, width, 4) of what `deed` paints on white, blue first."""
    image = QImage(round(200 * ratio), round(160 * ratio), QImage.Format.Format_ARGB32_Premultiplied)
    image.setDevicePixelRatio(ratio)
    image.fill(Qt.GlobalColor.white)
    painter = QPainter(image)
    deed(painter)
    painter.end()
    return np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.width(), 4).astype(int)


@pytest.mark.parametrize("ratio", [1.0, 2.0])
@pytest.mark.parametrize("colour", [QColor(31, 111, 235), HOLLOW])
def test_many_discs_stand_where_few_do(qapp: object, monkeypatch: pytest.MonkeyPatch, ratio: float, colour: QColor) -> None:
    # on a lattice of its own, so that no disc hides another; some outside
    x, y = np.meshgrid(np.arange(-2, 12), np.arange(-2, 10))
    centres = np.c_[x.ravel(), y.ravel()] * 20.0 + 3.0
    pen = QPen(QColor(0, 0, 0), 1.6)
    few = painted(lambda painter: stamp_discs(painter, centres, colour, pen, 5.5), ratio)
    monkeypatch.setattr(stamps, "MANY", 10)
    many = painted(lambda painter: stamp_discs(painter, centres, colour, pen, 5.5), ratio)
    is_inked, is_inked_too = few.min(axis=2) < 128, many.min(axis=2) < 128
    assert is_inked.sum() > 1000 * ratio
    apart = is_inked != is_inked_too
    assert apart.sum() < 0.25 * is_inked.sum(), "but for rims that are smooth in one of them"
    shifted = is_inked != np.roll(is_inked_too, 4, axis=1)
    assert shifted.sum() > 2 * apart.sum()


def test_hard_soft_and_off_are_told_apart(qapp: object) -> None:
    discs = np.array([[30.0, 80.0], [100.0, 80.0], [170.0, 80.0]])
    vertices = discs + [0.0, -60.0]

    def paint(painter: QPainter) -> None:
        some = np.array([False, True, False])
        paint_anchors(
            painter,
            discs,
            vertices,
            is_selected=np.zeros(3, bool),
            is_soft=some,
            is_off=np.array([False, False, True]),
            is_behind=np.zeros(3, bool),
            theme=LIGHT,
        )

    seen = painted(paint)[:, :, :3]
    blue = [ANCHOR.blue(), ANCHOR.green(), ANCHOR.red()]
    insides = [seen[int(y) + 1, int(x) + 2].tolist() for x, y in discs]  # beside the line, which ends in the middle
    assert insides[0] == blue, "a disc"
    assert insides[1] == insides[2] == [255, 255, 255], "rings"
    between = seen[40:50, :, :].min(axis=2) < 250
    assert between[:, 90:110].any() and not between[:, 160:180].any(), "what holds nothing pulls at nothing"
    assert (seen[:, 85:115] == blue).all(axis=2).any() and not (seen[:, 155:185] == blue).all(axis=2).any()
