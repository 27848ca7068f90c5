"""Commands to the engine and its reports: all that crosses the process boundary."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from workbench.core.arrays import Booleans, Floats, Integers, frozen
from workbench.core.constraints import Anchors
from workbench.core.history_row import HistoryRow
from workbench.core.measure import Measure
from workbench.core.mesh import Mesh
from workbench.core.method import Kind
from workbench.core.status import Status

if TYPE_CHECKING:
    from workbench.core.dissection import Dissection

# ---------------------------------------------------------------------------------------------- commands


class Command:
    """Something the window asks for. Of those with one `slot` the newest wins, except `Step`, whose counts add up."""

    interrupts: ClassVar[bool] = True
    """Whether a step gives way to it."""

    @property
    def slot(self) -> Hashable:
        """What it takes the place in of an earlier one: its class, unless a class says otherwise."""
        return type(self).__name__


@dataclass(frozen=True)
class Load(Command):
    """Read a mesh and make it the source; the map becomes the start of the current choices.

    `source` is a path, or `sample:ID`; `fixes` are applied in their order; `kind` is `auto` or a `Kind`;
    `generation` is chosen by the sender and comes back in every report that belongs to this mesh.
    """

    source: str
    generation: int
    kind: str = "auto"
    fixes: tuple[str, ...] = ()
    tets: bool = False


@dataclass(frozen=True)
class SetProblem(Command):
    """Distortion (id or formula) with its parameters; the current map is kept.

    `fixed_boundary` holds the boundary vertices where they are now, beside the anchors. Refused where the distortion is no
    finite number on the current map. `equations` are linear constraints, a line each (see `workbench.core.linear_equations`);
    another mesh begins without any. `serial` is chosen by the sender (growing), and comes back in a refusal.
    """

    distortion: str = "symmetric-dirichlet"
    parameters: dict[str, float] = field(default_factory=dict)
    fixed_boundary: bool = False
    allow_inversions: bool = False
    equations: tuple[str, ...] = ()
    serial: int = field(default=0, compare=False)


@dataclass(frozen=True)
class SetSolver(Command):
    """Solver by id with its parameters; takes effect at the next step, the map is kept."""

    solver: str = "projected-newton"
    parameters: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class SetAnchors(Command):
    """All anchors: `vertices` (k,), `targets` (k, d), `weights` (k,) (inf is hard), `groups` (k,) (see `Anchors`; or None).

    `serial` is chosen by the sender (growing); `Snapshot.anchor_serial` tells which one a map has taken up.
    `dragging` is true while a hand holds one of them.
    """

    interrupts: ClassVar[bool] = False

    vertices: Integers
    targets: Floats
    weights: Floats
    serial: int = 0
    dragging: bool = False
    groups: Integers | None = None

    def __post_init__(self) -> None:
        if self.groups is not None:
            object.__setattr__(self, "groups", frozen(self.groups, np.int64))
        object.__setattr__(self, "vertices", frozen(self.vertices, np.int64))
        object.__setattr__(self, "targets", frozen(self.targets))
        object.__setattr__(self, "weights", frozen(self.weights))

    @property
    def anchors(self) -> Anchors:
        """Raises `WorkbenchError` where they contradict themselves."""
        return Anchors(self.vertices, self.targets, self.weights, self.groups)  # type: ignore[arg-type]


@dataclass(frozen=True)
class Run(Command):
    """Iterate until a criterion of the solver stops it; later anchor moves start it again."""

    iterations: int = 1000
    tolerance: float = 1e-6
    time_limit: float = float("inf")


@dataclass(frozen=True)
class Pause(Command):
    """Stop iterating after the step that is under way (it is interrupted); anchors no longer pull."""


@dataclass(frozen=True)
class Step(Command):
    """Take `count` iterations, then pause."""

    count: int = 1


@dataclass(frozen=True)
class Reset(Command):
    """Make the start anew: initializer by id with parameters, a file for `file`.

    `match_area` scales the start to the total area (volume) of the source.
    """

    initializer: str = ""  # empty: the default of the kind of map
    parameters: dict[str, Any] = field(default_factory=dict)
    file: str = ""
    match_area: bool = True


@dataclass(frozen=True, eq=False)
class TakeMap(Command):
    """Go on from a map (n, d) of the present mesh that was made elsewhere; dropped where `generation` is another mesh's."""

    generation: int
    positions: Floats


@dataclass(frozen=True, eq=False)
class TakeUp(Command):
    """Go on with all of these at once: what an undo, or a session that was opened, brings back. The map rests.

    `iteration` and `seconds` are what had led to the map. Dropped where `generation` is another mesh's; refused as a whole
    where the problem, the solver or the anchors are.
    """

    generation: int
    positions: Floats
    problem: SetProblem
    solver: SetSolver
    anchors: SetAnchors
    iteration: int = 0
    seconds: float = 0.0


@dataclass(frozen=True, eq=False)
class Restore(Command):
    """Go on from a map of a mesh that was loaded before: what the worker sends to a new process after a crash."""

    generation: int
    mesh: Mesh
    kind: Kind
    positions: Floats
    iteration: int
    number: int


@dataclass(frozen=True)
class Watch(Command):
    """What snapshots shall carry from now on, in place of what was watched before; the map at rest is reported anew.

    `measures` become `Snapshot.fields` by their ids, `singular_values` whether `Snapshot.singular_values` is made.
    What cannot be made of the mesh is left out, and refused with a sentence.
    """

    measures: tuple[Measure, ...] = ()
    singular_values: bool = False


