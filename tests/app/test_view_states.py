"""The views of a session come back with it; those of the last use with the next start."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from tests.app.conftest import WindowMaker
from workbench.app.main_window import MainWindow
from workbench.core.errors import WorkbenchError
from workbench.engine.session_file import read_session
from workbench.session.view_schema import views


def plain(value: object) -> object:
    return json.loads(json.dumps(value))


def assert_alike(one: object, other: object, place: str = "") -> None:
    if isinstance(one, dict) and isinstance(other, dict):
        assert set(one) == set(other), place
        for name in one:
            if name != "sizes":  # pixels go to and fro with the room
                assert_alike(one[name], other[name], f"{place}.{name}")
    elif isinstance(one, list) and isinstance(other, list):
        assert len(one) == len(other), place
        for a, b in zip(one, other, strict=True):
            assert_alike(a, b, place)
    elif isinstance(one, float):
        assert other == pytest.approx(one, rel=1e-6, abs=1e-9), place
    else:
        assert one == other, place


def arrange(window: MainWindow, qtbot: QtBot) -> None:
    """Something of everything that a session keeps of views."""
    pane = window.splitting.split("target", "below")
    other = window.splitting.split("map-dirichlet", "below")
    assert pane is not None and other is not None
    window.colouring.set_style(pane, "det")
    window.colouring.set_own(pane, True)
    window.colouring.range_of(pane).set_ends(0.25, 4.0)
    window.quantities.range_of("dirichlet").set_ends(1.0, 7.0)
    window.quantities.range_of("dirichlet").set_clipped(True)
    window.actions_by_name["boundary"].trigger()
    window.drawing.choose_in(window.splitting["pane-1"], "wireframe", True)
    window.splitting["pane-2"].tools.chain.setChecked(False)
    qtbot.wait(50)
    view = window.target.view
    view.set_camera(view.camera.zoomed(2.0, (30.0, 40.0), view.size_in_pixels))
    qtbot.wait(100)


def test_a_session_brings_its_views_back(make_window: WindowMaker, qtbot: QtBot, tmp_path: Path) -> None:
    window = make_window()
    qtbot.waitUntil(lambda: window.quantities.is_listed and window.document.positions is not None)
    arrange(window, qtbot)
    before = plain(window.view_states.state(of_mesh=True))
    window.sessions.desk.is_modified = False
    path = tmp_path / "mine.json"
    window.sessions.desk.save(str(path))
    qtbot.waitUntil(lambda: not window.sessions.desk.is_busy)
    window.splitting.arrange({}, {})
    assert not window.sessions.desk.is_modified, "looking elsewhere is no change to the session"
    window.actions_by_name["boundary"].trigger()
    window.quantities.range_of("dirichlet").fit(whole=False)
    window.target.view.fit()
    assert plain(window.view_states.state(of_mesh=True)) != before
    found = read_session(path)
    assert found.views is not None
    window.document.restore(found.session, window.document.positions)
    window.view_states.want(found.views)
    qtbot.waitUntil(lambda: len(window.splitting.panes) == 2)
    QTest.qWait(100)
    assert_alike(before, plain(window.view_states.state(of_mesh=True)))
    window.close()

    second = make_window()
    qtbot.waitUntil(lambda: second.quantities.is_listed and second.document.positions is not None)
    assert [pane.chooser.current for pane in second.splitting.panes] == ["det", "dirichlet"]
    assert second.target.view.surface.lines.boundary.is_shown or second.view_states.state(of_mesh=False)["draws"]
    assert second.target.view.shows_everything, "where a camera stood belongs to a mesh"


def test_a_session_of_a_solid_brings_back_how_it_is_looked_into(solid_window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    window, volume = solid_window, solid_window.volume
    assert "solid" not in window.view_states.state(of_mesh=True), "seen whole"
    volume.choose(is_cut=True, normal=(0.6, 0.0, -0.8), place=0.3, is_flipped=True, is_exact=True, spread=0.25)
    volume.peel(0.4)
    qtbot.waitUntil(lambda: volume.look.threshold is not None)
    volume.choose(threshold=1.25 * volume.look.threshold)  # found on an earlier map, and held since
    look, before = volume.look, plain(window.view_states.state(of_mesh=True))
    path = tmp_path / "solid.json"
    window.sessions.desk.save(str(path))
    qtbot.waitUntil(lambda: not window.sessions.desk.is_busy)
    volume.show_all()
    volume.choose(normal=(0.0, 0.0, 1.0), is_exact=False)
    window.view_states.want(read_session(path).views)
    window.document.restore(read_session(path).session, window.document.positions)
    qtbot.waitUntil(lambda: volume.look.is_cut and volume.look.threshold is not None)
    assert volume.look.normal == pytest.approx(look.normal) and volume.peeled == 0.4
    assert volume.look.threshold == pytest.approx(look.threshold)
    assert_alike(before["solid"], plain(window.view_states.state(of_mesh=True))["solid"])
    for nonsense in ({"normal": [0, 0, 0]}, {"place": 2}, {"cut": 1}, {"spread": -1}, {"threshold": "all"}, {"lid": True}):
        with pytest.raises(WorkbenchError, match="solid"):
            views("views", {"solid": nonsense})
    volume.show_all()


@pytest.mark.parametrize("value", [[], "x", {"layout": {"centre": 5}}, {"panes": {"pane-1": {"side": "up"}}}])
def test_hostile_views_neither_open_nor_keep_the_window_from_starting(
    make_window: WindowMaker, tmp_path: Path, value: object
) -> None:
    path = tmp_path / "bad.json"
    session = {"format": "distortion-workbench session", "version": 1, "source": {"path": "sample:bar"}, "views": value}
    path.write_text(json.dumps(session))
    with pytest.raises(WorkbenchError, match="views"):
        read_session(path)


def test_settings_that_something_else_wrote_are_passed_over(make_window: WindowMaker, qtbot: QtBot) -> None:
    window = make_window()
    qtbot.waitUntil(lambda: window.document.positions is not None)
    for value in ([], {"layout": {"centre": {"split": "right", "sizes": [1], "parts": ["target"]}}}, {"panes": 7}, None):
        window.view_states.restore(value)
        assert [leaf.objectName() for leaf in window.grid.leaves()] == ["source", "target"]
    far = {"focal": [1e69, -1e69], "half_height": 1e69, "axes": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]}
    near = far | {"focal": [0.0, 0.0], "half_height": 1e-250}
    for camera in (far, near):
        window.view_states.restore({"panes": {"target": {"camera": camera}, "source": {"camera": camera}}})
        QTest.qWait(30)
        assert not window.target.view.grab().isNull(), "a camera from nowhere shows nothing, and does no harm"
    window.commands.fit()
    assert window.target.view.shows_everything and window.target.view.camera.half_height < 1.0
