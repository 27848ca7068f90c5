"""Steps while anchors lag behind their targets: predict with the last factor, correct, never invert.

(65) with the right-hand side b - A x: the free vertices move with the anchors. One solve with the last factor gives the next
map, so that a picture does not wait for a factorisation; a fresh one is made when the prediction has grown poor.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from workbench.core.anchor_motion import anchor_groups, next_displacement
from workbench.core.anchor_response import AnchorResponse, displacement_shapes
from workbench.core.arrays import Floats, Integers, frozen
from workbench.core.blocked_anchors import bounded_push, unblocked
from workbench.core.carried_step import carried_step
from workbench.core.energy import Evaluation
from workbench.core.line_search import SAFETY, armijo, largest_step
from workbench.core.linear_back_end import SingularMatrixError
from workbench.core.solver import energy_scale
from workbench.core.state import Approach, State
from workbench.core.status import Status
from workbench.core.turned_steps import turned_step

if TYPE_CHECKING:
    from workbench.core.problem import Problem

PREDICTED_RISE = 0.02
"""Part of the energy that a prediction may cost; a dearer one is left to a step that weighs it."""
LEAST_PREDICTION = 0.02
"""Part of the way below which a prediction is not worth its picture; the correction makes room first."""
POOR_CONTRACTION = 0.7
"""A prediction that leaves more than this part of the force is poor."""
PATIENCE = 40
"""Steps without progress, each after a relaxation, before the run counts as stalled."""
LEAST_PROGRESS = 1e-3
"""Part of the way left that a step has to go to count as progress."""
CHEAP_FACTORISATION = 0.030
"""Seconds; a factorisation below this is made whenever it helps."""
SETTLED = 1e-7
"""Relative gain below which corrections with the last factor stop until something moves."""
DUTY = 0.05
"""Part of the time that dearer factorisations may take while a hand moves."""


Renewal = Literal["eager", "rationed", "never"]
"""When a poor factor is made anew: at once; while a hand moves, dear ones seldom; not at all."""


def approach_anchors(problem: Problem, state: State, interrupt: Callable[[], bool], *, renewal: Renewal = "eager") -> State:
    """One step towards A x = b under the step bound.

    Where there is no factor for these anchors at all, one is made whatever `renewal` says.
    Returns the old positions with status INTERRUPTED when `interrupt` says so; STALLED, SINGULAR or NONFINITE on failure.
    """
    x = state.positions
    hard = problem.anchors.hard_vertices
    system = problem.system
    approach = state.approach
    if interrupt():
        return replace(state, status=Status.INTERRUPTED)
    displacement = next_displacement(x[hard], problem.anchors.hard_targets, _groups(problem))
    if renewal == "eager" and not approach.hold:
        walked = carried_step(problem, state) or turned_step(problem, state, displacement, _groups(problem))
        if walked is not None:
            return walked
    fresh = not system.serves(hard) or (approach.refresh and _renews(problem, renewal))
    if fresh:
        evaluation = problem.evaluate(x, 2)
        if not math.isfinite(evaluation.energy):
            return replace(state, status=Status.NONFINITE)
        if interrupt():
            return replace(state, status=Status.INTERRUPTED)
        assert evaluation.hessian_values is not None
        try:
            system.factorise(evaluation.hessian_values, hard)
        except SingularMatrixError:
            return replace(state, status=Status.SINGULAR)
    else:
        evaluation = _evaluation(problem, state)
    if interrupt():
        return replace(state, status=Status.INTERRUPTED)

    if approach.hold:
        return _relax(problem, state, evaluation.energy, evaluation.gradient, interrupt)

    constraints = problem.free_constraints
    residual = constraints.residual(x) if constraints is not None else None
    try:
        direction = system.solve(evaluation.gradient, displacement, constraints, residual)
    except SingularMatrixError:
        return replace(state, status=Status.SINGULAR)
    if not np.isfinite(direction).all():
        system.forget()
        return replace(state, status=Status.SINGULAR)

    def follow(rest: Floats) -> Floats:
        return system.solve(evaluation.gradient, rest, constraints, residual)

    _, direction = unblocked(problem, x, displacement, direction, _groups(problem), follow)
    with problem.workspace.timed("line_search"):
        return _push(problem, state, evaluation.energy, evaluation.gradient, direction, interrupt)


def moved_anchors(problem: Problem, state: State) -> Integers:
    """Rows (j,) of the hard anchors that are not at their targets."""
    anchors = problem.anchors
    displacement = np.abs(anchors.hard_targets - state.positions[anchors.hard_vertices]).max(axis=1, initial=0.0)
    return np.flatnonzero(displacement > 0.1 * problem.anchor_tolerance)


def shapes_ahead(problem: Problem, state: State, kept: AnchorResponse | None) -> Floats:
    """(k, r) shapes of the way that the hard anchors have before them: those of the `kept` response where they will do."""
    places = state.positions[problem.anchors.hard_vertices]
    displacement = next_displacement(places, problem.anchors.hard_targets, _groups(problem))
    if kept is not None and kept.parts(displacement) is not None:
        return kept.shapes
    return displacement_shapes(displacement, places, moved_anchors(problem, state), _groups(problem))


def predict_with_response(
    problem: Problem,
    state: State,
    interrupt: Callable[[], bool],
    respond: Callable[[Floats], Floats | None],
) -> State | None:
    """Carry the map along with anchors that moved, without a solve: the answer to a unit displacement is kept.

    What an event of the hand costs until the next picture; a correction comes after it. `respond` gives, for a displacement
    of the hard anchors (k, d), what `AnchorResponse.to` does, or None. Returns None where there is none, or where the step
    would gain nothing or cost too much energy.
    """
    x = state.positions
    hard = problem.anchors.hard_vertices
    displacement = next_displacement(x[hard], problem.anchors.hard_targets, _groups(problem))
    moved = moved_anchors(problem, state)
    if not len(moved) or problem.constraints is not None:  # the kept response knows nothing of A x = b
        return None
    direction = respond(displacement)
    if direction is None:
        return None
    displacement, direction = unblocked(problem, x, displacement, direction, _groups(problem), respond)
    moved = moved[displacement[moved].any(axis=1)]
    with problem.workspace.timed("line_search"):
        size, limiting = bounded_push(problem, x, direction)
        allowed = state.energy + PREDICTED_RISE * abs(state.energy)
        while size >= LEAST_PREDICTION:
            candidate = x + size * direction
            if size == 1.0:
                candidate[hard[moved]] = x[hard[moved]] + displacement[moved]
                _place_exactly(problem, candidate)
            energy, inverted = problem.energy_and_inverted(candidate)
            if energy <= allowed and not (inverted and state.inverted == 0):
                break
            size *= 0.5
        else:
            return None
    if interrupt():
        return None
    return replace(
        state,
        positions=candidate,
        iteration=state.iteration + 1,
        energy=energy,
        step_size=size,
        inverted=inverted,
        anchor_error=problem.anchor_error(candidate),
        status=Status.RUNNING,
        previous_energy=float("nan"),
        limiting_simplex=limiting,
        memory=None,
        approach=replace(state.approach, predicted=True, positions=None, evaluation=None),
    )


def respond_with_last_factor(problem: Problem, state: State) -> Callable[[Floats], Floats | None]:
    """What `predict_with_response` asks for, by the problem's own last factor; its answers to a few shapes are kept."""
    system = problem.system

    def respond(displacement: Floats) -> Floats | None:
        direction = system.kept_response.to(displacement) if system.kept_response is not None else None
        if direction is None:
            shapes = shapes_ahead(problem, state, None)
            system.kept_response = AnchorResponse(shapes, system.response(shapes))
            direction = system.kept_response.to(displacement)
        return direction

    return respond


