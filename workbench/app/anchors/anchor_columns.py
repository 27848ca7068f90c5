"""The columns of the table of anchors: what they are called, and what may be typed into them."""

from __future__ import annotations

from dataclasses import dataclass

from workbench.io.anchor_rows import AXES


@dataclass(frozen=True)
class Column:
    """`key` is its name in copies and files, `title` what its head shows, `widest` a text that it has to have room for."""

    key: str
    title: str
    tip: str
    widest: str
    is_editable: bool = False


def columns_for(source_dimension: int, dimension: int) -> tuple[Column, ...]:
    """Those for maps of so many columns of sources of so many; what is only shown stands last, where there may be no room."""
    number = "-0.012345"
    sources = [
        Column(f"source_{axis}", f"Source {axis}", f"Where the source has the vertex, {axis}", number)
        for axis in AXES[:source_dimension]
    ]
    targets = [
        Column(axis, f"Target {axis}", f"Where the anchor wants its vertex, {axis}", number, True) for axis in AXES[:dimension]
    ]
    return (
        Column("on", "On", "Anchors that are off keep what they have, and hold nothing", "", True),
        Column("vertex", "Vertex", "Number of the vertex, from 0", "123456", True),
        *targets,
        Column(
            "weight",
            "Weight",
            "Hard: the target is reached exactly. A number w makes the anchor soft: w |x - target|² is added to the energy",
            "0.01234",
            True,
        ),
        Column("group", "Group", "Anchors of one number move together; empty for one that moves alone", "Group", True),
        Column("residual", "Residual", "Distance of the vertex in the map from its target", "9.29e-08"),
        *sources,
    )
