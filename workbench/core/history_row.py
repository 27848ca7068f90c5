"""A line of the history of a run."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class HistoryRow:
    """One line of the history: the map after `iteration` steps, `seconds` after the start."""

    iteration: int
    seconds: float
    energy: float
    mean_distortion: float
    gradient_norm: float
    step_size: float
    inverted: int
    anchor_error: float
