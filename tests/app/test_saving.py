"""Saved fields are those of the command line, whatever the window shows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PySide6.QtCore import QObject
from pytestqt.qtbot import QtBot

from workbench.app.document.saving import Saver, SaveRequest, write
from workbench.app.main_window import MainWindow
from workbench.core.mesh import Mesh
from workbench.core.registry import registry
from workbench.core.status import Status
from workbench.engine.messages import HistoryRow, Loaded, Snapshot
from workbench.io.opening import open_source
from workbench.session.session import Session


def request_of(square: Mesh, positions: np.ndarray, folder: Path, path: Path) -> SaveRequest:
    case = folder / "square.npz"
    np.savez(case, V=square.vertices, S=square.simplices)
    loaded = Loaded(1, square, "plane", (), np.empty((0, 2), np.int64), str(case))
    row = HistoryRow(0, 0.0, 1.0, 1.0, 0.0, 1.0, 0, 0.0)
    inverted = np.zeros(square.simplex_count, dtype=bool)
    snapshot = Snapshot(1, 1, positions, "idle", Status.RUNNING, row, inverted, {})
    return SaveRequest(path, Session(source=str(case)), loaded, snapshot, np.empty(0, np.int64), np.empty((0, 2)))


def test_every_distortion_is_saved_though_none_is_shown(square: Mesh, tmp_path: Path) -> None:
    out = tmp_path / "map.csv"
    write(request_of(square, square.vertices * [2.0, 0.5], tmp_path, out))
    header, *rows = out.read_text().splitlines()
    names = header.split(",")
    assert set(registry().distortions) | {"det"} <= set(names) and len(rows) == square.simplex_count
    saved = [float(line.split(",")[names.index("symmetric-dirichlet")]) for line in rows]
    np.testing.assert_allclose(saved, 8.5)


def test_what_is_asked_for_at_once_is_written_one_by_one_also_where_the_window_ends(
    square: Mesh, tmp_path: Path, qtbot: QtBot
) -> None:
    owner = QObject()
    saver = Saver(owner)
    told: list[str] = []
    saver.saved.connect(told.append)
    saver.failed.connect(told.append)
    names = ("first.obj", "again.obj", "again.obj", "no folder/x.obj", "5.obj", "6.obj")
    paths = [tmp_path / name for name in names]
    requests = [request_of(square, square.vertices * factor, tmp_path, path) for factor, path in enumerate(paths, 1)]
    for request in requests[:4]:
        saver.save(request)
    qtbot.waitUntil(lambda: len(told) == 4)
    assert told[:3] == [str(path) for path in paths[:3]] and "no folder" in told[3]
    for request in requests[4:]:
        saver.save(request)
    saver.wait()
    for name, factor in (("first", 1), ("again", 3), ("5", 5), ("6", 6)):
        assert np.array_equal(open_source(str(tmp_path / f"{name}.obj")).mesh.vertices, square.vertices * factor)


def test_screenshots_are_offered_by_what_panels_show(window: MainWindow, qtbot: QtBot) -> None:
    from PySide6.QtWidgets import QMenu

    from workbench.app.menus import fill_screenshots

    window.maps[0].show_quantity("det")
    menu = QMenu(window)
    fill_screenshots(window, menu)
    assert "Determinant…" in [action.text() for action in menu.actions()]
    window.maps[0].show_quantity("dirichlet")
    menu.deleteLater()
