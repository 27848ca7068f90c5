"""Ctrl+C as a wish, not an exception: the solver returns its last map."""

from __future__ import annotations

import signal
import threading
from types import FrameType, TracebackType


class InterruptFlag:
    """Within `with`, Ctrl+C sets the flag that a solver asks; pressed again it raises `KeyboardInterrupt` as ever."""

    def __init__(self) -> None:
        self._raised = False
        self._before: object = None

    def __call__(self) -> bool:
        return self._raised

    def __enter__(self) -> InterruptFlag:
        if threading.current_thread() is threading.main_thread():
            self._before = signal.signal(signal.SIGINT, self._receive)
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if self._before is not None:
            signal.signal(signal.SIGINT, self._before)  # type: ignore[arg-type]

    def _receive(self, number: int, frame: FrameType | None) -> None:
        if self._raised:
            raise KeyboardInterrupt
        self._raised = True
