"""A race of solvers: from one start on one problem, in turns, each charged the time that it spends itself.

A plain object without a process: whoever owns it calls `advance` as long as it likes; not to call it is a pause.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterable, Sequence

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.problem import Criteria, Problem
from workbench.core.run import Limits
from workbench.core.solver import Interrupt, never
from workbench.engine.compiling import compile_kernels
from workbench.engine.contestants import PRESETS, Contestant, Preset, check_labels
from workbench.engine.map_store import Frame, MapStore
from workbench.engine.racer import Marker, Racer, RaceRow, Terms

__all__ = ["PRESETS", "Contestant", "Frame", "Limits", "Marker", "Preset", "Race", "RaceRow", "Racer"]

SLICE = 0.05
"""Seconds of a turn."""
LEAD = 0.15
"""Seconds that a contestant may be ahead of whoever has spent least and still have its turn out of turn."""
STORE_BYTES = 256 * 2**20
"""Of the maps that are kept, of all contestants together."""


class Race:
    """Contestants on one problem from one start.

    Each has a workspace of its own (its factors, its counts); what depends on the mesh alone is made once, and its time is
    charged to everyone. Never do two of them compute at once, so a second is worth the same to each.

    Parameters
    ----------
    problem : Problem             elements and sparsity pattern are shared
    start : (n, d) float64
    contestants : sequence        labels differ
    criteria, limits              the same for all
    store_bytes : int             of the maps that are kept for going back in time
    pinned : iterable of int      iterations whose maps are kept in any case

    Raises `WorkbenchError` for two contestants of one label. A contestant that cannot start has its `fault` said.
    """

    def __init__(
        self,
        problem: Problem,
        start: Floats,
        contestants: Sequence[Contestant],
        *,
        criteria: Criteria | None = None,
        limits: Limits | None = None,
        store_bytes: int = STORE_BYTES,
        pinned: Iterable[int] = (),
    ) -> None:
        check_labels(contestant.label for contestant in contestants)
        if criteria is not None:
            problem = problem.with_criteria(criteria)
        for contestant in contestants:
            if contestant.solver is not None:
                compile_kernels(problem, contestant.solver)
        begin = time.perf_counter()
        problem.density.pattern  # noqa: B018  what all share is made before anyone's clock runs
        shared = time.perf_counter() - begin
        share, kept = store_bytes // max(len(contestants), 1), tuple(pinned)
        self.start = np.ascontiguousarray(start, dtype=np.float64)
        self.racers = tuple(
            Racer(
                contestant,
                problem,
                self.start,
                limits=limits or Limits(),
                store=MapStore(share, kept),
                seconds=0.0 if contestant.solver is None else shared,
            )
            for contestant in contestants
        )
        self._last_turns: dict[Racer, tuple[float, float]] = {}  # when they ended, and how long they were

    def racer(self, label: str) -> Racer:
        """The contestant of that label. Raises `KeyError`."""
        return {racer.label: racer for racer in self.racers}[label]

    @property
    def is_over(self) -> bool:
        """Whether no contestant has a step to take."""
        return not any(racer.is_running for racer in self.racers)

    @property
    def seconds(self) -> float:
        """What the contestant that has spent most has spent: the end of the time axis."""
        return max((racer.seconds for racer in self.racers), default=0.0)

    # ------------------------------------------------------------------------------------------- turns

    def advance(self, slice_seconds: float = SLICE, interrupt: Interrupt = never, patience: float = math.inf) -> Racer | None:
        """A turn for the running contestant that has spent the least; at least one step, until its slice is over.

        Returns the contestant, None where the race is over. `interrupt` ends the turn within a trial of a line search.
        Whoever had no turn for `patience` seconds on the clock comes first, short turns before long ones, unless it is
        ahead by more than `LEAD`: so long steps of several contestants do not follow on each other.
        """
        racer = self._next(patience)
        if racer is None:
            return None
        before = racer.seconds
        end = before + slice_seconds
        racer.step(interrupt)
        while racer.is_running and racer.seconds < end and not interrupt():
            racer.step(interrupt)
        self._last_turns[racer] = (time.perf_counter(), racer.seconds - before)
        return racer

    def _next(self, patience: float) -> Racer | None:
        """Whose turn it is."""
        running = [racer for racer in self.racers if racer.is_running]
        if not running:
            return None
        least = min(running, key=lambda racer: racer.seconds)
        latest = time.perf_counter() - patience
        waiting = [
            racer
            for racer in running
            if racer.seconds <= least.seconds + LEAD and self._last_turns.get(racer, (latest, 0.0))[0] < latest
        ]
        return min(waiting, key=lambda racer: self._last_turns[racer][1]) if waiting else least

    def step_all(self, interrupt: Interrupt = never) -> None:
        """One step of every running contestant."""
        for racer in self.racers:
            racer.step(interrupt)

    def run(self, slice_seconds: float = SLICE, interrupt: Interrupt = never) -> None:
        """Turns until all are done; where interrupted, everyone ends with the map that it has."""
        while not interrupt() and self.advance(slice_seconds, interrupt) is not None:
            pass
        self.stop()

    def stop(self) -> None:
        """Whoever still runs ends with the map that it has."""
        for racer in self.racers:
            racer.stop()

    # ------------------------------------------------------------------------------------- comparisons

    def best_energies(self) -> dict[Terms, float]:
        """Least energy that anyone has had so far with its anchors in place, for each of the energies that were minimised."""
        best: dict[Terms, float] = {}
        for racer in self.racers:
            for terms, energy in zip(racer.terms, _held_energies(racer).tolist(), strict=True):
                if energy < best.get(terms, math.inf):
                    best[terms] = energy
        return best

    def best_energy(self, racer: Racer) -> float:
        """Least energy so far on what `racer` minimises now; NaN where nobody holds the anchors."""
        return self.best_energies().get(racer.terms[-1], math.nan)

    def relative_errors(self, racer: Racer) -> Floats:
        """(E - best) / |best| for each row (rows,) of a contestant; NaN where its anchors lag, inf where E is."""
        best = self.best_energies()
        least = np.array([best.get(terms, math.nan) for terms in racer.terms])
        floor = 1e-14 * racer.problem.total_measure  # an energy whose minimum is 0 has no relative error to it
        return (_held_energies(racer) - least) / np.maximum(np.abs(least), floor)


def _held_energies(racer: Racer) -> Floats:
    """Energies (rows,) of the maps that hold their anchors; NaN for the others."""
    tolerance = racer.problem.anchor_tolerance
    return np.array([row.energy if row.anchor_error <= tolerance else math.nan for row in racer.rows])
