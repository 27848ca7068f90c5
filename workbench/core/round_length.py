"""Lengths that scale bars have."""

from __future__ import annotations

import math


def round_length(longest: float) -> float:
    """The largest of ..., 0.1, 0.2, 0.5, 1, 2, 5, ... that is at most `longest`; 0 where there is none."""
    if not (math.isfinite(longest) and longest > 0):
        return 0.0
    decade = 10.0 ** math.floor(math.log10(longest))
    return max(step * decade for step in (1.0, 2.0, 5.0) if step * decade <= longest * (1 + 1e-9))
