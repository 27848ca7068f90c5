"""Undo and redo: the states between what a user did, each with its choices and its map."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

from workbench.core.arrays import Floats
from workbench.session.kept_map import KeptMap

Choices = TypeVar("Choices")


@dataclass(frozen=True, eq=False)
class Moment(Generic[Choices]):
    """All that an undo brings back: immutable choices, and the map that belonged to them (or None)."""

    choices: Choices
    map: KeptMap | None

    @property
    def positions(self) -> Floats | None:
        return None if self.map is None else self.map.positions()


class UndoHistory(Generic[Choices]):
    """Steps in the order in which they were done, with the moment before each, and the present one once it is left.

    Going back and forth changes nothing of what is kept; a new step forgets those that were undone. Beyond `limit` bytes
    the oldest maps are rounded to float32 where `may_round` allows it, then the oldest steps are forgotten. `weigh` gives
    the bytes that choices take together, where these are worth counting.
    """

    def __init__(
        self,
        limit: int,
        may_round: Callable[[Floats], bool] = lambda positions: True,
        weigh: Callable[[Iterable[Choices]], int] = lambda choices: 0,
    ) -> None:
        self._limit = limit
        self._may_round = may_round
        self._weigh = weigh
        self._names: list[str] = []
        self._before: list[Moment[Choices]] = []
        self._tip: Moment[Choices] | None = None
        self._done = 0
        self._lock = threading.RLock()

    def set_limit(self, limit: int) -> None:
        """Another limit in bytes; `trim` keeps to it."""
        self._limit = limit

    # ------------------------------------------------------------------------------------------ what there is

    @property
    def names(self) -> tuple[str, ...]:
        """Of all steps, oldest first; the first `done` of them are done, the others undone."""
        return tuple(self._names)

    @property
    def done(self) -> int:
        return self._done

    @property
    def undo_name(self) -> str:
        """What the next undo takes back; empty where there is nothing."""
        return self._names[self._done - 1] if self._done else ""

    @property
    def redo_name(self) -> str:
        return self._names[self._done] if self._done < len(self._names) else ""

    @property
    def last(self) -> Moment[Choices] | None:
        """The moment before the step that was done last."""
        return self._before[self._done - 1] if self._done else None

    @property
    def byte_count(self) -> int:
        maps = sum(kept.byte_count for kept in self._maps())
        return maps + self._weigh(moment.choices for moment in self._moments())

    def _moments(self) -> tuple[Moment[Choices], ...]:
        return (*self._before, *([self._tip] if self._tip is not None else []))

    def _maps(self) -> list[KeptMap]:
        """Each map once, oldest first."""
        return list(dict.fromkeys(moment.map for moment in self._moments() if moment.map is not None))

    # ------------------------------------------------------------------------------------------ steps

    def begin_step(self, name: str, choices: Choices, positions: Floats | None) -> None:
        """Something named `name` is about to be done; what stands before it is this."""
        with self._lock:
            del self._names[self._done :], self._before[self._done :]
            self._tip = None
            self._names.append(name)
            self._before.append(self._moment(choices, positions))
            self._done += 1

    def rename_last(self, name: str) -> None:
        """The step that was done last went on, and is now called this."""
        self._names[self._done - 1] = name

    def forget_last(self) -> None:
        """The step that was done last came to nothing."""
        with self._lock:
            if self._done == len(self._names) and self._done:
                self._names.pop()
                self._before.pop()
                self._done -= 1

    def go_to(self, done: int, choices: Choices, positions: Floats | None) -> Moment[Choices]:
        """The moment at which the first `done` steps were done; `choices` and `positions` are the present ones."""
        with self._lock:
            if not 0 <= done <= len(self._names):
                raise IndexError(done)
            if self._done == len(self._names):
                self._tip = self._moment(choices, positions)
            self._done = done
            found = self._tip if done == len(self._names) else self._before[done]
            assert found is not None
            return found

    def stay_at(self, done: int) -> None:
        """The way to another moment failed: this one is still the present one."""
        self._done = done

    def forget_moment(self, done: int, present: int) -> int:
        """The moment at which the first `done` steps were done cannot be gone to: the steps on both sides of it become one.

        Returns what the number `present` of another moment is from now on, which is the one that is present.
        """
        with self._lock:
            if done == len(self._names):
                self._names.pop()
                self._tip = self._before.pop()
            else:
                del self._names[max(done - 1, 0)], self._before[done]
            self._done = present - (present > done)
            return self._done

    def _moment(self, choices: Choices, positions: Floats | None) -> Moment[Choices]:
        if positions is None:
            return Moment(choices, None)
        last = self._before[-1].map if self._before else None
        return Moment(choices, last if last is not None and last.holds(positions) else KeptMap(positions))

    # ------------------------------------------------------------------------------------------ memory

    def pack(self) -> None:
        """Compress what is not yet compressed; safe on another thread."""
        for kept in self._maps():
            kept.pack()

    def trim(self) -> None:
        """Keep within the limit; the newest step and the present moment stay whatever they take. Safe on another thread."""
        for moment in list(self._before[:-1]):
            if self.byte_count <= self._limit:
                return
            kept = moment.map
            if kept is not None and kept.is_exact:
                rounded = kept.rounded()
                if self._may_round(rounded.positions()):
                    self._exchange(moment, replace(moment, map=rounded))
        with self._lock:
            while self.byte_count > self._limit and len(self._names) > 1 and self._done > 1:
                self._names.pop(0)
                self._before.pop(0)
                self._done -= 1

    def _exchange(self, old: Moment[Choices], new: Moment[Choices]) -> None:
        with self._lock:
            self._before = [new if moment is old else moment for moment in self._before]
