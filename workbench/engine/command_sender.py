"""Commands on their way to the engine process, on a thread of their own: a pipe that is full holds up nobody else."""

from __future__ import annotations

import threading
from multiprocessing.connection import Connection

from workbench.engine.command_box import CommandBox
from workbench.engine.messages import Command


class CommandSender:
    """Sends commands to one child.

    A child that hangs does not read, and one that sends a large report reads only after it: whoever sent commands from the
    thread that also receives would wait for ever. Of what waits here, too, the newest of its kind wins.
    """

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._box = CommandBox()
        self._news = threading.Condition()
        self._is_closed = False
        threading.Thread(target=self._main, name="engine-commands", daemon=True).start()

    def send(self, commands: list[Command]) -> None:
        """Queue commands; returns at once."""
        with self._news:
            for command in commands:
                self._box.put(command)
            self._news.notify()

    def close(self) -> None:
        """Send nothing more; a thread that is stuck in a full pipe ends when the child does."""
        with self._news:
            self._is_closed = True
            self._news.notify()

    def _main(self) -> None:
        while True:
            with self._news:
                self._news.wait_for(lambda: self._box or self._is_closed)
                if self._is_closed:
                    return
                commands = self._box.take_all()
            try:
                for command in commands:
                    self._connection.send(command)
            except (OSError, ValueError):  # the child is dead, or its pipe closed; the worker sees that at its sentinel
                return
