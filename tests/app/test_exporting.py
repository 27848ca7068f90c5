"""Everything under File > Export, read back: what a file says is what the window had."""

from __future__ import annotations

import runpy
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from PySide6.QtCore import QMimeData, QPointF, Qt, QUrl
from PySide6.QtGui import QDropEvent
from pytestqt.qtbot import QtBot

from tests.app.conftest import end_window, new_window
from workbench.app.document.engine_bridge import engine_worker
from workbench.app.exporting.export_kinds import KINDS
from workbench.app.main_window import MainWindow
from workbench.cli import main
from workbench.core.samples import make_sample
from workbench.core.seams import texture_at_vertices
from workbench.engine.session_file import read_session
from workbench.figures.history_file import read_history
from workbench.io.opening import open_source


@pytest.fixture(scope="module")
def solved(qapp, tmp_path_factory: pytest.TempPathFactory) -> Iterator[MainWindow]:  # type: ignore[no-untyped-def]
    """A window with a mesh of a file, anchors, and a map that the solver has finished."""
    folder = tmp_path_factory.mktemp("exports")
    mesh = make_sample("gingerbread", 500)
    np.savez(folder / "man.npz", V=mesh.vertices, S=mesh.simplices)
    window = new_window(folder / "window.ini", engine_worker, "light")
    window.start(str(folder / "man.npz"))
    yield window
    end_window(window)


@pytest.fixture
def window(solved: MainWindow, qtbot: QtBot) -> MainWindow:
    document = solved.document
    qtbot.waitUntil(lambda: document.positions is not None)
    if not len(document.anchors):
        document.pin(np.array([3, 40]))
        document.move_anchor(3, document.positions[3] + [0.05, 0.1], False)
        document.run()
        qtbot.waitUntil(lambda: document.snapshot.phase == "finished" and document.snapshot.row.iteration > 0)
    return solved


def exported(window: MainWindow, qtbot: QtBot, name: str, path: Path) -> Path:
    window.commands.exporting.export(name, str(path))
    qtbot.waitUntil(path.exists)
    return path


