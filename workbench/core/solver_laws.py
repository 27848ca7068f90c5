"""The laws that every solver keeps, each as a function that tries a solver on a small problem.

A law returns the empty text where it holds, and else one sentence with the step and the numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, replace
from itertools import pairwise

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.constraints import Anchors
from workbench.core.guarded_step import SolverFaultError
from workbench.core.problem import Criteria, Problem
from workbench.core.run import run
from workbench.core.solver import Solver
from workbench.core.solver_cases import SolverCase, UndefinedEnergy, WalledEnergy, cases_for, with_energy
from workbench.core.state import State
from workbench.core.status import Status

Check = Callable[[Solver, SolverCase], str]

STEPS = 3
"""Steps after which inputs and repetition are looked at."""
LONG = 40
"""Steps of a run whose every map is looked at."""
REACH = 300
"""Steps in which anchors have to be reached."""
SILENCE = {"energy": 2, "gradient": 2, "hessian": 2, "factorise": 1}
"""Computations after which a step has to ask whether to stop."""
ROUNDING = 1e-13


def inputs_unchanged(solver: Solver, case: SolverCase) -> str:
    """`step` changes none of its inputs."""
    problem = case.problem()
    state = solver.init(problem, case.start)
    arrays = {
        "the vertices of the mesh": problem.mesh.vertices,
        "the simplices": problem.mesh.simplices,
        "the rest measures": problem.elements.rest_measures,
        "the targets of the anchors": problem.anchors.targets,
    }
    before = {name: array.copy() for name, array in arrays.items()}
    for _ in range(STEPS):
        kept = {item.name: getattr(state, item.name) for item in fields(state)}
        positions = state.positions.copy()
        following = solver.step(problem, state)
        if not np.array_equal(state.positions, positions):
            far = np.abs(state.positions - positions).max()
            return f"step {state.iteration + 1} changed the positions of the state that it was given, by up to {far:.3g}."
        changed = [name for name, value in kept.items() if getattr(state, name) is not value]
        changed += [name for name, array in arrays.items() if not np.array_equal(array, before[name])]
        if changed:
            return f"step {state.iteration + 1} changed {changed[0]} of what it was given."
        state = following
    return ""


def deterministic(solver: Solver, case: SolverCase) -> str:
    """The same input gives the same output, bit for bit."""
    first, second = (_walk(solver, case.problem(), case.start, STEPS) for _ in range(2))
    for one, other in zip(first, second, strict=False):
        if not np.array_equal(one.positions, other.positions) or one.energy != other.energy:
            apart = np.abs(one.positions - other.positions).max()
            return (
                f"step {one.iteration}: a second run gave a map {apart:.3g} away and the energy {other.energy!r} "
                f"instead of {one.energy!r}."
            )
    return ""


def energy_never_rises(solver: Solver, case: SolverCase) -> str:
    """Once the anchors are in place, the energy does not rise."""
    problem, states = _run(solver, case)
    for before, after in pairwise(states):
        in_place = before.anchor_error <= problem.anchor_tolerance
        energies = problem.energy(before.positions), problem.energy(after.positions)
        if solver.monotone and in_place and not energies[1] <= energies[0] * (1 + ROUNDING) + ROUNDING:
            return f"step {after.iteration}: the energy rose from {energies[0]:.12g} to {energies[1]:.12g}."
    last, best = problem.energy(states[-1].positions), min((problem.energy(s.positions) for s in states), default=0.0)
    if not solver.monotone and not problem.anchors_lag(states[0].positions) and last > best * (1 + ROUNDING) + ROUNDING:
        return f"after {states[-1].iteration} steps: the energy is {last:.12g}, but it was {best:.12g} on the way."
    return ""


def states_tell_the_truth(solver: Solver, case: SolverCase) -> str:
    """Energy, inverted simplices and anchor error of a state are those of its map."""
    problem, states = _run(solver, case)
    for state in states:
        energy, inverted = problem.energy(state.positions), problem.inverted(state.positions)
        if abs(state.energy - energy) > 1e-9 * abs(energy) + 1e-12:
            return f"step {state.iteration}: the state says energy {state.energy:.12g}, the map has {energy:.12g}."
        if state.inverted != inverted:
            return f"step {state.iteration}: the state says {state.inverted} inverted simplices, the map has {inverted}."
        error = problem.anchor_error(state.positions)
        if abs(state.anchor_error - error) > 1e-9 * problem.mesh.diameter:
            return f"step {state.iteration}: the state says anchor error {state.anchor_error:.6g}, the map has {error:.6g}."
    return ""


def nothing_inverts(solver: Solver, case: SolverCase) -> str:
    """A map without inverted simplices stays so."""
    problem = case.problem()
    for state in _walk(solver, problem, case.start, LONG):
        inverted = problem.inverted(state.positions)
        if inverted:
            return f"step {state.iteration}: {inverted} simplices are inverted, none was at the start."
    return ""


def interrupts(solver: Solver, case: SolverCase) -> str:
    """An interrupt returns the old positions within one trial of a line search or one factorisation."""
    questions, worst = _longest_silence(solver, case)
    if not questions:
        return "step 1 never asks whether to stop."
    for part, (most, allowed) in worst.items():
        if most > allowed:
            return f"step 1 goes on for {most} computations ({part}) without asking whether to stop; {allowed} are allowed."
    for asked in (1, 2, 3, 5):
        problem = case.problem()
        state = solver.init(problem, case.start)
        left = asked

        def interrupt() -> bool:
            nonlocal left
            left -= 1
            return left <= 0

        following = solver.step(problem, state, interrupt)
        if left > 0:
            break  # the step ended before it was told to
        if following.status is not Status.INTERRUPTED:
            return f"step 1, told to stop at question {asked}, ended with {following.status.name} instead of INTERRUPTED."
        if not np.array_equal(following.positions, state.positions) or following.iteration != state.iteration:
            return f"step 1, told to stop at question {asked}, did not return the old map."
    return ""


def _longest_silence(solver: Solver, case: SolverCase) -> tuple[int, dict[str, tuple[int, int]]]:
    """How often the first step asks whether to stop; the most computations by part between two questions, and the allowed."""
    problem = case.problem()
    state = solver.init(problem, case.start)
    counts = [problem.workspace.all_counts()]

    def record() -> bool:
        counts.append(problem.workspace.all_counts())
        return False

    solver.step(problem, state, record)
    counts.append(problem.workspace.all_counts())
    worst = {}
    for part, allowed in SILENCE.items():
        worst[part] = (max(after[part] - before[part] for before, after in pairwise(counts)), allowed)
    return len(counts) - 2, worst


def anchors_are_reached(solver: Solver, case: SolverCase) -> str:
    """Anchors that can be reached are."""
    if case.anchors == "none":
        return ""
    problem = case.problem()
    state = run(solver, problem, case.start, iterations=REACH).state
    error = problem.anchor_error(state.positions)
    if error > problem.anchor_tolerance:
        return f"after {state.iteration} steps ({state.status.name}) an anchor is {error:.3g} away from its target."
    return ""


def failed_search_is_told(solver: Solver, case: SolverCase) -> str:
    """Where no step lowers the energy the status is NO_DESCENT, never CONVERGED, and the map stays."""
    if case.anchors == "moved":
        return ""  # the way to the anchors is not a line search
    truth = case.problem()
    problem = with_energy(truth, WalledEnergy)
    state = run(solver, problem, case.start, iterations=LONG).state
    before, after = truth.energy(case.start), truth.energy(state.positions)
    if after > before * (1 + ROUNDING):
        return f"where every trial fails the energy went up from {before:.9g} to {after:.9g}."
    if after >= before * (1 - 1e-9) and state.status in (Status.CONVERGED, Status.MAX_ITERATIONS):
        return f"where every trial of the line search fails the status is {state.status.name}."
    return ""


def nonfinite_is_caught(solver: Solver, case: SolverCase) -> str:
    """A value that is not finite is caught in the step that made it."""
    if case.anchors == "moved":
        return ""
    bad = case.start.copy()
    bad[1, 0] = np.nan
    status = solver.init(case.problem(), bad).status
    if status is not Status.NONFINITE:
        return f"a start with NaN in it was taken with the status {status.name} instead of NONFINITE."
    problem = with_energy(case.problem(), UndefinedEnergy)
    state = replace(solver.init(case.problem(), case.start), memory=None)
    following = solver.step(problem, state)
    if not np.isfinite(following.positions).all():
        return "step 1: a gradient that is not finite became a map that is not finite."
    if np.array_equal(following.positions, state.positions) and not following.status.is_failure:
        return f"step 1: a gradient that is not finite was met with the status {following.status.name}."
    return ""


def inverted_start_is_told(solver: Solver, case: SolverCase) -> str:
    """A start on which the distortion is infinite is INVERTED_START and not touched."""
    problem = case.problem()
    if not problem.density.has_barrier:
        return ""
    mirrored = case.start * np.array([-1.0, 1.0, 1.0][: problem.dimension])
    state = run(solver, problem.with_anchors(Anchors.none(problem.dimension)), mirrored, iterations=LONG).state
    if state.status is not Status.INVERTED_START or not np.array_equal(state.positions, mirrored):
        return f"a mirrored start ended with {state.status.name} after {state.iteration} steps."
    return ""


def rebases(solver: Solver, case: SolverCase) -> str:
    """After `rebase` to other anchors the same map goes on under the new problem, and reaches them."""
    problem = case.problem()
    states = _walk(solver, problem, case.start, STEPS)
    state = states[-1]
    if case.anchors == "none":
        changed = problem.with_criteria(Criteria(1e-9))
    else:
        changed = problem.with_anchors(case.anchors_at(0.5))
    again = solver.rebase(changed, state)
    if not np.array_equal(again.positions, state.positions):
        return "`rebase` moved the map."
    energy, error = changed.energy(again.positions), changed.anchor_error(again.positions)
    if again.status is not Status.RUNNING:
        return f"`rebase` left the status {again.status.name} instead of RUNNING."
    if abs(again.energy - energy) > 1e-9 * abs(energy):
        return f"`rebase` says energy {again.energy:.9g}, the map has {energy:.9g}."
    if abs(again.anchor_error - error) > 1e-9 * problem.mesh.diameter:
        return f"`rebase` says anchor error {again.anchor_error:.3g}, the map has {error:.3g}."
    ended = run(solver, changed, again.positions, iterations=REACH).state
    if changed.anchors_lag(ended.positions):
        return f"after `rebase` an anchor stays {changed.anchor_error(ended.positions):.3g} away from its target."
    return ""


def minimum_is_recognised(solver: Solver, case: SolverCase) -> str:
    """At a minimum the run ends with CONVERGED at once, and the map stays."""
    if case.kind == "parameterize" or case.anchors != "none":
        return ""
    problem = case.problem()
    state = run(solver, problem, problem.mesh.vertices, iterations=LONG).state
    if state.status is not Status.CONVERGED or state.iteration > 2:
        return f"at the source itself the run ended with {state.status.name} after {state.iteration} steps."
    return ""


@dataclass(frozen=True)
class Law:
    """A law by its id, in words, with what tries it."""

    id: str
    words: str
    check: Check


LAWS: dict[str, Law] = {
    id: Law(id, (check.__doc__ or "").strip().partition("\n")[0], check)
    for id, check in (
        ("inputs-unchanged", inputs_unchanged),
        ("deterministic", deterministic),
        ("energy-never-rises", energy_never_rises),
        ("states-tell-the-truth", states_tell_the_truth),
        ("nothing-inverts", nothing_inverts),
        ("interrupt", interrupts),
        ("anchors-reached", anchors_are_reached),
        ("failed-search", failed_search_is_told),
        ("non-finite", nonfinite_is_caught),
        ("inverted-start", inverted_start_is_told),
        ("rebase", rebases),
        ("minimum", minimum_is_recognised),
    )
}


@dataclass(frozen=True)
class Finding:
    """What became of a law: `holds`; else the case and the sentence of the first violation; `cases` tried."""

    law: str
    holds: bool
    cases: int
    case: str = ""
    sentence: str = ""


def try_law(solver: Solver, law: Law, on_case: Callable[[str], None] = lambda case: None) -> Finding:
    """Try a law on every case that the solver takes, up to the first violation. A solver that raises breaks the law.

    `on_case` is told each case before it is tried.
    """
    count = 0
    for case in cases_for(type(solver)):
        count += 1
        on_case(str(case))
        try:
            sentence = law.check(solver, case)
        except SolverFaultError as error:
            sentence = error.sentence
        except (Exception, SystemExit) as error:
            sentence = f"it raised {type(error).__name__}: {error}"
        if sentence:
            return Finding(law.id, False, count, str(case), sentence)
    return Finding(law.id, True, count)


def try_laws(solver: Solver) -> Iterator[Finding]:
    """Every law in turn."""
    for law in LAWS.values():
        yield try_law(solver, law)


def _walk(solver: Solver, problem: Problem, start: Floats, steps: int) -> list[State]:
    """States of plain steps, the start first; ends early where one is not RUNNING any more."""
    states = [solver.init(problem, start)]
    while len(states) <= steps and states[-1].status is Status.RUNNING:
        states.append(solver.step(problem, states[-1]))
        states[-1] = replace(states[-1], status=solver.terminate(problem, states[-1]))
    return states


def _run(solver: Solver, case: SolverCase) -> tuple[Problem, list[State]]:
    """The problem and the states of a long run."""
    problem = case.problem()
    return problem, _walk(solver, problem, case.start, LONG)