def predict_with_last_factor(problem: Problem, state: State, interrupt: Callable[[], bool]) -> State | None:
    """`predict_with_response` by the problem's own last factor; never twice in a row without a correction in between."""
    approach = state.approach
    if approach.predicted or approach.hold or not problem.system.serves(problem.anchors.hard_vertices):
        return None
    return predict_with_response(problem, state, interrupt, respond_with_last_factor(problem, state))


def apply_correction(problem: Problem, state: State, direction: Floats, gradient_norm: float) -> State:
    """Go down along a Newton direction that was computed for a slightly older map; the anchors stay where they are.

    `step_size` is 0 where the direction no longer descends.
    """
    x = state.positions
    first = 1.0
    with problem.workspace.timed("line_search"):
        energy = problem.energy_and_inverted(x)[0]
        if problem.forbids_inversions:
            first = min(1.0, SAFETY * largest_step(x, direction, problem.elements.simplices)[0])
        most, search = problem.most_inverted(state.inverted), problem.energy_and_inverted
        found = armijo(search, x, direction, energy, 0.0, first, lambda: False, trials=6, most_inverted=most)
    problem.workspace.counts["trials"] += found.trials
    return replace(
        state,
        positions=found.positions,
        iteration=state.iteration + (found.size > 0.0),
        energy=found.energy,
        gradient_norm=gradient_norm,
        step_size=found.size,
        inverted=found.inverted if found.size else state.inverted,
        status=Status.RUNNING,
        previous_energy=energy if found.size else float("nan"),
        memory=None,
        approach=Approach(stuck=state.approach.stuck),
    )


