"""The dialog that refines source and map, and shows what that does to the distortion."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QCloseEvent, QPixmap
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QGroupBox,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

from workbench.app.files.new_file import ask_new_file
from workbench.app.refining.refine_work import MOST_MEASURED, CurvePicture, free_name, schemes_of
from workbench.app.status.reporter import counted
from workbench.core.errors import WorkbenchError
from workbench.core.mesh import Mesh
from workbench.core.refine import MOST_SIMPLICES, refined_count

SCHEME_TEXTS = {
    "linear": "Linear: every edge halved, the shape and all energies stay",
    "loop": "Loop: triangles in four, smoothed",
    "catmull-clark": "Catmull-Clark: quadrilaterals, smoothed, split at the end",
}
SLOW_TO_DRAW = 1_000_000
CURVES_HINT = (
    "Each scheme is applied to the map as it is now, and nothing is kept.\n"
    f"A curve ends before a level of more than {counted(MOST_MEASURED)} simplices."
)
FIGURE_FILTERS = "PDF (*.pdf);;SVG (*.svg);;PNG (*.png)"


class RefineDialog(QDialog):
    """Scheme, levels, the file of the result; below, distortion against level.

    `refine_wanted(path)`: the user has chosen. `curves_wanted(levels)`: curves of the map as it is now.
    `figure_wanted(path)`: save the figure that is shown.
    """

    refine_wanted = Signal(str)
    curves_wanted = Signal(int)
    figure_wanted = Signal(str)
    closed = Signal()

    def __init__(self, mesh: Mesh, stem: str, folder: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Refine source and map")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._mesh, self._stem = mesh, stem
        self._folder = Path(folder) if folder and Path(folder).is_dir() else Path.home()
        self._own_name = True  # until the user types another
        self._make_form()
        self._make_curves()
        layout = QVBoxLayout(self)
        layout.addLayout(self._form)
        layout.addWidget(self.error)
        layout.addWidget(self._group, 1)
        layout.addWidget(self.buttons)
        self._show_count()

    def _make_form(self) -> None:
        self.scheme = QComboBox(self)
        for id in schemes_of(self._mesh):
            self.scheme.addItem(SCHEME_TEXTS[id], id)
        self.levels = QSpinBox(self)
        self.levels.setMinimum(1)
        self.levels.setMaximumWidth(70)
        self.count = QLabel(self)
        levels_row = QHBoxLayout()
        levels_row.addWidget(self.levels)
        levels_row.addSpacing(8)
        levels_row.addWidget(self.count, 1)
        self.file = QLineEdit(self)
        self.file.setMinimumWidth(420)
        browse = QPushButton("Browse…", self)
        browse.setAutoDefault(False)
        browse.clicked.connect(self._browse)
        file_row = QHBoxLayout()
        file_row.addWidget(self.file, 1)
        file_row.addWidget(browse)
        self._form = QFormLayout()
        self._form.addRow("Scheme", self.scheme)
        self._form.addRow("Levels", levels_row)
        self._form.addRow("Save as", file_row)
        self.error = QLabel(self)
        self.error.setObjectName("form-error")
        self.error.setWordWrap(True)
        self.error.hide()
        self.buttons = QDialogButtonBox(self)
        self.accept_button = self.buttons.addButton("Refine and open", QDialogButtonBox.ButtonRole.AcceptRole)
        self.accept_button.setDefault(True)
        self.accept_button.setToolTip("Writes the refined source, its map and the anchors, and opens that file")
        self.buttons.addButton(QDialogButtonBox.StandardButton.Cancel)
        self.buttons.accepted.connect(self._accept)
        self.buttons.rejected.connect(self.close)
        self.scheme.currentIndexChanged.connect(self._show_count)
        self.levels.valueChanged.connect(self._show_count)
        self.file.textEdited.connect(self._typed)

    def _make_curves(self) -> None:
        self._group = QGroupBox("Distortion against level", self)
        self.picture = QLabel(CURVES_HINT, self._group)
        self.picture.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.picture.setMinimumSize(640, 120)
        self.curve_levels = QSpinBox(self._group)
        self.curve_levels.setRange(1, 6)
        self.curve_levels.setValue(3)
        self.measure = QPushButton("Measure", self._group)
        self.save = QPushButton("Save figure…", self._group)
        self.save.setEnabled(False)
        for button in (self.measure, self.save):
            button.setAutoDefault(False)
        self.measure.clicked.connect(self._ask_curves)
        self.save.clicked.connect(self._ask_figure)
        row = QHBoxLayout()
        row.addWidget(QLabel("up to level", self._group))
        row.addWidget(self.curve_levels)
        row.addWidget(self.measure)
        row.addStretch(1)
        row.addWidget(self.save)
        layout = QVBoxLayout(self._group)
        layout.addWidget(self.picture, 1)
        layout.addLayout(row)

    # ------------------------------------------------------------------------------------------ refining

    @property
    def chosen_scheme(self) -> str:
        return str(self.scheme.currentData())

    def _show_count(self) -> None:
        scheme = self.chosen_scheme
        most = max((k for k in range(1, 20) if refined_count(self._mesh, scheme, k) <= MOST_SIMPLICES), default=1)
        self.levels.setMaximum(most)
        levels = self.levels.value()
        after = refined_count(self._mesh, scheme, levels)
        noun = self._mesh.simplex_noun(2)
        slow = "; slow to draw and to solve" if after > SLOW_TO_DRAW else ""
        self.count.setText(f"{counted(self._mesh.simplex_count)} → {counted(after)} {noun}{slow}")
        if self._own_name:
            self.file.setText(str(free_name(self._folder, f"{self._stem}-{scheme}-{levels}")))

    def _typed(self) -> None:
        self._own_name = False
        self.error.hide()

    def _browse(self) -> None:
        ask_new_file(self, "Save the refined map", self.file.text(), "NumPy case (*.npz)", "npz", self._take_file)

    def _take_file(self, path: str) -> None:
        self._own_name = False
        self.file.setText(path)
        self.error.hide()

    def _accept(self) -> None:
        path = Path(self.file.text().strip()).expanduser()
        try:
            self._check(path)
        except WorkbenchError as error:
            self.show_error(error.sentence)
            return
        self.refine_wanted.emit(str(path))
        self.close()

    @staticmethod
    def _check(path: Path) -> None:
        """What can be told before the work: the rest is said when it fails."""
        if path.suffix.lower() != ".npz":
            raise WorkbenchError("The source with its map and anchors is written as .npz; choose that ending.")
        if not path.parent.is_dir():
            raise WorkbenchError(f"There is no folder {path.parent}; make it first, or choose another.")
        if path.exists():
            raise WorkbenchError(f"{path.name} is there already; choose another name.")

    def show_error(self, sentence: str) -> None:
        """Say in the dialog what is wrong."""
        self.error.setText(sentence)
        self.error.show()

    # ------------------------------------------------------------------------------------------ curves

    def _ask_curves(self) -> None:
        self.measure.setEnabled(False)
        self.picture.setText("Measuring…")
        self.curves_wanted.emit(self.curve_levels.value())

    def show_curves(self, curves: CurvePicture) -> None:
        """Show the figure and allow saving it."""
        picture = QPixmap()
        picture.loadFromData(curves.png, "PNG")
        picture.setDevicePixelRatio(self.devicePixelRatioF())
        self.picture.setPixmap(picture)
        self.picture.setMinimumSize(picture.deviceIndependentSize().toSize())
        self.measure.setEnabled(True)
        self.save.setEnabled(True)
        self.adjustSize()

    def show_no_curves(self, sentence: str) -> None:
        """Say why there is no figure."""
        self.picture.setText(sentence)
        self.measure.setEnabled(True)
        self.save.setEnabled(False)

    def _ask_figure(self) -> None:
        place = str(self._folder / f"{self._stem}-levels.pdf")
        ask_new_file(self, "Save the figure", place, FIGURE_FILTERS, "pdf", self.figure_wanted.emit, overwrites=True)

    def closeEvent(self, event: QCloseEvent) -> None:
        self.closed.emit()
        super().closeEvent(event)
