"""The engine process, begun before the program has imported what it needs to talk to it."""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from typing import Any

from workbench.engine.child import WithoutMainModule
from workbench.engine.priority import run_child

ENGINE = "workbench.engine.process:engine_main"
NAME = "workbench-engine"


@dataclass(frozen=True)
class BegunEngine:
    """A process that imports and compiles while its owner is still being made; `corrector` is the end for its helper."""

    process: Any
    connection: Connection
    corrector: Connection
    at: float
    """`time.monotonic` when it was begun."""

    def discard(self) -> None:
        """End it: another one is wanted in its place."""
        self.process.kill()
        self.process.join(timeout=5.0)
        for end in (self.connection, self.corrector):
            end.close()


def begin_child_process(name: str, gives_way: bool, body: Callable[..., None] | str, *arguments: Any) -> tuple[Any, Connection]:
    """A spawned process that runs `body(connection, *arguments)` (see `run_child`), and our end of the connection."""
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe(duplex=True)
    process = context.Process(target=run_child, args=(gives_way, body, theirs, *arguments), name=name, daemon=True)
    with WithoutMainModule():
        process.start()
    theirs.close()
    return process, ours


def begin_engine(*, threads: int = 0, gives_way: bool = False, ahead: str = "") -> BegunEngine:
    """Spawn the engine; see `EngineWorker` for the arguments, `engine_main` for `ahead`.

    One that gives way does so from its first map on: until then the window has nothing to draw.
    """
    engines, correctors = multiprocessing.get_context("spawn").Pipe(duplex=True)
    arguments = engines, time.time(), threads, gives_way, ahead
    process, connection = begin_child_process(NAME, False, ENGINE, *arguments)
    engines.close()
    return BegunEngine(process, connection, correctors, time.monotonic())
