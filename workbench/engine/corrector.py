"""A second process that computes fresh Newton steps while the hand moves.

The engine answers an event of the hand at once, by the kept response of the map to its anchors; what that leaves to do is
asked for here and applied when it comes. So no event waits for a factorisation, which holds the interpreter lock.
"""

from __future__ import annotations

import math
import os
import signal
import time
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any

import numpy as np

from workbench.core.anchor_response import AnchorResponse
from workbench.core.anchor_steps import shapes_ahead
from workbench.core.arrays import Floats, Integers
from workbench.core.distortion import Distortion
from workbench.core.energy import Energy
from workbench.core.jacobians import Elements
from workbench.core.linear_back_end import SingularMatrixError
from workbench.core.newton_system import NewtonSystem
from workbench.core.problem import Problem
from workbench.core.state import State

CHORDS = 3
"""Corrections with one factor before a fresh one is made."""
GREETING, PREPARATION = ("greeting",), ("preparation",)
"""What is waited for beside corrections: only one message is ever under way, so that no two large ones can meet."""
LONG = 0.08
"""Seconds of waiting for a correction after which the engine makes room with what it has."""
SMALLEST = 4000
"""Simplices below which a step of the engine itself is quicker than the way to another process."""


@dataclass(frozen=True, eq=False)
class _Source:
    elements: Elements


@dataclass(frozen=True, eq=False)
class _Request:
    key: tuple[Any, ...]
    distortion: Distortion
    positions: Floats
    hard: Integers
    shapes: Floats
    fresh: bool


@dataclass(frozen=True, eq=False)
class Correction:
    """A Newton direction (N, d) with the anchors held, for the map of the request, and the response where it is new.

    `response` : to displacements of the anchors in the shapes that were asked for;  `key` tells the request, `fresh`
    whether the factor was made for it
    """

    key: tuple[Any, ...]
    direction: Floats
    gradient_norm: float
    response: AnchorResponse | None
    fresh: bool


class CorrectorClient:
    """The engine's end: one request under way at a time; a corrector that has died is done without."""

    def __init__(self, connection: Connection | None) -> None:
        self._connection = connection
        self._elements: Elements | None = None
        self._asked: tuple[Any, ...] | None = GREETING  # the other process says when it is there
        self._asked_fresh = False
        self._asked_at = 0.0
        self._chords = CHORDS
        self._response: tuple[tuple[Any, ...], AnchorResponse] | None = None

    @property
    def waits_for(self) -> list[Connection]:
        """The connection while an answer is on its way."""
        return [self._connection] if self._connection is not None and self._asked is not None else []

    def tend(self, problem: Problem) -> None:
        """Between drags: take what has come, and let the other side prepare for a new source."""
        self.poll(problem)
        self.prepare(problem)

    def serves(self, problem: Problem) -> bool:
        """Whether this problem can be corrected elsewhere, and is worth it."""
        if not self._takes(problem):
            return False
        if self._asked in (GREETING, PREPARATION):
            self.poll(problem)
        self.prepare(problem)
        return self._asked not in (GREETING, PREPARATION)

    def is_coming(self, problem: Problem) -> bool:
        """Whether it will serve this problem once it has started and prepared."""
        return self._takes(problem) and self._asked in (GREETING, PREPARATION)

    def _takes(self, problem: Problem) -> bool:
        return (
            self._connection is not None
            and problem.mesh.simplex_count >= SMALLEST
            and problem.constraints is None
            and not len(problem.anchors.soft[0])
            and problem.forbids_inversions
        )

    @property
    def waited(self) -> float:
        """Seconds since the request under way was sent, 0 without one; at least `LONG` where it takes a factorisation."""
        if self._asked is None:
            return 0.0
        waited = time.perf_counter() - self._asked_at
        return max(waited, LONG) if self._asked_fresh else waited

    def prepare(self, problem: Problem) -> None:
        """Let the other side make its pattern and symbolic analysis before they are needed."""
        if not self._takes(problem) or self._elements is problem.elements or self._asked is not None:
            return
        assert self._connection is not None
        try:
            self._connection.send(_Source(problem.elements))
            self._elements, self._response, self._asked = problem.elements, None, PREPARATION
        except OSError:
            self._connection = None

    def ask(self, problem: Problem, state: State, *, fresh: bool = False) -> None:
        """Ask for a correction of this map, unless one is under way; `fresh` asks for a new factor."""
        if self._connection is None or self._asked is not None:
            return
        key = _key(problem)
        kept = self._response[1] if self._response is not None and self._response[0] == key else None
        shapes = shapes_ahead(problem, state, kept)
        self.prepare(problem)
        if self._connection is None or self._asked is not None:
            return
        try:
            hard = problem.anchors.hard_vertices
            self._connection.send(
                _Request(key, problem.distortion, state.positions, hard, shapes, fresh or self._chords >= CHORDS)
            )
            self._asked = key
            self._asked_fresh, self._asked_at = fresh or self._chords >= CHORDS, time.perf_counter()
            self._chords = 0 if self._asked_fresh else self._chords + 1
        except OSError:
            self._connection = None

    def poll(self, problem: Problem) -> Correction | None:
        """The correction that has come, None where none has or where it belongs to another problem by now."""
        if self._connection is None or self._asked is None:
            return None
        try:
            if not self._connection.poll():
                return None
            correction = self._connection.recv()
        except (EOFError, OSError):
            self._connection = None
            return None
        self._asked = None
        if not isinstance(correction, Correction) or correction.key != _key(problem):
            return None
        if correction.response is not None:
            self._response = (correction.key, correction.response)
        return correction

    def respond(self, problem: Problem, displacement: Floats) -> Floats | None:
        """Displacement of the map (N, d) for one of its hard anchors (k, d) by the kept response, None where none holds it."""
        if self._response is None or self._response[0] != _key(problem):
            return None
        return self._response[1].to(displacement)


