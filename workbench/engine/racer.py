"""One contestant at work: a problem with a workspace of its own, a map, a history, the seconds it has spent."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.constraints import Anchors
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.problem import Problem, Workspace
from workbench.core.run import HistoryRow, Limits, history_row, step_within
from workbench.core.solver import Interrupt, Solver, never, restarted
from workbench.core.state import State
from workbench.core.status import Status
from workbench.engine.admission import check_admissible
from workbench.engine.contestants import Contestant
from workbench.engine.map_store import Frame, MapStore


@dataclass(frozen=True)
class RaceRow(HistoryRow):
    """A row of the history with what was spent so far; an evaluation of the Hessian counts as one of the gradient, too."""

    factorisations: int
    energy_evaluations: int
    gradient_evaluations: int
    hessian_evaluations: int
    trials: int


@dataclass(frozen=True)
class Marker:
    """Something was switched: from row `index` of the history on another solver, distortion or other anchors hold."""

    index: int
    iteration: int
    seconds: float
    sentence: str


Terms = tuple[object, ...]
"""What an energy depends on beside the map: equal where two energies may be compared."""


class Racer:
    """A contestant with its problem, state, rows, maps and markers.

    `terms` says for each row what its energy depended on. `fault` is the sentence of a solver that raised or broke a law: it
    takes no further step, and `positions` is its last good map.
    """

    def __init__(
        self, contestant: Contestant, problem: Problem, start: Floats, *, limits: Limits, store: MapStore, seconds: float = 0.0
    ) -> None:
        """`seconds` is what is charged from the beginning, for what all contestants share."""
        self.contestant = contestant
        self.solver: Solver | None = contestant.solver
        self.problem = replace(problem, workspace=Workspace(problem.density))
        self.limits = limits
        self.seconds = seconds
        self.rows: list[RaceRow] = []
        self.terms: list[Terms] = []
        self.maps = store
        self.markers: list[Marker] = []
        self.fault = ""
        self._taken = 0
        self._allowed_from = 0.0
        self.state = self._first_state(start if contestant.map is None else contestant.map)
        self._record()

    def _first_state(self, positions: Floats) -> State:
        x = np.ascontiguousarray(positions, dtype=np.float64)
        if self.solver is None:
            self.problem = self.problem.from_start(x)
            return replace(restarted(self.problem, State(x)), status=Status.CONVERGED)
        with self._charged():
            self.problem = self.problem.from_start(x)
            try:
                if self.problem.kind not in self.solver.kinds:
                    raise WorkbenchError(f"{self.solver.label} does not solve {self.problem.kind} maps.")
                return self.solver.init(self.problem, x)
            except (Exception, SystemExit) as error:
                self.fault = _sentence(error, f"{self.solver.label} failed at the start")
        return replace(restarted(self.problem, State(x)), status=Status.INTERRUPTED)

    # ------------------------------------------------------------------------------------------- state

    @property
    def label(self) -> str:
        return self.contestant.label

    @property
    def positions(self) -> Floats:
        """The newest map (n, d)."""
        return self.state.positions

    @property
    def is_running(self) -> bool:
        """Whether `step` would take one."""
        return self.solver is not None and not self.fault and self.state.status is Status.RUNNING

    @property
    def phase(self) -> str:
        """running, finished (converged, or a limit), failed, or given: a map from elsewhere."""
        if self.solver is None:
            return "given"
        if self.is_running:
            return "running"
        return "failed" if self.fault or self.state.status.is_failure else "finished"

    @property
    def status_name(self) -> str:
        """Name of the status; FAILED for a solver at fault, GIVEN for a map from elsewhere."""
        if self.solver is None:
            return "GIVEN"
        return "FAILED" if self.fault else self.state.status.name

    @property
    def message(self) -> str:
        """One sentence about how it stands."""
        if self.solver is None:
            return "The map was given."
        return self.fault or self.state.status.value

    # ------------------------------------------------------------------------------------------- steps

    def step(self, interrupt: Interrupt = never) -> None:
        """One step, charged; an interrupt leaves the map as it is, and the contestant goes on in its next turn."""
        if not self.is_running:
            return
        assert self.solver is not None
        before = self.state
        with self._charged() as spent:
            try:
                following = step_within(
                    self.solver,
                    self.problem,
                    before,
                    self.limits,
                    self._taken,
                    lambda: self.seconds - self._allowed_from + spent(),
                    interrupt,
                )
            except (Exception, SystemExit) as error:
                self.fault = _sentence(error, f"{self.solver.label} failed in step {before.iteration + 1}")
                return
        if following.status is Status.INTERRUPTED:
            following = replace(following, status=Status.RUNNING)
        else:
            self._taken += 1
        self.state = following
        if following.iteration > before.iteration:
            self._record()

    def stop(self) -> None:
        """End with the map as it is."""
        if self.is_running:
            self.state = replace(self.state, status=Status.INTERRUPTED)

    def rebase(
        self,
        sentence: str,
        *,
        solver: Solver | None = None,
        distortion: Distortion | None = None,
        anchors: Anchors | None = None,
        allow_inversions: bool | None = None,
    ) -> None:
        """Go on from the present map with another solver, distortion or other anchors; `sentence` marks it in the history.

        Raises `WorkbenchError` where that does not fit the map, the kind of map or the solver: then all stays as it was.
        """
        problem, chosen = self.problem, solver or self.solver
        if distortion is not None:
            allowed = problem.density.allow_inversions if allow_inversions is None else allow_inversions
            problem = problem.with_distortion(distortion, allowed).from_start(self.positions)
            check_admissible(problem, self.positions)
        if anchors is not None:
            problem = problem.with_anchors(anchors)
        if self.solver is None:  # a map from elsewhere is only measured anew
            self.problem = problem
            self.state = replace(restarted(problem, self.state), status=Status.CONVERGED)
        else:
            assert chosen is not None
            if problem.kind not in chosen.kinds:
                raise WorkbenchError(f"{chosen.label} does not solve {problem.kind} maps; choose another solver.")
            chosen.check_distortion(problem.distortion)
            with self._charged():
                state = chosen.rebase(problem, replace(self.state, memory=None))
            if state.inverted and problem.density.meets_barrier(state.positions):
                state = replace(state, status=Status.INVERTED_START)
            self.problem, self.solver, self.state, self.fault = problem, chosen, state, ""
            self._taken, self._allowed_from = 0, self.seconds
        self.markers.append(Marker(len(self.rows), self.state.iteration, self.seconds, sentence))
        self._record()

    # ----------------------------------------------------------------------------------------- records

    def _record(self) -> None:
        counts = self.problem.workspace.all_counts()
        row = RaceRow(
            **asdict(history_row(self.problem, self.state, self.seconds)),
            factorisations=counts["factorise"],
            energy_evaluations=counts["energy"],
            gradient_evaluations=counts["gradient"] + counts["hessian"],
            hessian_evaluations=counts["hessian"],
            trials=counts["trials"],
        )
        terms = _terms(self.problem)
        self.terms.append(self.terms[-1] if self.terms and self.terms[-1] == terms else terms)
        self.maps.add(Frame(len(self.rows), row.iteration, row.seconds, self.state.positions))
        self.rows.append(row)

    @contextmanager
    def _charged(self) -> Iterator[Callable[[], float]]:
        """What is done within is charged; yields what asks for the seconds since it began."""
        begin = time.perf_counter()
        try:
            yield lambda: time.perf_counter() - begin
        finally:
            self.seconds += time.perf_counter() - begin


def _terms(problem: Problem) -> Terms:
    anchors = problem.anchors
    return (
        problem.distortion.id,
        tuple(sorted(problem.distortion.parameter_values.items())),
        anchors.vertices.tobytes(),
        anchors.targets.tobytes(),
        anchors.weights.tobytes(),
    )


def _sentence(error: BaseException, otherwise: str) -> str:
    return error.sentence if isinstance(error, WorkbenchError) else f"{otherwise}: {type(error).__name__}: {error}"
