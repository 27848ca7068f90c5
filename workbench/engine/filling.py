"""A closed surface filled with tetrahedra by a mesher in a child process, with limits of time and memory.

The mesher is fTetWild (Hu et al. 2020) as the package `pytetwild`, an optional extra under the MPL 2. It keeps
within a thin envelope about the surface and makes new triangles there; it draws random numbers, so that the same surface gives
another mesh of the same quality each time.
"""

from __future__ import annotations

import importlib.util
import math
import multiprocessing
import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from workbench.core.errors import MeshError, WorkbenchError
from workbench.core.fillable import check_fillable
from workbench.core.fixes import reorient
from workbench.core.mesh import Mesh
from workbench.engine.child import WithoutMainModule, exit_words
from workbench.engine.filling_child import FillJob, fill_main

MESHER = "pytetwild"
INSTALL = 'pip install ".[fill]" in a checkout of the program'
RELATIVE_EDGE = 1.0 / 20.0
"""Edge length where none is asked for, in diagonals of the bounding box."""
ENVELOPE = 1e-3
"""The boundary of the solid stays this near to the surface, in diagonals; less where edges are short."""
MOST_TETRAHEDRA = 3_000_000
TIME_LIMIT = 600.0
_LOOK = 0.1


class FillCancelledError(WorkbenchError):
    """Filling was cancelled; nothing came of it."""


@dataclass(frozen=True)
class FillOptions:
    """How a surface is filled.

    Parameters
    ----------
    edge_length : float     wanted, in units of the surface; 0: a twentieth of its diagonal
    time_limit : float      seconds
    memory_limit : int      bytes of the child's address space, where the system can bound it; 0: half of the machine's
    """

    edge_length: float = 0.0
    time_limit: float = TIME_LIMIT
    memory_limit: int = 0


def can_fill() -> bool:
    """Whether the mesher is installed."""
    return importlib.util.find_spec(MESHER) is not None


def fill_surface(
    surface: Mesh,
    options: FillOptions | None = None,
    *,
    cancelled: Callable[[], bool] = lambda: False,
    tell: Callable[[str], None] = lambda sentence: None,
) -> Mesh:
    """Tetrahedra that fill a closed surface, all positively oriented.

    Parameters
    ----------
    cancelled : () -> bool        looked at ten times a second
    tell : (sentence) -> None     progress, each second

    Raises `MeshError` for a surface that bounds no solid, `WorkbenchError` where the mesher is missing, fails or meets a limit,
    `FillCancelledError`. Blocks until done: a window calls it on a thread of its own.
    """
    options = options or FillOptions()
    if not can_fill():
        raise WorkbenchError(f"Filling needs the mesher {MESHER}, which is not installed; install it with: {INSTALL}")
    tell("Looking whether the surface is closed and free of self-intersections …")
    check_fillable(surface)
    edge_length = options.edge_length or RELATIVE_EDGE * surface.diameter
    _check_edge_length(surface, edge_length)
    job = FillJob(
        vertices=surface.vertices,
        triangles=surface.simplices,
        edge_length=edge_length,
        envelope=min(ENVELOPE, 0.02 * edge_length / surface.diameter),
        memory_limit=options.memory_limit or _half_of_memory(),
    )
    vertices, tetrahedra = _run(job, options, cancelled, tell)
    return _solid(vertices, tetrahedra, surface.name)


def _check_edge_length(surface: Mesh, edge_length: float) -> None:
    if not math.isfinite(edge_length) or edge_length <= 0.0 or edge_length > surface.diameter:
        raise WorkbenchError(
            f"An edge length of {edge_length:g} does not fit a surface of diagonal {surface.diameter:.6g}; "
            f"about {RELATIVE_EDGE * surface.diameter:.2g} is a good one."
        )
    corners = surface.vertices[surface.simplices]
    volume = abs(float(np.linalg.det(corners - surface.vertices.mean(axis=0)).sum())) / 6.0
    expected = volume / (edge_length**3 / (6.0 * math.sqrt(2.0)))
    if expected > MOST_TETRAHEDRA:
        raise WorkbenchError(
            f"With edges of length {edge_length:g} some {expected:.1e} tetrahedra would be made; ask for edges of at least "
            f"{edge_length * (expected / MOST_TETRAHEDRA) ** (1.0 / 3.0):.2g}."
        )


def _half_of_memory() -> int:
    try:
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 2
    except (AttributeError, OSError, ValueError):
        return 0


def _run(job: FillJob, options: FillOptions, cancelled: Callable[[], bool], tell: Callable[[str], None]) -> Any:
    """What the child sends: vertices and tetrahedra. The child is ended whatever happens."""
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe()
    process = context.Process(target=fill_main, args=(there,), name="workbench-fill", daemon=True)
    begin, told = time.monotonic(), 0.0
    try:
        with WithoutMainModule():
            process.start()
        there.close()
        here.send(job)
        while not here.poll(_LOOK):
            seconds = time.monotonic() - begin
            if cancelled():
                raise FillCancelledError("Filling was cancelled; nothing was changed.")
            if seconds > options.time_limit:
                raise WorkbenchError(
                    f"Filling took more than {options.time_limit:g} s and was ended; ask for longer edges, or allow more time."
                )
            if seconds - told >= 1.0:
                told = seconds
                tell(f"Filling with tetrahedra … {seconds:.0f} s")
        answer = here.recv()
    except (EOFError, BrokenPipeError, ConnectionResetError):
        process.join(timeout=5.0)
        raise WorkbenchError(
            f"The mesher ended before it was done ({exit_words(process.exitcode)}), perhaps for want of memory; "
            "ask for longer edges."
        ) from None
    finally:
        if process.pid is not None:
            process.kill()
            process.join()
        here.close()
    if isinstance(answer, str):
        raise WorkbenchError(answer)
    return answer


def _solid(vertices: np.ndarray, tetrahedra: np.ndarray, name: str) -> Mesh:
    if not len(tetrahedra):
        raise MeshError("The mesher found no inside: the surface may be turned inside out, or thinner than the edge length.")
    used, renumbered = np.unique(tetrahedra, return_inverse=True)
    mesh, _ = reorient(Mesh(vertices[used], renumbered.reshape(-1, 4), f"{name} (filled)"))
    if len(mesh.topology.degenerate):
        raise MeshError("The mesher left tetrahedra without volume; ask for another edge length.")
    return mesh
