"""A whole end of a solid is dragged, turned and thrown about: no map that anyone sees has an inverted tetrahedron."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

from tests.benchmarks._drag_hands import end_hand
from tests.engine.test_worker import Desk, desk  # noqa: F401  the fixture
from workbench.core.jacobians import build_elements, determinants
from workbench.core.samples import make_sample
from workbench.core.status import Status
from workbench.engine.loop import EngineLoop, MapReport
from workbench.engine.messages import Load, Loaded, Report, Run, SetAnchors, SetProblem, SetSolver


# below and above the size from which the corrector's process takes part
@pytest.mark.parametrize(("size", "is_named"), [(600, True), (4600, False)], ids=["alone, named", "with corrector, by edges"])
def test_an_end_of_a_bar_follows_the_hand_without_inversion(
    desk: Desk,  # noqa: F811
    tmp_path: Path,
    size: int,
    is_named: bool,
) -> None:
    mesh = make_sample("bar-3d", size)
    np.savez(tmp_path / "bar.npz", V=mesh.vertices, S=mesh.simplices)
    first = desk.open(str(tmp_path / "bar.npz"))
    hand = end_hand(first.positions, mesh.diameter)
    weights = np.full(len(hand.vertices), np.inf)
    groups = np.isin(np.arange(len(weights)), hand.held).astype(np.int64) if is_named else None
    desk.worker.post(Run())
    for event in range(1, 70):
        targets = hand.at(event / 20)
        desk.worker.post(SetAnchors(hand.vertices, targets, weights, event, True, groups))
        time.sleep(1 / 60)
    rest = first.positions[hand.vertices] + [0.0, 0.1, 0.0]
    desk.worker.post(SetAnchors(hand.vertices, rest, weights, 200, False, groups))
    desk.until(lambda: desk.snapshots[-1].anchor_serial == 200 and desk.snapshots[-1].phase == "finished")
    elements = build_elements(desk.told(Loaded)[0].mesh)  # type: ignore[attr-defined]
    for snapshot in desk.snapshots:
        assert (determinants(elements, snapshot.positions) > 0).all()
        assert not snapshot.inverted.any()
    last = desk.snapshots[-1]
    assert last.status is Status.CONVERGED
    assert np.abs(last.positions[hand.vertices] - rest).max() <= 1e-9 * mesh.diameter
    travelled = max(np.abs(s.positions - first.positions).max() for s in desk.snapshots)
    assert travelled > 0.1 * mesh.diameter, "the map did move"


def test_corners_that_are_named_a_group_turn_half_round_without_collapsing_the_solid_between_them(tmp_path: Path) -> None:
    """No edge joins the corners of an end: one by one they would go straight, through the axis."""
    mesh = make_sample("bar-3d", 600)
    path = tmp_path / "bar.npz"
    np.savez(path, V=mesh.vertices, S=mesh.simplices)
    reports: list[Report] = []
    loop = EngineLoop(reports.append)
    for command in (SetProblem(), SetSolver(), Load(str(path), 1)):
        loop.handle(command)
    is_corner = (np.abs(mesh.vertices[:, 1:] - 0.5) == 0.5).all(axis=1)
    near, far = (np.flatnonzero(is_corner & (mesh.vertices[:, 0] == x)) for x in (0.0, 4.0))
    held = np.concatenate([near, far])
    targets = mesh.vertices[held].copy()
    targets[4:, 1:] = 1.0 - targets[4:, 1:]
    loop.handle(SetAnchors(held, targets, np.full(8, np.inf), groups=np.repeat([0, 1], 4)))
    loop.handle(Run())
    while loop.advance():
        pass
    maps = [report for report in reports if isinstance(report, MapReport)]
    elements = build_elements(mesh)
    assert maps[-1].status is Status.CONVERGED
    widths = []
    for report in maps:
        assert (determinants(elements, report.positions) > 0).all()
        widths.append(np.linalg.norm(report.positions[far] - report.positions[far].mean(axis=0), axis=1).min())
    assert min(widths) > 0.99 * np.sqrt(0.5), "the end keeps its size all the way"
    assert np.abs(maps[-1].positions[held] - targets).max() <= 1e-9 * mesh.diameter
