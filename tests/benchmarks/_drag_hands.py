"""Scripted hands: which anchors they hold, and where those are to be at any time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation


@dataclass(frozen=True, eq=False)
class ScriptedHand:
    """Anchors `vertices` (k,), all hard; `at` says where they are to be (k, d) after so many seconds.

    `held` (j,) are the rows that the hand moves
    """

    vertices: np.ndarray
    held: np.ndarray
    at: Callable[[float], np.ndarray]


def wild_path(start: np.ndarray, diameter: float, seconds: float) -> np.ndarray:
    """Target of a hand at `seconds`: loops of several speeds, up to a third of the diameter away; `start` (d,)."""
    t = seconds
    offset = np.array(
        [
            0.22 * np.sin(2.1 * t) + 0.10 * np.sin(7.3 * t + 1.0) - 0.10 * np.sin(1.0),
            0.22 * np.sin(1.3 * t) + 0.10 * np.sin(9.1 * t),
            0.15 * np.sin(1.7 * t) + 0.08 * np.sin(8.3 * t),
        ]
    )
    return start + diameter * offset[: len(start)]


def corner_hand(positions: np.ndarray, diameter: float) -> ScriptedHand:
    """Extreme vertices are anchored, the first of them is dragged along the wild path."""
    d = positions.shape[1]
    directions = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
    if d == 3:
        directions = np.concatenate([np.c_[directions, np.full(4, side)] for side in (1.0, -1.0)])
    vertices = np.unique((positions @ directions.T).argmax(axis=0))[::-1]
    start = positions[vertices]

    def at(seconds: float) -> np.ndarray:
        targets = start.copy()
        targets[0] = wild_path(start[0], diameter, seconds)
        return targets

    return ScriptedHand(vertices, np.array([0]), at)


def end_hand(positions: np.ndarray, diameter: float, *, jumps: bool = True) -> ScriptedHand:
    """Both ends of a bar along x are anchored; the far one moves along the wild path, turns about itself, and, with
    `jumps`, is thrown somewhere else once a second, now and then right through the body."""
    x = positions[:, 0]
    near, far = np.flatnonzero(x <= x.min() + 1e-9), np.flatnonzero(x >= x.max() - 1e-9)
    vertices = np.concatenate([near, far])
    start = positions[vertices]
    held = np.arange(len(near), len(vertices))
    centre = start[held].mean(axis=0)
    throws = np.random.default_rng(7).uniform(-1.0, 1.0, (1000, positions.shape[1]))

    def at(seconds: float) -> np.ndarray:
        place = wild_path(centre, 0.6 * diameter, seconds)
        if jumps:
            thrown = throws[int(seconds)]
            place = place + 0.25 * diameter * thrown
            if int(seconds) % 4 == 3:  # through the body and out on the other side
                place = place - np.eye(len(centre))[0] * 1.1 * diameter * (1.0 - abs(2.0 * (seconds % 1.0) - 1.0))
        turn = Rotation.from_rotvec([1.6 * np.sin(1.1 * seconds), 0.8 * np.sin(1.9 * seconds), 0.7 * np.sin(2.3 * seconds)])
        if positions.shape[1] == 2:
            turn = Rotation.from_rotvec([0.0, 0.0, 1.6 * np.sin(1.1 * seconds)])
        body = np.zeros((len(held), 3))
        body[:, : len(centre)] = start[held] - centre
        targets = start.copy()
        targets[held] = place + turn.apply(body)[:, : len(centre)]
        return targets

    return ScriptedHand(vertices, held, at)
