"""What the window says while anchors were moved and the solver rests."""

from __future__ import annotations

from dataclasses import replace

from workbench.app.main_window import MainWindow


def test_anchors_that_wait_for_a_resting_solver_are_spoken_of(window: MainWindow) -> None:
    """A drag alone does not run it: who does not know that Space does would look at a map that does not follow."""
    rested = replace(window.document.snapshot, phase="idle")
    away = replace(rested, row=replace(rested.row, anchor_error=0.5))
    window.document._take_snapshot(away)
    assert "Space" in window.status.sentence.text() and "follows the anchors" in window.status.sentence.text()
    window.document._take_snapshot(replace(rested, row=replace(rested.row, anchor_error=0.0)))
    assert "follows the anchors" not in window.status.sentence.text()
    window.document._take_snapshot(replace(away, phase="finished"))
    assert "follows the anchors" not in window.status.sentence.text()
