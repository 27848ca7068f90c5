"""The grid of views: one camera for all, as large as they can be, drawn in turns."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.background import Background
from workbench.app.race.contestant_pane import ContestantPane
from workbench.app.race.race_colours import RaceColours
from workbench.app.race.race_model import RaceModel
from workbench.app.race.view_turns import ViewTurns
from workbench.app.views.camera import axes_for_solid
from workbench.app.views.flat_picture import compile_pictures
from workbench.app.views.geometry import Geometry
from workbench.app.views.mesh_view import MeshView, box_corners
from workbench.core.arrays import Floats
from workbench.core.solid_look.drawn_faces import drawn_faces

GAP = 3
HEADER_LINES = 2.8
"""Height of a pane's title, in lines of text."""
SMALL = 0.55
"""Part of a view, in its tighter direction, below which all maps together count as shrunk."""


class ViewGrid(QWidget):
    """One pane a contestant; `flip` lets two of them change places."""

    switch_wanted = Signal(int)
    take_wanted = Signal(int)

    def __init__(self, model: RaceModel, colours: RaceColours, theme: Theme, parent: QWidget) -> None:
        super().__init__(parent)
        self._model = model
        self._colours = colours
        self.theme = theme
        self.panes: list[ContestantPane] = []
        self._aspect = 1.0
        self._wants_fit = True
        self._is_linking = False
        self.turns = ViewTurns(self._draw, self)
        self._compiling = Background(compile_pictures, self)
        self._compiling.start()
        self.setMinimumSize(300, 200)
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        model.started.connect(self._show_mesh)
        model.map_changed.connect(self._contestant_changed)
        model.told.connect(self._show_record)
        model.phase_changed.connect(self._show_phase)
        colours.restyled.connect(self.restyle)
        self.make_panes()

    def make_panes(self) -> None:
        """As many views as there are contestants now."""
        count = len(self._model.records)
        while len(self.panes) > count:
            pane = self.panes.pop()
            pane.view.close_view()
            pane.hide()
            pane.deleteLater()
        while len(self.panes) < count:
            pane = ContestantPane(len(self.panes), self.theme, self)
            pane.view.camera_changed.connect(lambda view=pane.view: self._link(view))
            pane.tool.fit_wanted.connect(self.fit)
            pane.switch_wanted.connect(self.switch_wanted)
            pane.take_wanted.connect(self.take_wanted)
            pane.set_theme(self.theme)
            pane.show()
            self.panes.append(pane)
        for index, pane in enumerate(self.panes):
            pane.shown, pane.is_flipped = index, False
            self._tell(pane)
        self._place()

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        for pane in self.panes:
            pane.set_theme(theme)
        self.restyle()

    def close_views(self) -> None:
        self.turns.stop()
        self._compiling.wait()
        for pane in self.panes:
            pane.view.close_view()

    # ------------------------------------------------------------------------------------------ content

    def _show_mesh(self) -> None:
        start, set_up = self._model.start, self._model.set_up
        assert start is not None
        seen = start if start.shape[1] == 2 else start @ axes_for_solid(start)[:2].T
        width, height = np.maximum(np.ptp(seen, axis=0), 1e-12)
        self._aspect = float(width / height)
        faces = drawn_faces(set_up.mesh.simplices)
        for pane in self.panes:
            pane.show_mesh(Geometry(start, set_up.mesh.simplices, faces), set_up.anchors)
        self._place()
        self.restyle()
        self.fit()

    def restyle(self) -> None:
        """Give every view the colours of the one range, and draw it anew."""
        for place in range(len(self.panes)):
            self._restyle(place)

    def _restyle(self, place: int) -> None:
        pane = self.panes[place]
        surface = pane.view.surface
        if surface is None:
            return
        pane.is_reference = self._colours.is_plain(pane.shown)
        if pane.is_reference:
            surface.show_plain()
        else:
            surface.show_range(self._colours.range)
        self.turns.make_stale(place)

    def _contestant_changed(self, index: int) -> None:
        depends_on_all = self._colours.mode != "own" and index == self._colours.reference
        for place, pane in enumerate(self.panes):
            if pane.shown == index or depends_on_all:
                self.turns.make_stale(place)

    def _show_record(self, index: int) -> None:
        """Numbers change with the picture that they belong to; what ends a contestant is told at once."""
        record = self._model.records[index]
        for pane in self.panes:
            if pane.shown == index and (record.frame is None or record.frame.phase != "running"):
                self._tell(pane)

    def _show_phase(self) -> None:
        if len(self.panes) == len(self._model.records):  # else other contestants have no panes yet
            for pane in self.panes:
                self._tell(pane)

    def _tell(self, pane: ContestantPane) -> None:
        pane.show_record(self._model.records[pane.shown], self._model.is_running)

    def _draw(self, place: int) -> float:
        if place >= len(self.panes):
            return 0.0
        pane = self.panes[place]
        record = self._model.records[pane.shown]
        pane.show_map(record, self._colours.values_of(pane.shown))
        self._tell(pane)
        if self._wants_fit and self._fits_badly():
            self.fit()
        return float(pane.view.canvas.seconds)

    def flip(self, first: int, second: int, wanted: bool) -> None:
        """Show contestant `second` in the place of `first` and the other way round, or both in their own places."""
        places = {index: index for index in range(len(self.panes))}
        if wanted:
            places[first], places[second] = second, first
        for place, pane in enumerate(self.panes):
            if pane.shown != places[place] or pane.is_flipped != (places[place] != place):
                pane.shown, pane.is_flipped = places[place], places[place] != place
                self._tell(pane)
                self._restyle(place)

    # ------------------------------------------------------------------------------------------ camera

    def fit(self) -> None:
        """Show all of all maps, at one scale."""
        points = self._outermost()
        if len(points):
            view = self.panes[0].view
            self._set_cameras(view, view.camera.fitted(points, view.size_in_pixels))
        self._wants_fit = True

    def _outermost(self) -> Floats:
        """Points (k, 3) of the display between which all maps and their anchors lie."""
        shown = [pane for pane in self.panes if pane.geometry_shown is not None]
        boxes = [box_corners(pane.geometry_shown.points) for pane in shown]
        return np.concatenate([np.empty((0, 3)), *boxes, *(pane.view.overlay.scene.anchor_points for pane in shown)])

    def _link(self, view: MeshView) -> None:
        """One view was moved: the others follow."""
        if not self._is_linking:
            self._wants_fit = False
            self._set_cameras(view, view.camera)

    def _set_cameras(self, view: MeshView, camera) -> None:  # type: ignore[no-untyped-def]
        self._is_linking = True
        for pane in self.panes:
            if pane.view is not view or view.camera is not camera:
                pane.view.set_camera(camera)
        self._is_linking = False

    def _fits_badly(self) -> bool:
        """Whether something has left the views, or all has become small in them."""
        view = self.panes[0].view
        places = view.project(self._outermost()) / view.size_in_pixels
        return bool(places.min() < 0.0 or places.max() > 1.0 or np.ptp(places, axis=0).max() < SMALL)

    # ------------------------------------------------------------------------------------------ places

    def resizeEvent(self, event: QResizeEvent) -> None:
        self._place()

    def sizeHint(self) -> QSize:
        return QSize(900, 700)

    def _place(self) -> None:
        """The number of columns in which the start is drawn largest."""
        count = len(self.panes)
        if not count:
            return
        header = HEADER_LINES * self.fontMetrics().height()

        def scale(columns: int) -> float:
            rows = -(-count // columns)
            width, height = self.width() / columns, self.height() / rows - header
            return min(width / self._aspect, height)

        columns = max(range(1, count + 1), key=scale)
        rows = -(-count // columns)
        for index, pane in enumerate(self.panes):
            row, column = divmod(index, columns)
            in_row = min(columns, count - row * columns)
            left, right = column * self.width() // in_row, (column + 1) * self.width() // in_row
            top, bottom = row * self.height() // rows, (row + 1) * self.height() // rows
            # the gap at the right end, too: a picture that touches the curves has them painted anew
            pane.setGeometry(left, top, right - left - GAP, bottom - top)
        if self._wants_fit:
            self.fit()
