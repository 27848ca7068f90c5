"""Commands that wait."""

from __future__ import annotations

from workbench.engine.messages import Command, SetAnchors, Step


class CommandBox:
    """Commands that wait: of each class the newest, in order of arrival; step counts add up."""

    def __init__(self) -> None:
        self._waiting: dict[type[Command], Command] = {}

    def put(self, command: Command) -> None:
        kind = type(command)
        earlier = self._waiting.pop(kind, None)
        if isinstance(command, Step) and isinstance(earlier, Step):
            command = Step(command.count + earlier.count)
        self._waiting[kind] = command

    def take_all(self) -> list[Command]:
        commands = list(self._waiting.values())
        self._waiting.clear()
        return commands

    def __bool__(self) -> bool:
        return bool(self._waiting)

    @property
    def interrupts(self) -> bool:
        """Whether something waits that a step gives way to; anchors do not interrupt a step."""
        return any(kind is not SetAnchors for kind in self._waiting)
