"""How anchors look: hard ones are discs, soft ones rings, those that are off pale rings; lines lead to where they pull."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QLineF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from workbench.app.appearance.theme import ANCHOR, ANCHOR_RIM, ANCHOR_SELECTED, Theme
from workbench.app.views import drawing_style
from workbench.app.views.stamps import stamp_discs
from workbench.core.arrays import Booleans, Floats

SMALL = 0.54
"""Size of a disc among many, beside that of one."""
MANY = 40
"""Number of anchors from which on their discs are small."""
BEHIND = 0.35
"""Opacity of anchors that the solid hides."""
HOLLOW = QColor(0, 0, 0, 0)
MOST_LINES = 3000
"""Lines that are drawn; of more, some are left out evenly."""
APART = 2.0
"""Pixels between a vertex and its target from which on a line joins them."""


def paint_anchors(
    painter: QPainter,
    discs: Floats,
    vertices: Floats,
    *,
    is_selected: Booleans,
    is_soft: Booleans,
    is_off: Booleans,
    is_behind: Booleans,
    theme: Theme,
) -> None:
    """Anchors at pixels `discs` (k, 2), whose vertices are at pixels `vertices` (k, 2) now."""
    is_small = len(discs) > MANY
    radius = drawing_style.anchor_radius * (SMALL if is_small else 1.0)
    _paint_lines(painter, discs, vertices, is_soft, is_off, theme)
    outline = QPen(ANCHOR_RIM, 1.0 if is_small else 1.8)
    casing = 3.2 if is_small else 4.8
    pale = QPen(QColor(theme.faint), 1.2)
    for behind in (True, False):
        painter.setOpacity(BEHIND if behind else 1.0)
        for colour, chosen, larger in ((ANCHOR, ~is_selected, 0.0), (ANCHOR_SELECTED, is_selected, 1.0)):
            shown, size = chosen & (is_behind == behind), radius + larger
            stamp_discs(painter, discs[shown & ~is_soft & ~is_off], colour, outline, size)
            rings = discs[shown & is_soft & ~is_off]
            stamp_discs(painter, rings, HOLLOW, QPen(ANCHOR_RIM, casing), size)
            stamp_discs(painter, rings, HOLLOW, QPen(colour, casing - 2.0), size)
            stamp_discs(painter, discs[shown & is_off], HOLLOW, QPen(colour, 1.6) if larger else pale, size)
    painter.setOpacity(1.0)


def _paint_lines(painter: QPainter, discs: Floats, vertices: Floats, is_soft: Booleans, is_off: Booleans, theme: Theme) -> None:
    """Dashed ones where the map lags behind a hard anchor; solid ones for what a soft one has left to pull."""
    is_apart = (np.abs(discs - vertices).max(axis=1) > APART) & ~is_off
    lagging = QPen(QColor(theme.text), 1.2, Qt.PenStyle.DashLine)
    if np.count_nonzero(is_apart) > MANY:  # dashes of hundreds of lines take longer than all the rest
        lagging = QPen(QColor(theme.faint), 1.0)
    for chosen, pen in ((is_apart & ~is_soft, lagging), (is_apart & is_soft, QPen(ANCHOR, 1.6))):
        if chosen.any():
            painter.setPen(pen)
            ends = np.hstack([vertices, discs])[chosen]
            painter.drawLines([QLineF(*line) for line in ends[:: -(-len(ends) // MOST_LINES)].tolist()])
