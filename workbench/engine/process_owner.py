"""A background thread that owns a child process: the window posts commands and takes reports, and never waits."""

from __future__ import annotations

import contextlib
import multiprocessing
import threading
import traceback
from abc import ABC, abstractmethod
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Any, ClassVar

from workbench.engine.command_box import CommandBox
from workbench.engine.command_sender import CommandSender
from workbench.engine.head_start import begin_child_process
from workbench.engine.messages import Command, Failure, Quit, Report
from workbench.engine.shared_positions import PositionRing

QUIT_PATIENCE = 0.5
"""Seconds that a child has to leave by itself when its owner is closed."""


class ProcessOwner(ABC):
    """What owners of child processes have in common: thread, bell, boxes, spawning and ending; subclasses say what for."""

    name: ClassVar[str]
    """Of the child process."""
    trouble: ClassVar[str]
    """Sentence for a fault of the owner itself, with a place for the error."""

    def __init__(self, wake: Callable[[], None], *, threads: int = 0, gives_way: bool = False) -> None:
        """`wake` is called on the owner's thread when reports wait.

        `threads` is the kernels' thread count in the child, 0 for its default; `gives_way` runs the child at low priority,
        for a window that draws beside it.
        """
        self._wake = wake
        self._threads = threads
        self._gives_way = gives_way
        self._lock = threading.Lock()
        self._outbox = CommandBox()
        self._reports: list[Report] = []
        self._bell, self._rope = multiprocessing.Pipe(duplex=False)
        self._stop_asked = False
        self._closing = False
        self._thread = threading.Thread(target=self._main, name=f"{self.name}-owner", daemon=True)
        # What the thread alone touches:
        self._process: Any = None
        self._connection: Connection | None = None
        self._sender: CommandSender | None = None

    # ------------------------------------------------------------------------- called by the window's thread

    def start(self) -> None:
        """Spawn the child process and the thread that owns it."""
        self._thread.start()

    def post(self, command: Command) -> None:
        """Queue a command; returns at once. Newest of its slot wins."""
        with self._lock:
            self._outbox.put(command)
        self._ring_bell()

    def close(self) -> None:
        """Quit the child and join the thread."""
        if self._closing:
            return
        self._closing = True
        self._ring_bell()
        if self._thread.ident is not None:
            self._thread.join(timeout=10.0)

    @property
    def process_id(self) -> int | None:
        """Of the child process, None while there is none."""
        process = self._process
        return process.pid if process is not None and process.is_alive() else None

    def _ring_bell(self) -> None:
        with contextlib.suppress(OSError):
            self._rope.send_bytes(b"!")

    # ----------------------------------------------------------------------------------- the thread's own

    @abstractmethod
    def _spawn(self) -> None:
        """Begin a child."""

    @abstractmethod
    def _turn(self) -> None:
        """Wait for the bell or the child, and do what there is to do."""

    @property
    @abstractmethod
    def _generation(self) -> int:
        """What failures belong to."""

    def _main(self) -> None:
        try:
            self._spawn()
            while not self._closing:
                self._turn()
        except Exception as error:
            self._report(Failure(self._generation, self.trouble.format(error), traceback.format_exc()))
        finally:
            self._end_process()

    def _report(self, report: Report) -> None:
        with self._lock:
            self._reports.append(report)
        self._wake()

    def _send(self, *commands: Command) -> None:
        assert self._sender is not None
        self._sender.send(list(commands))

    # ---------------------------------------------------------------------------------------- the child

    def _begin_process(self, body: Callable[..., None], *arguments: Any) -> None:
        """Spawn a child that runs `body(connection, *arguments)`."""
        self._adopt(*begin_child_process(self.name, self._gives_way, body, *arguments))

    def _adopt(self, process: Any, connection: Connection) -> None:
        """Own a child that was begun."""
        self._process, self._connection = process, connection
        self._sender = CommandSender(connection)

    def _end_process(self, *, kill: bool = False) -> None:
        process, self._process = self._process, None
        if process is None:
            return
        if not kill:
            self._send(Quit())
            process.join(timeout=QUIT_PATIENCE)
        if self._sender is not None:
            self._sender.close()
            self._sender = None
        if process.is_alive():
            process.kill()
        process.join(timeout=5.0)
        process.close()
        if self._connection is not None:
            _free_unread(self._connection)
            self._connection.close()


def _free_unread(connection: Connection) -> None:
    """Give back the memory for maps that a child that has ended told of last, and nobody has opened."""
    with contextlib.suppress(EOFError, OSError):
        while connection.poll():
            message = connection.recv()
            if isinstance(message, tuple):  # as all that tell of memory, it ends with name and shape
                ring = PositionRing(message[-1], message[-2])
                ring.unlink()
                ring.close()
