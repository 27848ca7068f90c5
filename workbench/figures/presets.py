"""Recipes for figures as in the survey: on samples of our own, or on a mesh and maps that a user names."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from workbench.core.errors import WorkbenchError
from workbench.core.samples import make_sample, sample_info
from workbench.figures.recipe import CHEQUERED, MapChoice, Page, Panel, Recipe
from workbench.figures.solver_sheet import SheetCell, sheet_page, sheet_panels
from workbench.io.opening import SAMPLE, open_source
from workbench.session.session import Session

MEASURES = ("symmetric-dirichlet", "condition-number", "dirichlet")
"""Those of Fig. 3: (32), (29), (25)."""
FACTOR = "average-singular-value"
SOLVER = "projected-newton"
CONTESTANTS = {"projected-newton": "Projected Newton", "slim": "SLIM", "l-bfgs": "L-BFGS", "aqp": "AQP"}
STARTS = {"tutte": "Tutte", "lscm": "LSCM"}
STEPS = (1, 5, 20)
"""Iterations that the contact sheet shows before the last."""
LAST = 1000
POSE = ((0.06, 0.27), (-0.14, 0.10), (0.09, -0.01), (0.0, 0.0), (0.0, -0.26))
"""Moves of the figure's anchors, sorted from left to right, in diameters: a dancer."""


@dataclass(frozen=True)
class Given:
    """What a user names for a preset: a mesh with its kind and fixes, and maps of it as (label, file)."""

    mesh: str = ""
    kind: str = "auto"
    fixes: tuple[str, ...] = ()
    targets: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class Preset:
    """A figure by name; `make` takes what the user named."""

    id: str
    label: str
    citation: str
    make: Callable[[Given], Recipe]


def preset_recipe(id: str, given: Given | None = None) -> Recipe:
    """The recipe of a preset. Raises `WorkbenchError` where what was given does not do."""
    given = given or Given()
    if given.targets and not given.mesh:
        raise WorkbenchError("A map in a file is of some mesh; name the mesh, too.")
    return PRESETS[id].make(given)


def _session(given: Given, sample: str) -> Session:
    """The choices for the user's mesh with the anchors that it comes with, or for a sample."""
    session = Session(source=SAMPLE + sample, solver=SOLVER, iterations=LAST)
    if not given.mesh:
        return session
    session = replace(session, source=given.mesh, kind=given.kind, fixes=given.fixes)
    opened = open_source(given.mesh, kind=given.kind, fixes=given.fixes)
    if opened.anchor_vertices is None or opened.anchor_targets is None:
        return session
    return replace(
        session,
        anchor_vertices=tuple(opened.anchor_vertices.tolist()),
        anchor_targets=tuple(map(tuple, opened.anchor_targets.tolist())),
    )


def _targets(given: Given, session: Session) -> tuple[MapChoice, ...]:
    return tuple(MapChoice(f"map-{i + 1}", session, target=file, label=label) for i, (label, file) in enumerate(given.targets))


def _distribution(given: Given) -> Recipe:
    """A row a map: the source under the texture, then the map in the colours of three distortions."""
    session = _session(given, "bumpy-disc")
    maps = _targets(given, session) or (MapChoice("map", session, label="source"),)
    panels: list[Panel] = []
    for choice in maps:
        is_last = choice is maps[-1]
        name = choice.title if given.targets else "source"
        panels.append(Panel("source", (choice.name,), CHEQUERED, caption=name))
        panels += [
            Panel("map", (choice.name,), measure, scale=measure, frame="map", bar=is_last, caption=" ") for measure in MEASURES
        ]
    return Recipe(Page(columns=1 + len(MEASURES)), maps, tuple(panels))


def _sheet(given: Given) -> Recipe:
    """A column a solver, a row an iteration, the textured sources at the right."""
    session = _session(given, "gingerbread")
    if not given.mesh:
        session = _dancing(session)
    rows: list[tuple[MapChoice, ...]]
    if given.targets:
        rows = [_targets(given, session)]
    else:
        rows = [
            tuple(
                MapChoice(
                    f"{id}-{steps}",
                    replace(session, solver=id, iterations=steps),
                    label=f"{label}, {'last' if steps == LAST else steps}",
                )
                for id, label in CONTESTANTS.items()
            )
            for steps in (*STEPS, LAST)
        ]
    cells = [[SheetCell(choice.name) for choice in row] for row in rows]
    sources = [SheetCell(choice.name, f"source, {choice.title.removesuffix(', last')}") for choice in rows[-1]]
    columns, panels = sheet_panels(cells, sources)
    return Recipe(sheet_page(columns), tuple(choice for row in rows for choice in row), panels)


def _dancing(session: Session) -> Session:
    """The figure's anchors, moved."""
    name = session.source.removeprefix(SAMPLE)
    mesh, anchors = make_sample(name), np.array(sample_info(name).anchors)
    anchors = anchors[np.argsort(mesh.vertices[anchors, 0])]
    targets = mesh.vertices[anchors] + mesh.diameter * np.array(POSE)
    return replace(session, anchor_vertices=tuple(anchors.tolist()), anchor_targets=tuple(map(tuple, targets.tolist())))


def _histograms(given: Given) -> Recipe:
    """Maps in the colours of (78), and below each the histogram of it in the same colours, all on one scale."""
    session = _session(given, "bumpy-disc")
    maps = _targets(given, session) or (
        *_starts(given, session),
        MapChoice("symmetric-dirichlet", session, label="Symmetric Dirichlet"),
    )
    pictures = [Panel("map", (choice.name,), FACTOR, scale="factor", frame="map") for choice in maps]
    charts = [Panel("histogram", (choice.name,), FACTOR, scale="factor") for choice in maps]
    return Recipe(Page(columns=len(maps)), maps, (*pictures, *charts))


def _starts(given: Given, session: Session) -> tuple[MapChoice, ...]:
    """The start of the user's mesh; of the sample a map with a fixed boundary and one that keeps angles."""
    start = replace(session, iterations=0)
    if given.mesh:
        return (MapChoice("start", start, label="start"),)
    return tuple(MapChoice(id, replace(start, initializer=id), label=label) for id, label in STARTS.items())


def _before_after(given: Given) -> Recipe:
    """The source, and the map before and after, on one scale of colours and one of length."""
    session = _session(given, "fingers")
    before = MapChoice("before", replace(session, iterations=0), label="before")
    after = MapChoice("after", session, label="after")
    if len(given.targets) > 2:
        raise WorkbenchError("Before and after are two maps; name two files, or one that comes after the start.")
    if given.targets:
        after = replace(after, target=given.targets[-1][1], label=given.targets[-1][0])
    if len(given.targets) == 2:
        before = replace(before, target=given.targets[0][1], label=given.targets[0][0])
    shared = Panel("map", scale="distortion", frame="map")
    panels = (
        Panel("source", ("after",), CHEQUERED, caption="source"),
        replace(shared, maps=("before",)),
        replace(shared, maps=("after",)),
        Panel("empty"),
        Panel("colour-bar", scale="distortion", span=2),
    )
    return Recipe(Page(columns=3), (before, after), panels)


PRESETS = {
    item.id: item
    for item in (
        Preset("fig3", "A map in the colours of (32), (29) and (25)", "Fig. 3", _distribution),
        Preset("fig11", "Solvers and iterations on one scale, with textured sources", "Fig. 11", _sheet),
        Preset("fig1-histograms", "Maps with histograms of (78)", "Fig. 1", _histograms),
        Preset("before-after", "A map before and after, on a common scale", "", _before_after),
    )
}
