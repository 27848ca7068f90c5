"""Races: fair turns, nothing changed by company, failures that harm one alone, maps that can be gone back to."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import numpy as np
import pytest

from workbench.core.constraints import Anchors
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.problem import Criteria, Problem
from workbench.core.registry import registry
from workbench.core.run import run
from workbench.core.solver import Solver
from workbench.core.status import Status
from workbench.engine.contestants import PRESETS, Contestant, parse_choices
from workbench.engine.map_store import Frame, MapStore
from workbench.engine.race import LEAD, Limits, Race


@dataclass(frozen=True)
class Sleeper(Solver):
    """Moves a little, and takes its time."""

    id = "sleeper"
    label = "Sleeper"
    nap: float = 0.001

    def step(self, problem, state, interrupt=lambda: False):
        time.sleep(self.nap)
        positions = state.positions * 1.0001
        following = replace(state, positions=positions, iteration=state.iteration + 1)
        return replace(following, energy=problem.energy(positions), previous_energy=float("nan"))


@dataclass(frozen=True)
class Breaks(Solver):
    """Raises in its second step."""

    id = "breaks"
    label = "Breaks"

    def step(self, problem, state, interrupt=lambda: False):
        if state.iteration:
            raise ZeroDivisionError("by nothing")
        return replace(state, positions=state.positions * 1.01, iteration=1)


def problem_on(mesh, distortion="symmetric-dirichlet", reach=0.3) -> Problem:
    held = np.array([0, mesh.vertex_count - 1])
    targets = mesh.vertices[held, : mesh.dimension] + np.array([[0.0], [reach]])
    return Problem.create(mesh, "plane", Distortion.resolve(distortion), Anchors(held, targets))


def test_a_turn_goes_to_who_has_spent_least(square):
    race = Race(
        problem_on(square, reach=0.0),
        square.vertices,
        [Contestant("slow", Sleeper(0.008)), Contestant("quick", Sleeper(0.001))],
    )
    for _ in range(12):
        expected = min(race.racers, key=lambda racer: racer.seconds)
        before = {racer.label: racer.seconds for racer in race.racers}
        assert race.advance(0.01) is expected
        idle = next(racer for racer in race.racers if racer is not expected)
        assert idle.seconds == before[idle.label]  # others' time is not charged
        assert expected.seconds >= before[expected.label] + 0.01
    slow, quick = race.racers
    assert abs(slow.seconds - quick.seconds) < 0.01 + 0.008 + 0.2  # a slice and a step; the rest is a machine's hiccup
    assert len(quick.rows) > len(slow.rows)
    assert all(racer.rows[-1].seconds == racer.seconds for racer in race.racers)


def test_between_two_long_steps_comes_whoever_waits(square):
    long, slice_seconds, patience = 0.03, 0.004, 0.015
    contestants = [Contestant("one", Sleeper(long)), Contestant("two", Sleeper(long)), Contestant("quick", Sleeper(0.001))]
    race = Race(problem_on(square, reach=0.0), square.vertices, contestants)
    turns = []
    for _ in range(3):
        race.advance(slice_seconds, patience=patience)
    for _ in range(60):
        least = min(racer.seconds for racer in race.racers)
        ahead = race.racer("quick").seconds - least
        turn = race.advance(slice_seconds, patience=patience)
        if turn.label != "quick" and turns and turns[-1] != "quick":
            assert ahead > LEAD  # else it would have been its turn after so long a step
        turns.append(turn.label)
        seconds = [racer.seconds for racer in race.racers]
        assert max(seconds) - min(seconds) < LEAD + long + slice_seconds + 0.1  # the last is a machine's hiccup
    assert turns.count("quick") > 20 and {"one", "two"} < set(turns)


@pytest.mark.parametrize("preset", PRESETS)
def test_company_changes_nothing(square, preset):
    chosen = PRESETS[preset]
    problem = problem_on(square, chosen.distortion or "symmetric-dirichlet")
    race = Race(problem, square.vertices, chosen.contestants(), criteria=Criteria(1e-9), limits=Limits(60))
    race.run(slice_seconds=0.0)
    assert race.is_over
    for contestant, racer in zip(chosen.contestants(), race.racers, strict=True):
        alone = run(
            contestant.solver, problem_on(square, problem.distortion.id), square.vertices, tolerance=1e-9, iterations=60
        )
        assert np.array_equal(alone.state.positions, racer.positions)
        assert [row.energy for row in alone.rows] == [row.energy for row in racer.rows]
        assert racer.state.status is alone.state.status


def test_a_contestant_that_fails_harms_nobody(square):
    race = Race(
        problem_on(square),
        square.vertices,
        [
            Contestant("bad", Breaks()),
            Contestant.of("local-global"),  # does not minimise this distortion
            Contestant.of("projected-newton"),
        ],
    )
    race.run()
    bad, wrong, good = race.racers
    assert bad.phase == wrong.phase == "failed" and bad.status_name == "FAILED"
    assert "step 2" in bad.message and "by nothing" in bad.message
    assert len(bad.rows) == 2 and len(wrong.rows) == 1
    assert "arap" in wrong.message
    assert good.state.status is Status.CONVERGED and good.phase == "finished"


def test_counts_are_what_was_spent(square):
    problem = Problem.create(square, "plane", Distortion.resolve("symmetric-dirichlet"))
    start = square.vertices * [1.5, 0.8]
    race = Race(problem, start, [Contestant.of("projected-newton"), Contestant.of("aqp")])
    race.run()
    newton, aqp = race.racers
    steps = newton.rows[-1].iteration
    assert newton.rows[-1].factorisations == steps == newton.rows[-1].hessian_evaluations - 1
    assert aqp.rows[-1].factorisations == 1 and aqp.rows[-1].hessian_evaluations == 0
    for racer in race.racers:
        for name in ("seconds", "energy_evaluations", "gradient_evaluations", "factorisations", "trials"):
            values = [getattr(row, name) for row in racer.rows]
            assert values == sorted(values)
        assert racer.rows[-1].gradient_evaluations >= racer.rows[-1].hessian_evaluations


def test_relative_errors_are_to_the_best_map_that_holds_the_anchors(square):
    race = Race(
        problem_on(square),
        square.vertices,
        [Contestant.of("projected-newton"), Contestant.of("gradient-descent"), Contestant("given", None, square.vertices)],
        criteria=Criteria(1e-10),
    )
    newton, descent, given = race.racers
    assert np.isnan(race.relative_errors(newton)).all()  # the anchors lag at the start
    race.run()
    assert race.best_energy(newton) == min(newton.state.energy, descent.state.energy)
    assert race.relative_errors(newton)[-1] == pytest.approx(0.0, abs=1e-8)
    assert race.relative_errors(descent)[-1] > 0
    assert np.isnan(race.relative_errors(given)).all()  # less distorted, but not where the anchors are to be
    assert given.phase == "given" and len(given.rows) == 1 and given.seconds == 0.0


def test_switching_is_marked_and_goes_on_from_the_map(square):
    race = Race(problem_on(square), square.vertices, [Contestant.of("gradient-descent")], limits=Limits(15))
    race.run()
    (racer,) = race.racers
    assert racer.state.status is Status.MAX_ITERATIONS
    before, spent = racer.positions, racer.seconds
    racer.rebase("now by Newton", solver=registry().solver("projected-newton")())
    assert racer.is_running and racer.positions is before and racer.seconds >= spent
    race.run()
    assert racer.state.status is Status.CONVERGED
    assert race.relative_errors(racer)[1] > 0  # the energy is the same as before the switch
    racer.rebase("now mips", distortion=Distortion.resolve("mips"))
    assert [marker.sentence for marker in racer.markers] == ["now by Newton", "now mips"]
    assert all(racer.rows[m.index].iteration == m.iteration for m in racer.markers)
    race.run()
    assert racer.state.energy == pytest.approx(race.best_energy(racer))
    assert racer.state.energy == pytest.approx(problem_on(square, "mips").energy(racer.positions))


def test_a_switch_that_does_not_fit_changes_nothing(square):
    unbound = Problem.create(square, "plane", Distortion.resolve("symmetric-dirichlet"))
    race = Race(unbound, 50 * square.vertices, [Contestant.of("gradient-descent")])
    (racer,) = race.racers
    problem, state = racer.problem, racer.state
    with pytest.raises(WorkbenchError, match="minimises arap"):
        racer.rebase("no", solver=registry().solver("local-global")())
    with pytest.raises(WorkbenchError, match="not a finite number"):
        racer.rebase("no", distortion=Distortion.resolve("sigma1^2 - log(40 - sigma1)"))
    assert racer.problem is problem and racer.state is state and not racer.markers and len(racer.rows) == 1


def test_an_interrupt_is_a_pause(square):
    race = Race(problem_on(square, reach=0.0), square.vertices * 1.3, [Contestant.of("projected-newton")])
    (racer,) = race.racers
    race.advance(interrupt=lambda: True)
    assert racer.is_running and np.array_equal(racer.positions, race.start) and len(racer.rows) == 1
    race.run(interrupt=lambda: True)
    assert racer.state.status is Status.INTERRUPTED and race.is_over


def test_limits_hold_for_everyone(square):
    entries = [Contestant("a", Sleeper(0.001)), Contestant("b", Sleeper(0.004))]
    race = Race(problem_on(square, reach=0.0), square.vertices, entries, limits=Limits(seconds=0.03))
    race.run(0.005)
    assert all(racer.state.status is Status.TIME_LIMIT and racer.seconds >= 0.03 for racer in race.racers)
    race = Race(problem_on(square, reach=0.0), square.vertices, entries, limits=Limits(3))
    race.run(0.005)
    assert all(racer.state.status is Status.MAX_ITERATIONS and racer.state.iteration == 3 for racer in race.racers)


def test_two_of_one_label_are_refused(square):
    with pytest.raises(WorkbenchError, match="'aqp'"):
        Race(problem_on(square), square.vertices, [Contestant.of("aqp"), Contestant.of("aqp")])


def test_the_store_is_bounded_and_even():
    size = np.zeros((10, 2)).nbytes
    store = MapStore(16 * size, pinned=(5, 77))
    for index in range(200):
        store.add(Frame(index, index, 0.1 * index, np.full((10, 2), float(index))))
        assert len(store) <= 18  # the limit, the pinned
        assert store.byte_count == len(store) * size
        assert store.frames[0].index == 0 and store.frames[-1].index == index
    kept = [frame.index for frame in store.frames]
    assert {5, 77} <= set(kept)
    gaps = np.diff([index for index in kept[:-1] if index not in (5, 77)])
    assert len(set(gaps.tolist())) == 1 and len(kept) > 8
    for asked in (0.0, 3.33, 7.7, 19.0, 1e9, -1.0):
        newest = max((f for f in store.frames if f.seconds <= asked), key=lambda f: f.index, default=store.frames[0])
        assert store.at_seconds(asked) is newest
        assert store.at_iteration(10 * asked).index == newest.index


def test_one_can_go_back_in_time(square):
    race = Race(problem_on(square), square.vertices, [Contestant.of("aqp")])
    race.run()
    (racer,) = race.racers
    for row in racer.rows:
        frame = racer.maps.at_seconds(row.seconds)
        assert frame.iteration == row.iteration
        assert racer.problem.energy(racer.maps.at_iteration(row.iteration).positions) == pytest.approx(row.energy, rel=1e-12)


def test_words_name_contestants():
    plain, fast, slow = parse_choices("aqp, fast=aqp:eta=50:accelerate=no ,projected-newton:reach=1")
    assert (plain.label, plain.solver, plain.values) == ("aqp", "aqp", {})
    assert (fast.label, fast.solver, fast.values) == ("fast", "aqp", {"eta": "50", "accelerate": "no"})
    assert (slow.label, slow.solver) == ("projected-newton:reach=1", "projected-newton")


@pytest.mark.parametrize("text", ["aqp:eta", "=aqp", "a=", "aqp:=3", "aqp:eta="])
def test_words_that_name_none_are_refused(text):
    with pytest.raises(WorkbenchError, match=r"\[LABEL=\]ID"):
        parse_choices(text)
