"""Words that fit into their place: on two lines, smaller ones, then fewer of them."""

from __future__ import annotations

from functools import lru_cache

from workbench.figures.page_layout import MM_OF_POINT

LINE_HEIGHT = 1.2
"""From line to line, in font sizes: that of the text in figures."""
UNBROKEN = 0.9
"""Part of the font size down to which words shrink before they stand on another line."""
LEAST_TEXT = 0.7
"""Part of the font size down to which words shrink before they are cut short."""


@lru_cache(maxsize=2048)
def text_width(text: str, font_size: float) -> float:
    """Width of a line in the font of figures, mm; `font_size` in points."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextToPath

    if not text:
        return 0.0
    width, _, _ = TextToPath().get_text_width_height_descent(text, FontProperties(family="DejaVu Sans", size=100), ismath=False)
    return float(width) / 100 * font_size * MM_OF_POINT


def fit_text(text: str, width: float, font_size: float) -> tuple[str, float]:
    """Words, and the size in points, that fit into `width` mm."""
    wanted = text_width(text, font_size)
    if wanted <= width:
        return text, font_size
    size = max(font_size * width / wanted, LEAST_TEXT * font_size)
    return _cut(text, width, size), size


def fit_lines(text: str, width: float, font_size: float, most: int = 2) -> tuple[str, float]:
    """Words on up to `most` lines, one or two, and the size in points, that fit into `width` mm."""
    words = text.split()
    if most == 1 or len(words) < 2 or text_width(text, UNBROKEN * font_size) <= width:
        return fit_text(text, width, font_size)
    pairs = [(" ".join(words[:count]), " ".join(words[count:])) for count in range(1, len(words))]
    least = LEAST_TEXT * font_size
    shown = min(pairs, key=lambda pair: max(text_width(line, font_size) for line in pair))
    widest = max(text_width(line, font_size) for line in shown)
    size = max(font_size * min(1.0, width / widest), least)
    if size * widest > font_size * width * (1 + 1e-9):  # the second line is cut short: as much as can be is on the first
        fitting = (pair for pair in pairs if text_width(pair[0], least) <= width)
        shown = max(fitting, key=lambda pair: len(pair[0]), default=shown)
    return "\n".join(_cut(line, width, size) for line in shown), size


def _cut(text: str, width: float, size: float) -> str:
    """As much of the words as fits in this size."""
    shown = text
    while len(shown) > 1 and text_width(shown, size) > width * (1 + 1e-9):
        shown = f"{shown.rstrip('…')[:-1]}…" if len(shown) > 2 else "…"
    return shown
