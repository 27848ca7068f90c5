"""Parts of the window that need no engine: ranges, meters, anchors, history, settings, forms."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QObject, Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QLineEdit, QSlider, QWidget
from pytestqt.qtbot import QtBot

from tests.app.conftest import leaked_widgets
from workbench.app.appearance.style import style_sheet
from workbench.app.appearance.theme import DARK, LIGHT, Theme, palette_of
from workbench.app.background import Background, silence_all
from workbench.app.commands import boundary_vertices
from workbench.app.docks.convergence_plots import MOST_BINS, thinned
from workbench.app.document.anchor_set import AnchorSet
from workbench.app.document.history import History
from workbench.app.panels.method_form import MethodForm
from workbench.app.settings import Settings
from workbench.app.status.error_bar import ErrorBar
from workbench.app.status.meters import DragMeter, RateMeter
from workbench.app.status.progress_bar import ProgressLine
from workbench.app.status.reporter import in_window_words
from workbench.app.views.geometry import DisplayFrame
from workbench.core.method import Parameter
from workbench.engine.messages import HistoryRow


def test_each_event_is_answered_once_by_the_first_map_that_holds_it() -> None:
    meter = DragMeter()
    for serial in (1, 2, 3):
        meter.sent(serial, at=0.0)
    meter.drawn(2)
    assert len(meter.delays) == 2
    meter.drawn(2)
    assert len(meter.delays) == 2
    meter.drawn(9)
    assert len(meter.delays) == 3


def test_the_rate_forgets() -> None:
    meter = RateMeter(window=1.0)
    for tenth in range(10):
        meter.take(3, at=tenth / 10)
    assert meter.rate(at=0.9) == pytest.approx(30)
    assert meter.rate(at=5.0) == 0


def test_a_part_that_goes_hears_nothing_more_of_its_works(qtbot: QtBot) -> None:
    window = QWidget()
    qtbot.addWidget(window)
    part = QObject(window)
    heard: list[object] = []
    works = [Background(lambda: "done", part), Background(lambda: 1 / 0, part)]
    other = Background(lambda: "done")
    for work in (*works, other):
        work.finished.connect(heard.append)
        work.failed.connect(heard.append)
        work.start()
        work.wait()  # what it reports is on its way now, in the queue of this thread
    late = Background(lambda: heard.append("late"), part)
    silence_all(window)
    late.start()
    late.wait()
    qtbot.waitUntil(lambda: heard == ["done"])
    qtbot.wait(20)
    assert heard == ["done"]


def test_anchor_sets_are_values() -> None:
    first = AnchorSet.at([3, 1], np.arange(10.0).reshape(5, 2))
    moved = first.with_target(1, (9.0, 9.0))
    assert first.targets[1] == (2.0, 3.0)
    assert moved.vertices.tolist() == [3, 1]
    assert moved.target_array(2).tolist() == [[6.0, 7.0], [9.0, 9.0]]
    assert moved.without(3).vertices.tolist() == [1]
    assert moved.joined(first).targets == moved.targets
    assert AnchorSet.none().target_array(2).shape == (0, 2)


def test_history_grows_beyond_its_first_table() -> None:
    history = History()
    rows = [HistoryRow(i, 0.1 * i, 5.0 - i, 1.0, 0.5, 1.0, 0, 0.0) for i in range(1000)]
    history.extend(rows)
    assert len(history) == 1000
    np.testing.assert_array_equal(history.column("iteration"), np.arange(1000))
    history.clear()
    assert len(history.column("energy")) == 0


def test_a_row_that_is_told_twice_stands_once() -> None:
    nan = float("nan")
    first, lower = HistoryRow(0, 0.0, 5.0, 1.0, nan, 0.0, 0, nan), HistoryRow(0, 0.0, 4.0, 1.0, nan, 0.0, 0, nan)
    history = History()
    for rows in ((first,), (first,), (lower, lower), (first,)):
        history.extend(rows)
    assert history.column("energy").tolist() == [5.0, 4.0, 5.0], "another energy at the same iteration is another row"


def test_the_boundary_of_two_triangles_is_all_of_them() -> None:
    assert boundary_vertices(np.array([[0, 1, 2], [1, 3, 2]])).tolist() == [0, 1, 2, 3]
    fan = np.array([[0, i, i % 6 + 1] for i in range(1, 7)])
    assert boundary_vertices(fan).tolist() == [1, 2, 3, 4, 5, 6]


def test_a_display_frame_has_diameter_one_and_can_be_undone() -> None:
    positions = 1e6 + 1e-3 * np.random.default_rng(0).normal(size=(30, 2))
    frame = DisplayFrame.around(positions)
    shown = frame.to_display(positions)
    assert np.linalg.norm(np.ptp(shown, axis=0)) == pytest.approx(1.0)
    np.testing.assert_allclose(frame.from_display(shown[7]), positions[7], rtol=1e-15)


def test_recent_files_newest_first_and_only_those_that_exist(tmp_path: Path) -> None:
    settings = Settings(tmp_path / "s.ini")
    paths = [tmp_path / f"{i}.obj" for i in range(12)]
    for path in paths:
        path.write_text("")
        settings.remember_file(str(path))
    settings.remember_file(str(paths[5]))
    recent = Settings(tmp_path / "s.ini").recent_files
    assert recent[0] == str(paths[5])
    assert len(recent) == 10
    paths[5].unlink()
    assert str(paths[5]) not in settings.recent_files


def test_forms_report_what_differs_from_the_defaults(qtbot: QtBot) -> None:
    form = MethodForm()
    qtbot.addWidget(form)
    form.show_parameters(
        (
            Parameter("safety", float, 0.9, "share of the largest step", minimum=0.1, maximum=1.0),
            Parameter("count", int, 3),
            Parameter("boundary", str, "circle", choices=("circle", "square")),
            Parameter("repair", bool, True),
        )
    )
    safety = form.fields["safety"]
    assert safety.toolTip() == "share of the largest step (at least 0.1, at most 1)"
    assert form.fields["count"].toolTip() == "count"
    with qtbot.waitSignal(form.changed) as caught:
        safety.setText("0.5")
        safety.editingFinished.emit()
    assert caught.args == [{"safety": 0.5}]
    safety.setText("7")
    safety.editingFinished.emit()
    assert form.values == {"safety": 0.5}
    assert "outside" in safety.toolTip()
    form.fields["repair"].click()
    form.fields["boundary"].setCurrentText("square")
    form.fields["count"].setValue(5)
    assert form.values == {"safety": 0.5, "repair": False, "boundary": "square", "count": 5}


def test_the_error_bar_offers_fixes(qtbot: QtBot) -> None:
    bar = ErrorBar(LIGHT)
    qtbot.addWidget(bar)
    bar.show_message("Two things are wrong.", ("reorient", "cut"), "details")
    assert [b.text() for b in bar.fix_buttons] == ["Reorient consistently", "Cut open to a disc", "Do all of these"]
    with qtbot.waitSignal(bar.fix_wanted) as caught:
        bar.fix_buttons[2].click()
    assert caught.args == [("reorient", "cut")]
    assert not bar.isVisible()
    bar.show_message("One of two is enough.", ("seams", "cut"))
    assert [b.text() for b in bar.fix_buttons] == ["Cut along the texture seams", "Cut open to a disc"]


def test_many_buttons_leave_the_sentence_its_width(qtbot: QtBot) -> None:
    bar = ErrorBar(LIGHT)
    qtbot.addWidget(bar)
    bar.resize(900, 60)
    bar.show()
    sentence = "The edge between vertices 0 and 1 (from 0) has more than two triangles, and so have 19 others."
    for fixes in ((), ("cut",), ("seams", "cut"), ("reorient", "cut"), ("reorient", "cut", "largest")):
        bar.show_message(sentence, fixes, "details")
        qtbot.waitUntil(lambda: bar.sentence.width() > 0.4 * bar.width())


def test_a_bar_that_goes_leaves_its_keys_to_the_window_and_to_no_field(qtbot: QtBot) -> None:
    window = QWidget()
    qtbot.addWidget(window)
    fields = [QLineEdit(window)]
    bar, progress = ErrorBar(LIGHT, window), ProgressLine(window)
    fields.append(QLineEdit(window))
    window.show()
    window.activateWindow()
    qtbot.waitUntil(window.isActiveWindow)
    bar.show_message("It is closed.", ("cut",))
    progress.show()
    for button in (bar.fix_buttons[0], bar.close_button, progress.cancel_button):
        bar.show()
        button.setFocus()
        qtbot.waitUntil(button.hasFocus)
        button.click()
        assert not button.isVisible() and not any(field.hasFocus() for field in fields)
    fields[1].setFocus()
    bar.show()
    bar.dismiss()
    assert fields[1].hasFocus(), "who types goes on"


def test_words_of_the_window_name_no_options() -> None:
    for start in ("A file: The surface is closed, and a parameterization takes a disc", "None"):
        for advice in ("apply --fix cut", "apply --fix reorient,seams (cut along the texture seams) or --fix reorient,cut"):
            assert in_window_words(f"{start}; {advice}.") == f"{start}."


def test_the_leak_check_can_fail(qtbot: QtBot) -> None:
    widget = QWidget()
    widget.show()
    assert widget in leaked_widgets()
    qtbot.addWidget(widget)


@pytest.mark.parametrize("count", [0, 1, 5, 2 * MOST_BINS, 2 * MOST_BINS + 1, 12_345])
def test_a_thinned_curve_keeps_its_ends_and_peaks(count: int) -> None:
    abscissa, values = np.arange(count, dtype=float), np.random.default_rng(3).normal(size=count)
    x, y = thinned(abscissa, values)
    assert len(x) == len(y) <= 4 * MOST_BINS
    assert (np.diff(x) >= 0).all()
    np.testing.assert_array_equal(values[x.astype(int)], y)
    if count:
        assert (x[-1], y.min(), y.max()) == (count - 1, values.min(), values.max())


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=["light", "dark"])
@pytest.mark.parametrize("is_enabled", [True, False])
def test_sliders_are_told_from_the_window(qtbot: QtBot, theme: Theme, is_enabled: bool) -> None:
    panel = QWidget()
    qtbot.addWidget(panel)
    slider = QSlider(Qt.Orientation.Horizontal, panel)
    panel.setStyleSheet(style_sheet(theme))
    for widget in (panel, slider):
        widget.setPalette(palette_of(theme))
    slider.setEnabled(is_enabled)
    slider.resize(200, 24)
    panel.resize(220, 40)
    panel.show()
    picture = panel.grab().toImage()
    tones = np.array([[picture.pixelColor(x, y).lightness() for y in range(24)] for x in range(200)])
    away = np.abs(tones - QColor(theme.window).lightness())
    assert away[100:].max() > 15, "the groove"
    assert away[:20].max() > 40, "the handle"
