"""How long the solver may go on: until paused, for so many steps, iterations or seconds."""

from __future__ import annotations

from workbench.core.status import Status
from workbench.engine.messages import Run


class RunBudget:
    """What was asked for by `Run` and `Step`, and what of it is used up."""

    def __init__(self) -> None:
        self.limits = Run()
        self.is_running = False
        self._steps_left = 0
        self._iterations = 0
        self._begin = 0.0

    @property
    def wants_more(self) -> bool:
        return self.is_running or self._steps_left > 0

    def run(self, limits: Run) -> None:
        self.limits, self.is_running, self._steps_left = limits, True, 0

    def step(self, count: int) -> None:
        self.is_running, self._steps_left = False, self._steps_left + count

    def rest(self) -> None:
        self.is_running, self._steps_left = False, 0

    def begin(self, seconds: float) -> None:
        """Count iterations and seconds from here on; `seconds` is the clock of the solver."""
        self._iterations, self._begin = 0, seconds

    def count(self) -> None:
        """One more iteration is made."""
        self._iterations += 1
        if self._steps_left:
            self._steps_left -= 1

    def status(self, status: Status, seconds: float) -> Status:
        """What the solver said, or the limit that is reached; single steps end where the solver does."""
        if status is Status.RUNNING and self.is_running:
            if self._iterations >= self.limits.iterations:
                status = Status.MAX_ITERATIONS
            elif seconds - self._begin >= self.limits.time_limit:
                status = Status.TIME_LIMIT
        if status is not Status.RUNNING:
            self._steps_left = 0
        return status
