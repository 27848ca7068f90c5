"""Anchors as the window holds them: an immutable set of vertices with targets."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from workbench.core.arrays import Floats, Integers


@dataclass(frozen=True)
class AnchorSet:
    """Vertices and their targets, in the order in which they were set. All anchors of the window are hard.

    `targets` : vertex -> coordinates of its target (a tuple of d numbers)
    """

    targets: dict[int, tuple[float, ...]]

    @classmethod
    def none(cls) -> AnchorSet:
        return cls({})

    @classmethod
    def at(cls, vertices: Iterable[int], positions: Floats) -> AnchorSet:
        """Anchors that hold `vertices` where `positions` (n, d) has them."""
        return cls({int(v): tuple(float(c) for c in positions[v]) for v in vertices})

    @classmethod
    def to(cls, vertices: Integers, targets: Floats) -> AnchorSet:
        """Anchors with targets of their own: (k,) int64, (k, d) float64."""
        pairs = zip(vertices.tolist(), targets.tolist(), strict=True)
        return cls({int(v): tuple(target) for v, target in pairs})

    def __len__(self) -> int:
        return len(self.targets)

    def __contains__(self, vertex: int) -> bool:
        return vertex in self.targets

    def with_target(self, vertex: int, target: Iterable[float]) -> AnchorSet:
        """The same with an anchor set or moved."""
        return AnchorSet({**self.targets, int(vertex): tuple(float(c) for c in target)})

    def joined(self, other: AnchorSet) -> AnchorSet:
        """Both sets; where both have a vertex, this one's target holds."""
        return AnchorSet({**other.targets, **self.targets})

    def without(self, vertex: int) -> AnchorSet:
        return AnchorSet({v: t for v, t in self.targets.items() if v != vertex})

    @property
    def vertices(self) -> Integers:
        """(k,) int64"""
        return np.fromiter(self.targets, np.int64, len(self.targets))

    def target_array(self, dimension: int) -> Floats:
        """(k, d) float64"""
        return np.array(list(self.targets.values()), dtype=np.float64).reshape(len(self.targets), dimension)
