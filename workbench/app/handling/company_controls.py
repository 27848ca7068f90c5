"""Mirror and falloff in the window: switches with their state, the line of symmetry, the circle of reach."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import QObject, QTimer
from PySide6.QtGui import QActionGroup
from PySide6.QtWidgets import QMenu

from workbench.app.document.anchor_set import AnchorSet
from workbench.app.handling.anchor_tool import AnchorTool
from workbench.app.handling.company import Customs
from workbench.app.handling.reflection import Reflection
from workbench.app.views.geometry import Geometry
from workbench.app.views.sketch import Sketch, circle
from workbench.core.arrays import Floats, Integers

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

PLANES = {"mirror-x": "x", "mirror-y": "y", "mirror-z": "z", "mirror-found": "found"}
NAMES = {"x": "x to -x", "y": "y to -y", "z": "z to -z", "found": "as found"}
MARGIN = 1.08
"""How far lines of symmetry go beyond what is drawn."""
MOST_CIRCLES = 6
SYMMETRIC = 0.9
"""Part of the vertices with a twin below which a source is said to be symmetric in part only."""


class CompanyControls(QObject):
    """Connects the switches of a window to the company of its desk, and shows what goes along in every view."""

    def __init__(self, window: MainWindow, tools: list[AnchorTool]) -> None:
        super().__init__(window)
        self._window, self._tools = window, tools
        self._desk, self._company = window.desk, window.desk.company
        self._actions = window.actions_by_name
        self._last_mirror = "x"
        group = QActionGroup(self)
        for name, plane in PLANES.items():
            group.addAction(self._actions[name])
            self._actions[name].triggered.connect(lambda _=False, p=plane: self.mirror(p))
        self._actions["mirror"].triggered.connect(lambda on: self.mirror(self._last_mirror if on else ""))
        self._actions["falloff"].triggered.connect(self._set_falloff)
        self._actions["falloff-edges"].triggered.connect(lambda on: self._company.choose(along_edges=on))
        self._recall(window.settings.handling())
        self._company.changed.connect(self._show)
        self._desk.train_changed.connect(self._show_reach)
        window.document.anchors_changed.connect(self._show_reach)
        self._desk.twins_missed.connect(self._say_missed)
        window.document.snapshot_taken.connect(self._map_changed)
        self._show()

    def connect_tool(self, tool: AnchorTool) -> None:
        """Show it in one more view."""
        tool.wheel_turned.connect(self._desk.widen)
        tool.wheel_is_taken = self._company.customs.has_falloff
        QTimer.singleShot(0, self, self._show_symmetry)  # the view has nothing to show yet

    # ------------------------------------------------------------------------------------------ choices

    def mirror(self, plane: str) -> None:
        """Move the mirror twins of anchors likewise, across "x", "y", "z" or the plane "found"; empty: do not."""
        self._last_mirror = plane or self._last_mirror
        self._company.choose(mirror=plane)
        document, window = self._window.document, self._window
        if plane and document.mesh is not None and self._company.image() is None:
            what = (
                "no third axis" if document.mesh.vertices.shape[1] == 2 and plane == "z" else "no pairs of vertices that match"
            )
            window.status.say(f"There is nothing to mirror here: the source has {what}.")
        elif plane:
            part = self._company.symmetry()
            words = "an anchor that is moved takes its mirror twin along, which is made where there is none."
            if part < SYMMETRIC:
                words += f" Only {part:.0%} of the vertices have a twin."
            window.status.say(f"Mirror: {words}")
        else:
            window.status.say("Mirror is off.")

    def _set_falloff(self, on: bool) -> None:
        self._company.choose(has_falloff=on)
        words = "anchors near the one that is moved follow; the wheel changes how far." if on else ""
        self._window.status.say(f"Falloff: {words}" if on else "Falloff is off.")

    def _say_missed(self, missing: int, count: int) -> None:
        which = "it has" if count == 1 else f"{missing} of {count} anchors have"
        for tool in self._tools:
            if tool.is_dragging:
                tool.note = f"Mirror: {which} no twin, for no vertex lies near the mirror image"

    def _recall(self, kept: dict[str, Any]) -> None:
        """The customs of the last time, each where it is one."""
        plain = asdict(Customs())
        known = {name: kept[name] for name in plain if isinstance(kept.get(name), type(plain[name]))}
        if known.get("mirror") not in ("", *NAMES):
            known.pop("mirror", None)
        if not 0.0 < known.get("reach", 1.0) <= 10.0:
            known.pop("reach")
        self._company.choose(**known)
        self._last_mirror = str(known.get("mirror") or "x")

    # ------------------------------------------------------------------------------------------ showing

    def _show(self) -> None:
        customs = self._company.customs
        self._window.settings.save_handling({**self._window.settings.handling(), **asdict(customs)})
        self._actions["mirror"].setChecked(bool(customs.mirror))
        self._actions["mirror"].setText(f"&Mirror {NAMES[customs.mirror]}" if customs.mirror else "&Mirror")
        for name, plane in PLANES.items():
            self._actions[name].setChecked(plane == (customs.mirror or self._last_mirror))
        self._actions["falloff"].setChecked(customs.has_falloff)
        self._actions["falloff-edges"].setChecked(customs.along_edges)
        for tool in self._tools:
            tool.wheel_is_taken = customs.has_falloff
        self._show_symmetry()

    def _map_changed(self) -> None:
        snapshot = self._window.document.snapshot
        if self._company.customs.mirror and snapshot is not None and snapshot.phase != "dragging":
            self._show_symmetry()

    def _show_symmetry(self) -> None:
        image, plane = self._company.image(), self._company.plane
        for tool in self._tools:
            shown = image if tool.is_target else plane
            geometry, scene = tool.view.geometry_shown, tool.view.overlay.scene
            if shown is None or geometry is None or len(shown.normal) != len(geometry.frame.centre):
                if scene.sketches.pop("mirror", None) is not None:
                    tool.view.overlay.update()
            else:
                scene.sketches["mirror"] = Sketch(_frame_of(shown, geometry), "mirror")
                tool.view.overlay.update()

    def _show_reach(self) -> None:
        """Circles round what is held, and who follows, while a hand holds anchors with the falloff on."""
        train, document = self._desk.train, self._window.document
        is_shown = train is not None and self._company.customs.has_falloff and document.is_held
        is_shown = is_shown and train is not None and all(v in document.anchors for v in train.vertices.tolist())
        for tool in self._tools:
            view, scene = tool.view, tool.view.overlay.scene
            was_shown = scene.sketches.pop("reach", None) is not None
            if is_shown and train is not None and view.geometry_shown is not None:
                places = _shown_anchors(view.geometry_shown, document.anchors, train.vertices, tool.is_target)
                held, led = places[train.shares == 1.0], places[(train.shares < 1.0) & (train.shares + train.mirrored > 0.0)]
                centres = held if len(held) <= MOST_CIRCLES else held.mean(axis=0)[None]
                radius = self._company.radius * view.geometry_shown.frame.scale
                circles = [circle(centre, radius, view.camera.axes[:2]) for centre in centres]
                scene.sketches["reach"] = Sketch(np.concatenate(circles), "reach", led)
            if was_shown or is_shown:
                view.overlay.update()

    def fill_menu(self, menu: QMenu) -> None:
        """Both switches, and how they are meant."""
        menu.addAction(self._actions["mirror"])
        planes = menu.addMenu("Mirror a&cross")
        for name in PLANES:
            planes.addAction(self._actions[name])
        menu.addAction(self._actions["falloff"])
        menu.addAction(self._actions["falloff-edges"])


def _shown_anchors(geometry: Geometry, anchors: AnchorSet, vertices: Integers, is_target: bool) -> Floats:
    """(k, 3) of the display: targets of anchors `vertices` (k,), or, in the source, the vertices."""
    if is_target:
        return geometry.frame.to_display(anchors.targets_of(vertices))
    return np.asarray(geometry.points[vertices], dtype=np.float64)


def _frame_of(plane: Reflection, geometry: Geometry) -> Floats:
    """Segments (k, 2, 3) of the display: a line in the plane, a frame in space, as wide as what is drawn."""
    d = len(plane.normal)
    frame = geometry.frame
    points = np.asarray(geometry.vertices[:, :d], dtype=np.float64)
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    normal = plane.normal
    shown_height = (plane.height - float(normal @ frame.centre)) * frame.scale
    foot = middle - (float(middle @ normal) - shown_height) * normal
    directions = np.linalg.svd(normal[None])[2][1:]  # at right angles to the normal
    along = (points - foot) @ directions.T
    low, high = MARGIN * along.min(axis=0), MARGIN * along.max(axis=0)
    if d == 2:
        corners = foot + np.array([low, high]) * directions[0]
        rows = [(0, 1)]
    else:
        ends = np.array([[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]])
        corners = foot + ends @ directions
        rows = [(0, 1), (1, 2), (2, 3), (3, 0)]
    shown = np.zeros((len(corners), 3))
    shown[:, :d] = corners
    return shown[np.array(rows)]
