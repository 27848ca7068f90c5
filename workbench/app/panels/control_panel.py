"""The panel of choices: map, start, distortion, solver; and the buttons that run."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import (
    QComboBox,
    QFormLayout,
    QFrame,
    QGroupBox,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from workbench.app.document.document import Document
from workbench.app.document.first_start import has_own_map, start_in_force
from workbench.app.files.file_choice import MAP_FILTERS, ask_file
from workbench.app.panels.distortion_box import DistortionBox
from workbench.app.panels.method_box import MethodBox
from workbench.core.registry import Registry, registry
from workbench.engine.messages import Refused
from workbench.session.session import Session

KIND_LABELS = {"auto": "Automatic", "plane": "Plane to plane", "parameterize": "Surface to plane", "volume": "Solid to space"}

NAME_CHARACTERS = 24
"""Of the name of a file on a button: more would widen the panel."""


class ControlPanel(QScrollArea):
    """Shows the document's session and changes it; everything may be chosen before and while a solver runs."""

    def __init__(self, document: Document, run_actions: Iterable[QAction], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._document = document
        self._registry: Registry | None = None
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        body = QWidget(self)
        self._layout = QVBoxLayout(body)
        self._layout.setContentsMargins(8, 8, 8, 8)
        self._layout.setSpacing(8)
        self.run_buttons = self._make_run_buttons(run_actions)
        self._make_map_group()
        self.distortion = DistortionBox(body)
        self.distortion.chosen.connect(lambda text, values: document.choose(distortion=text, distortion_parameters=values))
        self.distortion.tools.formulas_changed.connect(lambda _: document.send_problem())
        document.snapshot_taken.connect(self.distortion.pacer.answered)
        self._group("Distortion", self.distortion)
        self.solver = MethodBox(body)
        self.solver.chosen.connect(lambda id, values: document.choose(solver=id, solver_parameters=values))
        self._group("Solver", self.solver)
        self.start = MethodBox(body)
        self.start.chosen.connect(self._choose_start)
        self.file_button = QPushButton("Choose the file…", body)
        self.file_button.clicked.connect(self._choose_file)
        self.file_button.hide()
        start_layout = self._group("Start", self.start)
        start_layout.addWidget(self.file_button)
        self._layout.addStretch(1)
        self.setWidget(body)
        self.setMinimumWidth(284)
        document.session_changed.connect(self.show_session)
        document.opened.connect(self.show_choices)
        document.refused.connect(self._show_refusal)
        self.show_session()

    # ------------------------------------------------------------------------------------------ making

    def _make_run_buttons(self, actions: Iterable[QAction]) -> dict[str, QToolButton]:
        row = QHBoxLayout()
        row.setSpacing(4)
        buttons = {}
        for action in actions:
            button = QToolButton(self)
            button.setDefaultAction(action)
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextUnderIcon)
            button.setMinimumSize(50, 46)
            row.addWidget(button, 1)
            buttons[action.objectName()] = button
        self._layout.addLayout(row)
        return buttons

    def _group(self, title: str, widget: QWidget) -> QVBoxLayout:
        group = QGroupBox(title, self)
        layout = QVBoxLayout(group)
        layout.setContentsMargins(8, 6, 8, 8)
        layout.addWidget(widget)
        self._layout.addWidget(group)
        return layout

    def _make_map_group(self) -> None:
        group = QWidget(self)
        layout = QFormLayout(group)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        self.kind = QComboBox(group)
        for id, label in KIND_LABELS.items():
            self.kind.addItem(label, id)
        self.kind.setToolTip("What is mapped to what; automatic looks at the mesh.")
        self.kind.activated.connect(lambda _: self._document.open_as(self.kind.currentData()))
        self.boundary = QComboBox(group)
        self.boundary.addItem("Free", False)
        self.boundary.addItem("Fixed where it is now", True)
        self.boundary.activated.connect(lambda _: self._document.choose(fixed_boundary=self.boundary.currentData()))
        self.scale = QComboBox(group)
        self.scale.addItem("Matched to the source", True)
        self.scale.addItem("Kept from the start", False)
        self.scale.setToolTip("Whether the start is scaled to the area or volume of the source; a change makes it anew.")
        self.scale.activated.connect(lambda _: self._document.choose(match_area=self.scale.currentData()))
        layout.addRow("Kind", self.kind)
        self.inversions = QComboBox(group)
        self.inversions.addItem("Never made", False)
        self.inversions.addItem("Allowed without a barrier", True)
        self.inversions.setToolTip("Whether simplices may invert under a distortion without a barrier, such as ARAP.")
        self.inversions.activated.connect(lambda _: self._document.choose(allow_inversions=self.inversions.currentData()))
        layout.addRow("Boundary", self.boundary)
        layout.addRow("Inversions", self.inversions)
        layout.addRow("Scale", self.scale)
        self.kind_found = QLabel("", group)
        self.kind_found.setObjectName("citation")
        self.kind_found.setWordWrap(True)
        layout.addRow(self.kind_found)
        self._group("Map", group)
        for box in (self.kind, self.boundary, self.inversions, self.scale):
            box.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
            box.setMinimumContentsLength(10)

    # ------------------------------------------------------------------------------------------ showing

    def set_registry(self, registry: Registry) -> None:
        """The methods were found: fill the lists."""
        self._registry = registry
        self.show_choices()

    def show_choices(self) -> None:
        if self._registry is None:
            return
        kind = self._document.kind
        self.distortion.show_choices(registry().distortions, kind)  # formulas of the user's own come and go
        self.solver.show_choices(self._registry.solvers, kind)
        self.start.show_choices(self._registry.initializers, kind)
        self.show_session()

    def show_session(self) -> None:
        """Bring every field in line with the session."""
        session = self._document.session
        self.kind.setCurrentIndex(max(self.kind.findData(session.kind), 0))
        found = self._document.kind
        is_auto = session.kind == "auto" and found
        self.kind_found.setText(f"Found: {KIND_LABELS.get(found, found).lower()}." if is_auto else "")
        self.kind_found.setVisible(bool(is_auto))
        self.boundary.setCurrentIndex(self.boundary.findData(session.fixed_boundary))
        self.inversions.setCurrentIndex(self.inversions.findData(session.allow_inversions))
        self.scale.setCurrentIndex(self.scale.findData(session.match_area))
        if self._registry is None:
            return
        self.distortion.show_choice(session.distortion, session.distortion_parameters)
        self.solver.show_choice(session.solver, session.solver_parameters)
        start = start_in_force(session, self._document.loaded)
        self.start.show_choice(start, session.initializer_parameters)
        self._name_start_file(session, start == "file")

    def _show_refusal(self, report: Refused) -> None:
        if report.command == "SetProblem":
            self.distortion.show_refusal(report.sentence)

    # ------------------------------------------------------------------------------------------ start

    def _name_start_file(self, session: Session, is_wanted: bool) -> None:
        """The button for the file of the start says which one it is."""
        self.file_button.setVisible(is_wanted)
        file = session.start_file if session.initializer else ""
        words = "The UVs of the mesh" if has_own_map(session) else Path(file).name or "Choose the file"
        if not session.initializer and self._has_case:
            words = "The start of the case"
        room = self.file_button.fontMetrics().averageCharWidth() * NAME_CHARACTERS
        self.file_button.setText(self.file_button.fontMetrics().elidedText(words, Qt.TextElideMode.ElideMiddle, room) + "…")
        self.file_button.setToolTip(f"The map to start from{f': {file}' if file else ''}; a click chooses another file")

    @property
    def _has_case(self) -> bool:
        """Whether the mesh came as a case, with a start of its own."""
        loaded = self._document.loaded
        return loaded is not None and loaded.has_start

    def _choose_start(self, id: str, values: dict[str, Any]) -> None:
        if id == "file" and self._has_case:
            id = ""
        elif id == "file" and not self._document.session.start_file:
            # nothing is sent before the file is known; the list shows the old choice again if it is not
            self._choose_file()
            return
        self._document.choose(initializer=id, initializer_parameters=values)

    def _choose_file(self) -> None:
        ask_file(self, "Map to start from", MAP_FILTERS, self.take_start_file, leave=self.show_session)

    def take_start_file(self, path: str) -> None:
        self._document.choose(initializer="file", initializer_parameters={}, start_file=path)
