"""F1: the help at the chapter that belongs to what is in use."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QApplication, QDialog, QWidget

if TYPE_CHECKING:
    from workbench.app.help.help_window import HelpWindow
    from workbench.app.main_window import MainWindow

CHAPTER_OF = {
    "FigureDialog": "Figures",
    "FillDialog": "Without a screen",
    "RefineDialog": "Without a screen",
    "UndoDock": "Sessions",
    "InspectorDock": "Write a distortion",
    "FormulaEdit": "Write a distortion",
    "DistortionBox": "Write a distortion",
    "SetUpDialog": "The window, part by part",
    "RaceWindow": "The window, part by part",
    "SignatureWindow": "The window, part by part",
    "QFileDialog": "Files",
    "LogDock": "Sessions",
}
"""Class of a widget -> the chapter about it."""
AT_FIRST = "The first minute"
SERVED = "has-help-key"


class HelpDesk(QObject):
    """Opens the help, in one window that stays; in dialogs F1 does so, too."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self.help: HelpWindow | None = None
        application = QApplication.instance()
        assert isinstance(application, QApplication)
        self._application = application
        application.focusChanged.connect(self._serve)

    def show(self, chapter: str = "") -> None:
        """Open the help at a chapter; at that of the widget in use where none is named."""
        from workbench.app.help.help_window import HelpWindow  # late: the first frame needs none

        if self.help is None:
            self.help = HelpWindow(self._window.theme, self._window)
            self._window.theme_switch.changed.connect(self.help.set_theme)
        self.help.show_chapter(chapter or chapter_of(QApplication.focusWidget()))
        self.help.show()
        self.help.raise_()
        self.help.activateWindow()

    def close(self) -> None:
        """The window goes."""
        self._application.focusChanged.disconnect(self._serve)
        if self.help is not None:
            self.help.close()

    def _serve(self, _: QWidget | None, now: QWidget | None) -> None:
        """Give a dialog that comes to the front the key; in the main window it is an action's."""
        dialog = now.window() if now is not None else None
        if isinstance(dialog, QDialog) and dialog is not self.help and not dialog.property(SERVED):
            dialog.setProperty(SERVED, True)
            QShortcut(QKeySequence.StandardKey.HelpContents, dialog).activated.connect(self.show)


def chapter_of(widget: QWidget | None) -> str:
    """The chapter about a widget, or about the nearest one round it that has one."""
    while widget is not None:
        for kind in type(widget).__mro__:
            if kind.__name__ in CHAPTER_OF:
                return CHAPTER_OF[kind.__name__]
        widget = widget.parentWidget()
    return AT_FIRST
