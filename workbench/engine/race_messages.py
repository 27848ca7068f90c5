"""Commands to the process in which a race runs, and its reports."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from workbench.core.arrays import Booleans, Floats
from workbench.core.mesh import Mesh
from workbench.core.method import Kind
from workbench.engine.messages import Command, Report, Reset, Run, SetAnchors, SetProblem

if TYPE_CHECKING:
    from workbench.engine.race import Marker, RaceRow

Axis = Literal["iteration", "seconds"]
AXES: tuple[Axis, ...] = ("iteration", "seconds")
LIVE = float("inf")
"""The place on either axis of the newest maps."""


@dataclass(frozen=True, eq=False)
class Entrant:
    """Who takes part: a registered solver with its values, or a map (n, d) that something else has made."""

    label: str
    solver: str = ""
    parameters: dict[str, Any] = field(default_factory=dict)
    map: Floats | None = None


@dataclass(frozen=True)
class StartWish:
    """The start that a source has with these choices: made anew, as when it was opened; `solver` may wish for one."""

    source: str
    solver: str = "projected-newton"
    fixes: tuple[str, ...] = ()
    reset: Reset = field(default_factory=Reset)


@dataclass(frozen=True, eq=False)
class StartRace(Command):
    """Put these on the start line, in place of any race before; `Run` lets them go.

    `start` is a map (n, d), or what makes one; `limits` hold for each; `serial` is chosen by the sender (growing), and comes
    back in every report.
    """

    serial: int
    mesh: Mesh
    kind: Kind
    start: Floats | StartWish
    entrants: tuple[Entrant, ...]
    problem: SetProblem
    anchors: SetAnchors
    limits: Run = field(default_factory=Run)


@dataclass(frozen=True)
class Seek(Command):
    """Show the maps of all contestants as they were at a place of the time axis; `LIVE`: follow the newest again.

    The race goes on meanwhile, if it was running.
    """

    interrupts: ClassVar[bool] = False

    axis: Axis = "seconds"
    place: float = LIVE


@dataclass(frozen=True)
class Switch(Command):
    """Let contestant `index` go on with another solver (empty: its own), distortion or other anchors; `sentence` marks it."""

    index: int
    sentence: str
    solver: str = ""
    parameters: dict[str, Any] = field(default_factory=dict)
    problem: SetProblem | None = None
    anchors: SetAnchors | None = None

    @property
    def slot(self) -> Hashable:
        return type(self).__name__, self.index, self.anchors is None


@dataclass(frozen=True)
class SaveTables(Command):
    """Write table.csv (a row a contestant) and history.csv (a row an iteration) into a folder; `TablesSaved` answers."""

    interrupts: ClassVar[bool] = False

    folder: str
    mesh_name: str


@dataclass(frozen=True)
class TablesSaved(Report):
    """Both tables are in the folder."""

    folder: str


@dataclass(frozen=True, eq=False)
class RaceStarted(Report):
    """All stand on the start line; `start` (n, d)."""

    serial: int
    start: Floats


@dataclass(frozen=True, eq=False)
class RaceFrame(Report):
    """News of contestant `index`.

    Parameters
    ----------
    number : int            growing, of maps; 0 where the report brings no map
    positions : (n, d)      None on its way through the pipe: the map itself goes through shared memory
    iteration, seconds      of the map
    rows : tuple            of the history, since the report before; `terms` has for each a number that is equal where
                            energies may be compared
    markers : tuple         all so far
    phase, status, message  see `workbench.engine.racer.Racer`
    fields, inverted        what is watched of the map, as in a `Snapshot`
    """

    serial: int
    index: int
    number: int
    iteration: int
    seconds: float
    rows: tuple[RaceRow, ...]
    terms: tuple[int, ...]
    markers: tuple[Marker, ...]
    phase: str
    status: str
    message: str
    inverted_count: int
    positions: Floats | None = None
    fields: dict[str, Any] = field(default_factory=dict)
    inverted: Booleans | None = None

    def after(self, earlier: RaceFrame | None) -> RaceFrame:
        """The two in one: the newer map, the rows of both."""
        if earlier is None or earlier.serial != self.serial:
            return self
        rows, terms = earlier.rows + self.rows, earlier.terms + self.terms
        if self.number or not earlier.number:
            return replace(self, rows=rows, terms=terms)
        kept = {name: getattr(earlier, name) for name in MAP_FIELDS}
        return replace(self, rows=rows, terms=terms, **kept)


MAP_FIELDS = ("number", "iteration", "seconds", "inverted_count", "positions", "fields", "inverted")


@dataclass(frozen=True)
class RacePhase(Report):
    """Whether the race runs now, and whether nobody has a step to take any longer."""

    serial: int
    is_running: bool
    is_over: bool


@dataclass(frozen=True)
class RaceEnded(Report):
    """The process of the race died or was stopped; what was shown stays, and a new `StartRace` begins anew."""

    sentence: str
