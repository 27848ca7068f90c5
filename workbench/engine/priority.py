"""Processes that give way: drawing and the hand come before solving where both want the same core."""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable
from typing import Any

NICENESS = 10


def run_child(gives_way: bool, body: Callable[..., None] | str, *arguments: Any) -> None:
    """Body of a child process, where `gives_way` at low priority, its later threads included.

    `body` may be `MODULE:NAME`: whoever begins the child need not have imported it.

    Without a graphics card the window's pictures are drawn by the processor; where the solver holds all cores a picture
    of 25 k triangles takes three times as long. Systems without priorities of this kind (Windows) leave it as it is.
    """
    if gives_way and hasattr(os, "nice"):
        os.nice(NICENESS)
    if isinstance(body, str):
        module, _, name = body.partition(":")
        body = getattr(importlib.import_module(module), name)
    body(*arguments)
