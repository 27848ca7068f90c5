"""What a hand notices of a race: pictures a second in each view, gaps of a 5 ms timer, the answer to a click.

    python -m tests.benchmarks.race [TRIANGLES] [SOLVER]...

A view can show no more maps than its solver makes in its share of the time: one of four whose step takes 60 ms makes four
a second. Needs a screen; where there is none a virtual one stands in for it.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable

import numpy as np
from PySide6.QtCore import QEventLoop, QPoint, Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from tests.benchmarks._screen import screen
from workbench.app.appearance.theme import LIGHT
from workbench.app.main import make_application
from workbench.app.quantities.quantity_book import QuantityBook
from workbench.app.race.race_window import RaceWindow
from workbench.core.samples import make_sample
from workbench.engine.messages import Run, SetAnchors, SetProblem
from workbench.engine.race_messages import Entrant, StartRace

BEAT = 5
"""Milliseconds of the timer whose gaps are measured."""
SECONDS = 12.0
CLICK_INTERVAL = 0.7
SOLVERS = ("projected-newton", "aqp", "slim", "l-bfgs")
QUICK = ("l-bfgs", "gradient-descent", "jacobi", "sobolev-gradient-descent")
"""Solvers with cheap steps, each with a quarter of the time for ten maps a second and more."""


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


class Pictures:
    """When another map of each contestant was shown, in whichever view; a picture of the same map does not count."""

    def __init__(self, window: RaceWindow) -> None:
        self._window = window
        self.times: list[list[float]] = [[] for _ in window.grid.panes]
        self._numbers = [0] * len(self.times)
        for place, pane in enumerate(window.grid.panes):
            pane.view.drawn.connect(lambda p=place: self._drawn(p))

    def _drawn(self, place: int) -> None:
        index = self._window.grid.panes[place].shown
        frame = self._window.model.records[index].frame
        if frame is not None and frame.number != self._numbers[index]:
            self._numbers[index] = frame.number
            self.times[index].append(time.perf_counter())

    def said(self, index: int, begin: float, end: float) -> str:
        """Pictures a second, and the time within which nine of ten followed on the one before."""
        times = np.array([moment for moment in self.times[index] if begin <= moment <= end])
        gaps = 1e3 * np.diff(np.concatenate([[begin], times, [end]]))
        return f"{len(times) / (end - begin):4.1f} pictures a second, nine of ten within {np.percentile(gaps, 90):.0f} ms"


def measure(triangles: int, solvers: tuple[str, ...]) -> None:
    """Race for some seconds, click meanwhile, print a line a contestant and two for all."""
    from workbench.app.garbage import GuiGarbage

    host = QWidget()
    window = RaceWindow(set_up(triangles, solvers), QuantityBook(), "symmetric-dirichlet", LIGHT, host)
    window.open(run=True)
    model = window.model
    _until(lambda: model.is_running and all(r.iterations > 1 for r in model.records), 180)
    interval = sys.getswitchinterval()
    sys.setswitchinterval(0.001)
    garbage = GuiGarbage()
    beats: list[float] = []
    answers: list[float] = []
    pictures = Pictures(window)
    before = [(record.iterations, record.spent) for record in model.records]
    loop = QEventLoop()
    beat, clicks = QTimer(), QTimer()
    beat.setTimerType(Qt.TimerType.PreciseTimer)
    begin, worked = time.perf_counter(), time.process_time()

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
    end, worked = time.perf_counter(), time.process_time() - worked
    beat.stop()
    clicks.stop()
    gaps = 1e3 * np.diff(beats)
    size = window.grid.panes[0].view.size_in_pixels
    print(f"{model.mesh.simplex_count} triangles, views of {size[0]} x {size[1]}:")
    charged = 0.0
    for index, (record, (steps, spent)) in enumerate(zip(model.records, before, strict=True)):
        steps, spent = record.iterations - steps, record.spent - spent
        charged += spent
        cost = f"{1e3 * spent / steps:.0f} ms a step" if steps else "no step"
        over = "" if record.frame is not None and record.frame.phase == "running" else ", then it was done"
        print(f"  {record.entrant.solver:26} {pictures.said(index, begin, end)}; {steps} steps in {spent:.2f} s, {cost}{over}")
    solved, worked = charged / (end - begin), worked / (end - begin)
    print(
        f"  the engine solved {solved:.0%} of the time, the window worked {worked:.0%} of a core; gaps of its {BEAT} ms timer: "
        f"median {np.median(gaps):.1f}, p99 {np.percentile(gaps, 99):.1f}, largest {gaps.max():.1f} ms"
    )
    print(
        f"  a click answered in {1e3 * np.median(answers):.0f} ms, at most {1e3 * (max(answers) + gaps.max() / 1e3):.0f} ms "
        f"with the longest wait for its turn",
        flush=True,
    )
    garbage.end()
    sys.setswitchinterval(interval)
    window.close()
    host.deleteLater()
    QApplication.processEvents()


def _until(holds: Callable[[], bool], seconds: float) -> None:
    end = time.perf_counter() + seconds
    while not holds():
        if time.perf_counter() > end:
            raise TimeoutError("the race did not get there")
        QTest.qWait(20)


def main(arguments: list[str]) -> None:
    """Two races of four on 25 000 triangles unless told otherwise."""
    with screen() as there_is_one:
        if there_is_one:
            _measure_all(arguments)


def _measure_all(arguments: list[str]) -> None:
    application = make_application()
    triangles = next((int(a) for a in arguments if a.isdigit()), 25_000)
    named = tuple(a for a in arguments if not a.isdigit())
    for solvers in (named,) if named else (SOLVERS, QUICK):
        measure(triangles, solvers)
    application.quit()


if __name__ == "__main__":
    main(sys.argv[1:])
