"""Earlier maps in the views: their colours are computed on a thread, while the solver may go on."""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject, Signal

from workbench.app.document.document import Document
from workbench.app.inspector.latest import Latest
from workbench.app.timeline.recorder import Recorder, anchors_of
from workbench.core.errors import WorkbenchError
from workbench.core.history_row import HistoryRow
from workbench.core.measure import Measure, SingularValues
from workbench.core.mesh import Mesh
from workbench.core.status import Status
from workbench.engine.messages import Snapshot, Watch
from workbench.session.moments import Moment

if TYPE_CHECKING:
    from workbench.core.jacobians import Elements

_numbers = count(-2, -1)
"""Of snapshots of the past: below all that the engine gives."""


class Measurer:
    """Measures maps of one mesh; for threads."""

    def __init__(self, mesh: Mesh) -> None:
        self.mesh = mesh
        self._elements: Elements | None = None

    def singular_values(self, moment: Moment) -> SingularValues:
        from workbench.core.jacobians import build_elements
        from workbench.core.surface_jacobians import singular_values_of_any

        if self._elements is None:
            self._elements = build_elements(self.mesh)
        return SingularValues(singular_values_of_any(self._elements, moment.positions))

    def snapshot(self, moment: Moment, watched: Watch, generation: int) -> Snapshot:
        """What a snapshot of the engine would have been at this moment, with what is watched now."""
        values = self.singular_values(moment)
        fields = {}
        for measure in watched.measures:
            try:
                fields[measure.id] = measured(measure, values)
            except WorkbenchError:
                continue  # a formula that is gone
        nan = float("nan")
        row = HistoryRow(moment.iteration, nan, moment.energy, nan, nan, nan, moment.inverted_count, nan)
        return Snapshot(
            generation,
            next(_numbers),
            moment.positions,
            "past",
            Status.RUNNING,
            row,
            moment.inverted,
            fields,
            solver=moment.solver,
            distortion=moment.distortion,
            singular_values=values.signed.astype(np.float32) if watched.singular_values else None,
        )


def measured(measure: Measure, values: SingularValues) -> np.ndarray:
    """(m,) float32, as the engine gives it. Raises `WorkbenchError` for what is no measure."""
    with np.errstate(all="ignore"):
        return measure.prepare(values.dimension)(values).astype(np.float32)


class LookingBack(QObject):
    """Which moment the views show; `changed` tells that it is another one, or the newest map again."""

    changed = Signal()
    failed = Signal(object)

    def __init__(self, document: Document, recorder: Recorder) -> None:
        super().__init__(document)
        self._document = document
        self._recorder = recorder
        self._measurer: Measurer | None = None
        self._shown_for: tuple[Moment, Watch] | None = None
        self.moment: Moment | None = None
        self._work = Latest(self)
        self._work.done.connect(self._take)
        self._work.failed.connect(self._fail)
        document.changing.connect(lambda *_: self.go_live())
        document.opened.connect(self._begin)
        document.snapshot_taken.connect(self._watch_again)

    @property
    def is_live(self) -> bool:
        return self.moment is None

    @property
    def index(self) -> int:
        """Place of what is shown in the record; that of the newest where it is live, -1 where there is nothing."""
        record = self._recorder.record
        return len(record) - 1 if self.moment is None else record.index_of(self.moment)

    def measurer(self) -> Measurer | None:
        """For the mesh that is open."""
        mesh = self._document.mesh
        if mesh is not None and (self._measurer is None or self._measurer.mesh is not mesh):
            self._measurer = Measurer(mesh)
        return self._measurer if mesh is not None else None

    def show(self, index: int) -> None:
        """Let the views show a moment of the record."""
        record = self._recorder.record
        if len(record):
            self.show_moment(record[min(max(index, 0), len(record) - 1)])

    def show_moment(self, moment: Moment) -> None:
        if moment is not self.moment:
            self.moment = moment
            self._ask()
            self.changed.emit()

    def go_live(self) -> None:
        """The newest map, as it comes."""
        if self.moment is not None:
            self.moment = self._shown_for = None
            self._document.look_back(None)
            self.changed.emit()

    def wait(self) -> None:
        self._work.wait()

    # ------------------------------------------------------------------------------------------ work

    def _ask(self) -> None:
        measurer, moment, loaded = self.measurer(), self.moment, self._document.loaded
        if measurer is None or moment is None or loaded is None:
            return
        watched, generation = self._document.watched, loaded.generation
        self._work.ask(lambda: (moment, watched, measurer.snapshot(moment, watched, generation)))

    def _take(self, found: tuple[Moment, Watch, Snapshot]) -> None:
        moment, watched, snapshot = found
        loaded = self._document.loaded
        if self.moment is None or loaded is None or snapshot.generation != loaded.generation:
            return  # live again, or another mesh; of two moments in quick turn the earlier one may be seen for a blink
        self._shown_for = (moment, watched)
        self._document.look_back(snapshot, anchors_of(moment))

    def _fail(self, error: Exception) -> None:
        self.go_live()
        self.failed.emit(error)

    def _watch_again(self) -> None:
        """What is watched may have changed: views want other colours of the same moment."""
        if self._shown_for is not None and self._shown_for[1] != self._document.watched:
            self._shown_for = (self._shown_for[0], self._document.watched)
            self._ask()

    def _begin(self) -> None:
        self.moment = self._shown_for = None
        self.changed.emit()
