"""Colours of a formula while it is typed: functions, singular values, distortions, parameters."""

from __future__ import annotations

import re
from collections.abc import Iterable

from PySide6.QtGui import QColor, QFont, QPalette, QSyntaxHighlighter, QTextCharFormat, QTextDocument

from workbench.core.formula import FUNCTIONS

LIGHT = {"function": "#0b5cad", "variable": "#1c2127", "distortion": "#0b7a4b", "parameter": "#9a4a00", "number": "#5d3fb0"}
DARK = {"function": "#79b8ff", "variable": "#e6e9ec", "distortion": "#7fd6a8", "parameter": "#ffb77a", "number": "#c4b0ff"}
_WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_]*|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")


def is_dark(palette: QPalette) -> bool:
    return palette.color(QPalette.ColorRole.Base).lightness() < 128


class FormulaColours(QSyntaxHighlighter):
    """Knows the distortions' names; what is nothing else is taken for a parameter."""

    def __init__(self, document: QTextDocument) -> None:
        super().__init__(document)
        self._distortions: frozenset[str] = frozenset()
        self._formats: dict[str, QTextCharFormat] = {}
        self.set_dark(False)

    def set_dark(self, dark: bool) -> None:
        self._formats = {}
        for kind, colour in (DARK if dark else LIGHT).items():
            style = QTextCharFormat()
            style.setForeground(QColor(colour))
            if kind == "parameter":
                style.setFontWeight(QFont.Weight.DemiBold)
            self._formats[kind] = style
        self.rehighlight()

    def set_distortions(self, names: Iterable[str]) -> None:
        self._distortions = frozenset(names)
        self.rehighlight()

    def kind_of(self, word: str) -> str:
        """function, variable, distortion, parameter or number"""
        if word[0].isdigit() or word[0] == ".":
            return "number"
        if word in FUNCTIONS:
            return "function"
        if re.fullmatch(r"sigma(\d*|n)|n|det", word):
            return "variable"
        return "distortion" if word in self._distortions else "parameter"

    def highlightBlock(self, text: str) -> None:
        for match in _WORD.finditer(text):
            self.setFormat(match.start(), match.end() - match.start(), self._formats[self.kind_of(match.group())])
