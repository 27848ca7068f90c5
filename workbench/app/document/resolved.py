"""Distortions by id or formula, read once for all parts of the window that ask for the same."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from workbench.core.distortion import Distortion
from workbench.core.registry import Registry, registry

KEPT = 8
_Key = tuple[str, tuple[tuple[str, Any], ...]]


class _Kept:
    """The newest distortions, and the methods that they were read with: an own formula may have been changed since."""

    def __init__(self) -> None:
        self.methods: Registry | None = None
        self.items: dict[_Key, Distortion] = {}


_kept = _Kept()


def resolved(text: str, values: Mapping[str, Any] | None = None) -> Distortion:
    """As `Distortion.resolve`, of the window's thread alone: a slider asks for the same formula in several places.

    Threads resolve for themselves, as a search for properties adds to the graph of a distortion.
    """
    methods = registry()
    if methods is not _kept.methods:
        _kept.methods, _kept.items = methods, {}
    key = (text, tuple(sorted((values or {}).items())))
    item = _kept.items.pop(key, None)
    if item is None:
        item = Distortion.resolve(text, dict(values or {}))
    _kept.items[key] = item
    while len(_kept.items) > KEPT:
        del _kept.items[next(iter(_kept.items))]
    return item
