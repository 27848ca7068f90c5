"""An exception that nobody caught."""

from __future__ import annotations

import platform
import traceback
from collections.abc import Hashable
from dataclasses import dataclass

from workbench import __version__
from workbench.core.errors import WorkbenchError


@dataclass(frozen=True)
class Fault:
    """`where` names the thread, empty for that of the window; `key` is the same for faults from one place."""

    sentence: str
    details: str
    key: Hashable
    where: str = ""


def fault_of(error: BaseException, where: str = "") -> Fault:
    """What a user is told of an exception."""
    details = "".join(traceback.format_exception(error))
    frames = traceback.extract_tb(error.__traceback__)
    place = (frames[-1].filename, frames[-1].lineno) if frames else ("", 0)
    sentence = error.sentence if isinstance(error, WorkbenchError) else f"{type(error).__name__}: {error}".rstrip(": ")
    return Fault(sentence, details, (type(error).__qualname__, *place), where)


def report_text(faults: dict[Hashable, tuple[Fault, int]]) -> str:
    """All that is worth to be passed on: versions, then each fault with how often it came."""
    head = f"Distortion Workbench {__version__}, Python {platform.python_version()}, {platform.platform()}"
    parts = [head]
    for fault, count in faults.values():
        times = f" ({count} times)" if count > 1 else ""
        thread = f" on the thread {fault.where}" if fault.where else ""
        parts.append(f"{fault.sentence}{times}{thread}\n\n{fault.details.rstrip()}")
    return "\n\n".join(parts) + "\n"
