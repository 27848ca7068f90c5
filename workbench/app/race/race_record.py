"""What the window knows of each contestant, and how far each is from the best."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from workbench.app.document.history import History
from workbench.core.arrays import Floats
from workbench.core.mesh import Mesh
from workbench.core.problem import ANCHOR_TOLERANCE
from workbench.engine.messages import SetAnchors, SetProblem
from workbench.engine.race_messages import Entrant, RaceFrame

COLUMNS = ("iteration", "seconds", "energy", "mean_distortion", "gradient_norm", "inverted", "anchor_error")


class RaceRecord:
    """A contestant's newest frame, all rows of its history, and what it does now."""

    def __init__(self, entrant: Entrant, problem: SetProblem, anchors: SetAnchors) -> None:
        self.entrant = entrant
        self.problem = problem
        self.anchors = anchors
        self.label = entrant.label
        self.asked: tuple[Entrant, SetProblem, SetAnchors] | None = None
        self.frame: RaceFrame | None = None
        self.history = History(COLUMNS)
        self.terms: list[int] = []

    def take(self, frame: RaceFrame) -> bool:
        """Take the news; whether they bring another map."""
        self.history.extend(frame.rows)
        self.terms.extend(frame.terms)
        has_map = frame.number > 0
        if self.asked is not None and self.frame is not None and len(frame.markers) > len(self.frame.markers):
            (self.entrant, self.problem, self.anchors), self.asked = self.asked, None
        self.frame = frame.after(self.frame)
        return has_map

    @property
    def spent(self) -> float:
        """Seconds so far."""
        seconds = self.history.column("seconds")
        return float(seconds[-1]) if len(seconds) else 0.0

    @property
    def iterations(self) -> int:
        steps = self.history.column("iteration")
        return int(steps[-1]) if len(steps) else 0


def relative_errors(records: Sequence[RaceRecord], mesh: Mesh, total_measure: float) -> list[Floats]:
    """(E - best) / |best| for each row (k,) of each contestant; NaN where anchors lag: such a map has not done its task.

    The best is the least energy that any of them reached with the anchors in place, for each energy that was minimised;
    `total_measure` is the area of the source.
    """
    held = [_held(record, mesh) for record in records]
    energies = np.concatenate(held) if held else np.empty(0)
    terms = [np.array(record.terms, dtype=np.int64) for record in records]
    joined = np.concatenate(terms) if terms else np.empty(0, np.int64)
    best = np.full(int(joined.max(initial=0)) + 1, np.inf)
    known = np.isfinite(energies)
    np.minimum.at(best, joined[known], energies[known])
    # an energy whose minimum is 0 has no relative error to it
    floor = 1e-14 * total_measure
    errors = []
    for values, these in zip(held, terms, strict=True):
        least = np.where(np.isfinite(best[these]), best[these], np.nan)
        errors.append((values - least) / np.maximum(np.abs(least), floor))
    return errors


def verdict(records: Sequence[RaceRecord], mesh: Mesh) -> str:
    """One sentence about a race that is over: who came lowest, where all minimised the same energy."""
    held = [_held(record, mesh) for record in records]
    last = [values[-1] if len(values) else np.nan for values in held]
    if len({record.terms[-1] for record in records if record.terms}) > 1:
        return "Over. They ended with different energies, so nobody is first."
    if not np.isfinite(last).any():
        return "Over. Nobody has brought its anchors into place."
    first = records[int(np.nanargmin(last))]
    mean = first.history.column("mean_distortion")[-1]
    noun = "iteration" if first.iterations == 1 else "iterations"
    how = f"after {first.iterations} {noun} and {first.spent:.2f} s of its own" if first.entrant.solver else "a given map"
    return f"Over. {first.label} came lowest: mean distortion {mean:.6g}, {how}."


def _held(record: RaceRecord, mesh: Mesh) -> Floats:
    energies, errors = record.history.column("energy"), record.history.column("anchor_error")
    return np.where(errors <= ANCHOR_TOLERANCE * mesh.diameter, energies, np.nan)
