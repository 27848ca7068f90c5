"""One view of the window, as splits, links and readings know it."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtWidgets import QWidget

from workbench.app.handling.anchor_tool import AnchorTool
from workbench.app.splitting.pane_tools import PaneTools
from workbench.app.views.mesh_view import MeshView
from workbench.app.views.pane import ViewPane


@dataclass(eq=False)
class Leaf:
    """`widget` is what stands in a grid; `pane` is None for a colour map, which has a title of its own."""

    name: str
    widget: QWidget
    view: MeshView
    is_source: bool
    pane: ViewPane | None
    tools: PaneTools | None = None
    tool: AnchorTool | None = None
