"""The dialog before a race: who takes part, on what, from where, how long."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor, QIcon
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QGroupBox,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QMenu,
    QPushButton,
    QSpinBox,
    QVBoxLayout,
    QWidget,
)

from workbench.app.background import Background
from workbench.app.files.file_choice import MAP_FILTERS, ask_files
from workbench.app.files.file_drops import FileDrops
from workbench.app.panels.method_form import MethodForm
from workbench.app.race.contestant_pane import FAILED, swatch_of
from workbench.app.race.draft import MOST, Draft, free_label, misfit, what_is_wrong
from workbench.core.arrays import Floats
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.mesh import Mesh
from workbench.core.registry import Registry
from workbench.engine.race import PRESETS
from workbench.engine.race_messages import Entrant

DOCUMENTS = ""
"""Data of the line that stands for the distortion of the document."""


@dataclass(frozen=True, eq=False)
class RaceChoice:
    """What the dialog comes to; `distortion` is empty for that of the document."""

    entrants: tuple[Entrant, ...]
    distortion: str
    from_map: bool
    iterations: int
    tolerance: float


@dataclass(frozen=True, eq=False)
class RaceGround:
    """What the document lays down: the source, and the distortion in force."""

    mesh: Mesh
    kind: str
    distortion: str
    parameters: Mapping[str, float]


class SetUpDialog(QDialog):
    """Contestants to the left, the one that is selected to the right; `chosen` carries a `RaceChoice`."""

    chosen = Signal(object)

    def __init__(self, ground: RaceGround, registry: Registry, drafts: list[Draft], parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("Race solvers")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.resize(760, 560)
        self._ground = ground
        self._registry = registry
        self.drafts = drafts
        self._readers: list[Background] = []
        self._refusals: list[str] = []
        self._make_list()
        self._make_details()
        self._make_terms()
        self.error = QLabel(self)
        self.error.setObjectName("form-error")
        self.error.setWordWrap(True)
        self.buttons = QDialogButtonBox(self)
        self.race_button = self.buttons.addButton("To the start", QDialogButtonBox.ButtonRole.AcceptRole)
        self.buttons.addButton(QDialogButtonBox.StandardButton.Cancel)
        self.buttons.accepted.connect(self._accept)
        self.buttons.rejected.connect(self.reject)
        columns = QHBoxLayout()
        columns.addWidget(self._list_group, 1)
        columns.addWidget(self._details, 1)
        layout = QVBoxLayout(self)
        layout.addLayout(columns, 1)
        layout.addWidget(self._terms)
        layout.addWidget(self.error)
        layout.addWidget(self.buttons)
        FileDrops(self, MAP_FILTERS, self.add_maps)
        if not drafts:
            for id in ("projected-newton", "aqp", "slim", "l-bfgs"):
                if id in registry.solvers and not misfit(registry.solvers[id], ground.kind, self.distortion):
                    self._append(Draft(registry.solvers[id].label, id))
        self._fill(0)

    # ------------------------------------------------------------------------------------------ making

    def _make_list(self) -> None:
        self._list_group = QGroupBox("Contestants", self)
        self.preset = QComboBox(self)
        self.preset.addItem("Choose a comparison…", "")
        for preset in PRESETS.values():
            self.preset.addItem(preset.label, preset.id)
        self.preset.activated.connect(lambda _: self._take_preset())
        self.list = QListWidget(self)
        self.list.currentRowChanged.connect(self._show_details)
        self.add_button = QPushButton("Add solver", self)
        self.menu = QMenu(self.add_button)
        self.menu.setToolTipsVisible(True)
        self.menu.aboutToShow.connect(self._fill_menu)
        self.add_button.setMenu(self.menu)
        self.map_button = QPushButton("Add maps…", self)
        self.map_button.setToolTip("Maps that something else has made: OBJ (texture coordinates, or positions) or npz")
        self.map_button.clicked.connect(self._ask_maps)
        self.remove_button = QPushButton("Remove", self)
        self.remove_button.clicked.connect(self._remove)
        row = QHBoxLayout()
        for button in (self.add_button, self.map_button, self.remove_button):
            button.setAutoDefault(False)
            row.addWidget(button)
        layout = QVBoxLayout(self._list_group)
        layout.addWidget(self.preset)
        layout.addWidget(self.list, 1)
        layout.addLayout(row)

    def _make_details(self) -> None:
        self._details = QGroupBox("Contestant", self)
        self.name = QLineEdit(self._details)
        self.name.textEdited.connect(self._rename)
        self.about = QLabel(self._details)
        self.about.setWordWrap(True)
        self.about.setObjectName("citation")
        self.form = MethodForm(self._details)
        self.form.changed.connect(self._take_values)
        layout = QVBoxLayout(self._details)
        line = QFormLayout()
        line.addRow("Name", self.name)
        layout.addLayout(line)
        layout.addWidget(self.about)
        layout.addWidget(self.form)
        layout.addStretch(1)

    def _make_terms(self) -> None:
        self._terms = QGroupBox("The same for all", self)
        self.distortion_box = QComboBox(self._terms)
        self.distortion_box.addItem(f"As in the document: {self._documents_label()}", DOCUMENTS)
        for item in sorted(self._registry.distortions.values(), key=lambda d: d.label.lower()):
            self.distortion_box.addItem(item.label, item.id)
        self.distortion_box.currentIndexChanged.connect(lambda _: self._fill(self.list.currentRow()))
        self.start_box = QComboBox(self._terms)
        self.start_box.addItem("The start of the document", False)
        self.start_box.addItem("The present map", True)
        self.iterations = QSpinBox(self._terms)
        self.iterations.setRange(1, 1_000_000)
        self.iterations.setValue(1000)
        self.tolerance = QLineEdit("1e-6", self._terms)
        self.tolerance.setToolTip("Relative decrease of the energy in a step below which a solver has converged")
        self.tolerance.textChanged.connect(lambda _: self._check())
        for box in (self.distortion_box, self.start_box):
            box.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
            box.setMinimumContentsLength(24)
        layout = QHBoxLayout(self._terms)
        for rows in (
            (("Distortion", self.distortion_box), ("Start", self.start_box)),
            (("Iterations at most", self.iterations), ("Tolerance", self.tolerance)),
        ):
            form = QFormLayout()
            for text, widget in rows:
                form.addRow(text, widget)
            layout.addLayout(form, 3 if len(text) == 5 else 2)

    def _documents_label(self) -> str:
        item = self._registry.distortions.get(self._ground.distortion)
        return item.label if item is not None else self._ground.distortion

    # ------------------------------------------------------------------------------------------ contestants

    @property
    def distortion(self) -> Distortion | None:
        """What all minimise; None where the document's text is none now."""
        id = str(self.distortion_box.currentData())
        try:
            return Distortion.resolve(id or self._ground.distortion, {} if id else self._ground.parameters)
        except WorkbenchError:
            return None

    def _append(self, draft: Draft) -> None:
        draft.label = free_label(draft.label, (other.label for other in self.drafts))
        self.drafts.append(draft)

    def add_solver(self, id: str) -> None:
        """One more, with its default parameters."""
        self._append(Draft(self._registry.solvers[id].label, id))
        self._fill(len(self.drafts) - 1)

    def _fill_menu(self) -> None:
        """All solvers; those that cannot take part are grey, and say why."""
        self.menu.clear()
        for id, solver in sorted(self._registry.solvers.items(), key=lambda pair: pair[1].label.lower()):
            reason = misfit(solver, self._ground.kind, self.distortion)
            action = self.menu.addAction(solver.label)
            action.setEnabled(not reason and len(self.drafts) < MOST)
            action.setToolTip(reason or " ".join((solver.__doc__ or "").split("\n\n")[0].split()))
            action.triggered.connect(lambda _=False, i=id: self.add_solver(i))

    def take_preset(self, id: str) -> None:
        """Choose a comparison of the list."""
        self.preset.setCurrentIndex(self.preset.findData(id))
        self._take_preset()

    def _take_preset(self) -> None:
        preset = PRESETS.get(str(self.preset.currentData()))
        if preset is None:
            return
        self.drafts[:] = [Draft(c.label, c.solver, _checked(self._registry, c.solver, c.values)) for c in preset.choices]
        needs = preset.distortion if preset.distortion != self._ground.distortion else ""
        self.distortion_box.setCurrentIndex(self.distortion_box.findData(needs or DOCUMENTS))
        self._fill(0)

    def _remove(self) -> None:
        row = self.list.currentRow()
        if 0 <= row < len(self.drafts):
            del self.drafts[row]
            self._fill(min(row, len(self.drafts) - 1))

    def _ask_maps(self) -> None:
        ask_files(self, "Maps of this source", MAP_FILTERS, self.add_maps)

    def add_maps(self, paths: list[str]) -> None:
        """Read maps on a thread; each becomes a contestant."""
        self._refusals.clear()
        for path in paths:
            reader = Background(lambda p=path: _read_map(p, self._ground), self)  # type: ignore[misc]
            reader.finished.connect(lambda positions, p=path: self._add_map(p, positions))
            reader.failed.connect(self._show_failure)
            self._readers.append(reader)
            reader.start()

    def _add_map(self, path: str, positions: Floats) -> None:
        self._append(Draft(Path(path).stem, map=positions, origin=path))
        self._fill(len(self.drafts) - 1)
        self.error.setText("\n".join(filter(None, (*self._refusals, self.error.text()))))

    def _show_failure(self, error: Exception) -> None:
        """Below what other files have already been refused for."""
        sentence = error.sentence if isinstance(error, WorkbenchError) else f"{type(error).__name__}: {error}"
        self._refusals.append(sentence)
        self.error.setText("\n".join(self._refusals))

    # ------------------------------------------------------------------------------------------ showing

    def _fill(self, row: int) -> None:
        """List the contestants as they are now, and select one."""
        distortion = self.distortion
        self.list.blockSignals(True)
        self.list.clear()
        for index, draft in enumerate(self.drafts):
            swatch = swatch_of(index)
            icon = QIcon(swatch)
            icon.addPixmap(swatch, QIcon.Mode.Selected)  # else it is tinted away
            item = QListWidgetItem(icon, draft.label)
            reason = misfit(self._registry.solvers[draft.solver], self._ground.kind, distortion) if draft.solver else ""
            if reason:
                item.setForeground(QColor(FAILED))
            item.setToolTip(reason or draft.origin)
            self.list.addItem(item)
        self.list.blockSignals(False)
        self.list.setCurrentRow(max(row, 0))
        self._show_details(self.list.currentRow())
        self._check()

    def _show_details(self, row: int) -> None:
        is_one = 0 <= row < len(self.drafts)
        self._details.setEnabled(is_one)
        draft = self.drafts[row] if is_one else Draft("")
        solver = self._registry.solvers.get(draft.solver)
        if self.name.text() != draft.label:
            self.name.setText(draft.label)
        self.about.setText(" · ".join(filter(None, (solver.label, solver.citation))) if solver is not None else draft.origin)
        self.form.show_parameters(solver.parameters() if solver is not None else (), draft.parameters)

    def _rename(self, text: str) -> None:
        row = self.list.currentRow()
        self.drafts[row].label = text
        self.list.item(row).setText(text)
        self._check()

    def _take_values(self, values: dict[str, Any]) -> None:
        self.drafts[self.list.currentRow()].parameters = dict(values)

    def _check(self) -> None:
        sentence = what_is_wrong(self.drafts, self._registry, self._ground.kind, self.distortion)
        if not sentence and self._tolerance() is None:
            sentence = "The tolerance is a number, 0 or above."
        self.error.setText(sentence)
        self.race_button.setEnabled(not sentence)
        self.add_button.setEnabled(len(self.drafts) < MOST)
        self.map_button.setEnabled(len(self.drafts) < MOST)

    def _tolerance(self) -> float | None:
        try:
            value = float(self.tolerance.text())
        except ValueError:
            return None
        return value if 0.0 <= value < 1.0 else None

    def _accept(self) -> None:
        tolerance = self._tolerance()
        assert tolerance is not None
        self.chosen.emit(
            RaceChoice(
                tuple(draft.entrant() for draft in self.drafts),
                str(self.distortion_box.currentData()),
                bool(self.start_box.currentData()),
                self.iterations.value(),
                tolerance,
            )
        )
        self.accept()

    def done(self, result: int) -> None:
        """Let readers end before the dialog does."""
        for reader in self._readers:
            reader.wait()
        super().done(result)


def _checked(registry: Registry, solver: str, values: Mapping[str, str]) -> dict[str, Any]:
    """Values in words as values of the parameters' types."""
    form = {item.name: item for item in registry.solvers[solver].parameters()}
    return {name: form[name].check(value) for name, value in values.items()}


def _read_map(path: str, ground: RaceGround) -> Floats:
    from workbench.engine.starts import adjusted_start
    from workbench.io.start_file import map_from_file

    kind: Any = ground.kind
    return adjusted_start(ground.mesh, kind, map_from_file(path, ground.mesh, kind), False)