def correct_with_last_factor(
    problem: Problem, state: State, interrupt: Callable[[], bool], *, renewal: Renewal = "rationed"
) -> State:
    """A descent step with the last factor while a hand holds still for a moment; `step_size` 0 where it gains nothing.

    A fresh factor is made only where it is missing, or poor and affordable.
    """
    x, system = state.positions, problem.system
    fresh = not system.serves(problem.anchors.hard_vertices) or (state.approach.refresh and _renews(problem, renewal))
    evaluation = problem.evaluate(x, 2) if fresh else _evaluation(problem, state)
    if not math.isfinite(evaluation.energy):
        return replace(state, status=Status.NONFINITE)
    if evaluation.hessian_values is not None:
        try:
            system.factorise(evaluation.hessian_values, problem.anchors.hard_vertices)
        except SingularMatrixError:
            return replace(state, status=Status.SINGULAR)
    following = _relax(problem, state, evaluation.energy, evaluation.gradient, interrupt)
    gain = evaluation.energy - following.energy
    if following.status is Status.RUNNING and gain <= SETTLED * abs(evaluation.energy):
        following = replace(following, step_size=0.0)
    return replace(following, approach=replace(state.approach, refresh=following.step_size < 0.5, predicted=False))


def _push(
    problem: Problem,
    state: State,
    energy: float,
    gradient: Floats,
    direction: Floats,
    interrupt: Callable[[], bool],
) -> State:
    x = state.positions
    hard = problem.anchors.hard_vertices
    size, limiting = bounded_push(problem, x, direction)
    clean = state.inverted == 0 and problem.forbids_inversions
    slope = float(np.einsum("ij,ij->", gradient, direction))
    anchor_force, work = problem.system.anchor_forces(direction)
    free_gradient = gradient.copy()
    free_gradient[hard] = 0.0
    force = free_gradient + anchor_force
    # H d = -gradient on the free vertices, so d . H d needs the rows of the anchors alone. The rise that dragging costs by
    # this model is what a step may cost; one that rises far more has left the model's range.
    curvature = work - float(np.einsum("ij,ij->", free_gradient, direction))
    rise = max(slope, 0.0) + 0.5 * max(curvature, 0.0)
    after, slight = None, 0.02 * energy_scale(problem, energy)
    # Less than that is no progress, and would only press what is in the way flat: the map gives way first, or never does.
    for _ in range(12 if size >= LEAST_PROGRESS else 0):
        if interrupt():
            return replace(state, status=Status.INTERRUPTED)
        candidate = x + size * direction
        if size == 1.0:
            _place_exactly(problem, candidate)
        problem.workspace.counts["trials"] += 1
        after = problem.evaluate(candidate, 1)
        allowed = energy + max(4.0 * size * rise, slight)
        if math.isfinite(after.energy) and not (clean and after.inverted) and after.energy <= allowed:
            break
        size *= 0.5
    else:
        size, candidate, after = 0.0, x, Evaluation(energy, state.inverted, gradient)
    error = problem.anchor_error(candidate)
    before, now = _way_left(problem, x), _way_left(problem, candidate)
    goes_on = error < (1.0 - LEAST_PROGRESS) * state.anchor_error or now < (1.0 - LEAST_PROGRESS) * before
    stuck = 0 if goes_on else state.approach.stuck + 1
    if stuck > PATIENCE:
        return replace(state, status=Status.STALLED, limiting_simplex=limiting)
    gradient_norm = problem.free_gradient_norm(after.gradient)
    poor = size < 0.5 or gradient_norm > POOR_CONTRACTION * float(np.linalg.norm(force))
    candidate = frozen(candidate)
    return replace(
        state,
        positions=candidate,
        iteration=state.iteration + 1,
        energy=after.energy,
        gradient_norm=gradient_norm,
        step_size=size,
        inverted=after.inverted,
        anchor_error=error,
        status=Status.RUNNING,
        previous_energy=float("nan"),
        limiting_simplex=limiting,
        memory=None,
        approach=Approach(refresh=poor, hold=size < 0.1, stuck=stuck, positions=candidate, evaluation=after),
    )


