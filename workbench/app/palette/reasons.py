"""Why something cannot be done now, in a few words."""

from __future__ import annotations

NO_MESH = "no mesh is open"
NO_SOLID = "what is open is no solid"
REASONS = {
    **dict.fromkeys(("run", "step", "reset", "save", "refine", "pin", "box", "clear", "fit", "race"), NO_MESH),
    "undo": "nothing was done yet",
    "redo": "nothing was taken back",
    "export-unit": "no surface is mapped to the plane",
    "cut": NO_SOLID,
    "uncut": NO_SOLID,
    **dict.fromkeys((f"glyphs-{name}" for name in ("more", "fewer", "larger", "smaller")), "no glyphs are drawn"),
    **dict.fromkeys(("past-live", "past-go-on"), "the views show the newest map"),
}
BY_MENU = {
    "Carry a surface": "no solid is open, or it carries nothing",
    "Figure as in the survey": NO_MESH,
    "Own formulas": "the distortion in force is none of your own",
}
EMPTY = frozenset({"Open recent", "Recent sessions", "Recent formulas"})
"""Menus whose only entry, while there is nothing in them, says so."""


def reason_of(name: str, path: tuple[str, ...]) -> str:
    """What an action waits for, by its name or else by its menu; empty where that is not known."""
    return REASONS.get(name) or BY_MENU.get(path[-1] if path else "", "")
