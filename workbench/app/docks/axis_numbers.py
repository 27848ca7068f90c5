"""The numbers along an axis: which ones, and how they are written."""

from __future__ import annotations

import math
import re

from workbench.app.colouring.range_fit import rounded_up


def decade_marks(low: float, high: float, most: int) -> list[float]:
    """Logarithms of at most `most` round numbers between 10**low and 10**high."""
    if not (math.isfinite(low) and math.isfinite(high)) or high <= low:
        return []
    decades = [float(d) for d in range(math.ceil(low), math.floor(high) + 1)]
    if len(decades) >= 2:
        return decades[:: math.ceil(len(decades) / most)]
    start = math.floor(low)
    marks = [start + d + math.log10(f) for d in (0, 1) for f in (1, 2, 5)]
    marks = [mark for mark in marks if low <= mark <= high]
    if len(marks) >= 2:
        return marks[:: math.ceil(len(marks) / most)]
    # less than a factor of five in sight: the axis is nearly linear
    least, greatest = 10.0**low, 10.0**high
    for parts in range(most, most + 5):  # of five parts, two ends at least are in sight
        step = rounded_up((greatest - least) / parts)
        marks = [math.log10(k * step) for k in range(math.ceil(least / step), math.floor(greatest / step) + 1) if k > 0]
        if len(marks) >= 2:
            break
    return marks[:: max(math.ceil(len(marks) / max(most, 2)), 1)]


def distinct_numbers(values: list[float]) -> list[str]:
    """Numbers as short as they may be and still differ, on an axis that shows a narrow range."""
    for digits in (1, 2, 3):
        texts = [short_number(value, digits) for value in values]
        if len(set(texts)) == len(texts):
            break
    return texts


def short_number(value: float, digits: int = 1) -> str:
    """Four digits (`digits` + 3) where the number is of ordinary size, else a power of ten with `digits` after the point."""
    if 1e-3 <= value < 1e4:
        return f"{value:.{digits + 3}g}"
    text = f"{value:.{digits}e}".replace("e+0", "e").replace("e-0", "e-").replace("e+", "e")
    return re.sub(r"\.?0+e", "e", text)
