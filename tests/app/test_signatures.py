"""The window that compares maps: added from the main window and from files, named, coloured, saved."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtGui import QColor
from pytestqt.qtbot import QtBot

from workbench.app.main_window import MainWindow
from workbench.app.signatures.signature_window import SignatureWindow
from workbench.core.mesh import Mesh
from workbench.core.signature import signature, wasserstein_distance


@pytest.fixture
def compared(window: MainWindow, qtbot: QtBot, tmp_path: Path, square: Mesh) -> Iterator[SignatureWindow]:
    """Two files beside the present map."""
    window.actions_by_name["signatures"].trigger()
    signatures = window.commands.signatures
    qtbot.waitUntil(lambda: len(signatures.maps.maps) == 1)
    for name, factors in (("wide", [2.0, 1.0]), ("large", [3.0, 3.0])):
        np.savez(tmp_path / f"{name}.npz", V=square.vertices, S=square.simplices, X=square.vertices * factors)
    signatures.add_files([str(tmp_path / "wide.npz"), str(tmp_path / "large.npz")])
    qtbot.waitUntil(lambda: signatures.comparison is not None and len(signatures.comparison.signatures) == 3)
    yield signatures
    window.commands.signatures = None
    signatures.wait()
    signatures.deleteLater()


def test_maps_are_compared_in_pairs(compared: SignatureWindow, square: Mesh) -> None:
    wide, large = (signature(square, square.vertices * f) for f in ([2.0, 1.0], [3.0, 3.0]))
    assert [item.signature.name for item in compared.maps.maps][1:] == ["wide", "large"]
    assert compared.pairs.rowCount() == 3 and len(compared.plot.curves) == 3
    shown = {(a, b): w for a, b, _, w in compared.comparison.distances.pairs()}
    assert shown["wide", "large"] == pytest.approx(wasserstein_distance(wide, large)) == pytest.approx(1.5)
    assert len({item.colour.name() for item in compared.maps.maps}) == 3


def test_without_the_scale_similar_maps_are_alike(compared: SignatureWindow, qtbot: QtBot) -> None:
    compared.normalised.setChecked(True)
    compared.logarithmic.setChecked(True)
    compared.bins.setValue(16)
    qtbot.waitUntil(lambda: compared.comparison.choices.bins == 16)
    assert compared.comparison.choices.is_normalised and len(compared.comparison.edges) == 17
    np.testing.assert_allclose(compared.comparison.distances.wasserstein, 0.0, atol=1e-9)


def test_renaming_colouring_removing(compared: SignatureWindow, qtbot: QtBot) -> None:
    compared.maps.item(2, 0).setText("wide")
    qtbot.waitUntil(lambda: "wide (2)" in compared.comparison.distances.names)
    compared.maps.set_colour(2, QColor("#123456"))
    assert compared.plot.curves[2].opts["pen"].color().name() == "#123456"
    compared.maps.selectRow(1)
    compared.buttons["remove"].click()
    qtbot.waitUntil(lambda: len(compared.comparison.distances.names) == 2)
    assert compared.pairs.rowCount() == 1 and compared.pairs.item(0, 1).text() == "wide (2)"


def test_what_is_shown_is_saved(compared: SignatureWindow, tmp_path: Path) -> None:
    for what in ("distances", "histograms"):
        compared.save(what, str(tmp_path / f"{what}.csv"))
    with (tmp_path / "distances.csv").open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [(row["a"], row["b"]) for row in rows] == [pair[:2] for pair in compared.comparison.distances.pairs()]
    with (tmp_path / "histograms.csv").open(newline="") as stream:
        assert len(list(csv.DictReader(stream))) == 64
    compared.save("distances", str(tmp_path / "nowhere" / "d.csv"))
    assert "nowhere" in compared.message.text()


def test_a_file_without_a_map_gives_a_sentence(compared: SignatureWindow, qtbot: QtBot, tmp_path: Path) -> None:
    path = tmp_path / "alone.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    compared.add_files([str(path)])
    qtbot.waitUntil(lambda: "holds no map" in compared.message.text())
    assert len(compared.maps.maps) == 3
