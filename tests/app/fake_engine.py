"""A worker that answers at once, on the caller's thread, with a flat grid: the window's tests need no solver."""

from __future__ import annotations

import time
from collections.abc import Callable
from itertools import permutations

import numpy as np
from PySide6.QtCore import QCoreApplication

from workbench.core.mesh import Mesh
from workbench.core.status import Status
from workbench.engine.messages import (
    Command,
    Failure,
    HistoryRow,
    Load,
    Loaded,
    Pause,
    Ready,
    Refused,
    Report,
    Reset,
    Restarted,
    Run,
    SetAnchors,
    Snapshot,
    Step,
    TakeUp,
    Watch,
)


def grid_mesh(columns: int = 21, rows: int = 13) -> Mesh:
    """A flat grid of (columns - 1) (rows - 1) 2 triangles over [0, 2] x [0, 1]."""
    x, y = np.meshgrid(np.linspace(0, 2, columns), np.linspace(0, 1, rows))
    index = np.arange(columns * rows).reshape(rows, columns)
    a, b, c, d = index[:-1, :-1].ravel(), index[:-1, 1:].ravel(), index[1:, :-1].ravel(), index[1:, 1:].ravel()
    return Mesh(np.c_[x.ravel(), y.ravel()], np.concatenate([np.c_[a, b, d], np.c_[a, d, c]]), name="grid")


def bumpy_mesh(columns: int = 21, rows: int = 13) -> Mesh:
    """The same grid as a surface in space."""
    flat = grid_mesh(columns, rows)
    x, y = flat.vertices.T
    return Mesh(np.c_[x, y, 0.3 * np.sin(3 * x) * np.cos(2 * y)], flat.simplices, name="bumpy grid")


def solid_mesh(cells: tuple[int, int, int] = (6, 3, 3)) -> Mesh:
    """A box of cells, each of six tetrahedra round its diagonal."""
    x, y, z = np.meshgrid(*(np.arange(count + 1) for count in cells), indexing="ij")
    index = np.arange(x.size).reshape(x.shape)
    inner = [slice(0, count) for count in cells]

    def corner(step: tuple[int, ...]) -> np.ndarray:
        return index[tuple(slice(s.start + k, s.stop + k) for s, k in zip(inner, step, strict=True))].ravel()

    tets = []
    for order in permutations(range(3)):
        steps = np.zeros((4, 3), int)
        for row, axis in enumerate(order, 1):
            steps[row:, axis] = 1
        tet = [corner(tuple(step)) for step in steps.tolist()]
        is_even = np.linalg.det(steps[1:]) > 0
        tets.append(np.stack(tet if is_even else [tet[0], tet[2], tet[1], tet[3]], axis=1))
    return Mesh(np.c_[x.ravel(), y.ravel(), z.ravel()] / 3.0, np.concatenate(tets), name="solid")


def let_reports_arrive() -> None:
    """What a worker has told comes to the document; it is taken at most once in 12 ms."""
    for _ in range(2):
        QCoreApplication.processEvents()
        time.sleep(0.013)
    QCoreApplication.processEvents()


