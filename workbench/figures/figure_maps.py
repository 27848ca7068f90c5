"""The maps of a recipe: read from files, or solved for, each solver running once however many of its maps are shown."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.carried_surface import CarriedSurface
from workbench.core.errors import SolverFailedError, WorkbenchError
from workbench.core.glyph_places import GlyphPlaces
from workbench.core.jacobians import Elements, build_elements
from workbench.core.measure import Measure, SingularValues
from workbench.core.mesh import Mesh
from workbench.core.run import HistoryRow
from workbench.core.solid_look.solid import Solid
from workbench.core.solver import Interrupt, never
from workbench.core.state import State
from workbench.core.surface_jacobians import singular_values_of_any
from workbench.engine.carried_source import carry_source
from workbench.engine.replay import anchors_of, replay
from workbench.engine.starts import adjusted_start
from workbench.figures.history_file import read_history
from workbench.figures.mesh_pictures import Skin, skin_of
from workbench.figures.recipe import MapChoice
from workbench.io.opening import OpenedSource, map_from_file, open_source
from workbench.session.record import SessionRecord


@dataclass(frozen=True, eq=False)
class FigureMap:
    """A map as panels need it.

    Parameters
    ----------
    title : str                    what captions call it
    mesh : Mesh                    the source
    positions : (n, d) float64     the map
    anchors : (k,) int64           anchored vertices
    rows : tuple of HistoryRow     up to this map; empty where it comes from a file
    carried : CarriedSurface       that a solid takes along; None where there is none
    cuts : (c, 2) int64            edges that a fix opened
    glyph_places : dict            by their number, as they are found; shared by all maps of the source
    """

    title: str
    mesh: Mesh
    positions: Floats
    anchors: Integers
    rows: tuple[HistoryRow, ...] = ()
    carried: CarriedSurface | None = None
    cuts: Integers = field(default_factory=lambda: np.empty((0, 2), np.int64))
    glyph_places: dict[int, GlyphPlaces] = field(default_factory=dict, repr=False)

    @cached_property
    def elements(self) -> Elements:
        return build_elements(self.mesh)

    @cached_property
    def skin(self) -> Skin:
        return skin_of(self.mesh)

    @cached_property
    def solid(self) -> Solid:
        return Solid(self.mesh)

    def moved(self, positions: Floats, anchors: Integers) -> FigureMap:
        """Another map of the same source; what was made for the source is not made anew."""
        other = replace(self, positions=positions, anchors=anchors)
        vars(other).update({name: vars(self)[name] for name in ("elements", "skin", "solid") if name in vars(self)})
        return other

    @cached_property
    def singular_values(self) -> SingularValues:
        return SingularValues(singular_values_of_any(self.elements, self.positions))

    def values(self, measure: Measure) -> Floats:
        """(m,) values of a measure, infinite where it is not defined."""
        with np.errstate(all="ignore"):
            found = measure.prepare(self.singular_values.dimension)(self.singular_values)
        return np.where(np.isnan(found), np.inf, found)


def make_maps(
    choices: Sequence[MapChoice], *, interrupt: Interrupt = never, tell: Callable[[str], None] = lambda _: None
) -> dict[str, FigureMap]:
    """Every map by its name. Raises `WorkbenchError` naming the map that cannot be made."""
    found: dict[str, FigureMap] = {}
    opened: dict[tuple[str, str, tuple[str, ...]], OpenedSource] = {}
    for choice in choices:
        if choice.name in found:
            continue
        session = choice.session
        key = session.source, session.kind, session.fixes
        try:
            if key not in opened:
                opened[key] = open_source(session.source, kind=session.kind, fixes=session.fixes)
            if choice.target:
                found[choice.name] = _map_of_file(choice, opened[key])
                continue
            tell(f"{choice.title}: solving on {session.source}")
            run = [item for item in choices if not item.target and _is_same_run(item, choice)]
            found |= _solved(run, opened[key], interrupt)
        except WorkbenchError as error:
            kind = SolverFailedError if isinstance(error, SolverFailedError) else WorkbenchError
            raise kind(f"Map {choice.name}: {error.sentence}", fixes=error.fixes) from error
    return found


def _map_of_file(choice: MapChoice, opened: OpenedSource) -> FigureMap:
    positions = map_from_file(choice.target, opened.mesh, opened.kind)
    positions = adjusted_start(opened.mesh, opened.kind, positions, match_area=False)
    rows = read_history(choice.history) if choice.history else ()
    carried, anchors = _carried(choice, opened), _anchors(choice, opened)
    return FigureMap(choice.title, opened.mesh, positions, anchors, rows, carried, opened.cut_edges)


def _is_same_run(first: MapChoice, second: MapChoice) -> bool:
    return replace(first.session, iterations=0) == replace(second.session, iterations=0)


def _solved(choices: Sequence[MapChoice], opened: OpenedSource, interrupt: Interrupt) -> Mapping[str, FigureMap]:
    """The maps of one run at the iterations that are wanted; who is done before keeps the last one."""
    longest = max(choices, key=lambda choice: choice.session.iterations)
    kept: dict[str, Floats] = {}

    def keep(state: State) -> None:
        for choice in choices:
            if state.iteration <= choice.session.iterations:
                kept[choice.name] = state.positions

    result = replay(SessionRecord(longest.session), opened, interrupt=interrupt, on_state=keep).result
    if interrupt():
        raise WorkbenchError("The figure was interrupted; nothing was written.")
    if result.state.status.is_failure:
        raise SolverFailedError(f"The solver failed: {result.state.status.value}")
    carried = _carried(longest, opened)
    return {
        choice.name: FigureMap(
            choice.title,
            opened.mesh,
            kept[choice.name],
            _anchors(choice, opened),
            tuple(row for row in result.rows if row.iteration <= choice.session.iterations),
            carried,
            opened.cut_edges,
        )
        for choice in choices
    }


def _carried(choice: MapChoice, opened: OpenedSource) -> CarriedSurface | None:
    return carry_source(choice.session.carried, opened.mesh) if choice.session.carried else None


def _anchors(choice: MapChoice, opened: OpenedSource) -> Integers:
    return anchors_of(choice.session, opened.mesh.vertex_count, opened.mesh.dimension).vertices
