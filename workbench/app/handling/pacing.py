"""How far a turn may go ahead of the map."""

from __future__ import annotations

import math

import numpy as np

from workbench.app.handling.motion import Motion
from workbench.core.arrays import Floats

AHEAD = 1.2
"""Radians; from half a turn on the map would come after the other way round."""


class TurnPacer:
    """Watches how far a group has turned; whole turns are counted.

    `start` : (k, d) float64     where the group was when it was taken up
    """

    def __init__(self, start: Floats) -> None:
        self._start = start
        self._axis: Floats = np.zeros(3)
        self._reached = 0.0

    def part(self, motion: Motion, places: Floats) -> float:
        """Part of a turn, in [0, 1], that may be asked for while the group is at `places` (k, d)."""
        if not motion.angle:
            return 1.0
        axis = motion.turn / motion.angle
        if axis @ self._axis < 0.0:  # back over the beginning: the same angle is counted the other way
            self._reached = -self._reached
        self._axis = axis
        angle = turned_angle(self._start, places, axis)
        self._reached += (angle - self._reached + math.pi) % (2.0 * math.pi) - math.pi
        return float(np.clip((self._reached + AHEAD) / motion.angle, 0.0, 1.0))


def turned_angle(before: Floats, after: Floats, axis: Floats) -> float:
    """Radians in (-pi, pi] by which points (k, d) have turned about an axis (3,) of length 1, in the mean."""
    arms = np.zeros((2, len(before), 3))
    for arm, points in zip(arms, (before, after), strict=True):
        arm[:, : points.shape[1]] = points - points.mean(axis=0)
        arm -= np.outer(arm @ axis, axis)
    sine = float(np.cross(arms[0], arms[1]).sum(axis=0) @ axis)
    return math.atan2(sine, float((arms[0] * arms[1]).sum()))
