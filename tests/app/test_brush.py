"""Brushed simplices: one set for the window, marked in every view, and what views watch of a map."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from tests.app.conftest import pixels_of
from workbench.app.appearance.theme import BRUSH
from workbench.app.main_window import MainWindow
from workbench.app.quantities.quantities import Quantity
from workbench.app.simplex_brush import SimplexBrush
from workbench.app.views.brush_mark import BrushedParts
from workbench.app.views.mesh_view import MeshView
from workbench.core.mesh import Mesh
from workbench.core.solid_look.drawn_faces import drawn_faces
from workbench.engine.messages import Watch

DETERMINANT = Quantity("det", "Determinant", "", "det J", 0.0)


def brushed_pixels(view: MeshView) -> int:
    """Pixels of the line round what is brushed."""
    colours = pixels_of(view)
    return int((np.abs(colours - np.array(BRUSH) * 255).max(axis=2) < 40).sum())


def test_the_brush_is_a_set_and_tells_changes_only(qtbot: QtBot) -> None:
    brush = SimplexBrush()
    told: list[int] = []
    brush.changed.connect(lambda: told.append(len(brush.simplices)))
    brush.brush([5, 3, 5], "here")
    brush.brush(np.array([3, 5]), "here")
    assert told == [2] and brush.simplices.tolist() == [3, 5] and brush.origin == "here"
    brush.clear()
    brush.clear()
    assert told == [2, 0] and brush.origin == "" and brush.simplices.dtype == np.int64


def test_brushed_simplices_are_marked_in_every_view_until_escape(window: MainWindow, qtbot: QtBot) -> None:
    views = [window.source.view, window.target.view, *(dock.view for dock in window.maps)]
    assert [brushed_pixels(view) for view in views] == [0] * len(views)
    window.brush.brush(np.arange(60, 160), "a test")
    for view in views:
        qtbot.waitUntil(lambda v=view: brushed_pixels(v) > 60)
    QTest.keyClick(window, Qt.Key.Key_Escape)
    assert not len(window.brush.simplices)
    for view in views:
        qtbot.waitUntil(lambda v=view: brushed_pixels(v) == 0)


@pytest.mark.parametrize("seed", [1, 2])
def test_the_outline_is_the_boundary_of_the_set(square: Mesh, seed: int) -> None:
    rows = np.flatnonzero(np.random.default_rng(seed).random(square.simplex_count) < 0.4)
    part = BrushedParts(drawn_faces(square.simplices)).part(np.append(rows, 10**6))
    np.testing.assert_array_equal(part.rows, rows)
    found = {tuple(sorted(edge)) for edge in part.outline.tolist()}
    times: Counter[tuple[int, ...]] = Counter()
    for a, b, c in square.simplices[rows].tolist():
        times.update(tuple(sorted(edge)) for edge in ((a, b), (b, c), (c, a)))
    assert found == {edge for edge, count in times.items() if count == 1} and len(found) == len(part.outline)


def test_another_mesh_clears_the_brush(window: MainWindow, qtbot: QtBot) -> None:
    window.brush.brush([1, 2], "a test")
    window.open("bumpy")
    qtbot.waitUntil(lambda: not len(window.brush.simplices))


def test_owners_watch_together_and_an_answer_comes_at_rest(window: MainWindow, qtbot: QtBot) -> None:
    document = window.document
    rows = len(window.history)
    document.watch("one", (DETERMINANT,))
    document.watch("another", (DETERMINANT,), singular_values=True)
    posted = [c for c in window.bridge._worker.commands if isinstance(c, Watch)]
    assert len(posted) == 2 and posted[-1].singular_values
    assert [measure.id for measure in posted[-1].measures].count("det") == 1
    qtbot.waitUntil(lambda: "det" in document.snapshot.fields and document.snapshot.singular_values is not None)
    assert len(window.history) == rows, "nothing was stepped"
    document.watch("another")
    document.watch("one")
    qtbot.waitUntil(lambda: "det" not in document.snapshot.fields and document.snapshot.singular_values is None)
