"""Views of one solid that are turned together."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from PySide6.QtCore import QObject, QTimer

from workbench.app.views.mesh_view import MeshView

PAUSE = 70
"""Milliseconds after a turn until the small views follow it: many turns make one picture of each."""


class LinkedViews(QObject):
    """Turning one of the `large` views turns the other at once, and the `small` ones when the hand pauses."""

    def __init__(self, large: Sequence[MeshView], small: Sequence[MeshView], is_wanted: Callable[[], bool]) -> None:
        super().__init__(large[0])
        self._large = tuple(large)
        self._small = tuple(small)
        self._is_wanted = is_wanted
        self._is_passing_on = False
        self._latest: MeshView = self._large[-1]
        self._later = QTimer(self)
        self._later.setSingleShot(True)
        self._later.setInterval(PAUSE)
        self._later.timeout.connect(self._turn_small)
        self._deeds: dict[MeshView, Callable[[], None]] = {}
        for view in (*self._large, *self._small):
            self._follow(view)

    def _follow(self, view: MeshView) -> None:
        self._deeds[view] = lambda: self._turned(view)
        view.camera_changed.connect(self._deeds[view])

    def add(self, view: MeshView) -> None:
        """One more view that follows when the hand pauses, and that the others follow."""
        self._small = (*self._small, view)
        self._follow(view)

    def remove(self, view: MeshView) -> None:
        """A view is gone."""
        view.camera_changed.disconnect(self._deeds.pop(view))
        self._small = tuple(other for other in self._small if other is not view)
        self._latest = self._large[-1] if self._latest is view else self._latest

    def _turned(self, view: MeshView) -> None:
        if self._is_passing_on or not self._is_wanted():
            return
        self._latest = view
        self._turn(view, self._large)
        self._later.start()

    def _turn_small(self) -> None:
        if self._is_wanted():
            self._turn(self._latest, self._small)

    def _turn(self, like: MeshView, others: Sequence[MeshView]) -> None:
        self._is_passing_on = True
        try:
            for other in others:
                if other is not like and other.geometry_shown is not None and (other.camera.axes != like.camera.axes).any():
                    other.turn(replace(other.camera, axes=like.camera.axes))
        finally:
            self._is_passing_on = False

    def stop(self) -> None:
        self._later.stop()
