"""What a run led to: the map, its history, and how good it is."""

from __future__ import annotations

import os
from dataclasses import dataclass, fields
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.measure import Measure
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.run import HistoryRow, RunResult
from workbench.core.status import Status
from workbench.engine.preparation import Prepared
from workbench.engine.run_report import build_report, history_text
from workbench.io.atomic import write_text
from workbench.io.json_text import json_text
from workbench.io.tables import number
from workbench.io.write import write_map
from workbench.notebook.measuring import Measured, measured_map
from workbench.notebook.pictures import WithPicture, html_page, picture_of
from workbench.notebook.source import Source
from workbench.notebook.wording import for_scripts


@dataclass(frozen=True, eq=False)
class Solution(WithPicture):
    """A map with all that is known of how it came to be.

    Parameters
    ----------
    prepared : Prepared      mesh, problem, start and solver of the run
    result : RunResult       its states and rows
    fault : str              the sentence of a solver that failed; its last map is kept
    """

    prepared: Prepared
    result: RunResult
    fault: str = ""

    @property
    def positions(self) -> Floats:
        """(n, d) float64, the map, a row a vertex of `mesh`."""
        return self.result.state.positions

    @property
    def start(self) -> Floats:
        """(n, d) float64, where it began."""
        return self.prepared.start

    @property
    def mesh(self) -> Mesh:
        """The source."""
        return self.problem.mesh

    @property
    def problem(self) -> Problem:
        """What was minimised."""
        return self.prepared.problem

    @property
    def source(self) -> Source:
        """The mesh as it was opened."""
        return Source(self.prepared.opened)

    @property
    def status(self) -> Status:
        """How the run ended; its value is a sentence."""
        return self.result.state.status

    @property
    def message(self) -> str:
        """What happened and what to try, in a sentence."""
        return for_scripts(self.fault or self.status.value)

    @property
    def energy(self) -> float:
        """Sum of w D over the simplices, plus the penalties of soft anchors."""
        return self.result.state.energy

    @property
    def mean_distortion(self) -> float:
        """Energy over the area or volume of the source."""
        return self.energy / self.problem.total_measure

    @property
    def iterations(self) -> int:
        """Steps taken, those of the run that it goes on from with them."""
        return self.result.state.iteration

    @cached_property
    def history(self) -> dict[str, np.ndarray]:
        """Columns (k,) by name, a row an iteration, for tables and plots: see `workbench.core.run.HistoryRow`."""
        rows = self.result.rows
        return {item.name: np.array([getattr(row, item.name) for row in rows]) for item in fields(HistoryRow)}

    @cached_property
    def report(self) -> dict[str, Any]:
        """The object that `workbench solve --report` writes, verdicts of injectivity among it."""
        found = build_report(self.prepared, self.result)
        return found | {"status": "FAILED", "message": self.fault} if self.fault else found

    def measure(self) -> Measured:
        """Every measure of the map."""
        return measured_map(self.mesh, self.positions, (self._measure,))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the map in the format of the ending, as `workbench solve --out` does.

        `.json` is the report. Raises `WorkbenchError` for other endings, and places that cannot be written.
        """
        if Path(path).suffix.lower() == ".json":
            write_text(path, json_text(self.report))
            return
        opened, anchors = self.prepared.opened, self.problem.anchors
        write_map(
            path,
            opened.file.mesh,
            opened.mesh,
            self.positions,
            opened.kind,
            others=(self._measure,),
            anchor_vertices=anchors.vertices,
            anchor_targets=anchors.targets,
        )

    def save_history(self, path: str | os.PathLike[str]) -> None:
        """Write the history as CSV, a row an iteration. Raises `WorkbenchError`."""
        write_text(path, history_text(self.result.rows))

    @property
    def _measure(self) -> Measure:
        return Measure.of_distortion(self.problem.distortion)

    @property
    def _facts(self) -> list[tuple[str, str]]:
        state, opened = self.result.state, self.prepared.opened
        anchors = self.problem.anchors
        rows = [
            ("mesh", opened.file.path or opened.mesh.name or "made"),
            ("distortion", self._measure.id),
            ("solver", self.prepared.solver.label),
            ("status", "FAILED" if self.fault else self.status.name),
            ("iterations", str(self.iterations)),
            ("energy", number(self.energy, 10)),
            ("mean distortion", number(self.mean_distortion, 8)),
            ("inverted", str(state.inverted)),
        ]
        if len(anchors.vertices):
            is_there = state.anchor_error <= self.problem.anchor_tolerance
            words = "in place" if is_there else f"off by {number(state.anchor_error, 3)} at most"
            rows.append(("anchors", f"{len(anchors.vertices)}, {words}"))
        return [*rows, ("seconds", number(self.result.seconds.get("total", 0.0), 3))]

    def __repr__(self) -> str:
        return f"<Solution {', '.join(f'{name} {value}' for name, value in self._facts)}>"

    @cached_property
    def png(self) -> bytes:
        """A picture of the source, and of the map in the colours of its distortion."""
        return picture_of(self.mesh, self.positions, self._measure, self.problem.anchors.vertices)

    def _repr_html_(self) -> str:
        is_well = not (self.fault or self.status.is_failure)
        return html_page(self.png, self._facts, () if is_well else (self.message,))