def _way_left(problem: Problem, positions: Floats) -> float:
    """Sum of the distances of the hard anchors from their targets: it falls while some go on although the worst one cannot."""
    offset = positions[problem.anchors.hard_vertices] - problem.anchors.hard_targets
    return float(np.linalg.norm(offset, axis=1).sum())


def _relax(problem: Problem, state: State, energy: float, gradient: Floats, interrupt: Callable[[], bool]) -> State:
    """A Newton step with the anchors held where they are, along A x = const: it makes room for the next push."""
    x, constraints = state.positions, problem.free_constraints
    still = None if constraints is None else np.zeros(len(constraints.values))
    try:
        direction = problem.system.solve(gradient, None, constraints, still)
    except SingularMatrixError:
        return replace(state, status=Status.SINGULAR)
    slope = float(np.einsum("ij,ij->", gradient, direction))
    first = 1.0
    if problem.forbids_inversions:
        first = min(1.0, SAFETY * largest_step(x, direction, problem.elements.simplices)[0])
    with problem.workspace.timed("line_search"):
        most = problem.most_inverted(state.inverted)
        found = armijo(problem.energy_and_inverted, x, direction, energy, slope, first, interrupt, most_inverted=most)
    problem.workspace.counts["trials"] += found.trials
    if found.interrupted:
        return replace(state, status=Status.INTERRUPTED)
    relaxed = found.size == 0.0 or energy - found.energy <= 1e-3 * abs(energy)
    return replace(
        state,
        positions=found.positions,
        iteration=state.iteration + 1,
        energy=found.energy,
        gradient_norm=problem.free_gradient_norm(gradient),
        step_size=found.size,
        inverted=found.inverted if found.size else state.inverted,
        anchor_error=problem.anchor_error(found.positions),
        status=Status.RUNNING,
        previous_energy=float("nan"),
        memory=None,
        approach=replace(state.approach, refresh=True, hold=not relaxed),
    )


def _evaluation(problem: Problem, state: State) -> Evaluation:
    """Energy and gradient at the current map, from the end of the step before where that was a walk of anchors too."""
    approach = state.approach
    if approach.evaluation is not None and approach.positions is state.positions:
        return approach.evaluation
    return problem.evaluate(state.positions, 1)


def _place_exactly(problem: Problem, candidate: Floats) -> None:
    """Put anchors that arrive on their targets to the last bit."""
    hard, targets = problem.anchors.hard_vertices, problem.anchors.hard_targets
    arrives = np.abs(candidate[hard] - targets).max(axis=1, initial=0.0) <= 1e-6 * problem.anchor_tolerance + 1e-12 * (
        np.abs(targets).max(initial=0.0)
    )
    candidate[hard[arrives]] = targets[arrives]


def _groups(problem: Problem) -> list[np.ndarray]:
    hard, numbers = problem.anchors.hard_vertices, problem.anchors.hard_groups
    key = hard.tobytes() + numbers.tobytes()
    cached = problem.workspace.groups
    if cached is None or cached[0] != key:
        cached = (key, anchor_groups(problem.elements.simplices, hard, numbers))
        problem.workspace.groups = cached
    return cached[1]


def _renews(problem: Problem, renewal: Renewal) -> bool:
    """Whether a poor factor is made anew now; rationed: where that keeps the pictures coming."""
    if renewal != "rationed":
        return renewal == "eager"
    system = problem.system
    cost = system.last_factorisation_seconds
    since = time.perf_counter() - system.factorised_at
    return cost <= CHEAP_FACTORISATION or since * DUTY >= cost
