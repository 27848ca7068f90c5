"""A screen for benchmarks of the window: the one there is, else a virtual one."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

SCREEN = ("-screen", "0", "1600x1000x24")


@contextmanager
def screen() -> Iterator[bool]:
    """True while there is a screen; false where none can be had, and one line says so."""
    if not sys.platform.startswith("linux") or os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"):
        yield True
        return
    try:
        server = subprocess.Popen(["Xvfb", "-displayfd", "1", *SCREEN], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    except OSError:
        print("left out: there is no screen, and no Xvfb to stand in for one")
        yield False
        return
    assert server.stdout is not None
    number = server.stdout.readline().decode().strip()
    if number:
        os.environ["DISPLAY"] = f":{number}"
    else:
        print("left out: there is no screen, and Xvfb does not start")
    try:
        yield bool(number)
    finally:
        os.environ.pop("DISPLAY", None)
        server.terminate()
        server.wait()
