"""What views show is there again in the next window."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from tests.app.conftest import WindowMaker
from workbench.app.main_window import MainWindow
from workbench.app.settings import Settings
from workbench.core.distortion import Distortion
from workbench.core.method import Parameter
from workbench.core.registry import registry
from workbench.engine.messages import Watch

TYPED = "t*(sigma1 - sigma2)"


def wait_for_methods(window: MainWindow, qtbot: QtBot) -> None:
    qtbot.waitUntil(lambda: window.quantities.is_listed and window.document.positions is not None)


def close(window: MainWindow) -> None:
    window.close()
    QTest.qWait(20)


def test_the_next_window_shows_what_the_last_one_showed(make_window: WindowMaker, qtbot: QtBot) -> None:
    first = make_window()
    wait_for_methods(first, qtbot)
    first.set_source_style("sigma1")
    first.set_target_style(first.quantities.add_formula(TYPED, {"t": 2.0}).id)
    first.maps[0].show_quantity("mips")
    first.histogram.show_quantity("det")
    first.histogram.set_weighted(True)
    first.histogram.set_logarithmic_counts(True)
    first.quantities.range_of("det").set_logarithmic(False)
    first.quantities.range_of("mips").set_reversed(True)
    first.convergence.abscissa.setCurrentIndex(1)
    first.convergence.logarithmic.setChecked(False)
    first.inspector.page = 2
    close(first)

    second = make_window()
    assert second.histogram.quantity == "det", "what is known at once is shown at once"
    wait_for_methods(second, qtbot)
    assert second.colouring.style_of(second.source) == second.source.chooser.current == "sigma1"
    assert second.source.legend.isVisibleTo(second.source)
    assert second.colouring.style_of(second.target) == f"{TYPED} [t=2]"
    assert second.maps[0].quantity == "mips" and second.maps[1].quantity == "condition-number"
    assert second.histogram.is_weighted and second.histogram.has_logarithmic_counts
    assert not second.histogram.range.is_logarithmic and not second.histogram.range.is_reversed
    assert second.maps[0].range.is_reversed
    assert second.convergence.abscissa.currentData() == "seconds" and not second.convergence.logarithmic.isChecked()
    assert second.inspector.page == 2
    qtbot.waitUntil(lambda: "mips" in second.document.snapshot.fields)
    kept = second.view_memory.state()
    close(second)
    assert Settings(second.settings._store.fileName()).views() == kept


def test_what_was_closed_before_the_methods_were_found_is_kept(make_window: WindowMaker, qtbot: QtBot, tmp_path: Path) -> None:
    words = {"formula": TYPED, "parameters": {"t": 2.0}}
    settings = Settings(tmp_path / "window.ini")
    settings.save_views({"views": {"map-dirichlet": words, "histogram": "mips"}, "scales": {"mips": {"reversed": True}}})
    settings.sync()
    window = make_window()
    if not window.quantities.is_listed:
        state = window.view_memory.state()
        assert state["views"]["map-dirichlet"] == words and state["views"]["histogram"] == "mips"
        assert state["scales"]["mips"] == {"reversed": True}
    window.maps[0].show_quantity("sigma1")
    wait_for_methods(window, qtbot)
    assert window.maps[0].quantity == "sigma1", "what the user chose meanwhile stays"
    assert window.histogram.quantity == "mips"


@pytest.mark.parametrize(
    "kept",
    [
        "no json, at all",
        "[1, 2]",
        json.dumps({"views": 3, "scales": [1], "histogram": None, "convergence": {"abscissa": 17}, "inspector": {"page": "x"}}),
        json.dumps({"views": {"source": "gone", "target": "marble", "histogram": {"formula": "import os"}, "x": "y"}}),
        json.dumps({"views": {"histogram": {"formula": "t*det", "parameters": {"t": "1"}}, "map-dirichlet": [1]}}),
        json.dumps({"scales": {"det": 3, "gone": {"logarithmic": 1}, "sigma1": {"logarithmic": "yes"}}}),
    ],
)
def test_what_cannot_be_shown_leaves_views_as_they_begin(
    kept: str, make_window: WindowMaker, qtbot: QtBot, tmp_path: Path
) -> None:
    settings = Settings(tmp_path / "window.ini")
    settings._store.setValue("views", kept)
    settings.sync()
    window = make_window()
    wait_for_methods(window, qtbot)
    assert window.colouring.style_of(window.source) == "checkerboard"
    assert window.colouring.style_of(window.target) == "plain"
    assert window.histogram.quantity == "average-singular-value"
    assert [dock.quantity for dock in window.maps] == ["dirichlet", "condition-number", "symmetric-dirichlet"]
    assert window.quantities.range_of("sigma1").is_logarithmic
    assert "views" in window.view_memory.state()


def test_views_go_on_with_a_formula_that_is_renamed_or_deleted(window: MainWindow, qtbot: QtBot) -> None:
    book = window.quantities
    qtbot.waitUntil(lambda: book.is_listed)
    parameter = Parameter("t", float, 2.0)

    def list_own(*items: Distortion) -> None:
        book.list_distortions([*registry().distortions.values(), *items], own=[item.id for item in items])

    other = Distortion("other-own", "Other", "det^2")
    list_own(Distortion("mine", "Mine", TYPED, parameters=(parameter,)), other)
    for show in (window.maps[1].show_quantity, window.histogram.show_quantity, window.set_target_style):
        show("mine")
    window.set_source_style("other-own")
    list_own(Distortion("yours", "Yours", TYPED, parameters=(parameter,)), other)
    assert window.histogram.quantity == window.maps[1].quantity == window.colouring.style_of(window.target) == "yours"
    assert window.histogram.chooser.currentText() == "Yours"
    assert window.colouring.style_of(window.source) == "other-own", "what is still there is left alone"
    list_own(other)
    typed = f"{TYPED} [t=2]"
    assert window.histogram.quantity == window.maps[1].quantity == window.colouring.style_of(window.target) == typed
    assert window.target.chooser.currentText() == typed
    qtbot.waitUntil(lambda: typed in window.document.snapshot.fields)
    watched = [c for c in window.bridge._worker.commands if isinstance(c, Watch)][-1]
    assert not {"mine", "yours"} & {measure.text for measure in watched.measures}
    window.set_source_style("checkerboard")
    window.set_target_style("plain")
    window.histogram.show_quantity("average-singular-value")
    window.maps[1].show_quantity("condition-number")
    list_own()
