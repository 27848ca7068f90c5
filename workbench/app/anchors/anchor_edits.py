"""What an edited cell, or rows from elsewhere, make of a set of anchors. No widgets."""

from __future__ import annotations

import numpy as np

from workbench.app.document.anchor_set import AnchorSet
from workbench.core.arrays import Integers
from workbench.core.errors import WorkbenchError
from workbench.io.anchor_rows import (
    AXES,
    MORE,
    AnchorTable,
    coordinate_of,
    group_of,
    named_columns,
    parse_rows,
    rows_of,
    switch_of,
    vertex_of,
    weight_of,
)


def edited(anchors: AnchorSet, column: str, vertices: Integers, text: str, vertex_count: int) -> AnchorSet:
    """The anchors with one value in a column for all of `vertices` (k,).

    `column` is vertex, x, y, z, weight, group or on; `text` what was typed. Raises `WorkbenchError` for what cannot be.
    """
    text = text.strip()
    if column == "vertex":
        return _at_vertex(anchors, vertices, vertex_of(text, vertex_count))
    if column in AXES:
        value, axis = coordinate_of(text.replace(",", ".") if "." not in text else text), AXES.index(column)
        targets = anchors.targets_of(vertices)
        targets[:, axis] = value
        return anchors.moved(vertices, targets)
    if column == "weight":
        return anchors.weighted(vertices.tolist(), weight_of(text.replace(",", ".")))
    if column == "group":
        group = group_of(text)
        return anchors.ungrouped(vertices) if group < 0 else anchors.in_group(vertices.tolist(), group)
    return anchors.switched(vertices.tolist(), on=switch_of(text))


def _at_vertex(anchors: AnchorSet, vertices: Integers, vertex: int) -> AnchorSet:
    if len(vertices) != 1:
        raise WorkbenchError("Only one anchor can be at a vertex; choose a single row to give it another one.")
    (old,) = vertices.tolist()
    if vertex != old and vertex in anchors:
        raise WorkbenchError(f"Vertex {vertex} has an anchor already; choose another vertex, or delete that row first.")
    return anchors.at_vertex(old, vertex)


# ---------------------------------------------------------------------------------------------- tables


def table_of(anchors: AnchorSet, dimension: int) -> AnchorTable:
    """All that a set of anchors says, as rows in its order."""
    return AnchorTable(
        anchors.vertices, anchors.target_array(dimension), anchors.weight_array, anchors.group_numbers, anchors.is_off
    )


def set_of(table: AnchorTable) -> AnchorSet:
    """The anchors that a table names."""
    vertices, soft, grouped = table.vertices, np.isfinite(table.weights), table.groups >= 0
    return AnchorSet(
        AnchorSet.to(vertices, table.targets).targets,
        dict(zip(vertices[grouped].tolist(), table.groups[grouped].tolist(), strict=True)),
        dict(zip(vertices[soft].tolist(), table.weights[soft].tolist(), strict=True)),
        frozenset(vertices[table.is_off].tolist()),
    )


def pasted(text: str, anchors: AnchorSet, vertex_count: int, dimension: int) -> AnchorSet:
    """The anchors in text from a spreadsheet, with a header or without.

    What the text does not speak of (weight, group, on) stays as those of `anchors` on the same vertices have it.
    Raises `WorkbenchError` that names row and column of what is wrong.
    """
    rows, decimal_comma = rows_of(text)
    if not rows:
        raise WorkbenchError("There is nothing to paste; copy rows of vertex, x, y first.")
    plain = ("vertex", *AXES[:dimension])
    header = rows[0][1]
    if any(cell.strip().lower() == "vertex" for cell in header):
        names = named_columns(header, dimension)
        if names is None:
            raise WorkbenchError(
                f"Row {rows[0][0]}: columns {', '.join(plain)} are needed, with {', '.join(MORE)} where wanted, each once; "
                f"these are {', '.join(cell.strip() for cell in header)[:80]}."
            )
        rows = rows[1:]
    else:
        names = (*plain, *MORE)[: len(header)]
        if not len(plain) <= len(header) <= len(plain) + len(MORE):
            raise WorkbenchError(
                f"Row {rows[0][0]} has {len(header)} cells; without a header they have to be {', '.join(plain)}, "
                f"then {', '.join(MORE)} where wanted."
            )

    def place(row: int, column: str) -> str:
        return f"Row {row}, column {column}" if column else f"Row {row}"

    found = set_of(parse_rows(rows, names, vertex_count, dimension, place, decimal_comma=decimal_comma))
    return AnchorSet(
        found.targets,
        found.groups if "group" in names else {v: g for v, g in anchors.groups.items() if v in found},
        found.weights if "weight" in names else {v: w for v, w in anchors.weights.items() if v in found},
        found.off if "on" in names else frozenset(v for v in anchors.off if v in found),
    )
