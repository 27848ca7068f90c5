"""What a race came to, as tables: a row a contestant, a row an iteration."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields
from typing import Any

from workbench.core.injectivity import global_injectivity, local_injectivity
from workbench.engine.race import Race, Racer, RaceRow

HISTORY_COLUMNS = tuple(item.name for item in fields(RaceRow))


def race_table(race: Race, mesh_name: str) -> list[dict[str, Any]]:
    """A row a contestant, as it stands now.

    `relative_error` is (E - best) / |best| to the least energy that any contestant reached with its anchors in place. The
    columns `locally_injective` and `globally_injective` are the verdicts on its map: true, false, None where not told.
    """
    return [_row(race, racer, mesh_name) for racer in race.racers]


def _row(race: Race, racer: Racer, mesh_name: str) -> dict[str, Any]:
    last = racer.rows[-1]
    mesh = racer.problem.mesh
    return {
        "mesh": mesh_name,
        "contestant": racer.label,
        "solver": racer.solver.id if racer.solver is not None else "",
        "status": racer.status_name,
        "iterations": last.iteration,
        "seconds": racer.seconds,
        "factorisations": last.factorisations,
        "energy_evaluations": last.energy_evaluations,
        "gradient_evaluations": last.gradient_evaluations,
        "hessian_evaluations": last.hessian_evaluations,
        "trials": last.trials,
        "energy": last.energy,
        "mean_distortion": last.mean_distortion,
        "relative_error": float(race.relative_errors(racer)[-1]),
        "gradient_norm": last.gradient_norm,
        "anchor_error": last.anchor_error,
        "inverted": last.inverted,
        "locally_injective": local_injectivity(mesh, racer.positions).holds,
        "globally_injective": global_injectivity(mesh, racer.positions).holds,
        "message": racer.message,
    }


def history_rows(race: Race, mesh_name: str) -> Iterator[dict[str, Any]]:
    """A row an iteration of every contestant; `switch` says what was switched just before it."""
    for racer in race.racers:
        switches = {marker.index: marker.sentence for marker in racer.markers}
        errors = race.relative_errors(racer).tolist()
        for index, (row, error) in enumerate(zip(racer.rows, errors, strict=True)):
            values = {name: getattr(row, name) for name in HISTORY_COLUMNS}
            yield {
                "mesh": mesh_name,
                "contestant": racer.label,
                **values,
                "relative_error": error,
                "switch": switches.get(index, ""),
            }
