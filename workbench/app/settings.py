"""What the window remembers from one use to the next."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from PySide6.QtCore import QByteArray, QSettings

RECENT_COUNT = 10
RECENT_FORMULAS = 20
RECENT_COMMANDS = 30
KEPT = ("recent", "sessions", "formulas", "folder")
"""What a reset leaves."""


class Settings:
    """Recent files, theme, layout and what views show. `path` names a file of its own, so that tests leave the user's alone."""

    def __init__(self, path: str | Path | None = None) -> None:
        self.recent_count = RECENT_COUNT
        """Files and sessions that are listed."""
        if path is None:
            self._store = QSettings(QSettings.Format.IniFormat, QSettings.Scope.UserScope, "distortion-workbench", "window")
        else:
            self._store = QSettings(str(path), QSettings.Format.IniFormat)

    @property
    def recent_files(self) -> list[str]:
        """Newest first; files that are gone are left out."""
        return self._files("recent")

    def remember_file(self, path: str) -> None:
        self._remember("recent", path)

    def forget_files(self) -> None:
        self._store.setValue("recent", [])

    @property
    def recent_sessions(self) -> list[str]:
        """Newest first; files that are gone are left out."""
        return self._files("sessions")

    def remember_session(self, path: str) -> None:
        self._remember("sessions", path)

    def _files(self, key: str) -> list[str]:
        return [path for path in self._texts(key) if _is_file(path)][: self.recent_count]

    def _remember(self, key: str, path: str) -> None:
        full = str(Path(path).resolve())
        others = [p for p in self._files(key) if p != full]
        self._store.setValue(key, [full, *others][: self.recent_count])

    @property
    def recent_formulas(self) -> list[str]:
        """Newest first."""
        return self._texts("formulas")

    def remember_formula(self, formula: str) -> None:
        self._put_first("formulas", formula, RECENT_FORMULAS)

    @property
    def recent_commands(self) -> list[str]:
        """Keys of what was done by the palette, newest first."""
        return self._texts("commands")

    def remember_command(self, key: str) -> None:
        self._put_first("commands", key, RECENT_COMMANDS)

    def _texts(self, key: str) -> list[str]:
        """A list of texts; what is none, in a file that something else has written, is passed over."""
        value: Any = self._store.value(key, [])
        values = value if isinstance(value, list | tuple) else [value]
        return [text for text in values if isinstance(text, str) and text]

    def _put_first(self, key: str, text: str, most: int) -> None:
        others = [other for other in self._texts(key) if other != text]
        self._store.setValue(key, [text, *others][:most])

    @property
    def theme(self) -> str:
        return str(self._store.value("theme", "system"))

    @theme.setter
    def theme(self, choice: str) -> None:
        self._store.setValue("theme", choice)

    @property
    def folder(self) -> str:
        """Folder of the last file that was opened or saved."""
        return str(self._store.value("folder", ""))

    @folder.setter
    def folder(self, path: str) -> None:
        self._store.setValue("folder", path)

    @property
    def time_line_memory(self) -> int:
        """Megabytes of maps that the time line keeps."""
        value = str(self._store.value("time-line-memory", ""))
        return min(max(int(value), 16), 2**16) if value.isascii() and value.isdigit() and len(value) < 9 else 256

    @time_line_memory.setter
    def time_line_memory(self, megabytes: int) -> None:
        self._store.setValue("time-line-memory", megabytes)

    def save_layout(self, geometry: QByteArray, state: QByteArray) -> None:
        self._store.setValue("geometry", geometry)
        self._store.setValue("state", state)

    def layout(self) -> tuple[QByteArray, QByteArray] | None:
        geometry, state = self._store.value("geometry"), self._store.value("state")
        if isinstance(geometry, QByteArray) and isinstance(state, QByteArray):
            return geometry, state
        return None

    def save_layouts(self, layouts: dict[str, str]) -> None:
        self._store.setValue("layouts", json.dumps(layouts))

    def layouts(self) -> dict[str, Any]:
        """Those of the user by name, as they stand in the file."""
        return self._table("layouts")

    def save_views(self, state: dict[str, Any]) -> None:
        self._store.setValue("views", json.dumps(state))

    def views(self) -> dict[str, Any]:
        """What views showed; empty where nothing was kept, or nothing that can be read."""
        return self._table("views")

    def save_preferences(self, values: dict[str, Any]) -> None:
        self._store.setValue("preferences", json.dumps(values))

    def preferences(self) -> dict[str, Any]:
        """What was chosen there, as it stands in the file; empty where nothing was."""
        return self._table("preferences")

    def save_film(self, choices: dict[str, Any]) -> None:
        self._store.setValue("film", json.dumps(choices))

    def film(self) -> dict[str, Any]:
        """Size, pace and looks of the last film; empty where there was none."""
        return self._table("film")

    def save_handling(self, customs: dict[str, Any]) -> None:
        self._store.setValue("handling", json.dumps(customs))

    def handling(self) -> dict[str, Any]:
        """How anchors go along with others; empty where nothing was kept, or nothing that can be read."""
        return self._table("handling")

    def _table(self, key: str) -> dict[str, Any]:
        try:
            found = json.loads(str(self._store.value(key, "{}")))
        except (ValueError, RecursionError):
            return {}
        return found if isinstance(found, dict) else {}

    def reset(self) -> None:
        """Forget what was chosen; what is open to be opened again, files, sessions and formulas, stays."""
        for key in self._store.allKeys():
            if key not in KEPT:
                self._store.remove(key)

    def sync(self) -> None:
        self._store.sync()


def _is_file(path: str) -> bool:
    try:
        return Path(path).is_file()
    except (OSError, ValueError):  # a name too long, a zero byte
        return False
