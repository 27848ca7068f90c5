"""How long the window keeps a 5 ms timer waiting while a scripted hand drags an anchor.

    python -m tests.benchmarks.window [TRIANGLES ...]
    python -m tests.benchmarks.window --bar [TETRAHEDRA ...]      an end of a solid bar; then a plane goes through it, too

Without arguments it does both. For each size, with drawing off and on: the three largest gaps between two beats of the timer
(gap/part of it in which the window's thread worked; in the rest it waited for a core or for the interpreter), the 99th
percentile, the time of a frame (median, longest), frames a second, and the delay from the hand to the picture. Needs a screen;
`xvfb-run -s "-screen 0 1600x1000x24"` stands in for one.
"""

from __future__ import annotations

import cProfile
import pstats
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from tests.benchmarks._drag_hands import ScriptedHand, corner_hand, end_hand
from workbench.app.document.anchor_set import AnchorSet
from workbench.app.main import make_application
from workbench.core.samples import make_sample

BEAT = 5
SECONDS = 5.0
EVENT_INTERVAL = 16


def measure(size: int, folder: Path, *, is_solid: bool = False, profile: bool = False) -> None:
    """Open a figure of about `size` triangles, or a bar of tetrahedra, drag it several times, print a line each."""
    from PySide6.QtCore import QEvent
    from PySide6.QtWidgets import QApplication

    from workbench.app.appearance.theme import ThemeSwitch
    from workbench.app.garbage import GuiGarbage
    from workbench.app.main_window import MainWindow
    from workbench.app.settings import Settings

    class TimedWindow(MainWindow):
        """Knows how long each frame took: Qt puts the whole window together in one event."""

        frames: list[float]

        def event(self, event: QEvent) -> bool:
            if event.type() != QEvent.Type.UpdateRequest:
                return super().event(event)
            begin = time.perf_counter()
            done = super().event(event)
            self.frames.append(time.perf_counter() - begin)
            return done

    application = QApplication.instance()
    assert isinstance(application, QApplication)
    name = "bar-3d" if is_solid else "gingerbread"
    mesh = make_sample(name, triangles=size)
    path = folder / f"{name}_{size}.npz"
    np.savez(path, V=mesh.vertices, S=mesh.simplices)
    window = TimedWindow(ThemeSwitch(application, "light"), Settings(folder / "settings.ini"))
    window.frames = []
    window.show()
    window.start(str(path))
    document = window.document
    _until(lambda: document.positions is not None, 120)
    start = document.positions
    assert start is not None
    hand = end_hand(start, mesh.diameter, jumps=False) if is_solid else corner_hand(start, mesh.diameter)
    document.pin(hand.vertices)
    document.run()
    _until(lambda: document.snapshot is not None and document.snapshot.phase == "finished", 120)
    interval = sys.getswitchinterval()
    sys.setswitchinterval(0.001)
    garbage = GuiGarbage()
    try:
        what = f"{mesh.simplex_count} {mesh.simplex_noun(2)}"
        for is_drawing in (False, True):
            window.set_drawing(is_drawing)
            _drag(window, hand, f"{what}, drawing {'on' if is_drawing else 'off'}", profile)
        if is_solid:
            window.look.cut_along("x")
            window.volume.choose(is_exact=True)
            sweep = lambda seconds: window.volume.choose(place=0.5 + 0.4 * np.sin(3.0 * seconds))  # noqa: E731
            _drag(window, hand, f"{what}, cut by a moving plane", profile, sweep)
    finally:
        garbage.end()
        sys.setswitchinterval(interval)
    window.close()
    window.deleteLater()
    application.processEvents()


def _drag(window, hand: ScriptedHand, what: str, profile: bool, beside: Callable[[float], None] | None = None) -> None:  # type: ignore[no-untyped-def]
    """Move a hand for some seconds; `beside` is called with the time at each of its moves."""
    from PySide6.QtCore import QEventLoop, Qt, QTimer

    document = window.document
    window.reporter.drag_meter.forget()
    beats: list[float] = []
    work: list[float] = []
    window.frames.clear()
    loop = QEventLoop()
    beat, events = QTimer(), QTimer()
    for timer, milliseconds in ((beat, BEAT), (events, EVENT_INTERVAL)):
        timer.setTimerType(Qt.TimerType.PreciseTimer)
        timer.setInterval(milliseconds)
    since = time.perf_counter()

    def move() -> None:
        seconds = time.perf_counter() - since
        if seconds > SECONDS:
            loop.quit()
            return
        targets = AnchorSet.to(hand.vertices, hand.at(seconds))
        document.set_anchors(targets, dragging=True, at=time.perf_counter())
        if beside is not None:
            beside(seconds)

    def tick() -> None:
        beats.append(time.perf_counter())
        work.append(time.thread_time())

    beat.timeout.connect(tick)
    events.timeout.connect(move)
    profiler = cProfile.Profile() if profile else None
    beat.start()
    events.start()
    if profiler is not None:
        profiler.enable()
    loop.exec()
    if profiler is not None:
        profiler.disable()
    beat.stop()
    events.stop()
    document.set_anchors(AnchorSet.to(hand.vertices, hand.at(0.0)))
    _until(lambda: document.snapshot.phase == "finished", 120)
    frames, gaps = window.frames, 1e3 * np.diff(beats)
    worked = 1e3 * np.diff(work)
    worst = np.argsort(gaps)[::-1][:3]
    delays = window.reporter.drag_meter.delays
    longest = ", ".join(f"{gaps[i]:.0f}/{worked[i]:.0f} at {beats[i] - since:.1f} s" for i in worst)
    line = f"{what}:  largest gap {gaps.max():.1f} ms ({longest})"
    line += f"  p99 {np.percentile(gaps, 99):.1f}"
    if frames and len(delays):
        line += f"  frame {1e3 * np.median(frames):.1f} ms, longest {1e3 * max(frames):.1f}"
        line += f"  {len(frames) / SECONDS:.0f} frames a second"
        line += f"  hand to picture {np.median(delays):.0f} ms, p95 {np.percentile(delays, 95):.0f}"
    print(line, flush=True)
    if profiler is not None:
        pstats.Stats(profiler).sort_stats("cumulative").print_stats(25)


def _until(holds: Callable[[], bool], seconds: float) -> None:
    from PySide6.QtTest import QTest

    end = time.perf_counter() + seconds
    while not holds():
        if time.perf_counter() > end:
            raise TimeoutError("the engine did not answer")
        QTest.qWait(20)


def main(arguments: list[str]) -> None:
    """Two lines a size, three for solids; `--profile` adds where Python spent the time."""
    make_application()
    sizes, profile = [int(a) for a in arguments if a.isdigit()], "--profile" in arguments
    with tempfile.TemporaryDirectory() as folder:
        if "--bar" not in arguments:
            for size in sizes or [2400, 25_000]:
                measure(size, Path(folder), profile=profile)
        if "--bar" in arguments or not sizes:
            for size in sizes or [12_000, 100_000]:
                measure(size, Path(folder), is_solid=True, profile=profile)


if __name__ == "__main__":
    main(sys.argv[1:])
