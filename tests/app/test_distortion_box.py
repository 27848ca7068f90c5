"""Formulas in the window: typed, completed, refused where they are wrong, with sliders, under names of their own."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget
from pytestqt.qtbot import QtBot

from workbench.app.main_window import MainWindow
from workbench.app.panels.distortion_box import DistortionBox
from workbench.app.panels.formula_help import EXAMPLES
from workbench.app.panels.parameter_range import ParameterRange
from workbench.app.panels.parameter_row import ParameterRow
from workbench.app.panels.value_pacer import ValuePacer
from workbench.core.distortion import Distortion
from workbench.core.formula_names import suggested_parameter, undeclared_names
from workbench.core.method import Parameter
from workbench.core.registry import registry
from workbench.engine.messages import Refused, SetProblem

BLEND = "lam*symmetric_dirichlet + (1 - lam)*condition_number"


@pytest.fixture
def box(window: MainWindow, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[DistortionBox]:
    """The panel's box, with symmetric Dirichlet in force and no formulas of the user's own."""
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    box = window.panel.distortion
    window.document.choose(distortion="symmetric-dirichlet", distortion_parameters={})
    box.give_up()
    window.bridge._worker.commands.clear()
    yield box
    monkeypatch.undo()
    box.show_choices(registry().distortions, "plane")
    window.document.choose(distortion="symmetric-dirichlet", distortion_parameters={})


def sent(window: MainWindow) -> list[SetProblem]:
    return [c for c in window.bridge._worker.commands if isinstance(c, SetProblem)]


def type_formula(box: DistortionBox, text: str, *, enter: bool = True) -> None:
    box.edit.setFocus()
    box.edit.selectAll()
    QTest.keyClicks(box.edit, text)
    if enter:
        QTest.keyClick(box.edit, Qt.Key.Key_Return)


def test_a_typed_formula_is_checked_while_typing_and_taken_by_enter(
    window: MainWindow, box: DistortionBox, qtbot: QtBot
) -> None:
    type_formula(box, "sum(sigma^2) + __import__", enter=False)
    qtbot.waitUntil(lambda: box.error.isVisibleTo(box))
    assert box.edit.marked == (15, 25)
    QTest.keyClick(box.edit, Qt.Key.Key_Return)
    assert not sent(window)
    type_formula(box, "sum(sigma^4 + 1/sigma^4)")
    assert sent(window)[-1].distortion == "sum(sigma^4 + 1/sigma^4)"
    assert not box.error.isVisibleTo(box) and box.edit.marked is None


@pytest.mark.parametrize(
    ("text", "marked", "word"),
    [
        ("sum(sgima^2)", "sgima", "sigma"),
        ("sum(sigma^2", "2", "never closed"),
        ("conditon_number + det", "conditon_number", "condition_number"),
        ("sum(sigma^2) + sigma7", "sigma7", "dimension"),
        ("sum(sigma^2) + $", "$", "character"),
        ("sum(sigma^2) + 1e9", "1e9", "number"),
    ],
)
def test_the_fault_is_marked_in_the_text(box: DistortionBox, text: str, marked: str, word: str) -> None:
    type_formula(box, text, enter=False)
    box.check()
    assert box.error.isVisibleTo(box) and word in box.error.text()
    assert box.edit.marked is not None
    begin, end = box.edit.marked
    if marked != "2":  # of an open bracket Python names the bracket or the end
        assert text[begin:end] == marked


def test_esc_brings_back_what_is_in_force(window: MainWindow, box: DistortionBox) -> None:
    before = box.edit.text
    type_formula(box, "sum(sigma^3) +", enter=False)
    box.check()
    QTest.keyClick(box.edit, Qt.Key.Key_Escape)
    assert box.edit.text == before and not box.error.isVisibleTo(box)
    assert not sent(window)


def test_keys_of_the_window_stay_letters_in_the_editor(window: MainWindow, box: DistortionBox) -> None:
    before = len(window.bridge._worker.commands)
    type_formula(box, "2.5 * sum(sigma^2) + f", enter=False)
    assert box.edit.text == "2.5 * sum(sigma^2) + f"
    assert len(window.bridge._worker.commands) == before


def test_names_are_completed(box: DistortionBox) -> None:
    type_formula(box, "sum(sigma^2) + condit", enter=False)
    assert box.edit.completions.isVisible()
    QTest.keyClick(box.edit, Qt.Key.Key_Tab)
    assert box.edit.text == "sum(sigma^2) + condition_number"
    assert not box.edit.completions.isVisible() and box.edit.hasFocus()
    type_formula(box, "ma", enter=False)
    assert box.edit.completions.word == "max("


def test_a_formula_in_force_is_where_editing_starts_and_keeps_its_values(window: MainWindow, box: DistortionBox) -> None:
    row = box.combo.findData("amips")
    box.combo.setCurrentIndex(row)
    box.combo.activated.emit(row)
    assert box.edit.text == registry().distortions["amips"].formula
    box.form.rows["alpha"].number.setValue(0.25)
    assert sent(window)[-1].parameters == {"alpha": 0.25}
    box.edit.setFocus()
    box.edit.moveCursor(box.edit.textCursor().MoveOperation.End)
    QTest.keyClicks(box.edit, " + weight*det")
    QTest.keyClick(box.edit, Qt.Key.Key_Return)
    assert sent(window)[-1].distortion.endswith(" + weight*det")
    assert sent(window)[-1].parameters == {"alpha": 0.25, "weight": 0.5}
    assert list(box.form.rows) == ["alpha", "weight"]


def test_new_names_become_sliders_and_what_they_send_is_in_force(window: MainWindow, box: DistortionBox) -> None:
    type_formula(box, BLEND)
    assert sent(window)[-1] == SetProblem(BLEND, {"lam": 0.5}, False, False)
    row = box.form.rows["lam"]
    row.slider.setValue(row.range.tick_of(0.25))
    assert window.document.session.distortion_parameters == {"lam": 0.25}
    row.number.setValue(7.0)  # beyond the slider: it grows
    assert sent(window)[-1].parameters == {"lam": 7.0}
    assert row.range.high == 7.0
    type_formula(box, BLEND + " + p*det")
    assert sent(window)[-1].parameters == {"lam": 7.0, "p": 2.0}


def test_a_held_slider_is_not_moved_by_what_the_document_says(window: MainWindow, box: DistortionBox) -> None:
    type_formula(box, BLEND)
    row = box.form.rows["lam"]
    row.slider.setSliderDown(True)
    row.slider.setValue(row.range.tick_of(0.9))
    window.document.session_changed.emit()
    assert row.value == pytest.approx(0.9, abs=0.01)
    row.slider.setSliderDown(False)
    assert window.document.session.distortion_parameters["lam"] == row.value
    assert box.form.rows["lam"] is row


def test_bounds_of_a_built_in_hold(window: MainWindow, box: DistortionBox) -> None:
    window.document.choose(distortion="amips", distortion_parameters={})
    row = box.form.rows["alpha"]
    row.number.setValue(1e9)
    assert row.value == 100.0
    row.low.setText("-5")
    row.high.setText("2")
    row.low.editingFinished.emit()
    assert row.range.low == 1e-3 and row.range.high == 2 and row.value == 2.0


def test_values_at_which_there_is_no_formula_are_not_sent(window: MainWindow, box: DistortionBox) -> None:
    type_formula(box, "sum(sigma^2)/(1 - w)")
    row = box.form.rows["w"]
    count = len(sent(window))
    row.slider.setValue(row.range.tick_of(1.0))
    assert row.value == 1.0 and len(sent(window)) == count
    assert "finite" in box.error.text()
    row.slider.setValue(row.range.tick_of(0.25))
    assert sent(window)[-1].parameters == {"w": 0.25} and not box.error.isVisibleTo(box)


def test_the_wheel_scrolls_the_panel_past_the_sliders(window: MainWindow, box: DistortionBox) -> None:
    type_formula(box, BLEND)
    row = box.form.rows["lam"]
    before = row.value
    for widget in (row.slider, row.number):
        where = QPointF(5, 5)
        wheel = QWheelEvent(
            where, widget.mapToGlobal(where), QPoint(), QPoint(0, 240), Qt.MouseButton.NoButton,
            Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False,
        )  # fmt: skip
        QApplication.sendEvent(widget, wheel)
        assert not wheel.isAccepted()
    assert row.value == before


def test_recent_formulas_come_back(window: MainWindow, box: DistortionBox) -> None:
    for text in ("sum(sigma^6)", BLEND, "sum(sigma^6)"):
        type_formula(box, text)
    assert box.tools.recent[:2] == ["sum(sigma^6)", BLEND]
    box.tools.fill_recent()
    box.tools.recent_menu.actions()[1].trigger()
    assert box.edit.text == BLEND and box.edit.hasFocus()
    assert sent(window)[-1].distortion == "sum(sigma^6)", "Enter takes it, not the menu"


def test_own_formulas_are_saved_listed_renamed_and_deleted(window: MainWindow, box: DistortionBox, qtbot: QtBot) -> None:
    type_formula(box, BLEND)
    box.form.rows["lam"].number.setValue(0.75)
    box.tools.ask_save()
    dialog = box.tools.dialog
    dialog.name.setText("MIPS")
    dialog.try_it()
    assert "mips" in dialog.sentence.text() and dialog.isVisible()
    dialog.name.setText("My blend")
    dialog.note.setPlainText("tried on faces")
    dialog.try_it()
    assert window.document.session.distortion == "my-blend"
    assert box.combo.currentText() == "My blend"
    window.panel.show_choices()
    assert box.combo.currentText() == "My blend", "also where another mesh fills the lists anew"
    headings = [box.combo.itemText(i) for i in range(box.combo.count())]
    assert headings.index("Own formulas") < headings.index("My blend")
    own = registry().own_formulas["my-blend"]
    assert own.note == "tried on faces"
    assert own.parameters[0].default == 0.75 and own.parameters[0].maximum == box.form.rows["lam"].range.high
    assert Distortion.resolve("2*my_blend").value([[1.0, 1.0]])[0] == pytest.approx(2 * (0.75 * 4 + 0.25))
    type_formula(box, f"2*({BLEND})")
    box.tools.ask_save()
    dialog = box.tools.dialog
    assert dialog.name.text() == "My blend"
    dialog.try_it()
    assert "already" in dialog.sentence.text() and dialog.isVisible()
    window.bridge._worker.commands.clear()
    dialog.try_it()  # asked twice: it replaces the one of that name
    assert registry().own_formulas["my-blend"].formula == f"2*({BLEND})"
    assert sent(window)[-1].distortion == window.document.session.distortion == "my-blend"
    box.tools.ask_rename()
    box.tools.dialog.name.setText("Best blend")
    box.tools.dialog.try_it()
    assert window.document.session.distortion == "best-blend"
    box.tools.delete("best-blend")
    assert window.document.session.distortion == f"2*({BLEND})", "its text is still in force"
    assert window.document.session.distortion_parameters == {"lam": 0.75}
    assert not registry().own_formulas and box.combo.findData("best-blend") < 0


def test_what_the_engine_refuses_stays_in_the_editor_and_the_session_is_the_engines(
    window: MainWindow, box: DistortionBox, qtbot: QtBot
) -> None:
    type_formula(box, BLEND)
    type_formula(box, "log(3 - sigma1) + sum(sigma^2)")
    worker, kept = window.bridge._worker, SetProblem(BLEND, {"lam": 0.5})
    newest = sent(window)[-1].serial
    worker._tell(Refused(window.document.generation, "SetProblem", "An old one.", kept=kept, serial=newest - 1))
    QTest.qWait(50)
    assert window.document.session.distortion.startswith("log"), "a newer choice is on its way"
    worker._tell(Refused(window.document.generation, "SetProblem", "Not on this map.", kept=kept, serial=newest))
    qtbot.waitUntil(lambda: window.document.session.distortion == BLEND)
    assert window.document.session.distortion_parameters == {"lam": 0.5}
    assert box.edit.text == "log(3 - sigma1) + sum(sigma^2)"
    assert box.error.text() == "Not on this map." and list(box.form.rows) == ["lam"]
    QTest.keyClick(box.edit, Qt.Key.Key_Escape)
    assert box.edit.text == BLEND
    window.error_bar.dismiss()


def test_help_has_examples_that_are_formulas(window: MainWindow, box: DistortionBox) -> None:
    for text, _ in EXAMPLES:
        new = undeclared_names(text)
        assert all(name.may_be_parameter for name in new)
        item = Distortion.resolve(text, {name.name: suggested_parameter(name.name).default for name in new})
        assert item.formula == text
    box.tools.show_help()
    box.tools.help.example_wanted.emit(EXAMPLES[2][0])
    assert box.edit.text == BLEND
    box.tools.help.close()


def test_no_row_is_wider_than_the_panel(window: MainWindow, box: DistortionBox, qtbot: QtBot) -> None:
    type_formula(box, "sum(sigma^2)*a_parameter_with_a_long_name + p*det")
    for row in box.form.rows.values():
        row.range_button.setChecked(True)
    window.panel_dock.setFixedWidth(290)
    QTest.qWait(30)
    viewport = window.panel.viewport().width()
    body: QWidget = window.panel.widget()
    assert body.minimumSizeHint().width() <= viewport
    for row in box.form.rows.values():
        for child in (row.number, row.range_button, row.log):
            assert child.mapTo(body, child.rect().topRight()).x() < viewport
    window.panel_dock.setMinimumWidth(0)
    window.panel_dock.setMaximumWidth(16777215)


# ------------------------------------------------------------------------------------------------- parts


@pytest.mark.parametrize(
    "span",
    [ParameterRange(0, 1), ParameterRange(-3, 7), ParameterRange(1e-6, 1, is_log=True), ParameterRange(1, 3, is_whole=True)],
)
def test_ticks_and_values_agree(span: ParameterRange) -> None:
    values = [span.value_at(tick) for tick in range(span.ticks + 1)]
    assert values[0] == span.low and values[-1] == span.high
    assert all(a < b for a, b in pairwise(values)), "every tick is another value, in order"
    assert [span.tick_of(value) for value in values] == list(range(span.ticks + 1))


@pytest.mark.parametrize(("low", "high", "is_log"), [(1, 1, False), (2, 1, False), (0, 1, True), (0, float("nan"), False)])
def test_ranges_that_are_none_are_refused(low: float, high: float, is_log: bool) -> None:
    with pytest.raises(ValueError, match="range"):
        ParameterRange(low, high, is_log)


@pytest.mark.parametrize(("typed", "value"), [("1e-7", 1e-7), ("0.123456789012", 0.123456789012), ("-3", -3.0)])
def test_a_number_is_taken_as_typed(qtbot: QtBot, typed: str, value: float) -> None:
    row = ParameterRow(Parameter("t", float, 1.0), 1.0, ParameterRange(0, 1), False)
    qtbot.addWidget(row)
    row.number.selectAll()
    QTest.keyClicks(row.number, typed)
    with qtbot.waitSignal(row.moved) as caught:
        QTest.keyClick(row.number, Qt.Key.Key_Return)
    assert caught.args == [pytest.approx(value, rel=1e-9), True]


def test_the_newest_value_goes_out_when_the_last_one_is_answered(qtbot: QtBot, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("workbench.app.panels.value_pacer.LONGEST_WAIT", 0.3)
    taken: list[dict] = []
    pacer = ValuePacer(taken.append)
    for number in range(20):
        pacer.offer({"t": number}, False)
    assert taken == [{"t": 0}]
    QTest.qWait(60)
    assert taken == [{"t": 0}], "no map has come yet"
    pacer.answered()
    qtbot.waitUntil(lambda: len(taken) == 2)
    assert taken[1] == {"t": 19} and not pacer.is_waiting
    pacer.offer({"t": 20}, False)
    pacer.offer({"t": 21}, True)
    assert taken[-1] == {"t": 21}, "a hand that rests is answered at once"
    pacer.offer({"t": 22}, False)
    qtbot.waitUntil(lambda: taken[-1] == {"t": 22})
