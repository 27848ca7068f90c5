"""A worker of races on the caller's own thread: the real loop without a process, a few turns at a time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from workbench.core.jacobians import build_elements
from workbench.engine.live import LiveColours
from workbench.engine.messages import Command, Report, Run, Watch
from workbench.engine.race_loop import RaceLoop
from workbench.engine.race_messages import RaceEnded, RaceFrame, StartRace, Switch


class InlineRaceWorker:
    """Carries every command out at once; `Run`, and a switch while it holds, go on until nobody has a step to take."""

    def __init__(self, wake: Callable[[], None]) -> None:
        self._wake = wake
        self._reports: list[Report] = []
        self.commands: list[Command] = []
        self.is_closed = False
        self._loop = RaceLoop(self._publish)
        self._watch = Watch()
        self._colours: LiveColours | None = None

    def start(self) -> None:
        pass

    def post(self, command: Command) -> None:
        self.commands.append(command)
        if isinstance(command, Watch):
            self._watch = command
        if isinstance(command, StartRace):
            self._colours = LiveColours(build_elements(command.mesh))
        if self._colours is not None:
            self._colours.watch(self._watch.measures, False)
        self._loop.handle(command)
        while self._loop.advance() and isinstance(command, Run | Switch):
            pass

    def take(self) -> list[Report]:
        taken, self._reports = self._reports, []
        return taken

    def stop(self) -> None:
        self._publish(RaceEnded("The race was stopped."))

    def close(self) -> None:
        self.is_closed = True

    def _publish(self, report: Report) -> None:
        if isinstance(report, RaceFrame) and report.positions is not None:
            assert self._colours is not None
            live = self._colours.of(report.positions, inverted=report.inverted_count, moving=False)
            report = replace(report, fields=live.fields, inverted=live.inverted)
        self._reports.append(report)
        self._wake()
