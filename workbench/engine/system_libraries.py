"""Shared libraries that Qt and VTK need from the system, and the Debian packages that bring them.

`python -m workbench.engine.system_libraries [--tests]` prints the packages that are missing, nothing where all is well.
"""

from __future__ import annotations

import ctypes
import shutil
import sys
from dataclasses import dataclass


@dataclass(frozen=True)
class SystemLibrary:
    """A shared library by the name that the loader knows, its Debian/Ubuntu package, and what it is for."""

    name: str
    package: str
    purpose: str


LIBRARIES = (
    SystemLibrary("libglib-2.0.so.0", "libglib2.0-0", "drawing"),
    SystemLibrary("libGL.so.1", "libgl1", "drawing"),
    SystemLibrary("libEGL.so.1", "libegl1", "drawing"),
    SystemLibrary("libxkbcommon.so.0", "libxkbcommon0", "drawing"),
    SystemLibrary("libfontconfig.so.1", "libfontconfig1", "drawing"),
    SystemLibrary("libdbus-1.so.3", "libdbus-1-3", "drawing"),
    SystemLibrary("libX11.so.6", "libx11-6", "drawing"),
    SystemLibrary("libXrender.so.1", "libxrender1", "drawing"),
    SystemLibrary("libX11-xcb.so.1", "libx11-xcb1", "window"),
    SystemLibrary("libxcb-cursor.so.0", "libxcb-cursor0", "window"),
    SystemLibrary("libxcb-icccm.so.4", "libxcb-icccm4", "window"),
    SystemLibrary("libxcb-image.so.0", "libxcb-image0", "window"),
    SystemLibrary("libxcb-keysyms.so.1", "libxcb-keysyms1", "window"),
    SystemLibrary("libxcb-randr.so.0", "libxcb-randr0", "window"),
    SystemLibrary("libxcb-render-util.so.0", "libxcb-render-util0", "window"),
    SystemLibrary("libxcb-shape.so.0", "libxcb-shape0", "window"),
    SystemLibrary("libxcb-xkb.so.1", "libxcb-xkb1", "window"),
    SystemLibrary("libxkbcommon-x11.so.0", "libxkbcommon-x11-0", "window"),
)
"""On Linux; elsewhere the wheels bring all that they need."""

VIRTUAL_SCREEN = "xvfb"
"""Package of `Xvfb`, which the tests of the window draw on."""


def missing_libraries() -> tuple[SystemLibrary, ...]:
    """Those of `LIBRARIES` that the loader cannot find; empty on systems other than Linux."""
    if not sys.platform.startswith("linux"):
        return ()
    return tuple(library for library in LIBRARIES if not _loads(library.name))


def install_command(libraries: tuple[SystemLibrary, ...]) -> str:
    """The line to type on Debian and Ubuntu that installs `libraries`; empty for none."""
    return "sudo apt-get install " + " ".join(item.package for item in libraries) if libraries else ""


def _loads(name: str) -> bool:
    try:
        ctypes.CDLL(name)
    except OSError:
        return False
    return True


def main(arguments: list[str]) -> int:
    """Print the names of the missing packages on one line; with `--tests` the virtual screen's too."""
    packages = [library.package for library in missing_libraries()]
    if "--tests" in arguments and sys.platform.startswith("linux") and shutil.which("Xvfb") is None:
        packages.append(VIRTUAL_SCREEN)
    if packages:
        print(" ".join(packages))
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
