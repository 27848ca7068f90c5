"""A scripted hand drags an anchor along a wild path: how long from an event to the map that holds it.

    python -m tests.benchmarks.drag [TRIANGLES ...]
    python -m tests.benchmarks.drag --bar [TETRAHEDRA ...]      a corner of a solid bar, then a whole end as one group

Without arguments it does both.

Prints, for each size: maps published, largest count of inverted simplices in any of them, percentiles of the time from an
event to the first map that holds it or a newer one, and how far the anchor lags behind the hand (median, in diameters);
then whether the anchor arrives after release and what the solver's status is.
"""

from __future__ import annotations

import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from tests.benchmarks._drag_hands import ScriptedHand, corner_hand, end_hand
from workbench.core.jacobians import build_elements, determinants
from workbench.core.measure import Measure
from workbench.core.samples import make_sample
from workbench.engine.messages import Failure, Load, Loaded, Reset, Run, SetAnchors, SetProblem, SetSolver, Snapshot, Watch
from workbench.engine.worker import EngineWorker

HandMaker = Callable[[np.ndarray, float], ScriptedHand]
"""From the map (n, d) at the start and the diameter of the source"""
EVENTS_A_SECOND = 60
SECONDS = 10.0
WATCHED = ("dirichlet", "condition-number", "symmetric-dirichlet", "average-singular-value")
"""What the window's panels show when it opens."""


def drag(
    path: str, make_hand: HandMaker = corner_hand, *, with_fields: bool = True, seconds: float = SECONDS
) -> dict[str, float]:
    """Drive an engine as the window does; returns what `main` prints."""
    news = threading.Condition()
    seen: list[tuple[float, Snapshot]] = []
    loaded: list[Loaded] = []
    failures: list[Failure] = []

    def on_snapshot(snapshot: Snapshot) -> None:
        with news:
            seen.append((time.perf_counter(), snapshot))
            news.notify_all()

    def wake() -> None:
        for report in worker.take():
            if isinstance(report, Loaded):
                loaded.append(report)
            if isinstance(report, Failure):
                failures.append(report)

    worker = EngineWorker(wake, on_snapshot=on_snapshot, with_fields=with_fields)
    worker.start()
    watched = Watch(tuple(Measure(id) for id in WATCHED))
    for command in (watched, Load(path, 1), SetProblem(), SetSolver(), Reset()):
        worker.post(command)
    _await(news, lambda: bool(seen), 120)
    mesh, start = loaded[0].mesh, seen[-1][1].positions
    elements, diameter = build_elements(mesh), mesh.diameter
    hand = make_hand(start, diameter)
    targets = hand.at(0.0)
    worker.post(_anchors(hand.vertices, start[hand.vertices], 1, dragging=False))
    worker.post(Run())
    _await(news, lambda: seen[-1][1].phase == "finished", 120)
    seen.clear()

    posted: list[tuple[int, float, np.ndarray]] = []
    begin = time.perf_counter()
    for event in range(int(seconds * EVENTS_A_SECOND)):
        due = begin + event / EVENTS_A_SECOND
        time.sleep(max(0.0, due - time.perf_counter()))
        targets = hand.at(event / EVENTS_A_SECOND)
        posted.append((event + 2, time.perf_counter(), targets[hand.held]))
        worker.post(_anchors(hand.vertices, targets, event + 2, dragging=True))
    worker.post(_anchors(hand.vertices, targets, posted[-1][0] + 1, dragging=False))
    _await(news, lambda: seen[-1][1].anchor_serial > posted[-1][0] and seen[-1][1].phase == "finished", 60)
    maps = list(seen)
    worker.close()

    latencies = _latencies(posted, maps)
    moved = hand.vertices[hand.held]
    lags = [
        np.linalg.norm(_target_at(posted, when) - snapshot.positions[moved], axis=1).max() / diameter
        for when, snapshot in maps
        if begin < when < begin + seconds
    ]
    final = maps[-1][1]
    return {
        "simplices": mesh.simplex_count,
        "maps": len(maps),
        "largest_inverted": max(int((determinants(elements, s.positions) <= 0).sum()) for _, s in maps),
        "largest_inverted_reported": max(s.row.inverted for _, s in maps),
        "p50_ms": 1e3 * float(np.percentile(latencies, 50)),
        "p95_ms": 1e3 * float(np.percentile(latencies, 95)),
        "max_ms": 1e3 * max(latencies),
        "median_lag": float(np.median(lags)),
        "p95_lag": float(np.percentile(lags, 95)),
        "final_error": float(np.linalg.norm(final.positions[hand.vertices] - targets, axis=1).max()) / diameter,
        "converged": float(final.status.name == "CONVERGED"),
        "failures": len(failures),
    }


def _anchors(vertices: np.ndarray, targets: np.ndarray, serial: int, *, dragging: bool) -> SetAnchors:
    return SetAnchors(vertices, targets, np.full(len(vertices), np.inf), serial, dragging)


def _latencies(posted: list[tuple[int, float, np.ndarray]], maps: list[tuple[float, Snapshot]]) -> list[float]:
    result = []
    k = 0
    for serial, when, _ in posted:
        while k < len(maps) - 1 and maps[k][1].anchor_serial < serial:
            k += 1
        result.append(maps[k][0] - when)
    return result


def _target_at(posted: list[tuple[int, float, np.ndarray]], when: float) -> np.ndarray:
    times = [p[1] for p in posted]
    return posted[max(0, int(np.searchsorted(times, when)) - 1)][2]


def _await(news: threading.Condition, holds: object, seconds: float) -> None:
    with news:
        if not news.wait_for(holds, timeout=seconds):  # type: ignore[arg-type]
            raise TimeoutError("the engine did not answer")


def main(arguments: list[str]) -> None:
    """Print a table, one line a size and hand."""
    sizes = [int(a) for a in arguments if a != "--bar"]
    if "--bar" not in arguments:
        _table("gingerbread", sizes or [2500, 25_000, 100_000], (corner_hand,))
    if "--bar" in arguments or not arguments:
        _table("bar-3d", sizes or [3000, 12_000], (corner_hand, end_hand))


def _table(sample: str, sizes: list[int], hands: tuple[HandMaker, ...]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        for size in sizes:
            mesh = make_sample(sample, size)
            path = Path(folder) / f"{sample}_{size}.npz"
            np.savez(path, V=mesh.vertices, S=mesh.simplices)
            for hand in hands:
                result = drag(str(path), hand)
                print(hand.__name__, "  ".join(f"{k} {v:.4g}" for k, v in result.items()), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
