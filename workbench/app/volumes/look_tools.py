"""Everything with which a hand looks into a solid, put into the window: controls, handle of the plane, linked cameras."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from PySide6.QtGui import QAction

from workbench.app.quantities.quantity_book import QuantityBook
from workbench.app.views.mesh_view import MeshView
from workbench.app.views.pane import ViewPane
from workbench.app.volumes.linked_views import LinkedViews
from workbench.app.volumes.plane_handle import PlaneHandle
from workbench.app.volumes.tools import CutTools, PeelTools
from workbench.app.volumes.volume_view import VolumeView
from workbench.core.solid_look.look import AXES, Direction


class LookTools:
    """Made once by the window; all of it is hidden while there is no solid."""

    def __init__(
        self,
        volume: VolumeView,
        book: QuantityBook,
        source: ViewPane,
        target: ViewPane,
        panels: Sequence[MeshView],
        actions: Mapping[str, QAction],
    ) -> None:
        self._volume = volume
        self._eye = source.view
        self.cut = CutTools(volume, self.cut_along, source)
        self.peel = PeelTools(volume, book, target)
        source.add_tools(self.cut)
        target.add_tools(self.peel)
        self.handles = [PlaneHandle(source.view, volume, of_target=False), PlaneHandle(target.view, volume, of_target=True)]
        self.linked = LinkedViews([source.view, target.view], panels, lambda: volume.is_on)

        self._cut, self._uncut = actions["cut"], actions["uncut"]
        self._cut.triggered.connect(lambda on: self.cut_along("view" if on else ""))
        self._uncut.triggered.connect(lambda _=False: volume.show_all())
        for signal in (volume.changed, volume.opened):
            signal.connect(self._show_actions)
        self._show_actions()

    def _show_actions(self) -> None:
        for action in (self._cut, self._uncut):
            action.setEnabled(self._volume.is_on)
        self._cut.setChecked(self._volume.look.is_cut)

    def cut_along(self, name: str) -> None:
        """Cut across an axis, or across the line of sight (`view`), so that the section faces the eye; empty: no plane."""
        if not name:
            self._volume.choose(is_cut=False)
            return
        sight = self._eye.camera.axes[2]
        normal: Direction = AXES[name] if name in AXES else tuple(float(c) for c in sight)  # type: ignore[assignment]
        self._volume.choose(is_cut=True, normal=normal, is_flipped=bool(np.dot(normal, sight) < 0))

    def stop(self) -> None:
        self.linked.stop()
