"""Numbers that are typed while anchors are held: 1.5, -90, one for each axis."""

from __future__ import annotations

LONGEST = 12
"""Characters of one number."""


class TypedNumbers:
    """What was typed so far; `count` numbers at the most, one after another."""

    def __init__(self, count: int) -> None:
        self._entries = [""] * max(count, 1)
        self._row = 0

    def type(self, character: str) -> bool:
        """Take a digit, a decimal point (or comma), or a minus, which changes the sign; whether it was one of these."""
        entry = self._entries[self._row]
        if character == "-":
            self._entries[self._row] = entry[1:] if entry.startswith("-") else "-" + entry
        elif character in (".", ","):
            if "." not in entry:
                self._entries[self._row] = entry + "."
        elif len(character) == 1 and character in "0123456789":
            if len(entry) < LONGEST:
                self._entries[self._row] = entry + character
        else:
            return False
        return True

    def delete(self) -> None:
        """Take the last character back."""
        self._entries[self._row] = self._entries[self._row][:-1]

    def next(self) -> None:
        """Go on with the number of the next axis."""
        self._row = (self._row + 1) % len(self._entries)

    @property
    def is_empty(self) -> bool:
        return not any(self._entries)

    @property
    def values(self) -> list[float | None]:
        """None where nothing, or no number yet, was typed."""
        return [float(text) if text.strip("-.") else None for text in self._entries]

    def words(self, names: list[str], unit: str = "") -> str:
        """All numbers with the names of their axes, and where the next character goes."""
        parts = []
        for row, (name, text) in enumerate(zip(names, self._entries, strict=True)):
            shown = (text or "0") + ("|" if row == self._row else "") + unit
            parts.append(f"{name} {shown}".strip() if len(names) > 1 else shown)
        return ", ".join(parts)