def test_maps_come_back_to_the_last_bit(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    document = window.document
    opened = open_source(str(exported(window, qtbot, "export-obj", tmp_path / "m.obj")))
    assert np.array_equal(opened.mesh.simplices, document.mesh.simplices)
    assert np.array_equal(opened.mesh.vertices, document.positions)
    with np.load(exported(window, qtbot, "export-case", tmp_path / "c.npz")) as case:
        assert np.array_equal(case["V"], document.mesh.vertices) and np.array_equal(case["S"], document.mesh.simplices)
        assert np.array_equal(case["X"], document.positions)
        assert np.array_equal(case["anchors"], document.anchors.vertices)
        assert np.array_equal(case["targets"], document.anchors.target_array(2))


def test_fields_and_measures_are_those_of_the_map(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    import pyvista as pv

    mesh, positions = window.document.mesh, window.document.positions
    grid = pv.read(exported(window, qtbot, "export-vtu", tmp_path / "m.vtu"))
    back = open_source(str(tmp_path / "m.vtu"))
    assert np.array_equal(back.mesh.vertices, mesh.vertices) and np.array_equal(back.start, positions)
    lines = exported(window, qtbot, "export-measures", tmp_path / "m.csv").read_text().splitlines()
    header, rows = lines[0].split(","), np.array([[float(x) for x in line.split(",")] for line in lines[1:]])
    assert len(rows) == mesh.simplex_count
    before, after = (np.moveaxis(x[mesh.simplices[:, 1:]] - x[mesh.simplices[:, :1]], 1, 2) for x in (mesh.vertices, positions))
    sigma = np.linalg.svd(after @ np.linalg.inv(before), compute_uv=False)
    expected = {
        "symmetric-dirichlet": (sigma**2 + sigma**-2.0).sum(axis=1),
        "det": sigma.prod(axis=1),
        "sigma_1": sigma[:, 0],
        "condition-number": sigma[:, 0] / sigma[:, 1],
    }
    for id, values in expected.items():
        np.testing.assert_allclose(rows[:, header.index(id)], values, rtol=1e-9, err_msg=id)
        np.testing.assert_allclose(grid.cell_data[id], values, rtol=1e-9, err_msg=id)
    assert not rows[:, header.index("inverted")].any()


def test_the_history_is_that_of_the_curves(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    rows = read_history(exported(window, qtbot, "export-history", tmp_path / "h.csv"))
    assert len(rows) == len(window.history) > 1
    for name in ("iteration", "energy", "gradient_norm", "inverted", "anchor_error", "mean_distortion"):
        assert np.array_equal([getattr(row, name) for row in rows], window.history.column(name), equal_nan=True)


def test_a_script_leads_to_the_map_that_the_window_has(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    script, snapshot = exported(window, qtbot, "export-script", tmp_path / "run.py"), window.document.snapshot
    assert f"RECORDED = {snapshot.row.energy!r}" in script.read_text()
    found = runpy.run_path(str(script))["result"]  # it ends with a complaint where the energy is another one
    assert found.energy == pytest.approx(snapshot.row.energy, rel=1e-10)
    np.testing.assert_allclose(found.positions, window.document.positions, atol=1e-9)
    assert found.iterations == snapshot.row.iteration


@pytest.mark.parametrize("name", [name for name, kind in KINDS.items() if kind.panel])
def test_pictures_are_vectors_or_pixels_by_their_ending(window: MainWindow, qtbot: QtBot, tmp_path: Path, name: str) -> None:
    png = exported(window, qtbot, name, tmp_path / "p.png")
    with Image.open(png) as picture:
        picture.load()
        assert picture.size[0] == pytest.approx(120 / 25.4 * 300, abs=2)
        assert picture.info["dpi"] == pytest.approx((300, 300), abs=0.1)
        pixels = np.asarray(picture.convert("RGB").resize((60, 60))).reshape(-1, 3)
        assert len(np.unique(pixels, axis=0)) > 3, "it shows something"
    svg = ElementTree.parse(exported(window, qtbot, name, tmp_path / "p.svg")).getroot()
    paths = [element for element in svg.iter() if element.tag.endswith("}path")]
    if name == "export-target":
        assert len(paths) > window.document.mesh.simplex_count, "every triangle is a path"
    assert len(paths) > 5
    assert exported(window, qtbot, name, tmp_path / "p.pdf").read_bytes().startswith(b"%PDF")


def test_a_picture_opens_the_session_that_it_shows(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    document = window.document
    png = tmp_path / "shot.png"
    window.commands.save_screenshot(window.target.view, str(png))
    qtbot.waitUntil(png.exists)
    record = read_session(png)
    assert np.array_equal(record.map, document.positions)
    assert record.session.anchor_vertices == document.complete_session.anchor_vertices
    assert main(["run", str(png), "--out", str(tmp_path / "again")]) == 0
    before, energy = document.positions, document.snapshot.row.energy
    document.set_anchors(document.anchors.without(3))
    document.run()
    qtbot.waitUntil(lambda: document.snapshot.phase == "finished" and document.snapshot.row.energy < energy)
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(png))])
    buttons, keys = Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    window.dropEvent(QDropEvent(QPointF(300, 300), Qt.DropAction.CopyAction, data, buttons, keys))
    qtbot.waitUntil(lambda: np.array_equal(document.positions, before))
    assert 3 in document.anchors
    assert window.sessions.desk.path == "", "saving asks for a place: a picture is no place for a session"


def test_the_preference_keeps_pictures_free_of_sessions(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    window.preferring.preferences.set("carry_session", False)
    try:
        png = tmp_path / "bare.png"
        window.commands.save_screenshot(window.target.view, str(png))
        qtbot.waitUntil(png.exists)
        assert not window.sessions.takes(str(png))
    finally:
        window.preferring.preferences.set("carry_session", True)


def test_a_place_that_cannot_be_written_is_told(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    for name in ("export-obj", "export-measures", "export-target"):
        window.error_bar.dismiss()
        folder = tmp_path / f"none-{name}"
        window.commands.exporting.export(name, str(folder / f"x{Path(KINDS[name].name).suffix}"))
        qtbot.waitUntil(lambda: f"no folder {folder}" in window.error_bar.sentence.text())  # noqa: B023
    assert list(tmp_path.iterdir()) == []


def test_uvs_in_the_unit_square_are_the_same_map(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    document = window.document
    flat = tmp_path / "flat.obj"
    window.commands.exporting.export("export-unit", str(flat))
    assert window.error_bar.isVisible() and not flat.exists(), "a figure has its map as its vertices"
    window.error_bar.dismiss()
    window.open("sample:bumpy-disc")
    qtbot.waitUntil(lambda: document.kind == "parameterize" and document.positions is not None)
    qtbot.waitUntil(lambda: not document.opening_source and len(document.positions) == document.mesh.vertex_count)
    mesh, positions = document.mesh, document.positions
    opened = open_source(str(exported(window, qtbot, "export-unit", tmp_path / "disc.obj")))
    assert np.array_equal(opened.mesh.vertices, mesh.vertices) and np.array_equal(opened.mesh.simplices, mesh.simplices)
    uv = texture_at_vertices(opened.mesh)
    assert uv is not None and uv.min() == 0.0 and uv.max() == 1.0
    np.testing.assert_allclose(uv * np.ptp(positions, axis=0).max(), positions - positions.min(axis=0), atol=1e-12)
