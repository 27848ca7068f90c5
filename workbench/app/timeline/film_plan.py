"""Which moments of a record become the frames of a film."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from workbench.app.timeline.recorder import anchors_of
from workbench.core.errors import WorkbenchError
from workbench.figures.film import MOST_FRAMES, Film, Still
from workbench.session.moments import Moment

PARTS = {"all": "Everything", "marked": "From A to B", "rest": "From what is shown to the newest"}
PACES = {"time": "As it was, times", "maps": "One map a frame"}


@dataclass(frozen=True)
class FilmPlan:
    """A film of a part of the record: `part` is one of `PARTS`, `pace` one of `PACES`, `speed` a factor of the time."""

    film: Film
    part: str = "all"
    pace: str = "time"
    speed: float = 1.0


def frames_of(moments: Sequence[Moment], rate: float, pace: str, speed: float) -> list[Moment]:
    """The moments of the frames: each of them, or what was to be seen at even steps of time; the last one is among them.

    Raises `WorkbenchError` for more frames than a film may have.
    """
    if pace == "maps" or len(moments) < 2:
        return list(moments)
    step = speed / rate
    count = math.ceil((moments[-1].time - moments[0].time) / step - 1e-9)
    if count >= MOST_FRAMES:
        raise WorkbenchError(f"The film would have {count + 1} frames; choose a shorter part, or a quicker pace.")
    found, place = [], 0
    for number in range(count + 1):
        now = moments[0].time + number * step
        while place + 1 < len(moments) and moments[place + 1].time <= now + 1e-9:
            place += 1
        found.append(moments[place])
    found[-1] = moments[-1]
    return found


def still_of(moment: Moment, has_anchors: bool) -> Still:
    """A frame of a moment, its numbers below."""
    anchors = tuple(anchors_of(moment).vertices.tolist()) if has_anchors else ()
    energy = f"energy {moment.energy:.5g}" if math.isfinite(moment.energy) else "energy infinite"
    inverted = f"    {moment.inverted_count} inverted" if moment.inverted_count else ""
    return Still(lambda: moment.positions, f"iteration {moment.iteration}    {energy}{inverted}", anchors)


def sentence_about(count: int, rate: float) -> str:
    """How long a film is."""
    return f"{count} {'frame' if count == 1 else 'frames'}, {count / rate:.1f} s"
