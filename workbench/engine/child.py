"""What child processes have in common: how they begin, and how their end is told."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading


def begin_child(threads: int) -> None:
    """First thing in a child: leave Ctrl+C to the window, end when the parent does; `threads` of the kernels, 0: default."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    from workbench.core.memory import keep_freed_memory
    from workbench.core.threads import set_thread_count

    keep_freed_memory()
    threading.Thread(target=_end_with_parent, daemon=True).start()
    if threads:
        set_thread_count(threads)


def _end_with_parent() -> None:
    """A step that hangs never sees that the pipe is broken; this does."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def exit_words(code: int | None) -> str:
    """How a process ended, by its exit code."""
    if code is None:
        return "no exit status"
    if code < 0:
        return "killed, perhaps out of memory" if code == -9 else f"signal {-code}"
    return f"exit status {code}"


class WithoutMainModule:
    """Spawn without importing the caller's main module again in the child: it may be a script that opens a window."""

    def __enter__(self) -> None:
        self._module = sys.modules["__main__"]
        self._saved = {key: getattr(self._module, key) for key in ("__file__", "__spec__") if hasattr(self._module, key)}
        for key in self._saved:
            setattr(self._module, key, None)

    def __exit__(self, *details: object) -> None:
        for key, value in self._saved.items():
            setattr(self._module, key, value)
