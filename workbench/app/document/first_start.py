"""Which start is in force; that of a file which holds a map already: an artist's texture coordinates are seen as they are."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from workbench.app.document.first_anchors import is_sample
from workbench.core.registry import registry
from workbench.core.seams import texture_at_vertices
from workbench.engine.messages import Loaded
from workbench.engine.starts import default_initializer
from workbench.session.session import Session


def start_in_force(session: Session, loaded: Loaded | None) -> str:
    """Id of the start: the one that was chosen, that of a case, or the one that the solver wishes for."""
    if session.initializer or (loaded is not None and loaded.has_start):
        return session.initializer or "file"
    solver = registry().solvers.get(session.solver)
    return default_initializer(loaded.kind if loaded is not None else "plane", solver.initializer if solver is not None else "")


def with_start_held(before: Session, after: Session, loaded: Loaded | None) -> Session:
    """The choices with the start that was in force, where another solver would wish for another: none needs its own."""
    if after.solver == before.solver:
        return after
    held, wished = start_in_force(before, loaded), start_in_force(after, loaded)
    return after if after.initializer != before.initializer or held == wished else replace(after, initializer=held)


def has_own_map(session: Session) -> bool:
    """Whether the start is the map that the mesh's own file holds."""
    return session.initializer == "file" and bool(session.source) and session.start_file == session.source


def with_own_start(loaded: Loaded, session: Session) -> Session:
    """The choices with the file's own map as the start, where it has one that a solver can go on from."""
    turns = _turns(loaded, session)
    if turns is None or min(turns) > 0:
        return session
    return replace(session, initializer="file", start_file=session.source)


def why_not_own_start(loaded: Loaded, session: Session) -> str:
    """A sentence where the file has a map, and the start is another one that nobody chose; else empty."""
    turns = None if session.initializer else _turns(loaded, session)
    if turns is None or min(turns) == 0:
        return ""
    return (
        f"The texture coordinates of the file turn {min(turns)} of {loaded.mesh.simplex_count} triangles over or flatten them, "
        "so the map begins elsewhere; Start > From a file shows them."
    )


def _turns(loaded: Loaded, session: Session) -> tuple[int, int] | None:
    """How many triangles the file's own map does not leave face up, and how many not face down; None where it has none."""
    return None if loaded.kind != "parameterize" or is_sample(session.source) else _counted(loaded)


@lru_cache(maxsize=1)  # asked for what to say, and for where to begin
def _counted(loaded: Loaded) -> tuple[int, int] | None:
    positions = texture_at_vertices(loaded.mesh)
    if positions is None:
        return None
    from workbench.core.jacobians import build_elements, determinants

    found = determinants(build_elements(loaded.mesh), positions)
    return int(np.count_nonzero(~(found > 0))), int(np.count_nonzero(~(found < 0)))
