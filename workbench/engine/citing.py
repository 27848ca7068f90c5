"""What is to be cited for a session: the methods that its choices name, and those of the legs that led to its map."""

from __future__ import annotations

from workbench.core.bibliography import Cited, methods_named, of_distortion
from workbench.core.registry import registry
from workbench.engine.starts import default_initializer
from workbench.io.opening import OpenedSource
from workbench.session.record import SessionRecord
from workbench.session.session import Session


def cited_in(record: SessionRecord, opened: OpenedSource | None = None) -> tuple[Cited, ...]:
    """Distortions, solvers and the start of a session, each once; what is not registered here is left out.

    opened : its mesh, which tells the start where the session leaves it to the kind of map
    """
    found: dict[Cited, None] = {}
    for choices in (*(leg.choices for leg in record.legs), record.session):
        found |= dict.fromkeys(of_distortion(choices.distortion))
        if choices.solver in registry().solvers:
            found |= dict.fromkeys(methods_named(choices.solver))
    start = _start(record.session, opened)
    if start in registry().initializers:
        found |= dict.fromkeys(methods_named(start))
    return tuple(found)


def _start(session: Session, opened: OpenedSource | None) -> str:
    if session.initializer:
        return session.initializer
    if opened is None:
        return ""
    if opened.start is not None:
        return "file"
    solver = registry().solvers.get(session.solver)
    return default_initializer(opened.kind, "" if solver is None else solver.initializer)
