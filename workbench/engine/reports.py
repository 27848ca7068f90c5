"""What the engine's loop tells of a mesh that was read, and of a command that it refuses."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from workbench.core.errors import WorkbenchError
from workbench.core.facets import facet_table, neighbouring_simplices
from workbench.core.samples import sample_info
from workbench.engine.messages import Command, Load, Loaded, Refused, SetProblem, TakeUp
from workbench.io.opening import SAMPLE

if TYPE_CHECKING:
    from workbench.io.opening import OpenedSource


def loaded_report(command: Load, opened: OpenedSource) -> Loaded:
    """The mesh as it was read, with what the window needs at once."""
    anchors = opened.anchor_vertices
    if anchors is None and command.source.startswith(SAMPLE):  # here the mesh is made already, in the window it is not
        anchors = np.array(sample_info(command.source.removeprefix(SAMPLE)).anchors, dtype=np.int64)
    return Loaded(
        generation=command.generation,
        mesh=opened.mesh,
        kind=opened.kind,
        lines=opened.lines,
        cut_edges=opened.cut_edges,
        source=command.source,
        fixes=command.fixes,
        anchor_vertices=anchors,
        anchor_targets=opened.anchor_targets,
        neighbours=neighbouring_simplices(facet_table(opened.mesh.simplices)) if opened.kind == "volume" else None,
        has_start=opened.start is not None,
    )


def refusal(command: Command, error: WorkbenchError, generation: int, choices: SetProblem) -> Refused:
    """The sentence of the error; `choices` are what stays in force, `generation` that of the present mesh."""
    kept, serial = (choices, command.serial) if isinstance(command, SetProblem) else (None, 0)
    serial = command.anchors.serial if isinstance(command, TakeUp) else serial
    generation = command.generation if isinstance(command, Load) else generation
    lines = tuple(getattr(error, "lines", ()))  # the report on load, where `open_source` could read the mesh
    return Refused(generation, type(command).__name__, error.sentence, error.fixes, lines, kept, serial)
