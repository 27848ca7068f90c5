"""The report and the history of a run: one JSON object, one CSV row an iteration."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict
from typing import Any

import numpy as np

from workbench.core.injectivity import global_injectivity, local_injectivity
from workbench.core.jacobians import determinants, signed_singular_values
from workbench.core.run import HistoryRow, RunResult
from workbench.core.threads import thread_count
from workbench.engine.doctor import versions
from workbench.engine.preparation import Prepared
from workbench.io.write import csv_text

SCHEMA = 1


def build_report(prepared: Prepared, result: RunResult) -> dict[str, Any]:
    """The object of `--report`; extremes and verdicts are those of the last map, on unsigned singular values."""
    opened, problem, state = prepared.opened, prepared.problem, result.state
    sigma = np.abs(signed_singular_values(problem.elements, state.positions))
    distortion = problem.distortion
    return {
        "schema": SCHEMA,
        "input": {
            "path": prepared.path,
            "sha256": opened.file.sha256,
            "kind": opened.kind,
            "vertices": opened.mesh.vertex_count,
            "simplices": opened.mesh.simplex_count,
        },
        "distortion": {
            "id": distortion.id,
            "formula": distortion.formula,
            "parameters": distortion.parameter_values,
        },
        "solver": prepared.solver.id,
        "init": prepared.initializer,
        "status": state.status.name,
        "message": state.status.value,
        "iterations": state.iteration,
        "energy": state.energy,
        "mean_distortion": state.energy / problem.total_measure,
        "initial_energy": result.initial.energy,
        "gradient_norm": state.gradient_norm,
        "inverted": state.inverted,
        "initial_inverted": result.initial.inverted,
        "min_det": determinants(problem.elements, state.positions).min(),
        "max_sigma": sigma.max(),
        "min_sigma": sigma.min(),
        "anchors": {"count": len(problem.anchors.vertices), "max_error": state.anchor_error},
        "injective": {
            "local": local_injectivity(opened.mesh, state.positions).holds,
            "global": global_injectivity(opened.mesh, state.positions).holds,
        },
        "seconds": {**result.seconds, **prepared.seconds},
        "threads": thread_count(),
        "versions": versions(),
    }


def history_text(rows: Iterable[HistoryRow]) -> str:
    """CSV of history rows, one an iteration; 17 significant digits; numbers that are not finite stay empty."""
    return csv_text(asdict(row) for row in rows)
