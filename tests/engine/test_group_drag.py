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
from workbench.engine.messages import Loaded, Run, SetAnchors


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
