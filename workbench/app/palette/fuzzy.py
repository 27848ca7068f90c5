"""How well a few typed letters fit a text: they stand in it in this order, best at the beginnings of words."""

from __future__ import annotations

from dataclasses import dataclass

WORD_BEGIN, IN_A_ROW, FIRST, PER_LETTER = 8.0, 9.0, 4.0, 1.0
"""What a letter is worth at the beginning of a word, right after the one before it, at the very beginning, and anywhere."""
GAP, LARGEST_GAP = 0.15, 3.0
"""What each letter that is passed over costs, and the most that one gap does."""
LENGTH = 0.02
"""What each letter of the text costs: of two that fit alike the shorter is meant."""


@dataclass(frozen=True)
class Fit:
    """How well a text fits (more is better), and the places of the letters that were typed."""

    score: float
    places: tuple[int, ...]


def fit(typed: str, text: str) -> Fit | None:
    """The best way in which the letters of `typed` stand in `text` in their order; None where they do not.

    Upper and lower case are the same. Nothing typed fits everything, with no score.
    """
    typed, lowered = typed.casefold(), text.lower()
    if not typed:
        return Fit(0.0, ())
    begun = 0
    for letter in typed:  # most texts go here
        begun = lowered.find(letter, begun) + 1
        if not begun:
            return None
    # for each letter, every place where it may stand with the best way to come there
    ways: list[dict[int, tuple[float, int]]] = []
    for letter in typed:
        here: dict[int, tuple[float, int]] = {}
        at = lowered.find(letter)
        while at >= 0:
            found = _best_way(ways[-1], at) if ways else (-min(GAP * at, LARGEST_GAP), -1)
            if found is not None:
                here[at] = (found[0] + _worth(text, at), found[1])
            at = lowered.find(letter, at + 1)
        ways.append(here)
    if not ways[-1]:
        return None
    place = max(ways[-1], key=lambda at: (ways[-1][at][0], -at))
    score = ways[-1][place][0] - LENGTH * len(text)
    places = []
    for here in reversed(ways):
        places.append(place)
        place = here[place][1]
    return Fit(score, tuple(reversed(places)))


def _best_way(before: dict[int, tuple[float, int]], at: int) -> tuple[float, int] | None:
    best: tuple[float, int] | None = None
    for place, (score, _) in before.items():
        if place < at:
            gap = at - place - 1
            total = score + (IN_A_ROW if not gap else -min(GAP * gap, LARGEST_GAP))
            if best is None or total > best[0]:
                best = (total, place)
    return best


def _worth(text: str, at: int) -> float:
    if at == 0:
        return PER_LETTER + WORD_BEGIN + FIRST
    before, letter = text[at - 1], text[at]
    is_begin = not before.isalnum() or (letter.isupper() and before.islower())
    return PER_LETTER + (WORD_BEGIN if is_begin and letter.isalnum() else 0.0)
