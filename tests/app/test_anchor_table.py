"""The table of anchors: what is copied is pasted, what is written is read, every edit is one step that can be undone."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from PySide6.QtCore import QItemSelectionModel, QPoint, Qt
from PySide6.QtGui import QGuiApplication
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLineEdit, QMessageBox
from pytestqt.qtbot import QtBot

from workbench.app.anchors import anchor_dock
from workbench.app.anchors.anchor_dock import AnchorDock
from workbench.app.anchors.anchor_edits import pasted, set_of, table_of
from workbench.app.anchors.anchor_table_model import AnchorTableModel
from workbench.app.document.anchor_set import AnchorSet
from workbench.app.main_window import MainWindow
from workbench.app.sessions.restoring import anchors_in, with_anchors
from workbench.core.errors import WorkbenchError
from workbench.io.anchors import read_anchors, write_anchors
from workbench.session.session import Session

COUNT = 40
NUMBERS = st.floats(-1e70, 1e70, allow_subnormal=True)


@st.composite
def anchor_sets(draw: st.DrawFn, dimension: int = 2) -> AnchorSet:
    vertices = draw(st.lists(st.integers(0, COUNT - 1), unique=True, max_size=6))
    some = st.lists(st.sampled_from(vertices), unique=True) if vertices else st.just([])
    return AnchorSet(
        {v: draw(st.tuples(*[NUMBERS] * dimension)) for v in vertices},
        {v: draw(st.integers(0, 2**62)) for v in draw(some)},
        {v: draw(st.floats(1e-9, 1e12)) for v in draw(some)},
        frozenset(draw(some)),
    )


def model_of(anchors: AnchorSet, dimension: int) -> AnchorTableModel:
    model = AnchorTableModel()
    model.show_mesh(np.random.default_rng(1).normal(size=(COUNT, 3)), dimension)
    model.show_anchors(anchors)
    return model


# ---------------------------------------------------------------------------------------------- laws


@pytest.mark.parametrize("dimension", [2, 3])
def test_what_is_copied_is_pasted(qapp: object, dimension: int) -> None:
    @given(anchor_sets(dimension), anchor_sets(dimension))
    def law(anchors: AnchorSet, present: AnchorSet) -> None:
        model = model_of(anchors, dimension)
        text = model.text_of_rows(np.arange(len(anchors)))
        assert pasted(text, present, COUNT, dimension) == anchors
        assert pasted(text, present, COUNT, dimension).joined(AnchorSet.none()) == anchors

    law()


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(anchor_sets())
def test_what_is_written_is_read(tmp_path: Path, anchors: AnchorSet) -> None:
    write_anchors(tmp_path / "a.csv", table_of(anchors, 2))
    assert set_of(read_anchors(tmp_path / "a.csv", COUNT, 2)) == anchors
    assert anchors_in(with_anchors(Session(), anchors)) == anchors


@given(anchor_sets(), anchor_sets(), st.integers(0, COUNT - 1))
def test_anchors_without_and_elsewhere_say_nothing_of_what_is_gone(one: AnchorSet, other: AnchorSet, vertex: int) -> None:
    for anchors in (one.without(vertex), one.joined(other), one.in_force, other.joined(one)):
        assert {*anchors.groups, *anchors.weights, *anchors.off} <= set(anchors.targets)
    assert not one.in_force.off and set(one.in_force.targets) == set(one.targets) - one.off
    assert one.joined(other).without(*(set(other.targets) - set(one.targets))) == one
    if vertex not in one:
        for old in one.targets:
            moved = one.at_vertex(old, vertex)
            assert vertex in moved and old not in moved and moved.at_vertex(vertex, old) == one
            assert list(moved.at_vertex(vertex, old).targets) == list(one.targets)


@given(anchor_sets(), st.integers(0, 8), st.booleans())
def test_sorting_is_a_permutation_by_the_column(anchors: AnchorSet, column: int, is_descending: bool) -> None:
    model = model_of(anchors, 2)
    model.sort(column, Qt.SortOrder.DescendingOrder if is_descending else Qt.SortOrder.AscendingOrder)
    vertices = model.vertices_in(np.arange(len(anchors))).tolist()
    assert sorted(vertices) == sorted(anchors.targets)
    values = {
        "vertex": lambda v: v,
        "x": lambda v: anchors.targets[v][0],
        "weight": lambda v: anchors.weights.get(v, math.inf),
        "group": lambda v: float(anchors.groups.get(v, -1)),
        "on": lambda v: v in anchors.off,
    }.get(model.columns[column].key)
    if values is not None:
        found = [values(v) for v in vertices]
        assert found == sorted(found, reverse=is_descending)


# ---------------------------------------------------------------------------------------------- text from elsewhere


def test_spreadsheets_of_many_tongues_are_understood() -> None:
    none = AnchorSet.none()
    wanted = AnchorSet({3: (0.5, -1.25), 7: (1000.0, 2.0)}, {7: 2}, {3: 2.5}, frozenset({7}))
    for text in (
        "vertex\tx\ty\tweight\tgroup\ton\n3\t0.5\t-1.25\t2.5\t\ton\n7\t1e3\t2\thard\t2\toff\n",
        "vertex;x;y;weight;group;on\r\n3;0,5;-1,25;2,5;;yes\r\n\r\n7;1000,0;2;inf;2;no\r\n",
        '3,0.5,-1.25,2.5,,1\n"7","1000","2",,2,0',
        "On, Y, X, Vertex, group, weight\n1,-1.25,0.5,3,-1,2.5\nFALSE,2,1e3,7,2,\n",
        "3\t0,5\t-1,25\t2,5\t\t\n7\t1000\t2\t\t2\toff\n",
    ):
        assert pasted(text, none, COUNT, 2) == wanted, text
    bare = pasted("7,1,2", AnchorSet({7: (0.0, 0.0), 8: (0.0, 0.0)}, {7: 4}, {7: 3.0, 8: 1.0}, frozenset({7})), COUNT, 2)
    assert bare == AnchorSet({7: (1.0, 2.0)}, {7: 4}, {7: 3.0}, frozenset({7})), "what is not said stays"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "nothing to paste"),
        ("3,1", "Row 1 has 2 cells"),
        ("3,1,2,1,1,on,9", "Row 1 has 7 cells"),
        ("vertex,x\n1,2", "Row 1: columns vertex, x, y"),
        ("vertex,x,y,colour\n1,2,3,4", "colour"),
        ("vertex,x,y,x\n1,2,3,4", "each once"),
        ("vertex,x,y\n1,2,3\n2,three,3", "Row 3, column x: 'three' is not a number"),
        ("1,2,nan", "Row 1, column y: the coordinate nan"),
        ("1,2,1e300", "Row 1, column y: the coordinate 1e300"),
        (f"{COUNT},2,3", f"Row 1, column vertex: there is no vertex {COUNT}"),
        ("-1,2,3", "no vertex -1"),
        ("9" * 400 + ",2,3", "there is no vertex 999"),
        ("1.5,2,3", "'1.5' is not the number of a vertex"),
        ("1,2,3\n2,2,3\n1,4,5", "Row 3, column vertex: vertex 1 has an anchor already"),
        ("1,2,3,-1", "Row 1, column weight: the weight '-1'"),
        ("1,2,3,0", "weight '0'"),
        ("1,2,3,nan", "weight 'nan'"),
        ("1,2,3,1e13", "up to 1e+12"),
        ("1,2,3,,1.5", "Row 1, column group: the group '1.5'"),
        ("1,2,3,," + "9" * 30, "column group"),
        ("1,2,3,,,perhaps", "Row 1, column on: 'perhaps' is neither on nor off"),
        ("1;2,5;3.5", "a decimal point and some a comma"),
        ("1,2,3\n2,3", "Row 2: it has 2 fields"),
    ],
)
def test_what_cannot_be_is_refused_with_its_place(text: str, words: str) -> None:
    with pytest.raises(WorkbenchError) as refusal:
        pasted(text, AnchorSet.none(), COUNT, 2)
    assert words in refusal.value.sentence and len(refusal.value.sentence) < 400


# ---------------------------------------------------------------------------------------------- the panel


@pytest.fixture
def dock(window: MainWindow, qtbot: QtBot) -> AnchorDock:
    """The panel with three anchors in it, in a window."""
    document, dock = window.document, window.anchor_files.dock
    document.set_anchors(AnchorSet.at([4, 130, 60], document.positions))
    dock.table.horizontalHeader().setSortIndicator(-1, Qt.SortOrder.AscendingOrder)
    dock.show()
    dock.raise_()
    qtbot.waitUntil(lambda: dock.isVisible() and dock.model.rowCount() == 3)
    document.select(-1)
    QTest.qWait(50)
    return dock


def cell_at(dock: AnchorDock, row: int, column: str) -> QPoint:
    index = dock.model.index(row, dock.model.place_of(column))
    dock.table.scrollTo(index)
    return dock.table.visualRect(index).center()


def click(dock: AnchorDock, row: int, column: str, keys: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
    QTest.mouseClick(dock.table.viewport(), Qt.MouseButton.LeftButton, keys, cell_at(dock, row, column))


def type_into(dock: AnchorDock, text: str) -> None:
    """As a hand would: the first key opens the cell."""
    QTest.keyClick(dock.table, text[0])
    editor = dock.table.findChild(QLineEdit)
    assert editor is not None
    QTest.keyClicks(editor, text[1:])
    commit(editor)


def commit(editor: QLineEdit) -> None:
    QTest.keyClick(editor, Qt.Key.Key_Return)
    QTest.qWait(1)  # Qt takes the text once the key is done with


def steps(window: MainWindow) -> tuple[str, ...]:
    return window.undoing.history.names[: window.undoing.history.done]


def test_cells_are_edited_one_by_one_and_many_at_once(window: MainWindow, dock: AnchorDock, qtbot: QtBot) -> None:
    document, before = window.document, window.document.anchors
    count, worker = len(steps(window)), window.bridge._worker
    click(dock, 1, "x")
    type_into(dock, ".75")
    assert document.anchors.targets[130][0] == 0.75 and document.anchors.targets[130][1] == before.targets[130][1]
    assert steps(window)[count:] == ("Move anchor",), "one step, and the key . took none of the solver"
    click(dock, 0, "weight")
    click(dock, 1, "weight", Qt.KeyboardModifier.ControlModifier)
    assert set(document.selection) == {4, 130}
    type_into(dock, "2,5")
    assert document.anchors.weights == {4: 2.5, 130: 2.5}
    sent = worker.commands[-1]
    assert dict(zip(sent.vertices.tolist(), sent.weights.tolist(), strict=True)) == {4: 2.5, 130: 2.5, 60: math.inf}
    type_into(dock, "3")
    assert document.anchors.groups == {} and document.anchors.weights[130] == 3.0, "the cell last clicked"
    click(dock, 2, "group")
    type_into(dock, "7")
    assert document.anchors.groups == {60: 7}
    assert steps(window)[count + 1 :] == ("Weight of 2 anchors", "Weight of 2 anchors", "Group anchors")
    for _ in range(4):
        window.undoing.undo()
        QTest.qWait(40)
    assert document.anchors == before
    qtbot.waitUntil(lambda: dock.model.data(dock.model.index(0, dock.model.place_of("weight"))) == "hard")


def test_a_double_click_edits_the_cell_of_all_selected_rows(window: MainWindow, dock: AnchorDock) -> None:
    document, viewport = window.document, dock.table.viewport()
    before, count = document.anchors, len(steps(window))
    click(dock, 0, "weight")
    click(dock, 2, "y", Qt.KeyboardModifier.ControlModifier)
    for row, column, text in ((0, "weight", "1.5"), (2, "y", "0.25")):
        click(dock, row, column)
        QTest.mouseDClick(viewport, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, cell_at(dock, row, column))
        assert dock.table.chosen_rows.tolist() == [0, 2] and set(document.selection) == {4, 60}
        editor = dock.table.findChild(QLineEdit)
        assert editor is not None and editor.hasFocus()
        editor.setText(text)
        commit(editor)
        QTest.qWait(20)
        del editor
        assert dock.table.chosen_rows.tolist() == [0, 2], "for the next cell"
    assert document.anchors.weights == {4: 1.5, 60: 1.5}
    assert [document.anchors.targets[v][1] for v in (4, 60)] == [0.25, 0.25]
    assert document.anchors.targets[130] == before.targets[130]
    assert steps(window)[count:] == ("Weight of 2 anchors", "Move 2 anchors")
    click(dock, 2, "x")
    assert set(document.selection) == {60}, "a click alone selects one row, as ever"
    click(dock, 1, "x")
    QTest.mouseDClick(viewport, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, cell_at(dock, 1, "x"))
    assert set(document.selection) == {130}, "and so do two on a row that was not selected"
    QTest.keyClick(dock.table.findChild(QLineEdit), Qt.Key.Key_Escape)


def test_a_tick_in_a_selected_row_is_set_for_all_of_them(window: MainWindow, dock: AnchorDock) -> None:
    document = window.document
    click(dock, 0, "x")
    click(dock, 1, "x", Qt.KeyboardModifier.ControlModifier)
    place = cell_at(dock, 1, "on")
    place.setX(dock.table.visualRect(dock.model.index(1, 0)).left() + 9)
    for off in ({4, 130}, set()):
        QTest.mouseClick(dock.table.viewport(), Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, place)
        assert document.anchors.off == off and set(document.selection) == {4, 130}


def test_letters_do_in_the_table_what_they_do_in_the_window(window: MainWindow, dock: AnchorDock) -> None:
    click(dock, 0, "x")
    before = window.document.anchors
    QTest.keyClick(dock.table, Qt.Key.Key_L)
    assert window.target_tool.area.is_armed and dock.table.findChild(QLineEdit) is None
    QTest.keyClick(dock.table, Qt.Key.Key_Escape)
    window.handling._end_areas()
    QTest.keyClick(dock.table, Qt.Key.Key_G)
    assert window.target_tool.is_dragging
    QTest.keyClick(dock.table, Qt.Key.Key_Escape)
    assert not window.target_tool.is_dragging and window.document.anchors == before


def test_a_tick_switches_anchors_off_and_nothing_holds_them_then(window: MainWindow, dock: AnchorDock) -> None:
    document, worker = window.document, window.bridge._worker
    place = cell_at(dock, 0, "on")
    place.setX(dock.table.visualRect(dock.model.index(0, 0)).left() + 9)
    QTest.mouseClick(dock.table.viewport(), Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, place)
    assert document.anchors.off == {4} and len(document.anchors) == 3
    assert worker.commands[-1].vertices.tolist() == [130, 60]
    assert steps(window)[-1] == "Switch off anchor"
    QTest.qWait(50)
    scene = window.target.view.overlay.scene
    assert scene.anchor_vertices[scene.off].tolist() == [4]
    assert "1 off" in dock.summary.text()
    QTest.keyClick(dock.table, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
    dock.table.selectionModel().setCurrentIndex(dock.model.index(1, 0), QItemSelectionModel.SelectionFlag.NoUpdate)
    QTest.keyClick(dock.table, Qt.Key.Key_Space)
    assert document.anchors.off == {4, 130, 60}, "the key of the cell, not that of the solver"
    assert not document.wants_to_run


def test_views_and_table_select_alike(window: MainWindow, dock: AnchorDock) -> None:
    document = window.document
    document.select_all([60, 4])
    assert dock.chosen_vertices.tolist() == [4, 60]
    click(dock, 1, "vertex")
    assert document.selection == (130,)
    scene = window.target.view.overlay.scene
    assert scene.anchor_vertices[scene.is_selected].tolist() == [130]
    document.select(-1)
    assert not len(dock.chosen_vertices)
    document.select(60)
    dock.table.sortByColumn(dock.model.place_of("vertex"), Qt.SortOrder.DescendingOrder)
    assert dock.model.vertices_in(np.arange(3)).tolist() == [130, 60, 4]
    assert dock.chosen_vertices.tolist() == [60], "rows move, the choice stays"


def test_keys_delete_copy_and_paste(
    window: MainWindow, dock: AnchorDock, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    document, before = window.document, window.document.anchors.weighted([4], 1.5).in_group([4, 60], 2)
    document.set_anchors(before)
    QTest.qWait(30)
    click(dock, 0, "vertex")
    QTest.keyClick(dock.table, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
    QTest.keyClick(dock.table, Qt.Key.Key_C, Qt.KeyboardModifier.ControlModifier)
    text = QGuiApplication.clipboard().text()
    assert text.splitlines()[0].split("\t")[:6] == ["vertex", "x", "y", "weight", "group", "on"]
    click(dock, 0, "vertex")
    click(dock, 1, "vertex", Qt.KeyboardModifier.ShiftModifier)
    QTest.keyClick(dock.table, Qt.Key.Key_Delete)
    assert list(document.anchors.targets) == [60] and steps(window)[-1] == "Remove 2 anchors"
    QTest.keyClick(dock.table, Qt.Key.Key_V, Qt.KeyboardModifier.ControlModifier)
    assert document.anchors == before and steps(window)[-1] == "Paste 3 anchors"
    QGuiApplication.clipboard().setText("130,0,0\n4,zero,0\n")
    QTest.keyClick(dock.table, Qt.Key.Key_V, Qt.KeyboardModifier.ControlModifier)
    assert document.anchors == before, "all or nothing"
    assert "Row 2, column x: 'zero' is not a number" in window.error_bar.sentence.text()
    monkeypatch.setattr(anchor_dock, "LONG", 1)
    for last in ("0.5", "half"):
        QGuiApplication.clipboard().setText(f"vertex,x,y\n4,0.25,{last}\n")
        QTest.keyClick(dock.table, Qt.Key.Key_V, Qt.KeyboardModifier.ControlModifier)
        qtbot.waitUntil(lambda: not len(dock.works))
    assert document.anchors == before.moved(np.array([4]), np.array([[0.25, 0.5]])), "long texts, too, and weights stay"
    assert "Row 2, column y: 'half'" in window.error_bar.sentence.text()
    click(dock, 0, "y")
    click(dock, 2, "y", Qt.KeyboardModifier.ShiftModifier)
    QGuiApplication.clipboard().setText("0.125\n")
    QTest.keyClick(dock.table, Qt.Key.Key_V, Qt.KeyboardModifier.ControlModifier)
    assert {target[1] for target in document.anchors.targets.values()} == {0.125}


def test_a_row_is_added_and_takes_the_vertex_that_is_typed(window: MainWindow, dock: AnchorDock) -> None:
    document = window.document
    dock.add_button.click()
    assert 0 in document.anchors and len(document.anchors) == 4
    editor = dock.table.findChild(QLineEdit)
    assert editor is not None and editor.isVisible()
    QTest.keyClicks(editor, "33")
    commit(editor)
    assert 0 not in document.anchors and document.anchors.targets[33] == tuple(document.positions[33])
    before = document.anchors
    for typed, words in (("60", "has an anchor already"), ("9999", "there is no vertex"), ("x", "not the number")):
        click(dock, 3, "vertex")
        type_into(dock, typed)
        assert document.anchors == before
        assert words in window.error_bar.sentence.text().replace("There", "there")


def test_residuals_are_distances_and_their_sum_up_is_true(window: MainWindow, dock: AnchorDock, qtbot: QtBot) -> None:
    document = window.document
    anchors = document.anchors
    document.set_anchors(anchors.moved(anchors.vertices, anchors.target_array(2) + [0.3, 0.4]).switched([60], on=False))

    def is_true() -> bool:
        held = document.anchors.in_force
        apart = np.linalg.norm(document.positions[held.vertices] - held.target_array(2), axis=1)
        return np.allclose(dock.model.residual_summary, (apart.max(), np.sqrt((apart**2).mean())))

    qtbot.waitUntil(is_true)
    assert "2 anchors" not in dock.summary.text() and "3 anchors, 1 off" in dock.summary.text()


def test_files_replace_or_add(window: MainWindow, dock: AnchorDock, qtbot: QtBot, tmp_path: Path) -> None:
    document, files = window.document, window.anchor_files
    soft = document.anchors.weighted([130], 4.0).switched([60], on=False).in_group([4, 130], 1)
    document.set_anchors(soft)
    files.write(str(tmp_path / "a.csv"))
    qtbot.waitUntil(lambda: (tmp_path / "a.csv").exists() and not len(files._works))
    document.set_anchors(AnchorSet.at([4, 77], document.positions + 0.1))

    def answer(word: str) -> None:
        window.open(str(tmp_path / "a.csv"))  # as a drop does
        qtbot.waitUntil(lambda: window.findChild(QMessageBox, "import-anchors") is not None)
        box = window.findChild(QMessageBox, "import-anchors")
        next(button for button in box.buttons() if button.text() == word).click()
        qtbot.waitUntil(lambda: window.findChild(QMessageBox, "import-anchors") is None)

    answer("Add")
    assert document.anchors.without(77) == soft and 77 in document.anchors
    assert steps(window)[-1] == "Import 3 anchors"
    answer("Replace")
    assert document.anchors == soft
    (tmp_path / "bad.csv").write_text("vertex,x,y\n1,2,3\n99999,0,0\n")
    files.read(str(tmp_path / "bad.csv"))
    qtbot.waitUntil(lambda: "bad.csv, line 3" in window.error_bar.sentence.text())
    assert document.anchors == soft
