"""Anchors as the window holds them: an immutable set of vertices with targets."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

import numpy as np

from workbench.core.arrays import Floats, Integers


@dataclass(frozen=True)
class AnchorSet:
    """Vertices and their targets, in the order in which they were set. All anchors of the window are hard.

    `targets` : vertex -> coordinates of its target (a tuple of d numbers)
    `groups` : vertex -> number of the group that it moves with; those without one move alone
    """

    targets: dict[int, tuple[float, ...]]
    groups: dict[int, int] = field(default_factory=dict)

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
        return replace(self, targets={**self.targets, int(vertex): tuple(float(c) for c in target)})

    def moved(self, vertices: Integers, targets: Floats) -> AnchorSet:
        """The same with those of `vertices` (k,) that are anchors at other targets (k, d)."""
        rows = zip(vertices.tolist(), targets.tolist(), strict=True)
        return replace(self, targets=self.targets | {v: tuple(t) for v, t in rows if v in self.targets})

    def joined(self, other: AnchorSet) -> AnchorSet:
        """Both sets; where both have a vertex, this one's target and group hold."""
        return AnchorSet({**other.targets, **self.targets}, {**other.groups, **self.groups})

    def without(self, *vertices: int) -> AnchorSet:
        gone = set(vertices)
        return AnchorSet(
            {v: t for v, t in self.targets.items() if v not in gone}, {v: g for v, g in self.groups.items() if v not in gone}
        )

    # ------------------------------------------------------------------------------------------ groups

    def grouped(self, vertices: Integers) -> AnchorSet:
        """Those of `vertices` (k,) that are anchors move together from now on."""
        number = max(self.groups.values(), default=-1) + 1
        return replace(self, groups=self.groups | {v: number for v in vertices.tolist() if v in self.targets})

    def ungrouped(self, vertices: Integers) -> AnchorSet:
        """Each of `vertices` (k,) moves alone from now on."""
        alone = set(vertices.tolist())
        return replace(self, groups={v: g for v, g in self.groups.items() if v not in alone})

    def group_of(self, vertex: int) -> Integers:
        """(k,) int64: the anchors that move with a vertex, itself among them; none where it is no anchor."""
        if vertex not in self.targets:
            return np.empty(0, np.int64)
        number = self.groups.get(vertex)
        if number is None:
            return np.array([vertex], dtype=np.int64)
        return np.array([v for v in self.targets if self.groups.get(v) == number], dtype=np.int64)

    def targets_of(self, vertices: Integers) -> Floats:
        """(k, d) float64: targets of some of the anchors."""
        return np.array([self.targets[v] for v in vertices.tolist()], dtype=np.float64)

    @property
    def vertices(self) -> Integers:
        """(k,) int64"""
        return np.fromiter(self.targets, np.int64, len(self.targets))

    @property
    def group_numbers(self) -> Integers:
        """(k,) int64, -1 for those that move alone"""
        return np.array([self.groups.get(v, -1) for v in self.targets], dtype=np.int64)

    def target_array(self, dimension: int) -> Floats:
        """(k, d) float64"""
        return np.array(list(self.targets.values()), dtype=np.float64).reshape(len(self.targets), dimension)
