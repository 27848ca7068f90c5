"""Between the choices of a session and the commands of the engine."""

from __future__ import annotations

from typing import Any

import numpy as np

from workbench.core.arrays import Floats
from workbench.engine.messages import LegBegun, SetAnchors, SetProblem, SetSolver, TakeUp
from workbench.session.journal import Leg
from workbench.session.session import Session


def leg_of(report: LegBegun) -> Leg:
    """What the engine told, as a session keeps it."""
    problem, solver, held = report.problem, report.solver, report.anchors
    choices = Session(
        distortion=problem.distortion,
        distortion_parameters=dict(problem.parameters),
        fixed_boundary=problem.fixed_boundary,
        allow_inversions=problem.allow_inversions,
        linear_equations=problem.equations,
        solver=solver.solver,
        solver_parameters=dict(solver.parameters),
        tolerance=report.tolerance,
        **({} if held is None else anchor_fields(held)),
    )
    return Leg(choices, report.origin, report.positions, 0, report.number, report.iteration)  # type: ignore[arg-type]


def anchor_fields(held: SetAnchors) -> dict[str, Any]:
    """The anchors of a command as fields of a session."""
    groups = held.anchors.groups
    return {
        "anchor_vertices": tuple(held.vertices.tolist()),
        "anchor_targets": tuple(map(tuple, held.targets.tolist())),
        "anchor_weights": tuple(held.weights.tolist()),
        "anchor_groups": tuple(groups.tolist()),
    }


def anchors_command(session: Session, dimension: int, serial: int = 0) -> SetAnchors:
    """The anchors of a session that are in force, for the engine."""
    session = session.in_force
    count = len(session.anchor_vertices)
    return SetAnchors(
        np.array(session.anchor_vertices, dtype=np.int64),
        np.array(session.anchor_targets, dtype=np.float64).reshape(count, dimension),
        np.array(session.anchor_weights or (np.inf,) * count, dtype=np.float64),
        serial=serial,
        groups=np.array(session.anchor_groups or (-1,) * count, dtype=np.int64),
    )


def problem_command(session: Session, serial: int = 0) -> SetProblem:
    """The distortion of a session, and what is held and allowed, for the engine."""
    parameters = dict(session.distortion_parameters)
    held, allowed, equations = session.fixed_boundary, session.allow_inversions, session.linear_equations
    return SetProblem(session.distortion, parameters, held, allowed, equations, serial)


def solver_command(session: Session) -> SetSolver:
    """The solver of a session for the engine."""
    return SetSolver(session.solver, dict(session.solver_parameters))


def take_up(session: Session, positions: Floats, generation: int, serial: int = 0, problem_serial: int = 0) -> TakeUp:
    """The command that brings the engine to the choices of a session and a map (n, d)."""
    problem, solver = problem_command(session, problem_serial), solver_command(session)
    return TakeUp(generation, positions, problem, solver, anchors_command(session, positions.shape[1], serial))
