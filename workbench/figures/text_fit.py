"""Words that fit into their place: smaller ones, then fewer of them."""

from __future__ import annotations

from functools import lru_cache

from workbench.figures.page_layout import MM_OF_POINT

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
    shown = text
    while len(shown) > 1 and text_width(shown, size) > width * (1 + 1e-9):
        shown = f"{shown.rstrip('…')[:-1]}…" if len(shown) > 2 else "…"
    return shown, size