def _key(problem: Problem) -> tuple[Any, ...]:
    distortion = problem.distortion
    values = tuple(sorted(distortion.parameter_values.items()))
    return (id(problem.elements), distortion.formula, values, problem.anchors.hard_vertices.tobytes())


def corrector_main(connection: Connection) -> None:
    """Body of the process; ends when the pipe breaks."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    from workbench.core.memory import keep_freed_memory
    from workbench.core.threads import set_thread_count

    keep_freed_memory()
    set_thread_count(1)  # the other core answers the hand
    if hasattr(os, "nice"):
        os.nice(10)  # the hand and the picture come first
    desk = _Desk()
    try:
        connection.send(None)  # the greeting
        while True:
            message = connection.recv()
            if isinstance(message, _Source):
                desk.take(message.elements)
                connection.send(None)
            else:
                connection.send(desk.correct(message))
    except (EOFError, OSError):
        pass


class _Desk:
    """The corrector's own copy of the problem, with its factor."""

    def __init__(self) -> None:
        self._energy: Energy | None = None
        self._system: NewtonSystem | None = None
        self._key: tuple[Any, ...] = ()
        self._chords = 0
        self._shapes = np.empty((0, 0))  # those that the last factor was asked about

    def take(self, elements: Elements) -> None:
        self._energy, self._system, self._key = Energy(elements, Distortion("none", "none", "sum(sigma)")), None, ()
        self._system = NewtonSystem(self._energy.pattern)
        self._system.solver  # noqa: B018  the symbolic analysis, before the first drag

    def correct(self, request: _Request) -> Correction | None:
        """None where no step can be computed: the engine goes on without."""
        assert self._energy is not None
        if request.key != self._key:
            self._energy = self._energy.with_distortion(request.distortion, False)
            self._key, self._chords = request.key, CHORDS
        assert self._system is not None
        fresh = request.fresh or self._chords >= CHORDS or not self._system.serves(request.hard)
        try:
            if fresh:
                evaluation = self._energy.hessian(request.positions)
                if not math.isfinite(evaluation.energy) or evaluation.hessian_values is None:
                    return None
                self._system.factorise(evaluation.hessian_values, request.hard)
                self._chords = 0
            else:
                evaluation = self._energy.gradient(request.positions)
                self._chords += 1
            direction = self._system.solve(evaluation.gradient)
            response = self._response(request.shapes, fresh)
        except SingularMatrixError:
            return None
        if not np.isfinite(direction).all():
            return None
        free = evaluation.gradient
        free[request.hard] = 0.0
        norm = float(np.linalg.norm(free))
        return Correction(request.key, direction, norm, response, fresh)

    def _response(self, shapes: Floats, fresh: bool) -> AnchorResponse | None:
        """The answer to `shapes`, where it has not been given with the present factor already."""
        if not shapes.size or (not fresh and np.array_equal(shapes, self._shapes)):
            return None
        assert self._system is not None
        self._shapes = shapes
        return AnchorResponse(shapes, self._system.response(shapes))