@dataclass(frozen=True)
class Dissect(Command):
    """Take the next step apart; the map stays as it is, and the run goes on. Answered by `Dissected`."""


@dataclass(frozen=True)
class Quit(Command):
    """End the engine process."""


# ---------------------------------------------------------------------------------------------- reports


class Report:
    """Something the engine tells."""


@dataclass(frozen=True)
class Ready(Report):
    """The process is up and its kernels are compiled; `seconds` from spawn."""

    seconds: float


@dataclass(frozen=True)
class Progress(Report):
    """Long work: a sentence; `fraction` in [0, 1], or negative where it is not known."""

    sentence: str
    fraction: float = -1.0


@dataclass(frozen=True, eq=False)
class Loaded(Report):
    """A mesh was read and is the source now.

    `mesh` has two columns of vertices for `plane`; `lines` is the report on load, one sentence a line;
    `cut_edges` (k, 2) are the edges (vertices of `mesh`) that a fix cut open. `anchor_vertices` (k,) are those that
    the file or the sample comes with, `anchor_targets` (k, d) their targets; None: where the start has them.
    `neighbours` (m, 4) are the tetrahedra beyond each face (see `neighbouring_simplices`), so that whoever draws a volume
    need not sort its faces; None for triangles. With `has_start` the file is a case with a start of its own.
    """

    generation: int
    mesh: Mesh
    kind: Kind
    lines: tuple[str, ...]
    cut_edges: Integers
    source: str
    fixes: tuple[str, ...] = ()
    anchor_vertices: Integers | None = None
    anchor_targets: Floats | None = None
    neighbours: Integers | None = None
    has_start: bool = False


@dataclass(frozen=True, eq=False)
class LegBegun(Report):
    """From here on the solver iterates on its own, so that whoever knows this can repeat it.

    `origin` is `start` or `map`, or `previous` where nothing has moved the map since the leg before; `positions` (n, d) may
    be None then. `iteration` counts on; `Snapshot.leg` names the leg that a map belongs to.
    """

    generation: int
    number: int
    origin: str
    iteration: int
    positions: Floats | None
    problem: SetProblem
    solver: SetSolver
    anchors: SetAnchors | None
    tolerance: float


@dataclass(frozen=True)
class Refused(Report):
    """A command could not be carried out: the sentence says why; `fixes` are names to offer as buttons.

    `lines` is the report on load where a mesh was read but does not suit; `command` is the class name.
    Of a `SetProblem`, `serial` is its own, and `kept` the one that stays in force; of a `TakeUp` it is that of its anchors.
    """

    generation: int
    command: str
    sentence: str
    fixes: tuple[str, ...] = ()
    lines: tuple[str, ...] = ()
    kept: SetProblem | None = None
    serial: int = 0


@dataclass(frozen=True)
class Failure(Report):
    """Something raised: a plugin or a fault of ours. The engine stays up; `traceback` is for the details."""

    generation: int
    sentence: str
    traceback: str


@dataclass(frozen=True)
class LogLine(Report):
    """A record of a logger in the engine process: `level` as in Python's logging, `name` that of the logger."""

    level: int
    name: str
    text: str
    details: str = ""


@dataclass(frozen=True)
class Restarted(Report):
    """The engine process died or was stopped, and a new one goes on from the last good map."""

    sentence: str


@dataclass(frozen=True, eq=False)
class MapReport(Report):
    """A snapshot without what the window derives from the positions (see `Snapshot`)."""

    generation: int
    number: int
    positions: Floats
    phase: str
    status: Status
    rows: tuple[HistoryRow, ...]
    anchor_serial: int
    limiting_simplex: int
    inverted: int
    seconds_published: float
    timing: dict[str, float]
    solver: str
    distortion: str
    leg: int = 0


@dataclass(frozen=True, eq=False)
class Snapshot(Report):
    """What the window draws.

    Parameters
    ----------
    generation : int          of the mesh
    number : int              growing
    positions : (n, d)        float64
    phase : str               idle, running, dragging, finished
    status : Status           `status.value` is the sentence; RUNNING while it runs
    row : HistoryRow          seconds are those spent in steps since the last Reset
    inverted : (m,) bool      det <= 0
    fields : dict             what is watched (see `Watch`), by the measure's id, each (m,) float32
    anchor_serial : int       of the newest `SetAnchors` that this map has taken up
    limiting_simplex : int    simplex that bounds the step while an anchor lags, else -1
    seconds_published : float `time.perf_counter()` clock of the machine when it was published
    singular_values : (m, n)  float32, signed, where someone watches them, else None
    timing : dict             seconds by part (assemble, factorise, solve, line_search) of the last step
    leg : int                 number of the `LegBegun` that led to the map; 0 where something else had the last word
    """

    generation: int
    number: int
    positions: Floats
    phase: str
    status: Status
    row: HistoryRow
    inverted: Booleans
    fields: dict[str, Any]
    anchor_serial: int = 0
    limiting_simplex: int = -1
    seconds_published: float = 0.0
    timing: dict[str, float] = field(default_factory=dict)
    solver: str = ""
    distortion: str = ""
    rows: tuple[HistoryRow, ...] = ()  # every row since the snapshot before, oldest first; none where nothing was stepped
    singular_values: Any = None
    leg: int = 0


@dataclass(frozen=True, eq=False)
class Dissected(Report):
    """The next step of the present solver from the present map, taken apart; `message` says how the step would end."""

    generation: int
    solver: str
    step: Dissection
    message: str
