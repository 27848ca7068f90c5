"""As-rigid-as-possible start."""

from dataclasses import dataclass
from typing import Literal

from workbench.api import Distortion, Floats, Initializer, Problem, StartRequest, WorkbenchError, parameter, rigid_map

FIRST = {"parameterize": "lscm", "plane": "rest", "volume": "rest"}


@dataclass(frozen=True)
class RigidStart(Initializer):
    """Rotations and linear solves in turn from another start: hard anchors at their targets, all else as rigid as it can be.

    Simplices may come out inverted: nothing bounds the steps.
    """

    id = "arap-start"
    label = "As rigid as possible (local/global)"
    citation = "Liu, Zhang, Xu, Gotsman, Gortler 2008 [LX*08]"

    begin: Literal["auto", "lscm", "tutte", "rest", "volumetric-harmonic"] = parameter(
        "auto", "The start it begins from: for a surface lscm, or tutte; else rest, or volumetric-harmonic."
    )
    rounds: int = parameter(40, "At most so many rounds of rotations and solve.", minimum=1, maximum=10_000)

    def start(self, request: StartRequest) -> Floats:
        """Positions (n, d); raises `WorkbenchError` where the first start cannot be made."""
        assert request.make is not None
        kind = request.kind
        try:
            first = request.make(FIRST[kind] if self.begin == "auto" else self.begin)
        except WorkbenchError:
            if self.begin != "auto" or kind != "parameterize":
                raise
            first = request.make("tutte")
        anchors = request.problem.anchors if request.problem is not None else None
        problem = Problem.create(request.mesh, kind, Distortion.resolve("arap"), anchors)
        return rigid_map(problem, first, self.rounds)
