"""The child process in which a surface is filled: it may take minutes, crash, or want all memory."""

from __future__ import annotations

import os
from dataclasses import dataclass
from multiprocessing.connection import Connection
from tempfile import TemporaryDirectory, gettempdir

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.engine.child import begin_child

ADDRESS_SPACE = 2**31
"""Bytes beyond the limit that code and libraries take up without using memory."""


@dataclass(frozen=True, eq=False)
class FillJob:
    """What the child is to do: lengths in units of the surface, `envelope` in diagonals, `memory_limit` in bytes, 0: none."""

    vertices: Floats
    triangles: Integers
    edge_length: float
    envelope: float
    memory_limit: int


def fill_main(connection: Connection) -> None:
    """Take a job, send back vertices and tetrahedra, or a sentence. More threads than one gain the mesher nothing."""
    begin_child(1)
    job: FillJob = connection.recv()
    _be_silent()
    _bound_memory(job.memory_limit)
    try:
        answer = _fill(job)
    except MemoryError:
        connection.send("The mesher ran out of memory; ask for longer edges.")
    except Exception as error:
        connection.send(f"The mesher failed ({type(error).__name__}: {error}); try another edge length.")
    else:
        connection.send(tuple(np.array(part) for part in answer))


def _fill(job: FillJob) -> tuple[Floats, Integers]:
    from pytetwild import tetrahedralize

    with TemporaryDirectory() as folder:  # the mesher leaves files of its own in the working directory
        os.chdir(folder)
        try:
            return tetrahedralize(
                np.array(job.vertices),
                job.triangles.astype(np.int32),
                edge_length_abs=job.edge_length,
                epsilon=job.envelope,
                num_threads=1,
            )
        finally:
            os.chdir(gettempdir())


def _be_silent() -> None:
    """What the mesher prints belongs into no report."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    for stream in (1, 2):
        os.dup2(nowhere, stream)


def _bound_memory(limit: int) -> None:
    if not limit:
        return
    try:
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (limit + ADDRESS_SPACE, resource.getrlimit(resource.RLIMIT_AS)[1]))
    except (ImportError, OSError, ValueError):
        pass  # this system bounds nothing
