"""Colours of glyphs, in figures and in the window."""

from __future__ import annotations

LONGER = (0.78, 0.16, 0.12)
SHORTER = (0.10, 0.32, 0.80)
EQUAL = (0.45, 0.45, 0.45)
"""Colours of what is stretched, of what is squeezed, and of what keeps its length."""
BODY = (0.93, 0.62, 0.30)
"""Colour of the image of a ball."""
