"""The properties of a distortion as chips: yes, no or undecided, by colour, sign and word."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QButtonGroup, QGridLayout, QLabel, QSizePolicy, QToolButton, QVBoxLayout, QWidget

from workbench.app.appearance.theme import LIGHT, Theme

if TYPE_CHECKING:
    from workbench.core.analysis import Analysis, Property

WORDS = {
    "normalised": ("Normalised", "D(1, …, 1) is the least value of D."),
    "symmetric": ("Symmetric", "D is the same for a map and for its inverse."),
    "bottom_barrier": ("Bottom barrier", "D grows without bound as σₙ → 0."),
    "top_barrier": ("Top barrier", "D grows without bound as σ₁ → ∞."),
    "smooth_almost_everywhere": ("Smooth a. e.", "D has derivatives almost everywhere."),
    "regular": ("Regular", "All that Corollary 2.1 asks for."),
    "convex": ("Convex in x", "The energy is convex in the positions (Theorem 8.3)."),
}
SIGNS: Mapping[bool | None, tuple[str, str]] = {True: ("✓", "yes"), False: ("✗", "no"), None: ("?", "undecided")}
LIGHT_CHIPS: Mapping[bool | None, tuple[str, str]] = {
    True: ("#d8f0dc", "#0b5a21"),
    False: ("#f8dedb", "#8c1d13"),
    None: ("#e7e9ec", "#3c444d"),
}
DARK_CHIPS: Mapping[bool | None, tuple[str, str]] = {
    True: ("#163d22", "#a5e8b5"),
    False: ("#4a1f1b", "#ffb9b0"),
    None: ("#31373e", "#d5dade"),
}
"""Background and text of a chip."""
METHODS = {
    "symbolic": "Found by rules on the formula.",
    "numeric": "Found by numbers.",
    "both": "Found by rules on the formula and by numbers.",
}


class Badges(QWidget):
    """A chip a property and a line that explains the chosen one."""

    chosen = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.theme: Theme = LIGHT
        self._analysis: Analysis | None = None
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(6)
        grid = QGridLayout()
        grid.setSpacing(5)
        self.chips: dict[str, QToolButton] = {}
        group = QButtonGroup(self)
        for place, (name, (word, meaning)) in enumerate(WORDS.items()):
            chip = QToolButton(self)
            chip.setObjectName(name)
            chip.setCheckable(True)
            chip.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
            chip.setCursor(Qt.CursorShape.PointingHandCursor)
            chip.setText(word)
            chip.setToolTip(meaning)
            chip.clicked.connect(lambda _=False, n=name: self.choose(n))
            group.addButton(chip)
            grid.addWidget(chip, place // 2, place % 2)
            self.chips[name] = chip
        layout.addLayout(grid)
        self.detail = QLabel(self)
        self.detail.setWordWrap(True)
        self.detail.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.detail.setAlignment(Qt.AlignmentFlag.AlignTop)
        layout.addWidget(self.detail)
        self._name = "normalised"
        self.chips[self._name].setChecked(True)
        self.say("")

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        self._paint()

    def say(self, sentence: str) -> None:
        """No properties, but a sentence: still at work, or what went wrong."""
        self._analysis = None
        self._paint()
        self.detail.setText(sentence)

    def show_analysis(self, analysis: Analysis) -> None:
        self._analysis = analysis
        self._paint()
        self.choose(self._name)

    def choose(self, name: str) -> None:
        """Explain one property."""
        self._name = name
        self.chips[name].setChecked(True)
        if self._analysis is None:
            return
        self.detail.setText(explained(name, getattr(self._analysis, name)))

    def _paint(self) -> None:
        colours = DARK_CHIPS if self.theme.is_dark else LIGHT_CHIPS
        for name, chip in self.chips.items():
            word, meaning = WORDS[name]
            found = None if self._analysis is None else getattr(self._analysis, name)
            holds = None if found is None else found.holds
            sign, answer = SIGNS[holds] if found is not None else ("…", "not known yet")
            paper, ink = colours[holds]
            chip.setText(f"{sign}  {word}")
            sentence = "" if found is None else f"\n{found.sentence}"
            chip.setToolTip(f"{word}: {answer}. {meaning}{sentence}")
            chip.setStyleSheet(
                f"QToolButton {{ background: {paper}; color: {ink}; border: 1px solid {paper}; border-radius: 9px;"
                f" padding: 3px 8px; text-align: left; }} QToolButton:checked {{ border: 1px solid {ink}; }}"
                f" QToolButton:hover {{ border: 1px solid {ink}; }}"
            )


def explained(name: str, found: Property) -> str:
    """Answer, sentence, method and witness of a property, as rich text."""
    word, _ = WORDS[name]
    parts = [f"<b>{word}: {SIGNS[found.holds][1]}.</b> {_escaped(found.sentence)}"]
    if found.method in METHODS:
        parts.append(METHODS[found.method])
    if found.witness:
        facts = "; ".join(f"{key.replace('_', ' ')} = {written(value)}" for key, value in found.witness.items())
        parts.append(f"Witness: {_escaped(facts)}.")
    return " ".join(parts)


def written(value: Any) -> str:
    """A number, or numbers in brackets, with four digits; the middle of a long list is left out."""
    if isinstance(value, str) or value is None or isinstance(value, bool):
        return str(value)
    if isinstance(value, Mapping):
        return ", ".join(f"{key} {written(item)}" for key, item in value.items())
    if isinstance(value, list | tuple | np.ndarray):
        items = [written(item) for item in value]
        if len(items) > 6:
            items = [*items[:3], "…", items[-1]]
        return f"({', '.join(items)})"
    return f"{float(value):.4g}"


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;")
