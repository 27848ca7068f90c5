"""F1: the help at the chapter that belongs to what is in use."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent
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
    "SetUpDialog": "The first minute",
    "RaceWindow": "The first minute",
    "SignatureWindow": "The first minute",
    "QFileDialog": "Files",
    "LogDock": "Sessions",
}
"""Class of a widget -> the chapter about it."""
AT_FIRST = "The first minute"


class HelpDesk(QObject):
    """Opens the help, in one window that stays; in dialogs F1 does so, too."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self.help: HelpWindow | None = None
        QApplication.instance().installEventFilter(self)  # type: ignore[union-attr]

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
        """The window goes: keys are nobody's here any longer."""
        QApplication.instance().removeEventFilter(self)  # type: ignore[union-attr]
        if self.help is not None:
            self.help.close()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() != QEvent.Type.KeyPress or not isinstance(event, QKeyEvent) or event.key() != Qt.Key.Key_F1:
            return False
        active = QApplication.activeWindow()
        if not isinstance(active, QDialog) or active is self.help or not isinstance(watched, QWidget):
            return False  # in the main window F1 is an action's
        self.show(chapter_of(watched))
        return True


def chapter_of(widget: QWidget | None) -> str:
    """The chapter about a widget, or about the nearest one round it that has one."""
    while widget is not None:
        for kind in type(widget).__mro__:
            if kind.__name__ in CHAPTER_OF:
                return CHAPTER_OF[kind.__name__]
        widget = widget.parentWidget()
    return AT_FIRST
