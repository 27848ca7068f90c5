"""What the window tells becomes records of its logger; what loggers tell is listed in the Log panel."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt

from workbench.app.notices.log_bridge import DETAILS, LogBridge
from workbench.app.notices.log_dock import LogDock
from workbench.app.notices.notice_list import NoticeList
from workbench.engine.log_file import log_path
from workbench.engine.messages import LogLine

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

logger = logging.getLogger("workbench.window")


class Noticing(QObject):
    """Owns the list and its panel."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self.notices = NoticeList(window.theme, self)
        self.dock = LogDock(self.notices, log_path(), window)
        self._bridge = LogBridge(self)
        self._bridge.told.connect(self.notices.add)
        self._bridge.install()
        window.error_bar.told.connect(tell_logger)
        window.undoing.changed.connect(lambda: window.error_bar.pass_by())
        window.actions_by_name["unbrush"].triggered.connect(lambda _=False: window.error_bar.pass_by(0.0))
        window.status.said.connect(logger.debug)
        window.bridge.log_line.connect(self._engine_told)
        window.theme_switch.changed.connect(self.notices.set_theme)
        self.dock.failed.connect(lambda sentence: window.error_bar.show_message(sentence))
        self.dock.saved.connect(lambda path: window.status.say(f"Saved {path}."))
        window.addDockWidget(Qt.DockWidgetArea.BottomDockWidgetArea, self.dock)
        window.tabifyDockWidget(window.convergence, self.dock)
        self.dock.hide()

    def show(self) -> None:
        """Bring the panel up."""
        self.dock.bring_up()

    def close(self) -> None:
        """Loggers tell nobody here any longer."""
        self._bridge.remove()

    def _engine_told(self, line: LogLine) -> None:
        logging.getLogger(f"engine.{line.name}").log(line.level, "%s", line.text, extra={DETAILS: line.details})


def tell_logger(level: int, sentence: str, details: str) -> None:
    """What a bar shows, as a record of the window's logger."""
    logger.log(level, "%s", sentence, extra={DETAILS: details})
