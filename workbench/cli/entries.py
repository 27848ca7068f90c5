"""Who runs on which mesh in a comparison, and what was refused and why."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from workbench.cli.options import wishes_of
from workbench.cli.output import full_sentence
from workbench.core.errors import WorkbenchError
from workbench.core.registry import registry
from workbench.core.solver import Solver
from workbench.engine.contestants import Contestant, SolverChoice
from workbench.engine.preparation import PreparedProblem, configured, prepare_problem
from workbench.io.opening import map_from_file
from workbench.io.text import shown_name

REFUSED = "REFUSED"
"""What the table says in place of a status."""


@dataclass(frozen=True, eq=False)
class Entry:
    """A mesh with those who run on it.

    Parameters
    ----------
    name, path : str             what the table calls the mesh, and its file
    prepared : PreparedProblem   None where the mesh itself is refused
    contestants : tuple          in the order of the command
    refused : dict               why, by the label of each contestant who cannot run, in the order of the command
    reason : str                 why the mesh is refused
    """

    name: str
    path: str
    prepared: PreparedProblem | None = None
    contestants: tuple[Contestant, ...] = ()
    refused: Mapping[str, str] = field(default_factory=dict)
    reason: str = ""


def enter_all(options: argparse.Namespace, choices: tuple[SolverChoice, ...], given: Mapping[str, str]) -> list[Entry]:
    """An entry for each file of `options`; what does not fit is refused in its entry.

    Raises `WorkbenchError` where nothing at all can run, and for what is wrong with the command itself.
    """
    for choice in choices:
        registry().solver(choice.solver).configured(dict(choice.values))  # refuses names that it has not
    names = mesh_names(options.files)
    entries, errors = [], []
    for name, file in zip(names, options.files, strict=True):
        try:
            entries.append(_entry(options, name, file, choices, given))
        except WorkbenchError as error:
            errors.append(error)
            reason = full_sentence(error)
            entries.append(Entry(name, file, reason=reason, refused={choice.label: reason for choice in choices}))
    if not any(entry.contestants for entry in entries):
        _refuse_all(entries, errors)
    return entries


def _entry(
    options: argparse.Namespace, name: str, file: str, choices: tuple[SolverChoice, ...], given: Mapping[str, str]
) -> Entry:
    unfit: dict[type[Solver], str] = {}
    methods = [registry().solver(choice.solver) for choice in choices]
    prepared, settings = prepare_problem(wishes_of(options), file, methods, unfit)
    contestants = [
        Contestant(choice.label, configured(method, {**settings, **choice.values}, options.seed))
        for choice, method in zip(choices, methods, strict=True)
        if method not in unfit
    ]
    mesh, kind = prepared.opened.mesh, prepared.opened.kind
    contestants += [Contestant(label, None, map_from_file(place, mesh, kind)) for label, place in given.items()]
    refused = {choice.label: unfit[method] for choice, method in zip(choices, methods, strict=True) if method in unfit}
    return Entry(name, file, prepared, tuple(contestants), refused)


def _refuse_all(entries: list[Entry], errors: list[WorkbenchError]) -> None:
    """Raise for entries of which none can run: the error itself where all meshes meet one and the same."""
    sentences = dict.fromkeys(sentence for entry in entries for sentence in (entry.reason, *entry.refused.values()) if sentence)
    if errors and len(sentences) == 1:
        raise errors[0]
    if len(entries) == 1 or len(sentences) == 1:
        raise WorkbenchError(" ".join(sentences))
    parts = (f"{entry.path}: {sentence}" for entry in entries for sentence in dict.fromkeys(entry.refused.values()))
    raise WorkbenchError(f"Nothing can be compared. {' '.join(parts)}")


def mesh_names(files: list[str]) -> list[str]:
    """A name for each file: its last part without the ending, numbered where that is not enough."""
    names: list[str] = []
    for file in files:
        stem = shown_name(Path(file.removeprefix("sample:")).stem)
        taken = sum(name == stem or name.startswith(f"{stem}-") for name in names)
        names.append(f"{stem}-{taken + 1}" if taken else stem)
    return names


def refused_rows(entry: Entry, solvers: Mapping[str, str], columns: list[str]) -> list[dict[str, Any]]:
    """Rows of the table, with these columns, for those who cannot run; `solvers` are ids by label."""
    empty: dict[str, Any] = dict.fromkeys(columns)
    return [
        {**empty, "mesh": entry.name, "contestant": label, "solver": solvers[label], "status": REFUSED, "message": sentence}
        for label, sentence in entry.refused.items()
    ]


def complaints(entry: Entry) -> list[str]:
    """What standard error says about what was refused: a mesh once, else each contestant."""
    if entry.reason:
        return [f"{entry.name}: {entry.reason}"]
    return [f"{entry.name}, {label}: {sentence}" for label, sentence in entry.refused.items()]
