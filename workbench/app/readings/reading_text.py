"""A reading in words: what the panel shows, and what is copied."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from workbench.core.simplex_reading import SimplexReading

SUBSCRIPTS = "₁₂₃"


@dataclass(frozen=True)
class ReadingText:
    """`heading` in a line or two; `rows` of a name and a number; `main` is the name of the row that the view shows."""

    heading: tuple[str, ...]
    rows: tuple[tuple[str, str], ...]
    main: str = ""

    def table(self) -> str:
        """Lines of a name, a tab and a number, for a spreadsheet."""
        return "\n".join([*(line.replace("   ", "\t") for line in self.heading), *(f"{a}\t{b}" for a, b in self.rows)])


def words_of(reading: SimplexReading, vertex: int, noun: str, main: str = "") -> ReadingText:
    """A reading; `vertex` is the one under the pointer or -1, `noun` what the simplex is called."""
    what = "area" if len(reading.sigma) == 2 else "volume"
    first = f"{noun} {reading.simplex}" + (f"   vertex {vertex}" if vertex >= 0 else "")
    corners = "corners " + ", ".join(str(corner) for corner in reading.vertices)
    stretches = [(f"σ{SUBSCRIPTS[i]}", shown(value)) for i, value in enumerate(reading.sigma)]
    sizes = [
        ("det", shown(reading.det)),
        (f"{what} in the source", shown(reading.rest_measure)),
        (what, shown(reading.measure)),
    ]
    values = [(name, shown(value)) for name, value in reading.values.items()]
    return ReadingText((first, corners), (*stretches, *sizes, *values), main)


def shown(value: float) -> str:
    """Six digits, ∞ for infinity."""
    if math.isinf(value):
        return "∞" if value > 0 else "−∞"
    return f"{value:.6g}".replace("-", "−")
