"""Words that fit into their place: on several lines, smaller ones, then fewer of them."""

from __future__ import annotations

from functools import lru_cache
from itertools import combinations, pairwise

from workbench.figures.page_layout import MM_OF_POINT

UNBROKEN = 0.9
"""Part of the font size down to which words shrink before they stand on another line."""
MOST_BROKEN = 16
"""Words among which lines are broken."""
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


def fit_lines(text: str, width: float, font_size: float, most: int = 3) -> tuple[str, float]:
    """Words on up to `most` lines, and the size in points, that fit into `width` mm: as few lines as keep them large."""
    best: tuple[str, ...] = (text,)
    size = 0.0
    for count in range(1, min(most, len(text.split())) + 1):
        lines, widest = _broken(text, count, font_size)
        fitted = font_size * min(1.0, width / max(widest, 1e-9))
        if fitted > size:
            best, size = lines, fitted
        if size >= UNBROKEN * font_size:
            break
    size = max(size, LEAST_TEXT * font_size)
    return "\n".join(_cut(line, width, size) for line in best), size


def _broken(text: str, count: int, font_size: float) -> tuple[tuple[str, ...], float]:
    """Words on so many lines, the widest of which, in mm, is as short as can be."""
    if count == 1:
        return (text,), text_width(text, font_size)
    words = text.split()
    found = []
    for breaks in combinations(range(1, min(len(words), MOST_BROKEN)), count - 1):
        ends = (0, *breaks, len(words))
        lines = tuple(" ".join(words[begin:end]) for begin, end in pairwise(ends))
        found.append((max(text_width(line, font_size) for line in lines), lines))
    widest, shown = min(found)
    return shown, widest


def _cut(text: str, width: float, size: float) -> str:
    """As much of the words as fits in this size."""
    shown = text
    while len(shown) > 1 and text_width(shown, size) > width * (1 + 1e-9):
        shown = f"{shown.rstrip('…')[:-1]}…" if len(shown) > 2 else "…"
    return shown
