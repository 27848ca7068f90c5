"""What to cite, for a notebook."""

from __future__ import annotations

import os
from pathlib import Path

from workbench.core.bibliography import Cited, bibtex, cited, methods_named, of_distortion
from workbench.engine.citing import cited_in, cited_in_file
from workbench.engine.preparation import GIVEN
from workbench.engine.session_file import is_session_file
from workbench.io.atomic import write_text
from workbench.notebook.solution import Solution
from workbench.session.record import SessionRecord


class References(str):
    """A bibliography in BibTeX, shown as it is."""

    def __repr__(self) -> str:
        return str(self)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write it as a `.bib` file. Raises `WorkbenchError`."""
        write_text(path, str(self))


def references(*what: Solution | SessionRecord | str | os.PathLike[str]) -> References:
    """BibTeX of what results, session files, and methods by their ids use; the survey comes first.

    Raises `WorkbenchError` for a name that is no method, and a session that cannot be read.
    """
    return References(bibtex(item for each in what for item in _cited(each)))


def _cited(what: Solution | SessionRecord | str | os.PathLike[str]) -> tuple[Cited, ...]:
    if isinstance(what, SessionRecord):
        return cited_in(what)
    if isinstance(what, str | os.PathLike):
        name = os.fspath(what)
        return cited_in_file(name) if is_session_file(name) or Path(name).is_file() else methods_named(name)
    prepared = what.prepared
    distortion = prepared.problem.distortion
    parts = [*of_distortion(distortion.id), *of_distortion(distortion.formula), cited(type(prepared.solver))]
    if prepared.initializer != GIVEN:
        parts += methods_named(prepared.initializer)
    return tuple(parts)
