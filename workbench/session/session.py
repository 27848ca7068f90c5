"""Everything that a user chose, in one immutable object."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Session:
    """The choices that make a run: the same in the window and on the command line.

    `source` is a path or `sample:ID`; empty strings stand for the default of the kind of map.
    Anchors are tuples, so that sessions compare by value: weights are inf for hard anchors, groups -1 for those that move
    alone (see `workbench.core.constraints.Anchors`). `carried` is the surface that a solid takes along.
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
    carried: str = ""
    iterations: int = 1000
    tolerance: float = 1e-6
    time_limit: float = float("inf")
