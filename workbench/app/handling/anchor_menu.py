"""What the right button, keys and tools ask of anchors beyond dragging: whole patches, boxes, numbers, groups."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QPoint
from PySide6.QtWidgets import QMenu

from workbench.app.handling.anchor_tool import AnchorTool
from workbench.app.handling.patches import Patches
from workbench.app.handling.place_dialog import PlaceDialog
from workbench.app.handling.rigid_motion import RigidMotion
from workbench.app.views.camera import Pixel
from workbench.app.views.mesh_view import MeshView

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

OFFERED = ("box", "lasso", "", "pin", "pin-loop", "pin-path", "", "select-box", "select-lasso", "select-all", "", "clear")
"""Actions where no anchor is under the pointer"""


class AnchorMenu(QObject):
    """Opens at the pointer of any tool of a window, and asks its desk and document."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._document, self._desk = window.document, window.desk
        self._patches: Patches | None = None
        self.menu: QMenu | None = None
        self.dialog: PlaceDialog | None = None
        self._desk.given_up.connect(
            lambda degrees: window.status.say(f"The turn ends at {degrees:.0f}°: the map cannot follow any further.")
        )
        self._document.opened.connect(self._forget)
        self._document.anchors_changed.connect(self._show_numbers)
        self._document.selection_changed.connect(self._show_numbers)

    def connect_tool(self, tool: AnchorTool) -> None:
        """Serve one more tool."""
        tool.patch_wanted.connect(lambda x, y: self.anchor_patch(tool.view, (x, y)))
        tool.menu_wanted.connect(lambda vertex, x, y: self._open(tool, vertex, (x, y)))
        tool.numbers_wanted.connect(self.ask_numbers)

    def _forget(self) -> None:
        self._patches = None
        if self.dialog is not None:
            self.dialog.close()

    # ------------------------------------------------------------------------------------------ menu

    def _open(self, tool: AnchorTool, vertex: int, pixel: Pixel) -> None:
        view, document, desk = tool.view, self._document, self._desk
        menu = QMenu(self._window)
        actions = self._window.actions_by_name
        if vertex >= 0:
            is_one_of_many = len(document.selection) > 1 and vertex in document.selected_anchors
            if not is_one_of_many:
                document.select(vertex)
            count = len(document.selected_anchors)
            menu.addAction("Place by numbers…").triggered.connect(self.ask_numbers)
            for name in ("move", "turn", "scale"):
                menu.addAction(actions[name])
            menu.addSeparator()
            which = "selected" if is_one_of_many else "of the group"
            menu.addAction(f"Let go of all {count} {which}").triggered.connect(desk.remove_selected)
            menu.addAction("Let go of this anchor").triggered.connect(lambda: document.remove_anchor(vertex))
            if is_one_of_many:
                menu.addAction(actions["group"])
            menu.addAction("Let each move alone").triggered.connect(desk.split_selected)
        else:
            near = view.vertex_at(pixel)
            action = menu.addAction("Anchor this vertex")
            action.setEnabled(near >= 0)
            action.triggered.connect(lambda: document.add_anchor(near))
            noun = "side" if self._patches_now().is_figure else "face"
            action = menu.addAction(f"Anchor this {noun}\tAlt+click")
            action.triggered.connect(lambda: self.anchor_patch(view, pixel))
            for name in OFFERED:
                menu.addAction(actions[name]) if name else menu.addSeparator()
        menu.aboutToHide.connect(menu.deleteLater)
        self.menu = menu
        menu.popup(view.overlay.mapToGlobal(QPoint(round(pixel[0]), round(pixel[1]))))

    # ------------------------------------------------------------------------------------------ patches

    def anchor_patch(self, view: MeshView, pixel: Pixel) -> None:
        """Anchor the whole face of a solid or a surface, or side of a figure, under a pixel, as one group."""
        patches = self._patches_now()
        vertices = patches.vertices_at(view, pixel)
        mesh = self._document.mesh
        if mesh is not None and len(vertices) == mesh.vertex_count:
            self._window.status.say("No sharp edge bounds a face here: all would be anchored. Draw a box (B) instead.")
            return
        self._desk.add_group(vertices)
        if len(vertices):
            self._window.status.say(f"{len(vertices)} anchors that move together: drag one, or the arrows and rings.")
        else:
            what = "a side of the figure" if patches.is_figure else "the boundary"
            self._window.status.say(f"There is no part of {what} here; click nearer to it.")

    def _patches_now(self) -> Patches:
        loaded = self._document.loaded
        assert loaded is not None
        if self._patches is None:
            self._patches = Patches(loaded.mesh, loaded.neighbours)
        return self._patches

    # ------------------------------------------------------------------------------------------ numbers

    def ask_numbers(self) -> None:
        """A small dialog for the selected anchors; it stays open while others are selected."""
        if not len(self._document.selected_anchors):
            return
        if self.dialog is None:
            self.dialog = PlaceDialog(self._window)
            self.dialog.motion_wanted.connect(self._place)
            self.dialog.finished.connect(self._closed)
        self._show_numbers()
        self.dialog.show()
        self.dialog.raise_()
        self.dialog.places[0].setFocus()
        self.dialog.places[0].selectAll()

    def _closed(self) -> None:
        self.dialog = None

    def _show_numbers(self) -> None:
        vertices = self._document.selected_anchors
        if self.dialog is not None and len(vertices) and not self._desk.is_turning:
            self.dialog.show_anchors(vertices, self._document.anchors.targets_of(vertices))

    def _place(self, motion: RigidMotion) -> None:
        self._desk.take_up()
        self._desk.move(motion, False)
