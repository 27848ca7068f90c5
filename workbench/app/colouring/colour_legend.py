"""What stands below a view that is coloured by a quantity: the colour bar, some numbers, what lies beyond the bar."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QPainter, QPaintEvent
from PySide6.QtWidgets import QVBoxLayout, QWidget

from workbench.app.appearance.theme import LIGHT, Theme
from workbench.app.colouring.colour_bar import ColourBar
from workbench.app.colouring.colour_range import ColourRange
from workbench.core.arrays import Floats

MEANING = "Every simplex counts once here; the mean of the status bar weighs them by their size in the source."


class NumbersRow(QWidget):
    """A line with numbers on the left and a note on the right; where it is narrow, the less important numbers give way."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._parts: tuple[str, ...] = ()
        self._note = ""
        self._colour = QColor(LIGHT.faint)
        self.setFixedHeight(self.fontMetrics().height() + 4)

    def set_theme(self, theme: Theme) -> None:
        self._colour = QColor(theme.faint)
        self.update()

    def show_parts(self, parts: tuple[str, ...], note: str) -> None:
        """`parts` in the order of the line; the last is the most important."""
        if (parts, note) != (self._parts, self._note):
            self._parts, self._note = parts, note
            self.setToolTip("\n".join(("   ".join((*parts, note)).strip(), MEANING)) if parts else "")
            self.update()

    def text(self) -> str:
        """All of the numbers, seen or not."""
        return "   ".join(self._parts)

    def note(self) -> str:
        return self._note

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setPen(self._colour)
        metrics = painter.fontMetrics()
        area = self.rect().adjusted(10, 0, -6, -3)
        note_width = metrics.horizontalAdvance(self._note)
        room = area.width() - (note_width + 14 if self._note else 0)
        parts = list(self._parts)
        while parts and metrics.horizontalAdvance("   ".join(parts)) > room:
            parts.pop(0)
        middle = Qt.AlignmentFlag.AlignVCenter
        painter.drawText(area, Qt.AlignmentFlag.AlignLeft | middle, "   ".join(parts))
        painter.drawText(area, Qt.AlignmentFlag.AlignRight | middle, self._note)
        painter.end()


class ColourLegend(QWidget):
    """A colour bar, and below it least, mean and largest value and how many lie beyond the bar's ends."""

    def __init__(self, colour_range: ColourRange, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("legend")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self.bar = ColourBar(colour_range, self)
        self.numbers = NumbersRow(self)
        self._parts: tuple[str, ...] = ()
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self.bar)
        layout.addWidget(self.numbers)

    def set_theme(self, theme: Theme) -> None:
        self.bar.set_theme(theme)
        self.numbers.set_theme(theme)
        self.setStyleSheet(f"#legend {{ background: {theme.view}; }}")

    def show_range(self, colour_range: ColourRange) -> None:
        self.bar.show_range(colour_range)
        self._show_numbers()

    def show_values(self, values: Floats) -> None:
        """Numbers and note for the values (m,) of a map."""
        finite = values if np.isfinite(values).all() else values[np.isfinite(values)]
        if len(finite):
            least, mean, most = float(finite.min()), float(finite.mean(dtype=np.float64)), float(finite.max())
            self._parts = (f"min {shown(least)}", f"mean {shown(mean)}", f"max {shown(most)}")
        self._show_numbers()

    def clear(self) -> None:
        self._parts = ()
        self._show_numbers()

    def _show_numbers(self) -> None:
        held = ("held",) if self.bar.range.is_locked else ()
        note = note_of(self.bar.range) if self._parts else ""
        self.numbers.show_parts(self._parts, ", ".join((*held, *filter(None, (note,)))))


def note_of(colour_range: ColourRange) -> str:
    """How many values lie beyond the ends; empty where none do. What no view could show is never passed over."""
    parts = [
        f"{percent(share)} {where}"
        for share, where in ((colour_range.share_below, "below"), (colour_range.share_above, "above"))
        if share > 0
    ]
    return ", ".join(parts)


def percent(share: float) -> str:
    """A part in per cent with two digits."""
    return f"{100 * share:.2g} %" if share >= 0.001 else "< 0.1 %"


def shown(value: float) -> str:
    """Four digits; the largest numbers of single precision stand for infinity."""
    if abs(value) > 1e30:
        return "∞" if value > 0 else "-∞"
    return f"{value:.4g}"
