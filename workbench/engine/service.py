"""What a child process does all its life: drain the pipe, carry out commands, take turns, rest; spawned, never forked."""

from __future__ import annotations

import os
from collections.abc import Callable
from multiprocessing.connection import Connection
from typing import Protocol

from workbench.engine.command_box import CommandBox
from workbench.engine.messages import Command


class Loop(Protocol):
    """What is served: `advance` is one turn, false where there was nothing to do."""

    has_quit: bool

    def handle(self, command: Command) -> None: ...
    def advance(self) -> bool: ...


class Inbox:
    """Commands that came through the pipe and wait."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._box = CommandBox()

    def drain(self) -> None:
        """Take over what is in the pipe. Raises `EOFError` where the other end is closed."""
        while self._connection.poll():
            self._box.put(self._connection.recv())

    def is_urgent(self) -> bool:
        """Whether a command waits that a step gives way to."""
        self.drain()
        return self._box.interrupts

    def serve(
        self, loop: Loop, begin: Callable[[], None], rest: Callable[[], None], end: Callable[[], None] = lambda: None
    ) -> None:
        """Body of a child process, which it ends: with `Quit`, or when the pipe breaks.

        `begin` is called first; `rest` where there is nothing to do, and returns when there may be; `end` last.
        """
        try:
            begin()
            while not loop.has_quit:
                self.drain()
                for command in self._box.take_all():
                    loop.handle(command)
                if not loop.advance() and not self._box:  # a step that fails may have drained a command first
                    rest()
        except (EOFError, BrokenPipeError, ConnectionResetError):
            pass
        finally:
            self._connection.close()
            end()
            os._exit(0)  # threads of a plugin or of BLAS shall not keep the process
