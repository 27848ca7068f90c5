"""Which choices of a session go to the engine by which command, and what they go back to where it refuses them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from workbench.engine.messages import Refused, SetProblem
from workbench.session.session import Session

PROBLEM_FIELDS = {"distortion", "distortion_parameters", "fixed_boundary", "allow_inversions", "linear_equations"}
SOLVER_FIELDS = {"solver", "solver_parameters"}
START_FIELDS = {"initializer", "initializer_parameters", "start_file", "match_area"}
REFUSABLE = {"SetProblem": PROBLEM_FIELDS, "SetSolver": SOLVER_FIELDS, "Reset": START_FIELDS}
"""Commands that the engine may refuse -> fields of the session that then go back to what they were."""
CARRIED_ALONG = {"SetSolver": {"initializer"}}
"""Fields that a choice of the user's writes down beside its own: the start in force is held where the solver changes."""


class EarlierChoices:
    """What the fields of a command were before it was sent."""

    def __init__(self) -> None:
        self._before: dict[str, dict[str, Any]] = {}

    def keep(self, session: Session, changes: Mapping[str, Any]) -> None:
        for command, fields in REFUSABLE.items():
            if fields & set(changes):
                names = fields | CARRIED_ALONG.get(command, set())
                self._before[command] = {name: getattr(session, name) for name in names}

    def keep_all(self, session: Session) -> None:
        self._before["TakeUp"] = dict(vars(session))

    def before_taking_up(self) -> Session:
        return Session(**self._before.pop("TakeUp", {}))

    def restored(self, session: Session, report: Refused) -> Session | None:
        """The session without what was refused; None where no choice was."""
        if report.kept is not None:
            return replace(session, **_fields(report.kept))
        if report.command in REFUSABLE:
            return replace(session, **self._before.pop(report.command, {}))
        return None


def _fields(kept: SetProblem) -> dict[str, Any]:
    return {
        "distortion": kept.distortion,
        "distortion_parameters": dict(kept.parameters),
        "fixed_boundary": kept.fixed_boundary,
        "allow_inversions": kept.allow_inversions,
        "linear_equations": kept.equations,
    }
