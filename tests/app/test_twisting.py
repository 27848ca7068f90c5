"""A solid bar in the window with the real engine: an end that its case holds is turned by hand while the solver runs."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from pytestqt.qtbot import QtBot

from tests.app.conftest import WindowMaker
from tests.app.space_hand import turn_by_ring
from workbench.app.document.engine_bridge import engine_worker
from workbench.app.handling.pacing import turned_angle
from workbench.core.samples import make_sample


def test_an_end_of_a_bar_is_turned_by_half_a_turn_while_it_is_solved(
    make_window: WindowMaker, qtbot: QtBot, tmp_path: Path
) -> None:
    mesh = make_sample("bar-3d", 600)
    ends = [np.flatnonzero(mesh.vertices[:, 0] == x) for x in (0.0, 4.0)]
    held = np.concatenate(ends)
    np.savez(tmp_path / "bar.npz", V=mesh.vertices, S=mesh.simplices, anchors=held, targets=mesh.vertices[held])
    window = make_window(engine_worker, source=str(tmp_path / "bar.npz"))
    document = window.document
    qtbot.waitUntil(lambda: len(document.anchors) == len(held))
    inverted: list[bool] = []
    document.snapshot_taken.connect(lambda: inverted.append(bool(document.snapshot.inverted.any())))
    document.select(int(ends[1][0]))
    assert sorted(document.selected_anchors.tolist()) == ends[1].tolist(), "what edges join in the case is one group"
    document.run()
    qtbot.waitUntil(lambda: document.snapshot.phase == "finished")
    inverted.clear()
    angle = turn_by_ring(window, 0, 180)
    qtbot.waitUntil(lambda: not window.desk.is_turning)
    serial = document.anchor_serial
    arrived = lambda: document.snapshot.anchor_serial == serial and document.snapshot.phase == "finished"  # noqa: E731
    qtbot.waitUntil(arrived)
    turned = turned_angle(mesh.vertices[ends[1]], document.positions[ends[1]], np.array([1.0, 0.0, 0.0]))
    assert abs(math.remainder(turned - angle, 2.0 * math.pi)) < 0.1
    np.testing.assert_allclose(document.positions[ends[0]], mesh.vertices[ends[0]], atol=1e-8)
    assert inverted and not any(inverted), "no map that was drawn has an inverted tetrahedron"
    assert document.snapshot.row.mean_distortion < 6.6, "the twist spreads over the whole bar"
