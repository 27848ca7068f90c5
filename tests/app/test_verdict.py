"""The verdict on a map: its sentence, and walking through what is to blame."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from tests.app.fake_engine import solid_mesh
from workbench.app.main_window import MainWindow
from workbench.app.quantities.quantities import CONFORMAL_FACTOR, LIVE_QUANTITIES
from workbench.app.verdict.ranked_places import worst_first
from workbench.app.verdict.verdict_window import judged, words_of
from workbench.core.mesh import Mesh


def open_and_fold(window: MainWindow, qtbot: QtBot, source: str, kind: str, vertex: int) -> None:
    """A map in which a vertex was pulled through the mesh while the others stay about where they are."""
    window.open(source)
    document = window.document
    qtbot.waitUntil(lambda: document.kind == kind and document.positions is not None and not document.opening_source)
    window.document.pin(np.arange(window.document.mesh.vertex_count))
    place = window.document.positions[vertex] + np.array([0.9, 0.4, 0.3])[: window.document.mesh.dimension]
    window.document.move_anchor(vertex, place, False)
    qtbot.waitUntil(lambda: window.document.snapshot.inverted.any())


@pytest.mark.parametrize(("source", "kind", "vertex"), [("grid", "plane", 110), ("solid", "volume", 42)])
def test_places_to_blame_are_listed_marked_and_looked_at(
    window: MainWindow, qtbot: QtBot, source: str, kind: str, vertex: int
) -> None:
    open_and_fold(window, qtbot, source, kind, vertex)
    inverted = np.flatnonzero(window.document.snapshot.inverted)
    QTest.keyClick(window, Qt.Key.Key_J, Qt.KeyboardModifier.ControlModifier)
    judging = window.commands.judging
    qtbot.waitUntil(lambda: judging.list is not None and judging.list.list.topLevelItemCount() > 0)
    assert "inverted" in judging.list.words.text()
    seen = []
    for _ in inverted:
        judging.walk(1)
        seen.append(int(window.brush.simplices[0]))
    assert seen == inverted.tolist()
    middle = window.target.view.geometry_shown.points[window.document.mesh.simplices[seen[-1]]]
    low, high = middle.min(axis=0), middle.max(axis=0)
    pixel = window.target.view.project(0.5 * (low + high)[None])[0]
    np.testing.assert_allclose(pixel, 0.5 * np.array(window.target.view.size_in_pixels), atol=0.2 * window.target.view.width())
    judging.walk(1)
    assert window.brush.simplices.tolist() == seen[:1], "round at the end"
    judging.walk(-1)
    assert window.brush.simplices.tolist() == seen[-1:]
    judging.list.close()
    qtbot.waitUntil(lambda: judging.list is None)


def test_of_a_solid_the_place_can_be_drawn_alone_until_the_list_is_closed(window: MainWindow, qtbot: QtBot) -> None:
    open_and_fold(window, qtbot, "solid", "volume", 42)
    window.actions_by_name["judge"].trigger()
    judging = window.commands.judging
    qtbot.waitUntil(lambda: judging.list is not None and judging.list.list.topLevelItemCount() > 0)
    judging.walk(1)
    judging.list.alone.setChecked(True)
    drawn = window.target.view.geometry_shown
    qtbot.waitUntil(lambda: set(drawn.faces.simplices.tolist()) == set(window.brush.simplices.tolist()))
    judging.list.close()
    qtbot.waitUntil(lambda: len(drawn.triangles) == len(window.volume.solid.boundary.triangles))


def test_an_injective_map_says_so_and_blames_nothing() -> None:
    mesh = solid_mesh((2, 2, 1))
    words, offenders = judged(mesh, mesh.vertices)
    assert words.startswith("Injective") and not offenders


def test_a_boundary_that_meets_itself_is_told_by_its_pairs() -> None:
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    mesh = Mesh(np.vstack([corners, corners + 5.0]), np.array([[0, 1, 2, 3], [4, 5, 6, 7]]))
    words, offenders = judged(mesh, np.vstack([corners, corners + 0.1]))
    assert words.startswith("Locally injective, but not as a whole")
    assert offenders[0].kind == "boundary" and "–" in words_of(offenders[0], 0)


def test_f3_walks_through_inverted_simplices_without_a_list(window: MainWindow, qtbot: QtBot) -> None:
    open_and_fold(window, qtbot, "grid", "plane", 110)
    inverted = np.flatnonzero(window.document.snapshot.inverted).tolist()
    assert len(inverted) > 1
    window.brush.clear()
    seen = []
    for _ in [*inverted, 0]:
        QTest.keyClick(window, Qt.Key.Key_F3)
        seen += window.brush.simplices.tolist()
    assert seen == [*inverted, inverted[0]]
    assert window.commands.judging.list is None
    QTest.keyClick(window, Qt.Key.Key_F3, Qt.KeyboardModifier.ShiftModifier)
    assert window.brush.simplices.tolist() == inverted[-1:]


def test_f4_goes_from_the_worst_simplex_to_the_next_worst(window: MainWindow, qtbot: QtBot) -> None:
    window.document.pin(np.arange(window.document.mesh.vertex_count))
    window.document.move_anchor(110, window.document.positions[110] + [0.02, 0.01], False)
    window.set_target_style("condition-number")
    field = window.quantities["condition-number"].field
    qtbot.waitUntil(lambda: field in window.document.snapshot.fields)
    values = window.document.snapshot.fields[field]
    seen = []
    for _ in range(4):
        QTest.keyClick(window, Qt.Key.Key_F4)
        (simplex,) = window.brush.simplices.tolist()
        seen.append(simplex)
    assert len(set(seen)) == 4
    assert sorted(values[seen], reverse=True) == values[seen].tolist() == np.sort(values)[::-1][:4].tolist()
    QTest.keyClick(window, Qt.Key.Key_F4, Qt.KeyboardModifier.ShiftModifier)
    assert window.brush.simplices.tolist() == seen[2:3]
    window.brush.clear()
    QTest.keyClick(window, Qt.Key.Key_F4)
    assert window.brush.simplices.tolist() == seen[:1], "after Esc it begins anew"


def test_of_factors_the_worst_is_farthest_from_one_on_either_side() -> None:
    values = np.array([1.0, 4.0, 0.2, np.nan, 2.0, -1.0])
    assert worst_first(CONFORMAL_FACTOR, values).tolist() == [3, 5, 2, 1, 4, 0]
    assert worst_first(LIVE_QUANTITIES[0], values[[0, 1, 2, 4]]).tolist() == [1, 3, 0, 2]