class FakeWorker:
    """Moves vertices towards anchors by a smooth blend; sources: grid, bumpy, closed, solid, raises."""

    def __init__(self, wake: Callable[[], None]) -> None:
        self._wake = wake
        self._reports: list[Report] = []
        self.commands: list[Command] = []
        self.is_closed = False
        self.stop_count = 0
        self._mesh: Mesh | None = None
        self._start = np.empty((0, 2))
        self._positions = np.empty((0, 2))
        self._generation = 0
        self._serial = 0
        self._iteration = 0
        self._number = 0
        self._running = False
        self._dragging = False
        self._watch = Watch()

    def start(self) -> None:
        self._tell(Ready(0.1))

    def post(self, command: Command) -> None:
        self.commands.append(command)
        if isinstance(command, Load):
            self._load(command)
        elif isinstance(command, Watch):
            self._watch = command
            if self._mesh is not None:
                self._publish(is_news=False)
        elif self._mesh is None:
            return
        elif isinstance(command, SetAnchors):
            self._serial, self._dragging = command.serial, command.dragging
            if len(command.vertices):
                self._blend(command)
            self._publish()
        elif isinstance(command, TakeUp):
            self._positions, self._serial, self._running = command.positions.copy(), command.anchors.serial, False
            self._dragging, self._iteration = False, command.iteration - 1  # it is told as it was, not stepped
            self._publish()
        elif isinstance(command, Reset):
            self._positions, self._iteration = self._start.copy(), 0
            self._publish()
        elif isinstance(command, Run | Step | Pause):
            self._running = isinstance(command, Run)
            self._publish()

    def take(self) -> list[Report]:
        taken, self._reports = self._reports, []
        return taken

    def stop(self) -> None:
        self.stop_count += 1
        self._running = False
        self._tell(Restarted("The engine was stopped and started again on the last good map."))

    def close(self) -> None:
        self.is_closed = True

    # ------------------------------------------------------------------------------------------

    def _tell(self, report: Report) -> None:
        self._reports.append(report)
        self._wake()

    def _load(self, command: Load) -> None:
        source = command.source
        if "closed" in source and "cut" not in command.fixes:
            self._tell(Refused(command.generation, "Load", "The surface is closed; cut it open.", ("cut",), ("1 component",)))
            return
        if "raises" in source:
            self._tell(Failure(command.generation, "The plugin raised ValueError.", "Traceback ..."))
            return
        cut = np.array([[0, 1], [1, 2]]) if "closed" in source else np.empty((0, 2), np.int64)
        mesh = grid_mesh() if "grid" in source else solid_mesh() if "solid" in source else bumpy_mesh()
        self._mesh, self._generation = mesh, command.generation
        self._start = mesh.vertices[:, : mesh.dimension].copy()
        self._positions, self._iteration, self._running = self._start.copy(), 0, False
        kind = "volume" if mesh.dimension == 3 else "plane" if mesh.vertices.shape[1] == 2 else "parameterize"
        lines = (f"{mesh.vertex_count} vertices, {mesh.simplex_count} {mesh.simplex_noun(2)}", "1 component")
        self._tell(Loaded(command.generation, mesh, kind, lines, cut, source, command.fixes))
        self._publish()

    def _blend(self, command: SetAnchors) -> None:
        """Inverse-distance blend of the anchors' displacements."""
        offset = command.targets - self._start[command.vertices]
        distance = np.linalg.norm(self._start[:, None] - self._start[command.vertices][None], axis=2)
        weights = 1.0 / (distance**2 + 1e-6)
        self._positions = self._start + (weights / weights.sum(axis=1, keepdims=True)) @ offset

    @staticmethod
    def _values_of(text: str, sigma: np.ndarray) -> np.ndarray:
        known = {
            "dirichlet": 2 * sigma**2,
            "condition-number": 1 + np.abs(sigma - 1),
            "symmetric-dirichlet": 2 * sigma**2 + 2 / np.maximum(sigma, 1e-3) ** 2,
            "det": sigma**2,
        }
        return known.get(text, sigma).astype(np.float32)

    def _publish(self, *, is_news: bool = True) -> None:
        assert self._mesh is not None
        self._number += is_news
        self._iteration += is_news
        area, rest = (_signed_measures(x[self._mesh.simplices]) for x in (self._positions, self._start))
        sigma = np.abs(area / rest) ** (1 / self._mesh.dimension)
        inverted = area <= 0
        energy = float((sigma**2 + 1 / np.maximum(sigma, 1e-3) ** 2).mean())
        seconds, norm = 0.01 * self._iteration, 1 / max(self._iteration, 1)
        row = HistoryRow(self._iteration, seconds, energy, energy, norm, 1.0, int(inverted.sum()), 0.0)
        phase = "dragging" if self._dragging and self._running else "running" if self._running else "idle"
        self._tell(
            Snapshot(
                self._generation,
                self._number,
                self._positions.copy(),
                phase,
                Status.RUNNING,
                row,
                inverted,
                {measure.id: self._values_of(measure.text, sigma) for measure in self._watch.measures},
                anchor_serial=self._serial,
                limiting_simplex=5 if self._dragging else -1,
                seconds_published=time.perf_counter(),
                rows=(row,) if is_news else (),
                singular_values=np.c_[(sigma,) * (self._mesh.dimension - 1) + (np.copysign(sigma, area),)].astype(np.float32)
                if self._watch.singular_values
                else None,
            )
        )


def _signed_measures(corners: np.ndarray) -> np.ndarray:
    """Determinants (m,) of the edges of simplices (m, d+1, d) from their first corners."""
    return np.linalg.det(corners[:, 1:] - corners[:, :1])
