"""How a run ended: an enumeration whose members are the messages."""

from __future__ import annotations

from enum import Enum


class Status(Enum):
    """State of a run; `value` is the sentence that says what happened and what to try."""

    RUNNING = "The solver is running."
    CONVERGED = "Converged: the energy no longer decreases by more than the tolerance and every anchor is in place."
    STALLED = (
        "Stalled: the anchors cannot come closer to their targets without inverting a simplex; "
        "move the anchors that lag, or release some."
    )
    NO_DESCENT = (
        "No descent: the line search found no step that lowers the energy; "
        "the map may be optimal to rounding, or try another solver or a smoother distortion."
    )
    SINGULAR = (
        "Singular system: the linear system of this step could not be factorised; "
        "set an anchor, remove degenerate simplices, or try gradient descent."
    )
    NONFINITE = "Not finite: the energy overflowed or is undefined; try another start, other parameters or a milder distortion."
    INVERTED_START = (
        "Inverted start: some simplices of the start are inverted or degenerate, and this distortion is infinite there; "
        "choose another start, a distortion without a barrier, or symmetric-dirichlet-filtered, which unfolds them."
    )
    MAX_ITERATIONS = "Stopped at the limit of iterations; raise --iterations to go on."
    TIME_LIMIT = "Stopped at the limit of time; raise --time-limit to go on."
    INTERRUPTED = "Interrupted: the map is the last accepted one."

    @property
    def is_failure(self) -> bool:
        """Whether the run did not do what was asked (limits and interruptions are the user's own)."""
        return self in _FAILURES


_FAILURES = frozenset({Status.STALLED, Status.NO_DESCENT, Status.SINGULAR, Status.NONFINITE, Status.INVERTED_START})
