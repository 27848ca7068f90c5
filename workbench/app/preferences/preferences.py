"""The preferences in force, and those that are kept."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from typing import Any

from PySide6.QtCore import QObject, Signal

from workbench.app.preferences.catalogue import BY_NAME
from workbench.app.settings import Settings
from workbench.core.errors import WorkbenchError

ELSEWHERE = {"theme": "theme", "time_line_megabytes": "time_line_memory"}
"""Attributes of the settings for what menus choose, too."""


class Preferences(QObject):
    """Values by name; `changed` names one that is another now. What is in force is kept only by `keep`.

    What a settings file holds beside that, or what does not fit, is passed over: the default stands.
    """

    changed = Signal(str)

    def __init__(self, settings: Settings, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._settings = settings
        self._values = {name: preference.default for name, preference in BY_NAME.items()}
        for name, value in {**settings.preferences(), **self._elsewhere()}.items():
            if name in BY_NAME:
                with suppress(WorkbenchError):
                    self._values[name] = BY_NAME[name].check(value)

    def _elsewhere(self) -> dict[str, Any]:
        """What menus choose, too."""
        return {name: getattr(self._settings, attribute) for name, attribute in ELSEWHERE.items()}

    def read_again(self) -> None:
        """Take up what was chosen in a menu meanwhile."""
        self.set_all(self._elsewhere())

    def __getitem__(self, name: str) -> Any:
        return self._values[name]

    @property
    def values(self) -> dict[str, Any]:
        return dict(self._values)

    def set(self, name: str, value: object) -> None:
        """Put a value in force. Raises `WorkbenchError` where it does not fit."""
        checked = BY_NAME[name].check(value)
        if checked != self._values[name]:
            self._values[name] = checked
            self.changed.emit(name)

    def set_all(self, values: dict[str, Any]) -> None:
        """Put these in force, such as those before a change."""
        for name, value in values.items():
            self.set(name, value)

    def restore_defaults(self, names: Iterable[str]) -> None:
        """Put the defaults of these in force."""
        self.set_all({name: BY_NAME[name].default for name in names})

    def keep(self) -> None:
        """Keep what is in force for the next start, but what is the default, which may become a better one."""
        others = {name: value for name, value in self._values.items() if name not in ELSEWHERE}
        self._settings.save_preferences({name: value for name, value in others.items() if value != BY_NAME[name].default})
        for name, attribute in ELSEWHERE.items():
            setattr(self._settings, attribute, self._values[name])
        self._settings.sync()
