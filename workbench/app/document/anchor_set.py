"""Anchors as the window holds them: an immutable set of vertices with targets."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from workbench.core.arrays import Booleans, Floats, Integers, frozen


@dataclass(frozen=True)
class AnchorSet:
    """Vertices and their targets, in the order in which they were set.

    `targets` : vertex -> coordinates of its target (a tuple of d numbers)
    `groups` : vertex -> number of the group that it moves with; those without one move alone
    `weights` : vertex -> weight of the penalty |x - target|^2 of a soft anchor; those without one are hard
    `off` : vertices of those that are switched off: they keep what they have, and hold nothing
    """

    targets: dict[int, tuple[float, ...]]
    groups: dict[int, int] = field(default_factory=dict)
    weights: dict[int, float] = field(default_factory=dict)
    off: frozenset[int] = frozenset()

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
        return cls(dict(zip(vertices.tolist(), map(tuple, targets.tolist()), strict=True)))

    def __len__(self) -> int:
        return len(self.targets)

    def __contains__(self, vertex: int) -> bool:
        return vertex in self.targets

    def with_target(self, vertex: int, target: Iterable[float]) -> AnchorSet:
        """The same with an anchor set or moved."""
        return self._retargeted({**self.targets, int(vertex): tuple(float(c) for c in target)})

    def moved(self, vertices: Integers, targets: Floats) -> AnchorSet:
        """The same with those of `vertices` (k,) that are anchors at other targets (k, d)."""
        rows = zip(vertices.tolist(), targets.tolist(), strict=True)
        return self._retargeted(self.targets | {v: tuple(t) for v, t in rows if v in self.targets})

    def _retargeted(self, targets: dict[int, tuple[float, ...]]) -> AnchorSet:
        """The same with other targets; arrays that do not change are kept where the vertices stay."""
        found = replace(self, targets=targets)
        if len(targets) == len(self.targets):
            kept = ("vertices", "group_numbers", "weight_array", "is_soft", "is_off")
            found.__dict__.update({name: self.__dict__[name] for name in kept if name in self.__dict__})
        return found

    def joined(self, other: AnchorSet) -> AnchorSet:
        """Both sets; where both have a vertex, all that this one says of it holds."""
        new = other.without(*self.targets)
        return AnchorSet(
            {**other.targets, **self.targets},
            {**new.groups, **self.groups},
            {**new.weights, **self.weights},
            new.off | self.off,
        )

    def without(self, *vertices: int) -> AnchorSet:
        gone = set(vertices)
        return AnchorSet(
            {v: t for v, t in self.targets.items() if v not in gone},
            {v: g for v, g in self.groups.items() if v not in gone},
            {v: w for v, w in self.weights.items() if v not in gone},
            self.off - gone,
        )

    def at_vertex(self, old: int, new: int) -> AnchorSet:
        """The same with the anchor of one vertex at another, which has none yet, in the same place of the order."""

        def named(vertex: int) -> int:
            return new if vertex == old else vertex

        return AnchorSet(
            {named(v): t for v, t in self.targets.items()},
            {named(v): g for v, g in self.groups.items()},
            {named(v): w for v, w in self.weights.items()},
            frozenset(map(named, self.off)),
        )

    # ------------------------------------------------------------------------------------------ weights, on and off

    def weighted(self, vertices: Iterable[int], weight: float) -> AnchorSet:
        """Those of `vertices` that are anchors get a weight; inf makes them hard."""
        chosen = [v for v in vertices if v in self.targets]
        if math.isinf(weight):
            hardened = set(chosen)
            return replace(self, weights={v: w for v, w in self.weights.items() if v not in hardened})
        return replace(self, weights=self.weights | dict.fromkeys(chosen, weight))

    def switched(self, vertices: Iterable[int], *, on: bool) -> AnchorSet:
        """Those of `vertices` that are anchors hold, or do not."""
        chosen = {v for v in vertices if v in self.targets}
        return replace(self, off=self.off - chosen if on else self.off | chosen)

    @cached_property
    def in_force(self) -> AnchorSet:
        """Those that are on."""
        return self.without(*self.off) if self.off else self

    # ------------------------------------------------------------------------------------------ groups

    def grouped(self, vertices: Integers) -> AnchorSet:
        """Those of `vertices` (k,) that are anchors move together from now on."""
        number = max(self.groups.values(), default=-1) + 1
        return self.in_group(vertices.tolist(), number)

    def in_group(self, vertices: Iterable[int], number: int) -> AnchorSet:
        """Those of `vertices` that are anchors move with the group of this number."""
        return replace(self, groups=self.groups | {v: number for v in vertices if v in self.targets})

    def ungrouped(self, vertices: Integers) -> AnchorSet:
        """Each of `vertices` (k,) moves alone from now on."""
        alone = set(vertices.tolist())
        return replace(self, groups={v: g for v, g in self.groups.items() if v not in alone})

    def together_with(self, vertices: Iterable[int]) -> Integers:
        """(k,) int64: anchors among `vertices` and all that move with them, in the order in which they were set."""
        is_chosen = np.isin(self.vertices, np.array(list(vertices), dtype=np.int64))
        numbers = self.group_numbers[is_chosen]
        return self.vertices[is_chosen | np.isin(self.group_numbers, numbers[numbers >= 0])]

    # ------------------------------------------------------------------------------------------ arrays

    def targets_of(self, vertices: Integers) -> Floats:
        """(k, d) float64: targets of some of the anchors."""
        return np.array([self.targets[v] for v in vertices.tolist()], dtype=np.float64)

    @cached_property
    def vertices(self) -> Integers:
        """(k,) int64"""
        return frozen(np.fromiter(self.targets, np.int64, len(self.targets)), np.int64)

    @cached_property
    def group_numbers(self) -> Integers:
        """(k,) int64, -1 for those that move alone"""
        return frozen(np.array([self.groups.get(v, -1) for v in self.targets], dtype=np.int64), np.int64)

    @cached_property
    def weight_array(self) -> Floats:
        """(k,) float64, inf for hard ones"""
        return frozen(np.array([self.weights.get(v, math.inf) for v in self.targets], dtype=np.float64))

    @cached_property
    def is_soft(self) -> Booleans:
        """(k,) which have a weight"""
        return np.isfinite(self.weight_array)

    @cached_property
    def is_off(self) -> Booleans:
        """(k,) which are switched off"""
        return np.array([v in self.off for v in self.targets], dtype=bool)

    @cached_property
    def _target_array(self) -> Floats:
        return frozen(np.array(list(self.targets.values()), dtype=np.float64))

    def target_array(self, dimension: int) -> Floats:
        """(k, d) float64"""
        return self._target_array.reshape(len(self.targets), dimension)
