"""What is measured of a map, as lines for people."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from workbench.io.tables import number, table

COLUMNS = ("mean", "min", "p50", "p95", "max", "area_weighted_mean")


def measure_rows(measured: Mapping[str, Any]) -> list[list[str]]:
    """A row a measure below a head, of what `workbench.core.quality.measure_map` found."""
    rows = [["measure", *COLUMNS]]
    return rows + [[id, *(number(values[name]) for name in COLUMNS)] for id, values in measured["measures"].items()]


def measure_lines(measured: Mapping[str, Any]) -> tuple[str, ...]:
    """The table, then counts and verdicts, each a line or more."""
    verdict = measured["injective"]
    words = {True: "yes", False: "no", None: "not known"}
    return (
        table(measure_rows(measured)),
        "inverted {inverted}, degenerate {degenerate}, least det {min_det:.6g}".format_map(measured),
        f"locally injective: {words[verdict['local']]}, globally injective: {words[verdict['global']]}",
        verdict["reason"],
    )
