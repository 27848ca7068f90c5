"""A formula drawn as mathematics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPaintEvent, QResizeEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from workbench.app.appearance.theme import LIGHT, Theme
from workbench.app.inspector.latest import Latest

SIZES = (17.0, 14.0, 12.0, 10.0, 8.5, 7.0)
"""Points, the largest that fits the width is taken."""
LINE_GAP = 8
"""Pixels between two lines of a broken formula."""
Ink = NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class Drawing:
    """Coverage (h, w) in pixels of the screen, and what it was made for."""

    ink: Ink
    terms: tuple[str, ...]
    width: int
    ratio: float


def draw_formula(terms: tuple[str, ...], width: int, ratio: float) -> Drawing:
    """Draw a formula at the largest size that fits.

    Parameters
    ----------
    terms : tuple of str   LaTeX; it may be broken between them
    width : int            logical pixels at most
    ratio : float          pixels of the screen in a logical one

    A formula too wide at the smallest size is as wide as it is. Raises `ValueError` for what mathtext does not know.
    """
    room = width * ratio
    # each term is measured once, as large as can be; widths go with the size and nearly add up
    widths = [_ink(term, SIZES[0], ratio).shape[1] for term in terms]
    for size in SIZES:
        lines = _broken(terms, [width * size / SIZES[0] for width in widths], room)
        if max(sum(line[1]) for line in lines) <= room:
            break
    sheet = _stack([_ink(line[0], size, ratio) for line in lines], round(LINE_GAP * ratio))
    return Drawing(sheet, terms, width, ratio)


def _broken(terms: tuple[str, ...], widths: list[float], room: float) -> list[tuple[str, list[float]]]:
    """Lines, as many terms each as there is room for, with the widths of these."""
    lines: list[tuple[str, list[float]]] = [(terms[0], [widths[0]])]
    for term, width in zip(terms[1:], widths[1:], strict=True):
        text, before = lines[-1]
        if sum(before) + width <= room:
            lines[-1] = (f"{text} {term}", [*before, width])
        else:
            lines.append((rf"\quad {term}", [width]))
    return lines


def _stack(lines: list[Ink], gap: int) -> Ink:
    height = sum(len(line) for line in lines) + gap * (len(lines) - 1)
    sheet = np.zeros((height, max(line.shape[1] for line in lines)), np.uint8)
    top = 0
    for line in lines:
        sheet[top : top + len(line), : line.shape[1]] = line
        top += len(line) + gap
    return sheet


def _ink(latex: str, size: float, ratio: float) -> Ink:
    # late: half a second, which neither the start nor the GUI thread should pay
    from matplotlib.font_manager import FontProperties
    from matplotlib.mathtext import MathTextParser

    font = FontProperties(size=size, math_fontfamily="cm")
    return np.asarray(MathTextParser("agg").parse(f"${latex}$", dpi=96 * ratio, prop=font).image, dtype=np.uint8)


def inked(ink: Ink, colour: QColor) -> QImage:
    """A drawing in a colour, on nothing."""
    pixels = np.empty((*ink.shape, 4), np.uint8)
    pixels[...] = (colour.red(), colour.green(), colour.blue(), 0)
    pixels[..., 3] = ink
    height, width = ink.shape
    return QImage(pixels.tobytes(), width, height, 4 * width, QImage.Format.Format_RGBA8888).copy()


class FormulaPicture(QWidget):
    """Shows LaTeX in the colour of the theme; drawn on a thread, anew when the width changes."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.theme: Theme = LIGHT
        self.drawing: Drawing | None = None
        self._terms: tuple[str, ...] = ()
        self._plain = ""
        self._image: QImage | None = None
        self._latest = Latest(self)
        self._latest.done.connect(self._take)
        self._latest.failed.connect(self._fail)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setMinimumHeight(56)

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        self._colour()

    def show_formula(self, terms: tuple[str, ...], plain: str) -> None:
        """Draw these terms; `plain` stands there while nothing is drawn yet, and where nothing can be."""
        if terms != self._terms:
            self._terms, self._plain = terms, plain
            self.drawing = self._image = None
            self._ask()
        self.update()

    def wait(self) -> None:
        self._latest.wait()

    def _ask(self) -> None:
        terms, width, ratio = self._terms, max(self.width() - 16, 120), self.devicePixelRatioF()
        if terms:
            self._latest.ask(lambda: draw_formula(terms, width, ratio))

    def _take(self, drawing: Drawing) -> None:
        if drawing.terms == self._terms:
            self.drawing = drawing
            self._colour()

    def _fail(self, error: Exception) -> None:
        self.drawing = self._image = None  # the plain text stays
        self.update()

    def _colour(self) -> None:
        if self.drawing is None:
            return
        self._image = inked(self.drawing.ink, QColor(self.theme.text))
        room = round(self.drawing.width * self.drawing.ratio)
        if self._image.width() > room:
            self._image = self._image.scaledToWidth(room, Qt.TransformationMode.SmoothTransformation)
        self._image.setDevicePixelRatio(self.drawing.ratio)
        self.setFixedHeight(max(round(self._image.height() / self.drawing.ratio) + 18, 56))
        self.update()

    def sizeHint(self) -> QSize:
        return QSize(300, self.height())

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if self.drawing is None or abs(self.drawing.width - (self.width() - 16)) > 4:
            self._ask()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(self.theme.view))
        if self._image is None:
            painter.setPen(QColor(self.theme.faint))
            painter.drawText(
                self.rect().adjusted(8, 4, -8, -4), Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap, self._plain
            )
        else:
            size = self._image.deviceIndependentSize()
            left = max((self.width() - size.width()) / 2, 8.0)
            painter.drawImage(int(left), int((self.height() - size.height()) / 2), self._image)
        painter.end()
