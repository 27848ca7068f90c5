"""What is to be cited for a session: the methods that its choices name, and those of the legs that led to its map."""

from __future__ import annotations

import os

from workbench.core.bibliography import Cited, methods_named, of_distortion
from workbench.core.method import Kind
from workbench.core.registry import registry
from workbench.engine.session_file import read_session, source_trouble
from workbench.engine.starts import default_initializer
from workbench.io.opening import open_source
from workbench.session.record import SessionRecord


def cited_in(record: SessionRecord, kind: Kind | None = None) -> tuple[Cited, ...]:
    """Distortions, solvers and the start of a session, each once; what is not registered here is left out.

    kind : of its map, where that decides the start; None: the mesh has a start of its own, or it is not known
    """
    session, known = record.session, registry()
    found: dict[Cited, None] = {}
    for choices in (*(leg.choices for leg in record.legs), session):
        found |= dict.fromkeys(of_distortion(choices.distortion))
        if choices.solver in known.solvers:
            found |= dict.fromkeys(methods_named(choices.solver))
    start = session.initializer
    if not start and kind is not None:
        start = default_initializer(kind, known.solvers[session.solver].initializer if session.solver in known.solvers else "")
    if start in known.initializers:
        found |= dict.fromkeys(methods_named(start))
    return tuple(found)


def cited_in_file(path: str | os.PathLike[str]) -> tuple[Cited, ...]:
    """What is to be cited for a session file; its mesh is opened where that decides the start, and it is at its place.

    Raises `WorkbenchError` for a file that is no session.
    """
    record = read_session(path)
    session = record.session
    if session.initializer or source_trouble(record):
        return cited_in(record)
    opened = open_source(session.source, kind=session.kind, fixes=session.fixes)
    return cited_in(record, opened.kind if opened.start is None else None)
