"""Shape signatures: the histograms of (78) of several maps over each other, and how far they are apart."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QDialog,
    QGridLayout,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QPushButton,
    QSpinBox,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from workbench.app.appearance.theme import Theme
from workbench.app.background import Background
from workbench.app.files.file_choice import ask_files, last_folder
from workbench.app.files.file_drops import FileDrops
from workbench.app.files.new_file import ask_new_file
from workbench.app.signatures.comparison import Comparison, ComparisonChoices, compare
from workbench.app.signatures.density_plot import DensityPlot
from workbench.app.signatures.map_list import MapList
from workbench.core.arrays import Floats
from workbench.core.errors import WorkbenchError
from workbench.core.mesh import Mesh
from workbench.core.signature import signature
from workbench.io.signatures import distances_text, histograms_text

MAP_FILTERS = "Source with its map (*.obj *.npz);;All files (*)"


class SignatureWindow(QDialog):
    """Maps are added from the main window and from files; all work is done on a thread, one piece after the other."""

    present_wanted = Signal()
    """The main window is asked for its map: it answers by `add_map`."""

    def __init__(self, theme: Theme, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("Shape signatures")
        self.setWindowFlag(Qt.WindowType.WindowMinMaxButtonsHint)
        self.resize(1120, 640)
        self._queue: deque[tuple[Callable[[], Any], Callable[[Any], None]]] = deque()
        self._work: Background | None = None
        self.comparison: Comparison | None = None
        self.maps = MapList(self)
        self.maps.changed.connect(self._compare)
        self.maps.repainted.connect(self._show)
        self.plot = DensityPlot(self)
        self.pairs = _pair_table(self)
        self.message = QLabel("", self)
        self.message.setWordWrap(True)
        self.message.setObjectName("form-error")
        self.message.hide()
        self._make_choices()
        self._make_buttons()
        self._lay_out()
        FileDrops(self, MAP_FILTERS, self.add_files)
        self.set_theme(theme)
        self._show()

    # ------------------------------------------------------------------------------------------ making

    def _make_choices(self) -> None:
        self.normalised = QCheckBox("Forget the scale (mean 1)", self)
        self.normalised.setToolTip("(78) grows with the scale of a map; maps of different size are compared without it.")
        self.logarithmic = QCheckBox("Logarithmic", self)
        self.bins = QSpinBox(self)
        self.bins.setRange(4, 512)
        self.bins.setValue(64)
        self.bins.setToolTip("Number of common bins; the L1 distance depends on it, Wasserstein-1 does not.")
        for box in (self.normalised, self.logarithmic):
            box.toggled.connect(lambda _: self._compare())
        self.bins.valueChanged.connect(lambda _: self._compare())

    def _make_buttons(self) -> None:
        self.buttons: dict[str, QPushButton] = {}
        for name, text, deed in (
            ("present", "Add the present map", self.present_wanted.emit),
            ("files", "Add files…", self._ask_files),
            ("remove", "Remove", self.maps.remove_selected),
            ("distances", "Save distances…", lambda: self._ask_place("distances")),
            ("histograms", "Save histograms…", lambda: self._ask_place("histograms")),
        ):
            button = QPushButton(text, self)
            button.setAutoDefault(False)
            button.clicked.connect(lambda _=False, d=deed: d())
            self.buttons[name] = button

    def _lay_out(self) -> None:
        choices = QHBoxLayout()
        choices.addWidget(self.normalised)
        choices.addWidget(self.logarithmic)
        choices.addStretch(1)
        choices.addWidget(QLabel("Bins", self))
        choices.addWidget(self.bins)
        left = QVBoxLayout()
        left.addLayout(choices)
        left.addWidget(self.plot, 1)
        right = QVBoxLayout()
        adding = QHBoxLayout()
        for name in ("present", "files", "remove"):
            adding.addWidget(self.buttons[name])
        saving = QHBoxLayout()
        for name in ("distances", "histograms"):
            saving.addWidget(self.buttons[name])
        right.addLayout(adding)
        right.addWidget(self.maps, 2)
        right.addWidget(QLabel("How far they are apart", self))
        right.addWidget(self.pairs, 3)
        right.addLayout(saving)
        grid = QGridLayout(self)
        grid.addLayout(left, 0, 0)
        grid.addLayout(right, 0, 1)
        grid.addWidget(self.message, 1, 0, 1, 2)
        grid.setColumnStretch(0, 5)
        grid.setColumnStretch(1, 4)

    def set_theme(self, theme: Theme) -> None:
        self.plot.set_theme(theme)

    # ------------------------------------------------------------------------------------------ maps

    def add_map(self, mesh: Mesh, positions: Floats, name: str) -> None:
        """Compare one more map."""
        self._do(lambda: signature(mesh, positions, name), self.maps.add)

    def add_files(self, paths: list[str]) -> None:
        """Compare the maps that these files hold."""
        for path in paths:
            self._do(lambda path=path: _signature_of_file(path), self.maps.add)  # type: ignore[misc]

    def _ask_files(self) -> None:
        ask_files(self, "Maps to compare", MAP_FILTERS, self.add_files)

    # ------------------------------------------------------------------------------------------ work

    def _do(self, work: Callable[[], Any], then: Callable[[Any], None]) -> None:
        self._queue.append((work, then))
        self._next()

    def _next(self) -> None:
        if self._work is not None or not self._queue:
            return
        work, then = self._queue.popleft()
        self._work = Background(work, self)

        def done(result: Any) -> None:
            self._work = None
            self.message.hide()
            then(result)
            self._next()

        def failed(error: Exception) -> None:
            self._work = None
            self.say(error.sentence if isinstance(error, WorkbenchError) else f"{type(error).__name__}: {error}")
            self._next()

        self._work.finished.connect(done)
        self._work.failed.connect(failed)
        self._work.start()

    def wait(self) -> None:
        """Let the thread end before the window does."""
        self._queue.clear()
        if self._work is not None:
            self._work.wait()

    def say(self, sentence: str) -> None:
        self.message.setText(sentence)
        self.message.show()

    # ------------------------------------------------------------------------------------------ showing

    def _compare(self) -> None:
        choices = ComparisonChoices(self.normalised.isChecked(), self.logarithmic.isChecked(), self.bins.value())
        compared = tuple(item.signature for item in self.maps.maps)
        if not compared:
            self.comparison = None
            self._show()
            return
        self._do(lambda: compare(compared, choices), self._take)

    def _take(self, comparison: Comparison) -> None:
        names = tuple(item.signature.name for item in self.maps.maps)
        if comparison.distances.names == names:  # else another comparison waits behind this one
            self.comparison = comparison
            self._show()

    def _show(self) -> None:
        comparison = self.comparison
        colours: list[QColor] = [item.colour for item in self.maps.maps]
        self.plot.show_comparison(comparison, colours)
        pairs = comparison.distances.pairs() if comparison is not None else []
        self.pairs.setSortingEnabled(False)
        self.pairs.setRowCount(len(pairs))
        for row, pair in enumerate(pairs):
            for column, value in enumerate(pair):
                self.pairs.setItem(row, column, _cell(value))
        self.pairs.setSortingEnabled(True)
        self.pairs.resizeRowsToContents()
        for name in ("distances", "histograms"):
            self.buttons[name].setEnabled(bool(pairs) if name == "distances" else comparison is not None)

    # ------------------------------------------------------------------------------------------ saving

    def _ask_place(self, what: str) -> None:
        place = str(Path(last_folder(self)) / f"{what}.csv")
        ask_new_file(self, f"Save the {what}", place, "CSV (*.csv)", "csv", partial(self.save, what), overwrites=True)

    def save(self, what: str, path: str) -> None:
        """Write `distances` or `histograms` as the command line does."""
        from workbench.io.atomic import write_text

        shown = self.comparison
        if shown is None:
            return
        text = distances_text(shown.distances) if what == "distances" else histograms_text(shown.signatures, shown.edges)
        try:
            write_text(path, text)
        except WorkbenchError as error:
            self.say(error.sentence)


def _signature_of_file(path: str) -> Any:
    from workbench.engine.map_file import open_map

    opened = open_map(path)
    return signature(opened.mesh, opened.positions, Path(path).stem)


def _pair_table(parent: QWidget) -> QTableWidget:
    table = QTableWidget(0, 4, parent)
    table.setHorizontalHeaderLabels(["a", "b", "L1", "Wasserstein-1"])
    table.verticalHeader().hide()
    table.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
    table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
    header = table.horizontalHeader()
    for column in range(4):
        stretches = column < 2
        header.setSectionResizeMode(
            column, QHeaderView.ResizeMode.Stretch if stretches else QHeaderView.ResizeMode.ResizeToContents
        )
    return table


def _cell(value: str | float) -> QTableWidgetItem:
    """Numbers sort as numbers, and are shown with four digits."""
    cell = QTableWidgetItem()
    if isinstance(value, float):
        cell.setData(Qt.ItemDataRole.DisplayRole, float(f"{value:.4g}"))
        cell.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
    else:
        cell.setText(value)
    return cell
