"""The best of the quick starts."""

from __future__ import annotations

from dataclasses import dataclass

from workbench.api import (
    Distortion,
    Floats,
    Initializer,
    Problem,
    StartRequest,
    WorkbenchError,
    best_start,
)

QUICK = ("rest", "tutte", "mean-value", "harmonic", "lscm")
"""Initializers that are tried: one linear system each, or none. What refuses the mesh, or fails on it, is passed over."""


@dataclass(frozen=True)
class Auto(Initializer):
    """Every quick start at the scale that suits the distortion: the one with fewest inverted simplices, then least energy."""

    id = "auto"
    label = "Best of the quick ones"
    citation = "section 4.3"

    def start(self, request: StartRequest) -> Floats:
        make = request.make
        assert make is not None
        problem = request.problem or Problem.create(request.mesh, request.kind, Distortion.resolve("symmetric-dirichlet"))
        starts: dict[str, Floats] = {}
        for id in QUICK:
            try:
                starts[id] = make(id)
            except WorkbenchError:
                continue
        return best_start(problem, starts)[0].positions
