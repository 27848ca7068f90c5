"""Anchors chosen and moved by hand beyond a plain drag: which tool, key or menu asks for what."""

from __future__ import annotations

from collections.abc import Sized
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject
from PySide6.QtWidgets import QMenu

from workbench.app.handling.anchor_menu import AnchorMenu
from workbench.app.handling.anchor_tool import AnchorTool
from workbench.app.handling.area_drawing import AreaMode
from workbench.app.handling.company_controls import CompanyControls
from workbench.app.handling.pinning import Pinning
from workbench.core.arrays import Integers

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

AT_ONE_PLACE = "One anchor alone does not {}: select more (Shift+click, Shift+L), or let those near by follow it (O)."
NO_ANCHORS = "There are no anchors: a click on a vertex sets one."
NO_GROUP = "None of the selected anchors is in a group."
NOTHING_SELECTED = "No anchor is selected: click one, with Shift more of them, or draw a lasso round them (Shift+L)."

MENUS = (
    ("&Select anchors", ("select-all", "select-none", "select-box", "select-lasso", "through", "", "group", "ungroup")),
    ("&Pin", ("pin", "pin-loop", "pin-path", "box", "lasso")),
    ("&Move anchors", ("move", "turn", "scale")),
)


class Handling(QObject):
    """Knows every tool of a window that sets and moves anchors."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._document, self._desk = window.document, window.desk
        self._tools: list[AnchorTool] = []
        self.menu = AnchorMenu(window)
        self.pinning = Pinning(window, self._tools)
        self.company = CompanyControls(window, self._tools)
        self._mode = AreaMode()
        self._through = window.actions_by_name["through"]
        self._mode.through = window.settings.handling().get("through") is True
        self._through.setChecked(self._mode.through)
        deeds = {
            "box": lambda: self.arm("box", "anchor"),
            "lasso": lambda: self.arm("lasso", "anchor"),
            "select-box": lambda: self.arm("box", "select"),
            "select-lasso": lambda: self.arm("lasso", "select"),
            "select-all": self.select_every,
            "select-none": lambda: self._document.select_all(()),
            "through": self._set_through,
            "group": self.group,
            "ungroup": self.ungroup,
            "pin-loop": lambda: self.pinning.begin("loop"),
            "pin-path": lambda: self.pinning.begin("path"),
            "move": lambda: self.hold("move"),
            "turn": lambda: self.hold("turn"),
            "scale": lambda: self.hold("scale"),
        }
        for name, deed in deeds.items():
            window.actions_by_name[name].triggered.connect(lambda _=False, d=deed: d())

    def connect_tool(self, tool: AnchorTool) -> None:
        """Let one more tool ask."""
        self._tools.append(tool)
        tool.may_hold = self._may_hold
        tool.destroyed.connect(lambda: self._tools.remove(tool))
        self.menu.connect_tool(tool)
        self.pinning.connect_tool(tool)
        self.company.connect_tool(tool)
        tool.area.mode = self._mode
        tool.area.chosen.connect(self._take_area)
        tool.area.nothing_chosen.connect(self._say_nothing)
        tool.area.ended.connect(self._end_areas)
        tool.area.mode_changed.connect(self._show_mode)
        tool.anchor_toggled.connect(self.toggle)

    # ------------------------------------------------------------------------------------------ choosing

    def arm(self, shape: str, deed: str) -> None:
        """The next drag in any view draws a "box" or a "lasso", to "anchor" vertices or to "select" anchors."""
        if self._document.positions is None:
            return
        self.pinning.end()
        self._mode.shape, self._mode.deed = shape, deed
        for tool in self._tools:
            tool.area.arm()
        self._show_mode()

    def _show_mode(self) -> None:
        self._through.setChecked(self._mode.through)
        self._window.settings.save_handling({**self._window.settings.handling(), "through": self._mode.through})
        armed = [tool for tool in self._tools if tool.area.is_armed]
        for tool in armed:
            tool.area.show_hint()
        if armed:
            self._window.status.say(f"{armed[0].area.words()}: drag in any view; Esc leaves.")

    def _set_through(self) -> None:
        self._mode.through = self._through.isChecked()
        self._show_mode()

    def _end_areas(self) -> None:
        for tool in self._tools:
            if tool.area.is_armed:
                tool.area.end()
        self._window.status.say("")

    def _take_area(self, vertices: Integers, deed: str, how: str) -> None:
        document = self._document
        if deed == "select":
            self._combine(vertices, how)
        elif how == "remove":
            self._desk.remove(vertices)
        elif how == "add":
            before = document.selection
            document.pin(vertices)
            document.select_all([*before, *vertices.tolist()])
        else:
            self._desk.add_group(vertices)
        count = len(document.selected_anchors)
        self._window.status.say("" if how == "remove" and deed == "anchor" else _selected(count))

    def _combine(self, vertices: Integers, how: str) -> None:
        """Groups go whole: one of a group stands for all of it."""
        document = self._document
        chosen = set(document.anchors.together_with(vertices.tolist()).tolist())
        before = [] if how == "replace" else document.selected_anchors.tolist()
        kept = [v for v in before if v not in chosen]
        document.select_all(kept if how == "remove" else [*kept, *sorted(chosen)])

    def toggle(self, vertex: int, wanted: bool) -> None:
        """Select one more anchor, or, where it is selected already or is not `wanted`, one less."""
        is_selected = vertex in self._document.selected_anchors
        self._combine(np.array([vertex]), "remove" if is_selected or not wanted else "add")

    def _say_nothing(self) -> None:
        what = "vertex" if self._mode.deed == "anchor" else "anchor"
        self._window.status.say(f"No {what} is in the {self._mode.shape}.")

    def group(self) -> None:
        """The selected anchors move together from now on."""
        document, selected = self._document, self._document.selected_anchors
        if len(selected) > 1:
            document.set_anchors(document.anchors.grouped(selected))
            self._window.status.say(f"{len(selected)} anchors are one group now.")
        else:
            self._window.status.say(NOTHING_SELECTED.replace("No anchor is", "Fewer than two anchors are"))

    def select_every(self) -> None:
        """All anchors there are."""
        if self._are(self._document.anchors, NO_ANCHORS):
            self._document.select_all(self._document.anchors.targets)

    def ungroup(self) -> None:
        """Each of the selected anchors moves alone from now on."""
        groups, selected = self._document.anchors.groups, self._document.selected_anchors
        if self._are(selected, NOTHING_SELECTED) and self._are(set(groups) & set(selected.tolist()), NO_GROUP):
            self._desk.split_selected()

    def remove_selected(self) -> None:
        """Let the selected anchors go."""
        if self._are(self._document.selected_anchors, NOTHING_SELECTED):
            self._desk.remove_selected()

    def clear(self) -> None:
        """Let all anchors go."""
        if self._are(self._document.anchors, NO_ANCHORS):
            self._document.clear_anchors()

    def _are(self, anchors: Sized, otherwise: str) -> bool:
        """Whether there are any; where not, a sentence says so."""
        if not len(anchors):
            self._window.status.say(otherwise)
        return len(anchors) > 0

    # ------------------------------------------------------------------------------------------ moving

    def hold(self, deed: str) -> None:
        """Let the selected anchors follow the pointer, in the target that it is over."""
        targets = [tool for tool in self._tools if tool.is_target]
        over = [tool for tool in targets if tool.view.overlay.underMouse()]
        if any(tool.is_dragging for tool in targets):
            return
        if self._may_hold(deed) and not (over or targets)[0].hold(deed):
            self._window.status.say(NOTHING_SELECTED)

    def _may_hold(self, deed: str) -> bool:
        """What is at one place has nothing about which it could turn: that is said instead."""
        if deed == "move" or not self._desk.is_at_one_place:
            return True
        self._window.status.say(AT_ONE_PLACE.format(deed))
        return False

    def fill_menu(self, menu: QMenu) -> None:
        """What is offered for choosing, pinning and moving, in menus within a menu."""
        actions = self._window.actions_by_name
        for title, names in MENUS:
            part = menu.addMenu(title)
            for name in names:
                part.addAction(actions[name]) if name else part.addSeparator()
        part.addSeparator()
        self.company.fill_menu(part)


def _selected(count: int) -> str:
    if count == 0:
        return "No anchor is selected."
    return "1 anchor is selected." if count == 1 else f"{count} anchors are selected: G moves, R turns, S scales."
