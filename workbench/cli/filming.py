"""`--film`: the maps of a run, one a frame, as GIF or MP4."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from workbench.core.state import State
    from workbench.engine.preparation import Prepared
RATE = 12.0
"""Frames a second: one can follow single iterations."""
SIZE = (960, 540)
MOST = 500
"""Maps that are kept at most, in single precision."""


@dataclass(frozen=True, eq=False)
class Kept:
    """A map (n, d) float32 of a run."""

    positions: Any
    iteration: int
    energy: float


def add_film_option(parser: argparse.ArgumentParser) -> None:
    told = "the maps of the run, one a frame: .gif, or .mp4 where there is ffmpeg"
    parser.add_argument("--film", metavar="FILM.gif", help=told)


class Filming:
    """Keeps maps of a run, evenly spread over it, and writes the film of them.

    Raises `WorkbenchError` at once where the film could not be written.
    """

    def __init__(self, path: str, prepared: Prepared) -> None:
        from workbench.figures.film_file import check_film_path

        check_film_path(path)
        self._path, self._prepared = path, prepared
        self._kept: list[Kept] = []
        self._last: Kept | None = None
        self._every = 1

    def take(self, state: State) -> None:
        """One more map, as the run tells of it; of a long run every so many iterations stay."""
        self._last = Kept(state.positions.astype("float32"), state.iteration, state.energy)
        if state.iteration % self._every == 0:
            self._kept.append(self._last)
        if len(self._kept) > MOST:
            self._every *= 2
            self._kept = [kept for kept in self._kept if kept.iteration % self._every == 0]

    def write(self, tell: Callable[[str], None]) -> None:
        """The source under the texture of the map, and the map in the colours of what was minimised.

        Raises `WorkbenchError` where that fails.
        """
        from workbench.core.measure import Measure
        from workbench.figures.film import Film, Still
        from workbench.figures.film_file import save_film
        from workbench.figures.recipe import CHEQUERED, Panel

        problem = self._prepared.problem
        measure = Measure.of_distortion(problem.distortion)
        panels = (
            Panel("source", colour=CHEQUERED, caption="Source"),
            Panel("map", colour=measure.text, parameters=dict(measure.parameters), caption="Map", bar=True),
        )
        anchors = tuple(problem.anchors.vertices.tolist())

        def still(kept: Kept) -> Still:
            words = f"iteration {kept.iteration}    energy {kept.energy:.6g}"
            return Still(lambda: kept.positions.astype(float), words, anchors)

        shown = self._kept if self._last in self._kept[-1:] or self._last is None else [*self._kept, self._last]
        tell(f"filming {len(shown)} maps")
        save_film(self._path, Film(panels, *SIZE, RATE), self._prepared.opened.mesh, [still(kept) for kept in shown])
