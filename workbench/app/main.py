"""Opening the window."""

from __future__ import annotations

import gc
import os
import sys
from pathlib import Path
from typing import Any

# before anything imports qtpy, through pyvistaqt
os.environ.setdefault("QT_API", "pyside6")

FIRST = "sample:gingerbread"
"""What is open at first, where nothing is named."""


def run_window(
    source: str | None = None,
    *,
    theme: str = "",
    settings_file: str | Path | None = None,
    reset: bool = False,
    **unused: Any,
) -> int:
    """Open the window and return its exit status when it is closed.

    Parameters
    ----------
    source : str             file to open, or `sample:ID`; the first sample where there is none
    theme : str              system, light or dark; the user's last choice where it is empty
    settings_file : path     settings of its own instead of the user's
    reset : bool             forget layout, views and preferences first
    """
    from workbench.engine.head_start import begin_engine

    begun = begin_engine(gives_way=True, ahead=source or FIRST)  # it imports its own while this process does
    gc.disable()  # what is made now stays; `GuiGarbage` collects later
    application = make_application()
    from workbench.app.faults.guard import Guard

    guard = Guard()
    from workbench.app.appearance.theme import ThemeSwitch
    from workbench.app.document.engine_bridge import engine_worker
    from workbench.app.garbage import GuiGarbage
    from workbench.app.main_window import MainWindow
    from workbench.app.preferences.environment import set_environment
    from workbench.app.preferences.preferences import Preferences
    from workbench.app.settings import Settings

    settings = Settings(settings_file)
    if reset:
        settings.reset()
    preferences = Preferences(settings)
    if set_environment(preferences.values):  # the engine that has begun knows nothing of it
        begun.discard()
        begun = begin_engine(gives_way=True)
    if not source and preferences["start_with"] == "last":
        source = next(iter(settings.recent_files), None)
    switch = ThemeSwitch(application, theme if theme in ("light", "dark") else settings.theme)
    window = MainWindow(switch, settings, lambda wake: engine_worker(wake, begun))
    window.show()
    window.start(source or FIRST)
    window.autosave.start()
    guard.look_after(window)
    # the engine's thread shares the interpreter: it shall give the window its turn soon
    interval = sys.getswitchinterval()
    sys.setswitchinterval(0.001)
    garbage = GuiGarbage()
    try:
        return int(application.exec())
    finally:
        garbage.end()
        guard.end()
        sys.setswitchinterval(interval)


def make_application() -> Any:
    """The one QApplication, with the style that looks alike everywhere and knows light and dark."""
    from PySide6.QtWidgets import QApplication

    application = QApplication.instance()
    if application is None:
        application = QApplication(sys.argv[:1])
    assert isinstance(application, QApplication)
    application.setApplicationName("Distortion Workbench")
    application.setStyle("Fusion")
    return application
