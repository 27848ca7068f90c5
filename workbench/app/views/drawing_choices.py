"""What a view draws beside its colours."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class DrawingChoices:
    """`edges` None leaves them to the size of the mesh; `seams` are those of the texture and where a fix cut."""

    edges: bool | None = None
    wireframe: bool = False
    seams: bool = True
    boundary: bool = False
    scale_bar: bool = False


LINES = ("edges", "wireframe", "seams", "boundary", "scale_bar")
"""Names of the fields, in the order of the menus."""
