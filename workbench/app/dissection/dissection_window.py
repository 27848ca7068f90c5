"""A step dissected: its direction as arrows on the map, what bounds it, the trials of its line search."""

from __future__ import annotations

import math

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtGui import QCloseEvent
from PySide6.QtWidgets import QCheckBox, QDialog, QHBoxLayout, QLabel, QPushButton, QSplitter, QVBoxLayout, QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.dissection.energy_plot import EnergyPlot
from workbench.app.document.document import Document
from workbench.app.handling.navigation_tool import NavigationTool
from workbench.app.views.arrow_layer import ArrowLayer
from workbench.app.views.geometry import Geometry
from workbench.app.views.mesh_view import MeshView
from workbench.engine.messages import Dissected, Refused

HOW = "Arrows: direction d of the step. Drag the dotted line over the curve to walk along x + t d."


class DissectionWindow(QDialog):
    """Shows the next step of the document's solver; nothing in the document changes unless a step is taken."""

    def __init__(self, document: Document, theme: Theme, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("A step dissected")
        self.setWindowFlag(Qt.WindowType.WindowMinMaxButtonsHint)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.resize(1120, 640)
        self._document = document
        self._is_closed = False
        self._generation = -1
        self._geometry: Geometry | None = None
        self.report: Dissected | None = None
        self.view = MeshView(theme, self)
        self.tool = NavigationTool(self.view)
        self.arrows = ArrowLayer(self.view)
        self.plot = EnergyPlot(theme, self)
        self.plot.place_chosen.connect(self._walk_to)
        self.words = QLabel(HOW, self)
        self.words.setWordWrap(True)
        self.words.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.again = QPushButton("Dissect the present step", self)
        self.again.setToolTip("Look at the next step from the document's present map")
        self.again.clicked.connect(self.ask)
        self.next = QPushButton("Take the step", self)
        self.next.setToolTip("Let the document take one step, and look at the one after it")
        self.next.clicked.connect(self._take_step)
        self.show_arrows = QCheckBox("Arrows", self)
        self.show_arrows.setChecked(True)
        self.show_arrows.toggled.connect(self.arrows.setVisible)
        self._waits_for_step = False
        self._lay_out()
        self.set_theme(theme)
        document.dissected.connect(self.show_report)
        document.snapshot_taken.connect(self._snapshot_taken)
        document.refused.connect(self._show_refusal)

    def _lay_out(self) -> None:
        splitter = QSplitter(Qt.Orientation.Horizontal, self)
        splitter.addWidget(self.view)
        splitter.addWidget(self.plot)
        splitter.setSizes([620, 500])
        splitter.setChildrenCollapsible(False)
        row = QHBoxLayout()
        for button in (self.again, self.next):
            button.setAutoDefault(False)
            row.addWidget(button)
        row.addWidget(self.show_arrows)
        row.addWidget(self.words, 1)
        layout = QVBoxLayout(self)
        layout.addWidget(splitter, 1)
        layout.addLayout(row)

    def set_theme(self, theme: Theme) -> None:
        self.view.set_theme(theme)
        self.plot.set_theme(theme)

    # ------------------------------------------------------------------------------------------ asking

    def ask(self) -> None:
        """Take the next step of the document apart."""
        self._document.dissect()

    def _take_step(self) -> None:
        self._waits_for_step = True
        self._document.step()

    def _snapshot_taken(self) -> None:
        snapshot = self._document.snapshot
        if self._waits_for_step and snapshot is not None and snapshot.phase != "running":
            self._waits_for_step = False
            self.ask()

    def _show_refusal(self, refusal: Refused) -> None:
        if refusal.command == "Dissect":
            self.words.setText(refusal.sentence)

    # ------------------------------------------------------------------------------------------ showing

    def show_report(self, report: Dissected) -> None:
        """Draw a step."""
        mesh = self._document.mesh
        if mesh is None:
            return
        step = report.step
        self.report = report
        if self._geometry is None or self._generation != report.generation:
            self._generation = report.generation
            self._geometry = Geometry(step.before.positions, mesh.simplices)
            self.view.show_geometry(self._geometry)
        self._geometry.write(step.before.positions)
        self.view.fit_if_it_left()
        self.plot.show_step(step)
        self._walk_to(step.step_size)
        self.words.setText(f"{_words(report)}\n{HOW}")

    def _walk_to(self, t: float) -> None:
        """Show the map x + t d, the arrows where they begin."""
        report, geometry, surface = self.report, self._geometry, self.view.surface
        if report is None or geometry is None or surface is None:
            return
        step = report.step
        positions = step.before.positions + t * step.direction
        geometry.write(positions)
        self.view.points_changed()
        surface.set_values(None, _inverted(positions, geometry.simplices))
        seen = np.unique(geometry.triangles)  # of a solid, arrows inside would be drawn over it
        begins = geometry.frame.to_display(positions[seen])
        ends = geometry.frame.to_display(positions[seen] + step.direction[seen])
        self.arrows.show_arrows(begins, ends - begins)
        scene = self.view.overlay.scene
        held = self._document.anchors.in_force
        scene.anchor_vertices = held.vertices
        scene.anchor_points = geometry.frame.to_display(held.target_array(positions.shape[1]))
        scene.vertex_points = geometry.points[held.vertices]
        scene.limiting = None
        if step.limiting_simplex >= 0:
            scene.limiting = geometry.points[geometry.simplices[step.limiting_simplex]]
            noun = "triangle" if geometry.simplices.shape[1] == 3 else "tetrahedron"
            scene.limiting_label = f"{noun} {step.limiting_simplex} inverts at t = {step.bound:.4g}"
        self.view.refresh()

    def closeEvent(self, event: QCloseEvent) -> None:
        if not self._is_closed:
            self._is_closed = True
            self._document.dissected.disconnect(self.show_report)
            self._document.snapshot_taken.disconnect(self._snapshot_taken)
            self._document.refused.disconnect(self._show_refusal)
            self.view.close_view()
        super().closeEvent(event)


def _inverted(positions: np.ndarray, simplices: np.ndarray) -> np.ndarray:
    """Simplices (m,) bool that are not positively oriented."""
    corners = positions[simplices]
    return np.asarray(np.linalg.det(corners[:, 1:] - corners[:, :1]) <= 0)


def _words(report: Dissected) -> str:
    step = report.step
    count = len(step.trial_sizes)
    bound = f"it may go to t = {step.bound:.4g} before a simplex inverts" if math.isfinite(step.bound) else "nothing bounds it"
    if step.step_size > 0:
        change = step.after.energy - step.before.energy
        sign, towards = ("+", ", towards its anchors") if change > 0 else ("−", "")
        taken = f"goes to t = {step.step_size:.4g}{towards}, energy {step.before.energy:.6g} {sign} {abs(change):.3g}"
    else:
        taken = f"goes nowhere ({report.message})"
    noun = "trial" if count == 1 else "trials"
    return f"{report.solver}, step {step.before.iteration + 1}: {taken}; {bound}; {count} {noun}."
