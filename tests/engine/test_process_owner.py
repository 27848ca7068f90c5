"""What an owner gives back when its child ends, however it ends."""

from __future__ import annotations

import contextlib
import os
import signal
import time
from multiprocessing.connection import Connection
from multiprocessing.shared_memory import SharedMemory
from pathlib import Path
from typing import ClassVar

import pytest

from workbench.engine.messages import Ready
from workbench.engine.process_owner import ProcessOwner
from workbench.engine.shared_positions import PositionRing


class Owner(ProcessOwner):
    """Reads nothing; the test does all that its thread would."""

    name: ClassVar[str] = "sharing"
    trouble: ClassVar[str] = "{}"

    def __init__(self, notes: str) -> None:
        super().__init__(lambda: None)
        self._notes = notes

    def _spawn(self) -> None:
        self._begin_process(share, self._notes)

    def _turn(self) -> None:
        pass

    @property
    def _generation(self) -> int:
        return 0


def share(connection: Connection, notes: str) -> None:
    """Tell of two pieces of memory, as the engine and as a race do, and of something else; then wait for the end."""
    rings = [PositionRing((5, 2)), PositionRing((4, 3))]
    for message in ((rings[0].name, (5, 2)), Ready(0.1), (1, 0, rings[1].name, (4, 3))):
        connection.send(message)
    Path(notes).write_text(" ".join(ring.name for ring in rings))
    with contextlib.suppress(EOFError):
        connection.recv()


@pytest.mark.parametrize("how", ["quit", "kill", "killed"])
def test_memory_that_a_child_told_of_and_nobody_opened_is_given_back(how: str, tmp_path: Path) -> None:
    notes = tmp_path / "names"
    owner = Owner(str(notes))
    owner._spawn()
    until = time.monotonic() + 60.0
    while not notes.exists() or len(notes.read_text().split()) < 2:
        assert time.monotonic() < until
        time.sleep(0.02)
    for name in notes.read_text().split():
        SharedMemory(name).close()
    if how == "killed":
        os.kill(owner.process_id, signal.SIGKILL)  # type: ignore[arg-type]
    owner._end_process(kill=how == "kill")
    for name in notes.read_text().split():
        with pytest.raises(FileNotFoundError):
            SharedMemory(name)
