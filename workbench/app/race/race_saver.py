"""Keeping what a race came to: its tables, and its curves as a figure."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QWidget

from workbench.app.background import Background
from workbench.app.files.file_choice import ask_folder
from workbench.app.race.race_model import RaceModel
from workbench.app.race.race_record import RaceRecord, relative_errors
from workbench.core.errors import WorkbenchError
from workbench.engine.race_messages import SaveTables, TablesSaved
from workbench.figures.convergence_curves import Curve, convergence_curves
from workbench.figures.save import FORMATS, save_figure


class RaceSaver(QObject):
    """Tables are written by the process of the race, the figure on a thread; `saved` says where they are."""

    saved = Signal(str)
    failed = Signal(str)

    def __init__(self, model: RaceModel, parent: QWidget) -> None:
        super().__init__(parent)
        self._model = model
        self._window = parent
        self._work: Background | None = None
        model.bridge.saved.connect(self._tables_saved)

    def ask(self) -> None:
        """Choose a folder."""
        ask_folder(self._window, "Folder for the tables and curves of the race", self.save)

    def save(self, folder: str) -> None:
        """Write table.csv and history.csv, then curves.svg, .pdf and .png, into a folder."""
        self._model.bridge.post(SaveTables(folder, self._model.mesh.name or "mesh"))

    def _tables_saved(self, report: TablesSaved) -> None:
        errors = relative_errors(self._model.records, self._model.mesh, self._model.total_measure)
        curves = [_curve(record, error.copy()) for record, error in zip(self._model.records, errors, strict=True)]
        folder = Path(report.folder)
        self._work = Background(lambda: _draw(curves, self._model.mesh.name, folder), self)
        self._work.finished.connect(lambda _: self.saved.emit(f"Tables and curves are in {folder}."))
        self._work.failed.connect(self._fail)
        self._work.start()

    def _fail(self, error: Exception) -> None:
        self.failed.emit(error.sentence if isinstance(error, WorkbenchError) else f"{type(error).__name__}: {error}")


def _curve(record: RaceRecord, errors) -> Curve:  # type: ignore[no-untyped-def]
    history, frame = record.history, record.frame
    names = ("iteration", "seconds", "energy", "gradient_norm", "inverted")
    return Curve(
        label=record.label,
        relative_error=errors,
        switches=tuple(marker.index for marker in frame.markers) if frame is not None else (),
        is_constant=record.entrant.map is not None,
        **{name: history.column(name).copy() for name in names},
    )


def _draw(curves: list[Curve], title: str, folder: Path) -> None:
    figure = convergence_curves(curves, title)
    for ending in FORMATS:
        save_figure(figure, folder / f"curves{ending}")
