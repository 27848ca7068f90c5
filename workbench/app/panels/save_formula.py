"""Asking for the name and the note of a formula that is kept."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QFormLayout, QLabel, QLineEdit, QPlainTextEdit, QWidget

from workbench.core.errors import WorkbenchError
from workbench.core.named_formulas import LONGEST_NAME, id_of_name
from workbench.io.formula_store import NameTakenError


class NameDialog(QDialog):
    """`attempt` is called with name, note and whether to replace; what it raises stands in the dialog, which stays open.

    A name that is taken turns Save into Replace.
    """

    done_with = Signal(str)

    def __init__(
        self,
        title: str,
        attempt: Callable[[str, str, bool], str],
        parent: QWidget,
        *,
        name: str = "",
        note: str | None = None,
        remark: str = "",
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle(title)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._attempt = attempt
        self._replaces = False
        self.name = QLineEdit(name, self)
        self.name.setMaxLength(LONGEST_NAME)
        self.name.textChanged.connect(self._say_id)
        self.note = QPlainTextEdit(note or "", self)
        self.note.setTabChangesFocus(True)
        self.note.setFixedHeight(70)
        self.note.setVisible(note is not None)
        self.remark = QLabel(remark, self)
        self.remark.setWordWrap(True)
        self.remark.setVisible(bool(remark))
        self.sentence = QLabel(self)
        self.sentence.setWordWrap(True)
        self.buttons = QDialogButtonBox(self)
        self.save_button = self.buttons.addButton(QDialogButtonBox.StandardButton.Save)
        self.buttons.addButton(QDialogButtonBox.StandardButton.Cancel)
        self.buttons.accepted.connect(self.try_it)
        self.buttons.rejected.connect(self.reject)
        layout = QFormLayout(self)
        layout.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        layout.addRow("Name", self.name)
        if note is not None:
            layout.addRow("Note", self.note)
        layout.addRow(self.remark)
        layout.addRow(self.sentence)
        layout.addRow(self.buttons)
        self.setMinimumWidth(420)
        self._say_id(name)

    def _say_id(self, name: str) -> None:
        self._replaces = False
        self.save_button.setText("Save")
        self.sentence.setObjectName("citation")
        try:
            id = id_of_name(name) if name else ""
            text = f"On the command line {id}, in formulas {id.replace('-', '_')}." if id else "A name in a few words."
        except WorkbenchError as error:
            text = error.sentence
        self._say(text)

    def _say(self, text: str) -> None:
        self.sentence.setText(text)
        self.sentence.style().unpolish(self.sentence)  # a style sheet looks at object names only then
        self.sentence.style().polish(self.sentence)

    def try_it(self) -> None:
        try:
            id = self._attempt(self.name.text().strip(), self.note.toPlainText().strip(), self._replaces)
        except WorkbenchError as error:
            if isinstance(error, NameTakenError):
                self._replaces = True
                self.save_button.setText("Replace")
            self.sentence.setObjectName("form-error")
            self._say(error.sentence)
            return
        self.accept()
        self.done_with.emit(id)
