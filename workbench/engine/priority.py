"""Processes that give way: drawing and the hand come before solving where both want the same core."""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

NICENESS, LOWEST = 10, 19


def run_child(gives_way: bool, body: Callable[..., None] | str, *arguments: Any) -> None:
    """Body of a child process, where `gives_way` at low priority, its later threads included.

    `body` may be `MODULE:NAME`: whoever begins the child need not have imported it.

    Without a graphics card the window's pictures are drawn by the processor; where the solver holds all cores a picture
    of 25 k triangles takes three times as long. Systems without priorities of this kind (Windows) leave it as it is.
    """
    if gives_way:
        give_way()
    if isinstance(body, str):
        module, _, name = body.partition(":")
        getattr(importlib.import_module(module), name)(*arguments)
    else:
        body(*arguments)


def give_way() -> None:
    """Low priority for this process from now on, the threads that it has included."""
    tasks = Path("/proc/self/task")
    if tasks.is_dir():  # Linux: priorities belong to threads
        low = min(os.getpriority(os.PRIO_PROCESS, 0) + NICENESS, LOWEST)
        for task in tasks.iterdir():
            with suppress(OSError):  # it has ended meanwhile
                os.setpriority(os.PRIO_PROCESS, int(task.name), low)
    elif hasattr(os, "nice"):
        os.nice(NICENESS)
