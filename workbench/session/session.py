"""Everything that a user chose, in one immutable object."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

ANCHORS = ("anchor_vertices", "anchor_targets", "anchor_weights", "anchor_groups")
"""Fields that have an entry an anchor."""


@dataclass(frozen=True)
class Session:
    """The choices that make a run: the same in the window and on the command line.

    `source` is a path or `sample:ID`; empty strings stand for the default of the kind of map.
    Anchors are tuples, so that sessions compare by value: weights are inf for hard anchors, groups -1 for those that move
    alone (see `workbench.core.constraints.Anchors`). `anchors_off` are vertices of anchors that are kept and hold nothing.
    `linear_equations` bind coordinates of the map (see `workbench.core.linear_equations`). `carried` is the surface that a
    solid takes along.
    """

    source: str = ""
    kind: str = "auto"
    fixes: tuple[str, ...] = ()
    distortion: str = "symmetric-dirichlet"
    distortion_parameters: dict[str, float] = field(default_factory=dict)
    solver: str = "fast"
    solver_parameters: dict[str, Any] = field(default_factory=dict)
    initializer: str = ""
    initializer_parameters: dict[str, Any] = field(default_factory=dict)
    start_file: str = ""
    match_area: bool = True
    fixed_boundary: bool = False
    allow_inversions: bool = False
    anchor_vertices: tuple[int, ...] = ()
    anchor_targets: tuple[tuple[float, ...], ...] = ()
    anchor_weights: tuple[float, ...] = ()
    anchor_groups: tuple[int, ...] = ()
    linear_equations: tuple[str, ...] = ()
    anchors_off: frozenset[int] = frozenset()
    carried: str = ""
    iterations: int = 1000
    tolerance: float = 1e-6
    time_limit: float = float("inf")

    @property
    def in_force(self) -> Session:
        """The same without the anchors that are switched off."""
        if not self.anchors_off:
            return self
        rows = [row for row, vertex in enumerate(self.anchor_vertices) if vertex not in self.anchors_off]
        columns = {name: getattr(self, name) for name in ANCHORS}
        kept: dict[str, Any] = {name: tuple(values[row] for row in rows) for name, values in columns.items() if values}
        return replace(self, **kept, anchors_off=frozenset())
