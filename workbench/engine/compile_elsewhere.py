"""Kernels compiled where it stops nobody: compiling holds the interpreter for seconds."""

from __future__ import annotations

from collections.abc import Callable
from multiprocessing import get_context

from workbench.engine.child import WithoutMainModule
from workbench.engine.process import is_cached


def compile_elsewhere(kernel: object, use: Callable[[], None]) -> None:
    """Unless an earlier run has compiled `kernel`: call `use`, a function of a module, in a process of its own, and wait.

    What it compiles is read from numba's cache here when it is first called.
    """
    if not is_cached(kernel):
        process = get_context("spawn").Process(target=use, daemon=True)
        with WithoutMainModule():
            process.start()
        process.join()
