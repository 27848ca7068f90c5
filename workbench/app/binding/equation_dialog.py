"""The linear equations that bind the map: typed, from a file, with how far each is from holding."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PySide6.QtCore import QTimer
from PySide6.QtGui import QFontDatabase, QShowEvent
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QLabel, QPlainTextEdit, QVBoxLayout, QWidget

from workbench.app.document.document import Document
from workbench.app.files.file_choice import ask_file, last_folder
from workbench.app.files.file_drops import FileDrops
from workbench.app.files.new_file import ask_new_file
from workbench.core.constraints import LinearConstraints
from workbench.core.errors import WorkbenchError
from workbench.core.linear_equations import linear_constraints, read_equations
from workbench.engine.messages import Refused
from workbench.io.equations import read_equation_file, write_equation_file

MILLISECONDS = 150
"""Between two looks at how well the equations hold."""
EXPLANATION = (
    "One equation a line, in the coordinates of the map; vertices from 0, # begins a remark:\n"
    "    x[12] - x[30] = 0\n    0.5 y[3] + 0.5 y[4] = 1.25"
)
FILTER = "Linear equations (*.txt);;All files (*)"
Buttons = QDialogButtonBox.StandardButton
Role = QDialogButtonBox.ButtonRole


class EquationDialog(QDialog):
    """Stays open beside the window; `Apply` gives the equations to the document as one step that can be undone."""

    def __init__(self, document: Document, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("Linear equations")
        self._document = document
        self._read: tuple[tuple[str, ...], int] = ((), 0)
        self._rows: LinearConstraints | None = None
        explanation = QLabel(EXPLANATION, self)
        self.text = QPlainTextEdit(self)
        self.text.setFont(QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont))
        self.text.setMinimumSize(420, 180)
        self.text.setPlaceholderText("No linear equations")
        self.state = QLabel(self)
        self.state.setWordWrap(True)
        buttons = QDialogButtonBox(Buttons.Apply | Buttons.Close, self)
        for words, deed in (("&Open…", self._ask_open), ("&Save…", self._ask_save)):
            buttons.addButton(words, Role.ActionRole).clicked.connect(deed)
        self.apply_button = buttons.button(Buttons.Apply)
        self.apply_button.clicked.connect(self.apply)
        buttons.rejected.connect(self.reject)
        layout = QVBoxLayout(self)
        for part in (explanation, self.text, self.state, buttons):
            layout.addWidget(part)
        FileDrops(self, FILTER, lambda files: self.open(files[0]))
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(MILLISECONDS)
        self._timer.timeout.connect(self._show_state)
        self.text.textChanged.connect(self._edited)
        document.snapshot_taken.connect(self._look_soon)
        document.session_changed.connect(self._follow)
        document.refused.connect(self._take_refused)
        self._shown = document.session.linear_equations
        self._in_force = "\n".join(self._shown)
        """What is typed where it is in force, with its remarks."""
        self._fill(self._shown)
        self._edited()

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._show_state()

    # --------------------------------------------------------------------------------------- deeds

    def apply(self) -> None:
        """Bind the map by what is typed, or say what is wrong with it."""
        mesh = self._document.mesh
        try:
            if mesh is None:
                raise WorkbenchError("There is no map to bind; open a mesh first.")
            equations = read_equations(self.text.toPlainText())
            linear_constraints(equations, mesh.vertex_count, mesh.dimension)
        except WorkbenchError as error:
            self._show_error(error.sentence)
            return
        self._shown, self._in_force = equations, self.text.toPlainText()
        self._document.choose(linear_equations=equations)
        self._edited()
        self._show_state()

    def open(self, path: str) -> None:  # type: ignore[override]
        """Put the equations of a file into the text; they bind when they are applied."""
        try:
            self._fill(read_equation_file(path))
        except WorkbenchError as error:
            self._show_error(error.sentence)

    def save(self, path: str) -> None:
        """Write what is typed."""
        try:
            write_equation_file(path, read_equations(self.text.toPlainText()))
        except WorkbenchError as error:
            self._show_error(error.sentence)

    def _ask_open(self) -> None:
        ask_file(self, "Open linear equations", FILTER, self.open)

    def _ask_save(self) -> None:
        place = str(Path(last_folder(self)) / "equations.txt")
        ask_new_file(self, "Save linear equations", place, FILTER, "txt", self.save, overwrites=True)

    # --------------------------------------------------------------------------------------- showing

    def _fill(self, equations: tuple[str, ...]) -> None:
        self.text.setPlainText("\n".join(equations))

    def _follow(self) -> None:
        """Undo, a refusal or another mesh changed them."""
        equations = self._document.session.linear_equations
        if equations != self._shown:
            self._shown, self._in_force = equations, "\n".join(equations)
            self._fill(equations)
            self._edited()
        self._look_soon()

    def _edited(self) -> None:
        self.apply_button.setEnabled(self.text.toPlainText() != self._in_force)
        self._look_soon()

    def _look_soon(self) -> None:
        if self.isVisible() and not self._timer.isActive():
            self._timer.start()

    def _take_refused(self, report: Refused) -> None:
        if self.isVisible() and report.command == "SetProblem":
            self._timer.stop()
            self._show_error(report.sentence)

    def _show_error(self, sentence: str) -> None:
        self._name_state("form-error")
        self.state.setText(sentence)

    def _show_state(self) -> None:
        self._name_state("")
        self.state.setText(self._state_in_words())

    def _name_state(self, name: str) -> None:
        self.state.setObjectName(name)
        self.state.style().polish(self.state)

    def _state_in_words(self) -> str:
        positions, equations = self._document.positions, self._document.session.linear_equations
        if self.apply_button.isEnabled():
            return "Not applied yet." + (f" In force: {len(equations)}." if equations else "")
        if not equations or positions is None:
            return "Nothing binds the map."
        key = (equations, len(positions))
        if self._read != key:
            self._read, self._rows = key, linear_constraints(equations, *positions.shape)
        assert self._rows is not None
        residual = np.abs(self._rows.residual(positions))
        worst = int(residual.argmax())
        count = f"{len(equations)} equation{'s' if len(equations) > 1 else ''}"
        return f"{count} in force; the residual is at most {residual[worst]:.2g}, in line {worst + 1}."
