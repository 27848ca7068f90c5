"""Cameras of views of one kind that move together: never those of a figure with those of a thing in space."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QObject, QTimer

from workbench.app.views.mesh_view import MeshView

AT_ONCE = 0.02
"""Seconds of drawing that may be spent on views that follow while a hand turns one; the rest follow when it pauses."""
PAUSE = 70
"""Milliseconds after the last move until those follow."""


@dataclass
class Link:
    """A view, whether it shows the source, and whether its camera goes with the others."""

    view: MeshView
    is_source: bool
    is_on: bool

    @property
    def kind(self) -> tuple[bool, bool] | None:
        """Source or map, in the plane or in space; None while nothing is shown."""
        geometry = self.view.geometry_shown
        return None if geometry is None else (self.is_source, geometry.is_flat)


class CameraLinks(QObject):
    """Passes the camera of one linked view on to all others of its kind."""

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._links: dict[MeshView, Link] = {}
        self._deeds: dict[MeshView, Callable[[], None]] = {}
        self._is_passing_on = False
        self._behind: dict[MeshView, MeshView] = {}
        self._later = QTimer(self)
        self._later.setSingleShot(True)
        self._later.setInterval(PAUSE)
        self._later.timeout.connect(self._catch_up)

    def add(self, view: MeshView, *, is_source: bool, is_on: bool) -> None:
        """Know one more view."""
        self._links[view] = Link(view, is_source, is_on)
        self._deeds[view] = lambda: self._moved(view)
        view.camera_changed.connect(self._deeds[view])

    def remove(self, view: MeshView) -> None:
        """A view is gone."""
        view.camera_changed.disconnect(self._deeds.pop(view))
        del self._links[view]
        self._behind = {k: v for k, v in self._behind.items() if view not in (k, v)}

    def is_on(self, view: MeshView) -> bool:
        return self._links[view].is_on

    def set_on(self, view: MeshView, on: bool) -> None:
        """Link a view, which takes the camera of those of its kind that are linked, or let it go its own way."""
        link = self._links[view]
        link.is_on = on
        if on:
            partner = next((other for other in self._followers(link)), None)
            if partner is not None:
                self._pass_on(partner.view, view)

    def note(self, view: MeshView, on: bool) -> None:
        """Link a view or not, and leave its camera as it is until one of its kind is moved."""
        self._links[view].is_on = on
        self._behind.clear()

    def stop(self) -> None:
        self._later.stop()

    def _followers(self, link: Link) -> list[Link]:
        return [other for other in self._links.values() if other is not link and other.is_on and other.kind == link.kind]

    def _moved(self, view: MeshView) -> None:
        link = self._links[view]
        if self._is_passing_on or not link.is_on or link.kind is None:
            return
        spent = 0.0
        for other in sorted(self._followers(link), key=lambda other: other.view.canvas.seconds):
            spent += other.view.canvas.seconds if other.view.is_shown() else 0.0
            if spent <= AT_ONCE:
                self._behind.pop(other.view, None)
                self._pass_on(view, other.view)
            else:
                self._behind[other.view] = view
        if self._behind:
            self._later.start()

    def _catch_up(self) -> None:
        behind, self._behind = self._behind, {}
        for view, leader in behind.items():
            if self._links[view].is_on and self._links[view].kind == self._links[leader].kind:
                self._pass_on(leader, view)

    def _pass_on(self, leader: MeshView, view: MeshView) -> None:
        """What shows everything goes on doing so, seen from the same side."""
        self._is_passing_on = True
        try:
            if leader.shows_everything:
                view.camera = leader.camera
                view.fit()
            else:
                view.set_camera(leader.camera)
        finally:
            self._is_passing_on = False
