"""What a session file holds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from workbench.core.arrays import Floats
from workbench.session.journal import Leg
from workbench.session.session import Session


@dataclass(frozen=True, eq=False)
class SessionRecord:
    """Choices, and the map that they had led to.

    Parameters
    ----------
    session : Session
    sha256 : str             of the source as it was; empty where that is not known
    map : (n, d) float64     or None
    legs : tuple of Leg      what leads to the map; none where a hand had the last word
    energy : float           of the map under the choices; None where there is none
    views : dict             how a window shows it, see `view_schema`; None where nobody said
    """

    session: Session
    sha256: str = ""
    map: Floats | None = field(default=None, repr=False)
    legs: tuple[Leg, ...] = ()
    energy: float | None = None
    views: Mapping[str, Any] | None = field(default=None, repr=False)
