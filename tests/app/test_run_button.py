"""The button says Pause while the solver is at work, and Run as soon as it is not."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtTest import QTest

from workbench.app.main_window import MainWindow


def test_a_run_that_ends_before_its_first_map_is_over_for_the_button_too(window: MainWindow) -> None:
    document, button = window.document, window.actions_by_name["run"]
    assert document.snapshot is not None
    document.run()
    QTest.qWait(60)  # the maps of the engine come before those of this test
    done = replace(document.snapshot, phase="finished")
    for _ in range(3):
        document._take_snapshot(done)
        assert button.text() == "Run"
        document._run()  # such as undo asks for
        assert button.text() == "Pause"
    document._take_snapshot(done)
    assert button.text() == "Run"
    document.pause()
