"""What a hand notices of a race: pictures a second in each view, gaps of a 5 ms timer, the answer to a click.

    python -m tests.benchmarks.race [TRIANGLES] [SOLVER]...

A view can show no more maps than its solver makes in its share of the time; those that make many show what drawing allows.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

import numpy as np

from workbench.app.main import make_application
from workbench.core.samples import make_sample
from workbench.engine.messages import Run, SetAnchors, SetProblem
from workbench.engine.race_messages import Entrant, StartRace

BEAT = 5
"""Milliseconds of the timer whose gaps are measured."""
SECONDS = 12.0
CLICK_INTERVAL = 0.7
SOLVERS = ("projected-newton", "aqp", "slim", "l-bfgs")
QUICK = ("l-bfgs", "gradient-descent", "jacobi", "sobolev-gradient-descent")
"""Solvers with cheap steps."""


def set_up(triangles: int, solvers: tuple[str, ...]) -> StartRace:
    """A figure that is pulled far at its ends, so that all have work for long."""
    mesh = make_sample("gingerbread", triangles=triangles)
    start = np.ascontiguousarray(mesh.vertices[:, :2])
    directions = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
    held = np.unique((start @ directions.T).argmax(axis=0))
    targets = start[held] + 0.3 * mesh.diameter * np.array([[0.3, 0.5], [0.6, -0.2], [-0.1, 0.3], [0.5, 0.5]])[: len(held)]
    return StartRace(
        serial=0,
        mesh=mesh,
        kind="plane",
        start=start,
        entrants=tuple(Entrant(f"{id} {row}", id) for row, id in enumerate(solvers)),
        problem=SetProblem(),
        anchors=SetAnchors(held, targets, np.full(len(held), np.inf)),
        limits=Run(iterations=1_000_000, tolerance=0.0),
    )


def measure(triangles: int, solvers: tuple[str, ...]) -> None:
    """Race for some seconds, click meanwhile, print three lines."""
    from PySide6.QtCore import QEventLoop, QPoint, Qt, QTimer
    from PySide6.QtTest import QTest
    from PySide6.QtWidgets import QApplication, QWidget

    from workbench.app.garbage import GuiGarbage
    from workbench.app.quantity_book import QuantityBook
    from workbench.app.race.race_window import RaceWindow
    from workbench.app.theme import LIGHT

    host = QWidget()
    window = RaceWindow(set_up(triangles, solvers), QuantityBook(), "symmetric-dirichlet", LIGHT, host)
    window.open(run=True)
    _until(lambda: window.model.is_running and all(r.iterations > 1 for r in window.model.records), 180)
    interval = sys.getswitchinterval()
    sys.setswitchinterval(0.001)
    garbage = GuiGarbage()
    beats: list[float] = []
    answers: list[float] = []
    window.grid.turns.counts.clear()
    maps = [record.iterations for record in window.model.records]
    loop = QEventLoop()
    beat, clicks = QTimer(), QTimer()
    beat.setTimerType(Qt.TimerType.PreciseTimer)
    begin = time.perf_counter()

    def tick() -> None:
        beats.append(time.perf_counter())
        if beats[-1] - begin > SECONDS:
            loop.quit()

    def click() -> None:
        """Press a button, and wait for the picture that shows it."""
        button = window.compare.flip_button
        asked = time.perf_counter()
        QTest.mouseClick(button, Qt.MouseButton.LeftButton, pos=QPoint(8, 8))
        button.repaint()
        answers.append(time.perf_counter() - asked)

    beat.timeout.connect(tick)
    clicks.timeout.connect(click)
    beat.start(BEAT)
    clicks.start(round(1e3 * CLICK_INTERVAL))
    loop.exec()
    beat.stop()
    clicks.stop()
    gaps = 1e3 * np.diff(beats)
    pictures = [window.grid.turns.counts.get(index, 0) / SECONDS for index in range(len(solvers))]
    steps = [record.iterations - before for record, before in zip(window.model.records, maps, strict=True)]
    spent = [record.spent for record in window.model.records]
    size = window.grid.panes[0].view.size_in_pixels
    print(f"{window.model.mesh.simplex_count} triangles, {', '.join(solvers)}, views of {size[0]} x {size[1]}:")
    print(f"  pictures a second {', '.join(f'{p:.1f}' for p in pictures)}; steps taken {steps}; seconds {np.round(spent, 2)}")
    print(
        f"  gaps of a {BEAT} ms timer: median {np.median(gaps):.1f}, p99 {np.percentile(gaps, 99):.1f}, "
        f"largest {gaps.max():.1f} ms; a click answered in {1e3 * np.median(answers):.0f} ms, at most "
        f"{1e3 * (max(answers) + gaps.max() / 1e3):.0f} ms with the longest wait for its turn",
        flush=True,
    )
    garbage.end()
    sys.setswitchinterval(interval)
    window.close()
    host.deleteLater()
    QApplication.processEvents()


def _until(holds: Callable[[], bool], seconds: float) -> None:
    from PySide6.QtTest import QTest

    end = time.perf_counter() + seconds
    while not holds():
        if time.perf_counter() > end:
            raise TimeoutError("the race did not get there")
        QTest.qWait(20)


def main(arguments: list[str]) -> None:
    """Two races of four on 25 000 triangles unless told otherwise."""
    make_application()
    triangles = next((int(a) for a in arguments if a.isdigit()), 25_000)
    named = tuple(a for a in arguments if not a.isdigit())
    for solvers in (named,) if named else (SOLVERS, QUICK):
        measure(triangles, solvers)


if __name__ == "__main__":
    main(sys.argv[1:])
