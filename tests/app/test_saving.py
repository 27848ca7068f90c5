"""Saved fields are those of the command line, whatever the window shows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from pytestqt.qtbot import QtBot

from workbench.app.main_window import MainWindow
from workbench.app.saving import SaveRequest, write
from workbench.core.mesh import Mesh
from workbench.core.registry import registry
from workbench.core.status import Status
from workbench.engine.messages import HistoryRow, Loaded, Snapshot
from workbench.session.session import Session


def test_every_distortion_is_saved_though_none_is_shown(square: Mesh, tmp_path: Path) -> None:
    case = tmp_path / "square.npz"
    np.savez(case, V=square.vertices, S=square.simplices)
    loaded = Loaded(1, square, "plane", (), np.empty((0, 2), np.int64), str(case))
    row = HistoryRow(0, 0.0, 1.0, 1.0, 0.0, 1.0, 0, 0.0)
    positions = square.vertices * [2.0, 0.5]
    inverted = np.zeros(square.simplex_count, dtype=bool)
    snapshot = Snapshot(1, 1, positions, "idle", Status.RUNNING, row, inverted, {})
    out = tmp_path / "map.csv"
    write(SaveRequest(out, Session(source=str(case)), loaded, snapshot, np.empty(0, np.int64), np.empty((0, 2))))
    header, *rows = out.read_text().splitlines()
    names = header.split(",")
    assert set(registry().distortions) | {"det"} <= set(names) and len(rows) == square.simplex_count
    saved = [float(line.split(",")[names.index("symmetric-dirichlet")]) for line in rows]
    np.testing.assert_allclose(saved, 8.5)


def test_screenshots_are_offered_by_what_panels_show(window: MainWindow, qtbot: QtBot) -> None:
    from PySide6.QtWidgets import QMenu

    from workbench.app.menus import fill_screenshots

    window.maps[0].show_quantity("det")
    menu = QMenu(window)
    fill_screenshots(window, menu)
    assert "Determinant…" in [action.text() for action in menu.actions()]
    window.maps[0].show_quantity("dirichlet")
    menu.deleteLater()
