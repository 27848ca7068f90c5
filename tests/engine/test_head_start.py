"""An engine that was begun before its owner: it works like any other, and gives way once it has shown a map."""

from __future__ import annotations

import sys
import threading
import time

import psutil
import pytest

from workbench.engine import process
from workbench.engine.head_start import begin_engine
from workbench.engine.log_lines import MOST, LogLines
from workbench.engine.messages import Load, Loaded, SetProblem, SetSolver, Snapshot
from workbench.engine.priority import LOWEST, NICENESS
from workbench.engine.worker import EngineWorker


def test_an_engine_that_has_begun_is_taken_over_and_gives_way_from_its_first_map_on() -> None:
    begun = begin_engine(gives_way=True, ahead="sample:gingerbread")
    bell = threading.Event()
    worker = EngineWorker(bell.set, gives_way=True, begun=begun)
    worker.start()
    child = psutil.Process(begun.process.pid)
    try:
        usual = psutil.Process().nice()
        assert child.nice() == usual, "until there is a map nothing else wants the processor"
        for command in (SetProblem(), SetSolver(), Load("sample:gingerbread", 1)):
            worker.post(command)
        reports: list[object] = []
        until = time.monotonic() + 120
        while not any(isinstance(report, Snapshot) for report in reports):
            assert time.monotonic() < until
            bell.wait(1.0)
            bell.clear()
            reports += worker.take()
        loaded = next(report for report in reports if isinstance(report, Loaded))
        assert worker.process_id == begun.process.pid
        assert loaded.anchor_vertices is not None and len(loaded.anchor_vertices) == 5, "the sample's own anchors come along"
        if sys.platform.startswith("linux"):
            while child.nice() != min(usual + NICENESS, LOWEST):
                assert time.monotonic() < until
                time.sleep(0.02)
    finally:
        worker.close()
    assert not child.is_running() or child.status() == psutil.STATUS_ZOMBIE


def test_the_first_start_says_that_it_compiles_and_later_ones_do_not(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[str] = []
    process.warm_up(lambda: told.append("first"))
    told.clear()
    process.warm_up(lambda: told.append("later"))
    assert not told
    monkeypatch.setattr(process, "is_cached", lambda kernel: False)
    process.warm_up(lambda: told.append("as at first"))
    assert told == ["as at first"]


def test_lines_of_loggers_are_kept_for_the_window_and_no_more_than_fit() -> None:
    import logging

    root, level = logging.getLogger(), logging.getLogger().level
    lines = LogLines()
    try:
        for number in range(MOST + 20):
            logging.getLogger("of_a_plugin").info("line %d of %s", number, "many")
        lines.handle(logging.LogRecord("of_a_plugin", logging.WARNING, "", 0, "does not fit %d", ("text",), None))
        taken = lines.take()
        assert len(taken) == MOST and taken[-1].level == logging.WARNING and taken[-2].text == f"line {MOST + 19} of many"
        assert not lines.take()
    finally:
        root.removeHandler(lines)
        root.setLevel(level)
        logging.captureWarnings(False)
