"""Fixes that change how a file is read, beside those of `core.fixes`, which change a mesh that was read."""

from __future__ import annotations

from collections.abc import Iterable

READING_FIXES = ("linearise", "tets")
"""`linearise`: elements of higher order become linear ones on their corners. `tets`: as the option of that name."""


def split_fixes(names: Iterable[str]) -> tuple[dict[str, bool], tuple[str, ...]]:
    """Options of `read_mesh` that some of the fixes stand for, and the names of the others, in their order."""
    names = tuple(names)
    return {name: True for name in READING_FIXES if name in names}, tuple(n for n in names if n not in READING_FIXES)
