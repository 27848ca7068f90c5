"""Colours of the window, light and dark, and who decides between them."""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtGui import QColor, QPalette
from PySide6.QtWidgets import QApplication

Colour = tuple[float, float, float]

INVERTED = (1.0, 0.83, 0.0)
INVERTED_OUTLINE = (0.10, 0.10, 0.10)
CUT = (0.10, 0.65, 0.25)
BRUSH = (0.0, 0.86, 0.92)
BRUSH_CASING = (0.02, 0.10, 0.14)
ANCHOR = QColor("#1f6feb")
ANCHOR_SELECTED = QColor("#ff8c1a")
ANCHOR_RIM = QColor("#000000")
LIMITING = QColor("#d6249f")


@dataclass(frozen=True)
class Theme:
    """Colours of one appearance; triples are RGB in [0, 1] for VTK, strings are for Qt."""

    name: str
    is_dark: bool
    view: str
    fill: Colour
    edges: Colour
    window: str
    base: str
    text: str
    faint: str
    accent: str
    border: str
    warning: str
    warning_text: str
    curves: tuple[str, str, str]


LIGHT = Theme(
    name="light",
    is_dark=False,
    view="#ffffff",
    fill=(0.86, 0.90, 0.94),
    edges=(0.52, 0.58, 0.65),
    window="#f3f4f6",
    base="#ffffff",
    text="#1c2127",
    faint="#5d6772",
    accent="#1f6feb",
    border="#cfd4da",
    warning="#fff1cc",
    warning_text="#4a3500",
    curves=("#1f6feb", "#b45309", "#b91c1c"),
)
DARK = Theme(
    name="dark",
    is_dark=True,
    view="#15181c",
    fill=(0.27, 0.32, 0.37),
    edges=(0.50, 0.56, 0.62),
    window="#22262b",
    base="#1a1d21",
    text="#e6e9ec",
    faint="#a0a9b3",
    accent="#4c93ff",
    border="#3b424a",
    warning="#4a3b12",
    warning_text="#ffe9b0",
    curves=("#5aa2ff", "#f0a04b", "#ff6b6b"),
)


def palette_of(theme: Theme) -> QPalette:
    """Qt palette of a theme, for the Fusion style."""
    palette = QPalette()
    window, base, text = QColor(theme.window), QColor(theme.base), QColor(theme.text)
    faint, accent = QColor(theme.faint), QColor(theme.accent)
    role = QPalette.ColorRole
    for where, colour in (
        (role.Window, window),
        (role.WindowText, text),
        (role.Base, base),
        (role.AlternateBase, window),
        (role.Text, text),
        (role.Button, window),
        (role.ButtonText, text),
        (role.BrightText, QColor("#ffffff")),
        (role.ToolTipBase, base),
        (role.ToolTipText, text),
        (role.PlaceholderText, faint),
        (role.Highlight, accent),
        (role.HighlightedText, QColor("#ffffff")),
        (role.Link, accent),
        (role.Light, window.lighter(115)),
        (role.Midlight, QColor(theme.border)),
        (role.Mid, QColor(theme.border)),
        (role.Dark, QColor(theme.border).darker(130)),
        (role.Shadow, QColor("#000000")),
    ):
        palette.setColor(where, colour)
    for where in (role.WindowText, role.Text, role.ButtonText, role.HighlightedText):
        palette.setColor(QPalette.ColorGroup.Disabled, where, QColor(theme.faint).darker(110))
    return palette


class ThemeSwitch(QObject):
    """The theme in use: `system` follows the desktop while it changes, `light` and `dark` hold."""

    changed = Signal(object)

    def __init__(self, application: QApplication, choice: str = "system") -> None:
        super().__init__()
        self._application = application
        self._system_is_dark = application.palette().color(QPalette.ColorRole.Window).lightness() < 128
        self.choice = choice
        self.theme = LIGHT
        application.styleHints().colorSchemeChanged.connect(self._system_changed)
        self.choose(choice)

    def choose(self, choice: str) -> None:
        self.choice = choice if choice in ("light", "dark") else "system"
        self.theme = {"light": LIGHT, "dark": DARK}.get(self.choice) or (DARK if self._wants_dark() else LIGHT)
        self._application.setPalette(palette_of(self.theme))
        self.changed.emit(self.theme)

    def _wants_dark(self) -> bool:
        scheme = self._application.styleHints().colorScheme()
        if scheme == Qt.ColorScheme.Unknown:
            return self._system_is_dark
        return scheme == Qt.ColorScheme.Dark

    def _system_changed(self, *_: object) -> None:
        if self.choice == "system":
            self.choose("system")
