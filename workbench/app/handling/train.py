"""Which anchors go along when some are held, and how far: what is near, and the mirror images."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from workbench.app.document.anchor_set import AnchorSet
from workbench.app.handling.motion import Motion
from workbench.app.handling.reflection import Reflection
from workbench.core.arrays import Floats, Integers


@dataclass(frozen=True, eq=False)
class Train:
    """Anchors that move, from where they were.

    `vertices` (k,), `places` (k, d) before;  `shares` (k,) in [0, 1]: what part of the motion each makes;
    `mirrored` (k,): what part of the mirror image of the motion, about `reflection`
    """

    vertices: Integers
    places: Floats
    shares: Floats
    mirrored: Floats
    reflection: Reflection | None = None

    @classmethod
    def of(cls, anchors: AnchorSet, vertices: Integers) -> Train:
        """Those that are held alone."""
        return cls(vertices, anchors.targets_of(vertices), np.ones(len(vertices)), np.zeros(len(vertices)))

    def after(self, motion: Motion) -> Floats:
        """(k, d) places afterwards; who makes both the motion and its mirror image goes between the two."""
        if self.reflection is None:
            return motion.of(self.places, self.shares)
        own = motion.of(self.places, self.shares) - self.places
        image = self.reflection.of(motion.of(self.reflection.of(self.places), self.mirrored)) - self.places
        image[self.mirrored == 0.0] = 0.0  # not even by a rounding
        return np.asarray(self.places + (own + image) / np.maximum(1.0, self.shares + self.mirrored)[:, None])


def falloff(distances: Floats, radius: float) -> Floats:
    """(k,) share of a motion at distances (k,) from what is held: 1 there, 0 at the radius, smooth between."""
    if not radius > 0.0:
        return np.where(distances > 0.0, 0.0, 1.0)
    within = np.clip(1.0 - (distances / radius) ** 2, 0.0, 1.0)
    return np.asarray(within**2)
