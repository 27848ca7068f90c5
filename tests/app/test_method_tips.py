"""Tips of the panel's lists: every method tells what it is and where it comes from, distortions in mathematics."""

from __future__ import annotations

import re

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QTextDocument
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QToolTip
from pytestqt.qtbot import QtBot

from workbench.app.inspector.formula_picture import draw_formula
from workbench.app.main_window import MainWindow
from workbench.app.method_tips.tips import WIDTH, picture_of, tip_of_distortion, tip_of_method, titles_of
from workbench.core.registry import registry

TIP = Qt.ItemDataRole.ToolTipRole


def text_of(tip: str) -> str:
    document = QTextDocument()
    document.setHtml(tip)
    return document.toPlainText()


def test_every_method_says_what_it_is_and_where_it_comes_from(qapp: object) -> None:
    found = registry()
    for method in (*found.solvers.values(), *found.initializers.values()):
        text = text_of(tip_of_method(method))
        assert method.label in text and method.citation in text, method.id
        assert len(text) > len(method.label) + len(method.citation) + 20, method.id
    for item in found.distortions.values():
        text = text_of(tip_of_distortion(item))
        assert item.formula in text and item.citation in text and item.label in text, item.id


def test_what_a_user_wrote_is_no_mark_up(qapp: object) -> None:
    from dataclasses import replace

    item = replace(registry().distortions["dirichlet"], label="<img src=x>", description="a <b>&</b> `c`", citation="<script>")
    text = text_of(tip_of_distortion(item))
    assert "<img src=x>" in text and "<script>" in text and "a <b>&</b> c" in text


def test_works_are_named_in_full() -> None:
    titles = titles_of("(32); Smith & Schaefer 2015 [SS15]")
    assert len(titles) == 1 and len(titles[0]) > 20 and not re.search(r"[{}\\]", titles[0])
    assert titles_of("") == [] == titles_of("Nobody 1900 [XX00]")


@pytest.mark.parametrize("ratio", [1.0, 2.0])
def test_a_formula_is_a_picture_no_wider_than_the_tip(qapp: object, ratio: float) -> None:
    picture = picture_of(draw_formula((r"D = \sum_i \sigma_i^2",), WIDTH, ratio), "#102030")
    document = QTextDocument()
    document.setHtml(picture)
    width = document.idealWidth()
    assert 60 < width <= WIDTH + 8
    assert document.size().height() > 20, "the picture is read, not its sign for one that is missing"


def test_the_pointer_over_a_list_finds_its_tip(window: MainWindow, qtbot: QtBot) -> None:
    box = window.panel.distortion.combo
    QTest.mouseMove(box, QPoint(30, 10))
    window.commands.tips.fill()
    solver = window.panel.solver.combo
    row = solver.findData("slim")
    assert "SLIM" in text_of(solver.itemData(row, TIP))
    row = box.findData("symmetric-dirichlet")
    assert "sum(sigma^2" in box.itemData(row, TIP) or "<img" in box.itemData(row, TIP)
    qtbot.waitUntil(lambda: "<img" in box.itemData(row, TIP))
    assert "<img" in box.toolTip()
    pictures = sum("<img" in str(box.itemData(row, TIP)) for row in range(box.count()))
    assert pictures >= 0.9 * sum(bool(box.itemData(row)) for row in range(box.count()))
    light = box.itemData(row, TIP)
    window.commands.choose_theme("dark")
    window.commands.tips.fill()
    assert box.itemData(row, TIP) != light
    window.commands.choose_theme("light")
    QToolTip.hideText()
