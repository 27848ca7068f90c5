"""A colour range as plain values."""

from __future__ import annotations

from typing import Any

from workbench.app.colouring.colour_range import ColourRange

FLAGS = ("reversed", "whole", "clipped")


def range_state(colour_range: ColourRange, *, with_ends: bool) -> dict[str, Any]:
    """What differs from a fresh range; ends that are held, where `with_ends`."""
    found: dict[str, Any] = {name: True for name in FLAGS if getattr(colour_range, f"is_{name}")}
    if colour_range.is_logarithmic != colour_range.quantity.is_logarithmic:
        found["logarithmic"] = colour_range.is_logarithmic
    if with_ends and colour_range.is_locked:
        found |= {"low": colour_range.low, "high": colour_range.high}
    return found


def take_range_state(colour_range: ColourRange, state: object) -> None:
    """Be as a state says; values of another kind are passed over."""
    if not isinstance(state, dict):
        return
    is_logarithmic = state.get("logarithmic")
    colour_range.set_logarithmic(is_logarithmic if isinstance(is_logarithmic, bool) else colour_range.quantity.is_logarithmic)
    colour_range.set_reversed(state.get("reversed") is True)
    colour_range.set_clipped(state.get("clipped") is True)
    colour_range.fit(whole=state.get("whole") is True)
    low, high = state.get("low"), state.get("high")
    if isinstance(low, int | float) and isinstance(high, int | float):
        try:
            colour_range.set_ends(low, high)
        except ValueError:
            return  # no range
