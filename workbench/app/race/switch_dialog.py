"""Letting one contestant go on in another way: another solver, distortion or parameter."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QDialog, QDialogButtonBox, QGroupBox, QLabel, QVBoxLayout, QWidget

from workbench.app.panels.method_box import MethodBox
from workbench.app.panels.method_form import MethodForm
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.registry import Registry
from workbench.engine.messages import SetProblem
from workbench.engine.race_messages import Entrant


class SwitchDialog(QDialog):
    """`switched` carries the sentence for the marker, solver id, its values, and a `SetProblem` or None."""

    switched = Signal(str, str, dict, object)

    def __init__(self, entrant: Entrant, problem: SetProblem, kind: str, registry: Registry, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle(f"Change {entrant.label}")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.resize(420, 380)
        self._registry = registry
        self._problem = problem
        self._before = entrant
        self._solver, self._values = entrant.solver, dict(entrant.parameters)
        self.solver = MethodBox(self)
        self.solver.show_choices(registry.solvers, kind)
        self.solver.show_choice(self._solver, self._values)
        self.solver.chosen.connect(self._take_solver)
        self.distortion = QComboBox(self)
        self.distortion.setEditable(True)
        self.distortion.setToolTip("A distortion of the list, or a formula")
        for item in sorted(registry.distortions.values(), key=lambda d: d.label.lower()):
            self.distortion.addItem(item.label, item.id)
        row = self.distortion.findData(problem.distortion)
        self.distortion.setCurrentIndex(row)
        if row < 0:
            self.distortion.setEditText(problem.distortion)
        self.form = MethodForm(self)
        self.distortion.currentTextChanged.connect(lambda _: self._show_parameters({}))
        self.error = QLabel(self)
        self.error.setObjectName("form-error")
        self.error.setWordWrap(True)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Ok | QDialogButtonBox.StandardButton.Cancel, self)
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        layout = QVBoxLayout(self)
        for title, widgets in (("Solver", (self.solver,)), ("Distortion", (self.distortion, self.form))):
            group = QGroupBox(title, self)
            inner = QVBoxLayout(group)
            for widget in widgets:
                inner.addWidget(widget)
            group.setVisible(title != "Solver" or bool(entrant.solver))
            layout.addWidget(group)
        layout.addStretch(1)
        layout.addWidget(QLabel("It goes on from the map that it has now; a mark on its curves says so.", self))
        layout.addWidget(self.error)
        layout.addWidget(buttons)
        self._show_parameters(dict(problem.parameters))

    def _take_solver(self, id: str, values: dict[str, Any]) -> None:
        self._solver, self._values = id, dict(values)
        self.solver.show_choice(id, values)

    @property
    def text(self) -> str:
        """Id of a distortion, or a formula."""
        typed = self.distortion.currentText().strip()
        row = self.distortion.findText(typed)
        return str(self.distortion.itemData(row)) if row >= 0 else typed

    def _show_parameters(self, values: dict[str, Any]) -> None:
        try:
            item = Distortion.resolve(self.text)
        except WorkbenchError:
            self.form.show_parameters(())
            return
        self.form.show_parameters(item.parameters, values)

    def accept(self) -> None:
        """Refuse here what can be told here; the engine refuses the rest."""
        parameters = self.form.values
        try:
            distortion = Distortion.resolve(self.text, parameters)
            if self._solver:
                self._registry.solver(self._solver).check_distortion(distortion)
        except WorkbenchError as error:
            self.error.setText(error.sentence)
            return
        is_other = (self.text, parameters) != (self._problem.distortion, dict(self._problem.parameters))
        problem = None
        parts = []
        if (self._solver, self._values) != (self._before.solver, dict(self._before.parameters)):
            parts.append(_said(self._registry.solver(self._solver).label, self._values))
        if is_other:
            allow = self._problem.allow_inversions
            problem = SetProblem(self.text, parameters, self._problem.fixed_boundary, allow)
            parts.append(_said(self.distortion.currentText(), parameters))
        if parts:
            self.switched.emit("; ".join(parts), self._solver, self._values, problem)
        super().accept()


def _said(name: str, values: dict[str, Any]) -> str:
    return ", ".join((name, *(f"{key} = {value}" for key, value in values.items())))
