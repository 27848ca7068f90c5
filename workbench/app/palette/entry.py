"""One thing that can be done: what the palette lists."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from workbench.app.palette.fuzzy import Fit, fit

ARROW = " › "
RECENT = 10.0
"""What the entry that was used last is worth beside what fits it; those before it less and less."""
BEHIND, OTHERWISE = 0.4, 0.8
"""What letters in the path, and in other words for it, are worth against those in the title."""
GREY = 0.35
"""What a fit is worth where the entry cannot be used now: less than one that fits by its path alone, and can."""


@dataclass(frozen=True, eq=False)
class Entry:
    """Words, keys and deed of one command.

    `path` are the menus that lead to it, `name` is what it is remembered by: titles such as that of Undo change.
    `also` are other words for it, such as an id, in which whole pieces of what is typed are found.
    `is_checked` is None for what cannot be switched on and off; `reason` says why it is not possible now. `lift` is what an
    entry is worth beside another that fits as well.
    """

    title: str
    path: tuple[str, ...]
    run: Callable[[], None]
    name: str = ""
    keys: str = ""
    tip: str = ""
    is_checked: bool | None = None
    is_enabled: bool = True
    reason: str = ""
    lift: float = 0.0
    also: str = ""

    @property
    def place(self) -> str:
        return ARROW.join(self.path)

    @property
    def key(self) -> str:
        """What it is remembered by from one use to the next."""
        return self.name or ARROW.join((*self.path, self.title))


@dataclass(frozen=True, eq=False)
class Found:
    """An entry that fits what was typed, and the letters of its title that do."""

    entry: Entry
    score: float
    places: tuple[int, ...] = ()


def search(entries: Sequence[Entry], typed: str, recent: Iterable[str] = ()) -> list[Found]:
    """Entries that fit, the best first; what was used lately comes first among those that fit alike.

    Each word that was typed is to be found in the title or in the path. Where nothing was typed, what was used lately
    stands before all others, which stay in their order.
    """
    words = typed.split()
    ranks = {key: rank for rank, key in reversed(list(enumerate(recent)))}
    found = []
    for entry in entries:
        rank = ranks.get(entry.key)
        if not words:
            found.append(Found(entry, 0.0 if rank is None else 1.0 / (1 + rank)))
            continue
        one = _fit_all(entry, typed, words)
        if one is not None:
            bonus = 0.0 if rank is None else RECENT / (1.0 + 0.25 * rank)
            score = one.score + bonus + entry.lift
            found.append(Found(entry, score if entry.is_enabled or score < 0 else GREY * score, one.places))
    found.sort(key=lambda one: -one.score)
    return found


def _fit_all(entry: Entry, typed: str, words: Sequence[str]) -> Fit | None:
    whole = fit(" ".join(words), entry.title)
    score, places = 0.0, set()
    for word in words:
        in_title, in_path = fit(word, entry.title), fit(word, entry.place)
        in_other = fit(word, entry.also) if word.casefold() in entry.also.lower() else None
        if in_title is None and in_path is None and in_other is None:
            return whole
        by_path = in_path.score * BEHIND if in_path is not None else float("-inf")
        if in_other is not None:
            by_path = max(by_path, in_other.score * OTHERWISE)
        if in_title is not None and in_title.score >= by_path:
            score += in_title.score
            places.update(in_title.places)
        else:
            score += by_path
    if whole is not None and whole.score >= score:
        return whole
    return Fit(score, tuple(sorted(places)))
