"""Every registered solver keeps every law; a solver that is wrong in one way breaks the law of it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from workbench.core.descent import descend
from workbench.core.descent_solver import DescentSolver, direction_in_laplacian
from workbench.core.registry import registry
from workbench.core.solver import never
from workbench.core.solver_laws import LAWS, try_law
from workbench.core.status import Status


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("id", sorted(registry().solvers))
def test_every_registered_solver_keeps_every_law(id, law):
    finding = try_law(registry().solvers[id](), LAWS[law])
    assert finding.holds, f"{finding.case}: {finding.sentence}"
    assert finding.cases >= 6  # two kinds of map at least, with anchors and without


@dataclass(frozen=True)
class Right(DescentSolver):
    """Descent in the metric of the source's Laplacian, as it should be."""

    id = "right"
    label = "Right"

    def advance(self, problem, state, evaluation, interrupt):
        direction = direction_in_laplacian(problem, evaluation.gradient)
        return descend(problem, state, evaluation, direction, interrupt)


class WritesIntoItsInput(Right):
    def step(self, problem, state, interrupt=never):
        following = super().step(problem, state, interrupt)
        state.positions.setflags(write=True)
        state.positions[0] += 1e-12
        return following


class DrawsLots(Right):
    def advance(self, problem, state, evaluation, interrupt):
        shaken = replace(evaluation, gradient=evaluation.gradient * np.random.default_rng().uniform(0.99, 1.01))
        return super().advance(problem, state, shaken, interrupt)


class Climbs(Right):
    def advance(self, problem, state, evaluation, interrupt):
        return moved(problem, state, -1e-3 * direction_in_laplacian(problem, evaluation.gradient))


class Boasts(Right):
    def step(self, problem, state, interrupt=never):
        following = super().step(problem, state, interrupt)
        return replace(following, energy=following.energy * (1 - 1e-6))


class Leaps(Right):
    def advance(self, problem, state, evaluation, interrupt):
        return moved(problem, state, 20 * direction_in_laplacian(problem, evaluation.gradient))


class IsDeaf(Right):
    def step(self, problem, state, interrupt=never):
        return super().step(problem, state, never)


class HearsLate(Right):
    def step(self, problem, state, interrupt=never):
        following = super().step(problem, state, interrupt)
        if following.status is Status.RUNNING:
            for _ in range(5):
                problem.energy(state.positions)
        return following


class StopsElsewhere(Right):
    def step(self, problem, state, interrupt=never):
        following = super().step(problem, state, interrupt)
        if following.status is Status.INTERRUPTED:
            return replace(following, positions=state.positions * 1.001)
        return following


class ForgetsAnchors(Right):
    def step(self, problem, state, interrupt=never):
        held = problem.anchors.hard_vertices
        near = problem.with_anchors(type(problem.anchors)(held, state.positions[held])) if len(held) else problem
        following = super().step(near, state, interrupt)
        return replace(following, anchor_error=problem.anchor_error(following.positions))


class CallsFailureSuccess(Right):
    def step(self, problem, state, interrupt=never):
        following = super().step(problem, state, interrupt)
        return replace(following, status=Status.CONVERGED) if following.status is Status.NO_DESCENT else following


class PassesOnNaN(Right):
    def step(self, problem, state, interrupt=never):
        if problem.anchors_lag(state.positions):
            return super().step(problem, state, interrupt)
        return moved(problem, state, -1e-3 * problem.evaluate(state.positions).gradient)


class TakesAnyStart(Right):
    def init(self, problem, positions):
        return replace(super().init(problem, positions), status=Status.RUNNING)


class KeepsItsOldEnergy(Right):
    def rebase(self, problem, state):
        fresh = super().rebase(problem, state)
        known = np.isfinite(state.energy)
        return replace(fresh, anchor_error=state.anchor_error, energy=state.energy) if known else fresh


class NeverEnds(Right):
    def terminate(self, problem, state):
        return Status.RUNNING


class Raises(Right):
    def advance(self, problem, state, evaluation, interrupt):
        raise ZeroDivisionError("by nothing")


def moved(problem, state, direction):
    """A state at another map, without a line search."""
    positions = state.positions + direction
    energy, inverted = problem.energy_and_inverted(positions)
    error = problem.anchor_error(positions)
    following = replace(state, positions=positions, energy=energy, inverted=inverted, anchor_error=error)
    return replace(following, iteration=state.iteration + 1, previous_energy=state.energy, memory=None)


WRONG = [
    (WritesIntoItsInput, "inputs-unchanged", "changed the positions"),
    (DrawsLots, "deterministic", "second run"),
    (Climbs, "energy-never-rises", "the energy rose from"),
    (Boasts, "states-tell-the-truth", "the state says energy"),
    (Leaps, "nothing-inverts", "inverted, none was"),
    (IsDeaf, "interrupt", "never asks"),
    (HearsLate, "interrupt", "without asking"),
    (StopsElsewhere, "interrupt", "did not return the old map"),
    (ForgetsAnchors, "anchors-reached", "away from its target"),
    (CallsFailureSuccess, "failed-search", "CONVERGED"),
    (PassesOnNaN, "non-finite", "not finite"),
    (TakesAnyStart, "inverted-start", "mirrored start"),
    (KeepsItsOldEnergy, "rebase", "`rebase` says"),
    (NeverEnds, "minimum", "MAX_ITERATIONS"),
    (Raises, "deterministic", "by nothing"),
]


@pytest.mark.parametrize("law", LAWS)
def test_the_model_of_the_wrong_ones_is_right(law):
    finding = try_law(Right(), LAWS[law])
    assert finding.holds, f"{finding.case}: {finding.sentence}"


@pytest.mark.parametrize(("wrong", "law", "words"), WRONG, ids=lambda item: getattr(item, "__name__", None))
def test_a_wrong_solver_is_caught(wrong, law, words):
    finding = try_law(wrong(), LAWS[law])
    assert not finding.holds
    assert words in finding.sentence
    assert "simplices" in finding.case  # the mesh is named


class LeapsHonestly(Right):
    def step(self, problem, state, interrupt=never):
        if problem.anchors_lag(state.positions):
            return super().step(problem, state, interrupt)
        far = replace(state, positions=state.positions - problem.gradient(state.positions))
        return replace(self.rebase(problem, far), iteration=state.iteration + 1, previous_energy=state.energy)


def test_who_inverts_much_but_counts_right_does_not_count_wrong():
    assert not try_law(LeapsHonestly(), LAWS["nothing-inverts"]).holds
    finding = try_law(LeapsHonestly(), LAWS["states-tell-the-truth"])
    assert finding.holds, finding.sentence


def test_every_law_has_a_solver_that_breaks_it():
    assert {law for _, law, _ in WRONG} == set(LAWS)
