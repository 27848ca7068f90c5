"""Commands that wait."""

from __future__ import annotations

from collections.abc import Hashable

from workbench.engine.messages import Command, Step


class CommandBox:
    """Commands that wait: of each slot the newest, in order of arrival; step counts add up."""

    def __init__(self) -> None:
        self._waiting: dict[Hashable, Command] = {}

    def put(self, command: Command) -> None:
        slot = command.slot
        earlier = self._waiting.pop(slot, None)
        if isinstance(command, Step) and isinstance(earlier, Step):
            command = Step(command.count + earlier.count)
        self._waiting[slot] = command

    def take_all(self) -> list[Command]:
        commands = list(self._waiting.values())
        self._waiting.clear()
        return commands

    def __bool__(self) -> bool:
        return bool(self._waiting)

    @property
    def interrupts(self) -> bool:
        """Whether something waits that a step gives way to."""
        return any(command.interrupts for command in self._waiting.values())
