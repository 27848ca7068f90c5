"""The dialog that fills a closed surface with tetrahedra."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtGui import QCloseEvent
from PySide6.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QProgressBar,
    QPushButton,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

from workbench.app.files.file_choice import ask_file
from workbench.app.files.file_drops import FileDrops
from workbench.app.files.new_file import ask_new_file, stem_of
from workbench.app.filling.fill_work import FillRequest, check_request
from workbench.app.refining.refine_work import free_name
from workbench.core.errors import WorkbenchError

SURFACES = "Surfaces (*.obj *.off *.ply *.stl *.npz *.mat *.vtk *.vtu);;All files (*)"
SOLIDS = "MEDIT (*.mesh);;Gmsh (*.msh);;VTK (*.vtu);;NumPy case (*.npz);;OBJ (*.obj)"
HINT = (
    "The surface has to be closed and must not meet itself. The solid gets triangles of its own, close to those of the surface."
)
FIRST_PARTS = 20


class FillDialog(QDialog):
    """Surface, size of the tetrahedra, the file of the result; while the work is done, how long it has taken.

    `fill_wanted(request)`: the user has chosen; the dialog stays until `close`, and says what is told to `show_progress`.
    `cancelled`: the work is to end.
    """

    fill_wanted = Signal(object)
    cancelled = Signal()
    closed = Signal()

    def __init__(self, source: str, folder: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Fill with tetrahedra")
        self._folder = Path(folder) if folder and Path(folder).is_dir() else Path.home()
        self._own_name = True  # until the user types another
        self.is_busy = False
        self._make_form(source)
        self.progress = QProgressBar(self)
        self.progress.setRange(0, 0)
        self.progress.setTextVisible(False)
        self.progress.hide()
        self.words = QLabel(HINT, self)
        self.words.setWordWrap(True)
        self.words.setMinimumHeight(2 * self.words.fontMetrics().lineSpacing())
        self.error = QLabel(self)
        self.error.setObjectName("form-error")
        self.error.setWordWrap(True)
        self.error.hide()
        self.buttons = QDialogButtonBox(self)
        self.accept_button = self.buttons.addButton("Fill and open", QDialogButtonBox.ButtonRole.AcceptRole)
        self.accept_button.setDefault(True)
        self.cancel_button = self.buttons.addButton(QDialogButtonBox.StandardButton.Cancel)
        self.buttons.accepted.connect(self._accept)
        self.buttons.rejected.connect(self._cancel)
        layout = QVBoxLayout(self)
        layout.addWidget(self._fields)
        layout.addWidget(self.words)
        layout.addWidget(self.error)
        layout.addWidget(self.progress)
        layout.addWidget(self.buttons)
        FileDrops(self, SURFACES, lambda files: self.source.setText(files[0]))
        self._propose_name()

    def _make_form(self, source: str) -> None:
        self._fields = QWidget(self)
        self.source = QLineEdit(source, self._fields)
        self.source.setPlaceholderText("file of a closed surface")
        self.source.setMinimumWidth(420)
        self.source.textChanged.connect(self._propose_name)
        self.parts = QSpinBox(self._fields)
        self.parts.setRange(5, 200)
        self.parts.setValue(FIRST_PARTS)
        self.parts.setMaximumWidth(70)
        self.parts.setToolTip("So many edges of tetrahedra make the diagonal of the surface's box")
        self.file = QLineEdit(self._fields)
        self.file.textEdited.connect(self._typed)
        form = QFormLayout(self._fields)
        form.setContentsMargins(0, 0, 0, 0)
        form.addRow("Surface", self._row(self.source, self._browse_surface))
        size = QHBoxLayout()
        size.addWidget(self.parts)
        size.addSpacing(8)
        size.addWidget(QLabel("edges to the diagonal; twice as many make eight times the tetrahedra", self._fields), 1)
        form.addRow("Fineness", size)
        form.addRow("Save as", self._row(self.file, self._browse_solid))

    def _row(self, field: QLineEdit, browse: object) -> QHBoxLayout:
        button = QPushButton("Browse…", self._fields)
        button.setAutoDefault(False)
        button.clicked.connect(browse)
        row = QHBoxLayout()
        row.addWidget(field, 1)
        row.addWidget(button)
        return row

    # ------------------------------------------------------------------------------------------ choices

    def _propose_name(self) -> None:
        self.error.hide()
        if not self._own_name:
            return
        stem = stem_of(self.source.text().strip()) or "solid"
        self.file.setText(str(free_name(self._folder, f"{stem}-filled", ".mesh")))

    def _typed(self) -> None:
        self._own_name = False
        self.error.hide()

    def _browse_surface(self) -> None:
        ask_file(self, "Fill a surface", SURFACES, self.source.setText)

    def _browse_solid(self) -> None:
        ask_new_file(self, "Save the solid", self.file.text(), SOLIDS, "mesh", self._take_file)

    def _take_file(self, path: str) -> None:
        self._own_name = False
        self.file.setText(path)
        self.error.hide()

    # ------------------------------------------------------------------------------------------ the work

    def _accept(self) -> None:
        request = FillRequest(self.source.text().strip(), self.parts.value(), Path(self.file.text().strip()).expanduser())
        try:
            check_request(request)
        except WorkbenchError as error:
            self.show_error(error.sentence)
            return
        self.error.hide()
        self._show_busy(True)
        self.words.setText("Reading the surface…")
        self.fill_wanted.emit(request)

    def _show_busy(self, is_busy: bool) -> None:
        self.is_busy = is_busy
        self._fields.setEnabled(not is_busy)
        self.accept_button.setEnabled(not is_busy)
        self.progress.setVisible(is_busy)

    def _cancel(self) -> None:
        if self.is_busy:
            self.words.setText("Cancelling…")
            self.cancelled.emit()
        else:
            self.close()

    def show_progress(self, sentence: str) -> None:
        if self.is_busy:
            self.words.setText(sentence)

    def show_error(self, sentence: str) -> None:
        """The work has ended without a solid; another choice can be made."""
        self._show_busy(False)
        self.words.setText(HINT)
        self.error.setText(sentence)
        self.error.show()

    def closeEvent(self, event: QCloseEvent) -> None:
        if self.is_busy:
            self.cancelled.emit()
        self.closed.emit()
        super().closeEvent(event)
