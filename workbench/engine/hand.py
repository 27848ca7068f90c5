"""Following the hand: a map for every event, corrected as Newton steps come in."""

from __future__ import annotations

from collections.abc import Callable
from multiprocessing.connection import Connection

from workbench.core.anchor_steps import (
    SETTLED,
    Renewal,
    apply_correction,
    approach_anchors,
    correct_with_last_factor,
    predict_with_last_factor,
    predict_with_response,
    respond_with_last_factor,
)
from workbench.core.arrays import Floats
from workbench.core.fence import along_faint_fence
from workbench.core.problem import Problem
from workbench.core.state import State
from workbench.core.threads import one_thread
from workbench.engine.corrector import LONG, CorrectorClient

POOR_CORRECTION = 0.25
"""Part of a correction below which the next one is asked with a fresh factor."""
TOO_LONG = 0.5
"""Seconds of waiting for a correction after which the engine factorises by itself, now and then."""


class HandFollower:
    """Chooses each step while a hand moves an anchor; on small meshes, or without a corrector, all in this process."""

    def __init__(self, connection: Connection | None, pending: Callable[[], bool]) -> None:
        """`connection` leads to the corrector's process; `pending` interrupts, see `workbench.engine.loop.EngineLoop`."""
        self._corrector = CorrectorClient(connection)
        self._pending = pending
        self._settled = False
        self._wants_fresh = False

    @property
    def waits_for(self) -> list[Connection]:
        """What else than a command can give `step` or `tend` something to do."""
        return self._corrector.waits_for

    def tend(self, problem: Problem) -> None:
        """Between drags: let the corrector make the pattern and the analysis of a new source before the first one."""
        self._corrector.tend(problem)

    def moved(self) -> None:
        """Anchors, problem or map changed: there is something to do again."""
        self._settled = False

    def step(self, problem: Problem, state: State) -> State | None:
        """The next map, None where nothing is to be done before the next event."""
        return along_faint_fence(problem, state, self._next)

    def _next(self, problem: Problem, state: State) -> State | None:
        if self._corrector.serves(problem):
            with one_thread():  # the corrector and the drawing have the other core
                return self._with_corrector(problem, state)
        # Where the corrector is only getting ready, what it will bring is not worth a pause now.
        renewal: Renewal = "never" if self._corrector.is_coming(problem) else "rationed"
        if problem.anchors_lag(state.positions):
            predicted = predict_with_last_factor(problem, state, self._pending)
            return predicted or approach_anchors(problem, state, self._pending, renewal=renewal)
        if self._settled:
            return None
        following = correct_with_last_factor(problem, state, self._pending, renewal=renewal)
        self._settled = following.step_size == 0.0
        return following

    def _with_corrector(self, problem: Problem, state: State) -> State | None:
        """Answer by the kept response, and take up corrections as they come; never wait."""
        corrector = self._corrector
        correction = corrector.poll(problem)
        if correction is not None:
            following = apply_correction(problem, state, correction.direction, correction.gradient_norm)
            gain = following.previous_energy - following.energy
            self._settled = not gain > SETTLED * abs(following.energy)
            # One that came late is no news about its factor: only a quick one that gains nothing is.
            self._wants_fresh = following.step_size < POOR_CORRECTION and not correction.fresh
            if following.step_size > 0.0:
                return following
        lags = problem.anchors_lag(state.positions)
        if lags or not self._settled:
            corrector.ask(problem, state, fresh=self._wants_fresh)
        if not lags:
            return None
        own = problem.system
        has_factor = own.serves(problem.anchors.hard_vertices)

        own_respond = respond_with_last_factor(problem, state)

        def respond(displacement: Floats) -> Floats | None:
            direction = corrector.respond(problem, displacement)
            return own_respond(displacement) if direction is None and has_factor else direction

        # After a step that an inversion bounded, another one of its kind would only press the map harder against it.
        was_bounded = state.approach.predicted and state.step_size < 1.0
        predicted = None if was_bounded else predict_with_response(problem, state, self._pending, respond)
        if predicted is None and corrector.waited >= LONG:
            renewal: Renewal = "rationed" if corrector.waited >= TOO_LONG else "never"
            if has_factor:
                return correct_with_last_factor(problem, state, self._pending, renewal=renewal)
            if renewal == "rationed":  # the other process gets no processor: better slow than not at all
                return approach_anchors(problem, state, self._pending, renewal=renewal)
        return predicted
