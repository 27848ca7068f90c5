"""All that watches over the program while its window is open: log file, hooks, and the watch for hard faults."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING

from workbench.app.faults.fault_hooks import FaultHooks
from workbench.engine.log_file import FaultWatch, open_log

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow


class Guard:
    """Begun before the window is made; tells of what the last one left when it is there."""

    def __init__(self) -> None:
        self._file = open_log()
        if self._file is not None:
            logging.getLogger().addHandler(self._file)
        self._watch = FaultWatch()
        self._left = self._watch.begin()
        self._hooks = FaultHooks()
        self._hooks.install()

    def look_after(self, window: MainWindow) -> None:
        """Show faults in this window from now on."""
        self._hooks.raised.connect(window.faults.take)
        if self._left:
            logging.getLogger("workbench.fault").error("The program was ended by a fault last time.\n%s", self._left)
            window.faults.tell_of_last_time(self._left)

    def end(self) -> None:
        """The program ends by itself."""
        self._hooks.remove()
        self._watch.end()
        if self._file is not None:
            logging.getLogger().removeHandler(self._file)
            self._file.close()
