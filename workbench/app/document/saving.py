"""Writing the map to a file, on a thread of its own."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from workbench.app.background import Backgrounds
from workbench.core.arrays import Floats, Integers
from workbench.core.errors import WorkbenchError
from workbench.engine.messages import Loaded, Snapshot
from workbench.session.session import Session

FILTERS = (
    "OBJ, vertex order and faces kept (*.obj);;NumPy case (*.npz);;VTK with fields (*.vtu);;MEDIT (*.mesh);;Gmsh (*.msh);;"
    "CSV of the measures (*.csv);;All files (*)"
)

SURFACE_FILTERS = (
    "OBJ, faces kept (*.obj);;NumPy, source and map (*.npz);;VTK with fields (*.vtu);;CSV of the measures (*.csv);;"
    "All files (*)"
)


@dataclass(frozen=True, eq=False)
class SaveRequest:
    """All that a file needs, taken at the moment of asking."""

    path: Path
    session: Session
    loaded: Loaded
    snapshot: Snapshot
    anchor_vertices: Integers
    anchor_targets: Floats


class Saver(QObject):
    """Reads the source again for what the window does not hold (the file's own faces), then writes; one file at a time."""

    saved = Signal(str)
    failed = Signal(str)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._works = Backgrounds(self)
        self._waiting: list[SaveRequest] = []

    def save(self, request: SaveRequest) -> None:
        """Write it when what was asked for before is written."""
        self._waiting.append(request)
        self._go_on()

    def wait(self) -> None:
        """Write all that was asked for, before the window ends."""
        self._works.wait()
        for request in self._waiting:
            with suppress(WorkbenchError, OSError):  # nobody is there any more to be told
                write(request)
        self._waiting.clear()

    def _go_on(self) -> None:
        if self._works or not self._waiting:
            return
        request = self._waiting.pop(0)
        path = str(request.path)

        def done(_: None) -> None:
            self.saved.emit(path)
            self._go_on()

        def fail(error: Exception) -> None:
            is_expected = isinstance(error, WorkbenchError)
            self.failed.emit(error.sentence if is_expected else f"The map could not be written to {path}: {error}.")
            self._go_on()

        self._works.start(lambda: write(request), done, fail)


def write(request: SaveRequest) -> None:
    """Write a map as the command line does. Raises `WorkbenchError`."""
    from workbench.core.distortion import Distortion
    from workbench.core.measure import Measure
    from workbench.io.opening import open_source
    from workbench.io.write import write_map

    loaded, session = request.loaded, request.session
    opened = open_source(session.source, kind=loaded.kind, fixes=session.fixes)
    if opened.mesh.vertex_count != loaded.mesh.vertex_count:
        raise WorkbenchError(f"{session.source} was changed since it was opened; open it again, or save as npz.")
    write_map(
        request.path,
        opened.file.mesh,
        opened.mesh,
        request.snapshot.positions,
        opened.kind,
        others=(Measure.of_distortion(Distortion.resolve(session.distortion, session.distortion_parameters)),),
        anchor_vertices=request.anchor_vertices,
        anchor_targets=request.anchor_targets,
    )
