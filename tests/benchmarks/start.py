"""From the command to a window that can be used, beside a bare window of Qt with one view of VTK in the same run.

    python -m tests.benchmarks.start [ROUNDS]

A line a round: seconds until the window is painted, until the first map is drawn in it, until every method is listed; the
window's own processor time until the map; then the same for a window with a plane in pyvistaqt's widget. The first round may
compile; it is marked. The two take turns, so that what else the machine does is shared. The engine's process works beside.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from tests.benchmarks._screen import screen

ROUNDS = 3
PATIENCE = 120

OURS = """
import resource, sys, time
begin = float(sys.argv[1])
from workbench.app.main import make_application, run_window
make_application()
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication
seen = {}
def look():
    windows = [w for w in QApplication.topLevelWidgets() if type(w).__name__ == "MainWindow"]
    for window in windows:
        view = window.target.view
        for name, holds in (
            ("painted", window.isVisible() and window.windowHandle() is not None and window.windowHandle().isExposed()),
            ("map", window.document.positions is not None and view.geometry_shown is not None),
            ("methods", window.panel.solver.combo.count() > 0),
        ):
            if holds and name not in seen:
                seen[name] = time.time() - begin
                if name == "map":
                    used = resource.getrusage(resource.RUSAGE_SELF)
                    seen["cpu"] = used.ru_utime + used.ru_stime
        if len(seen) == 4:
            print(*(f"{seen[name]:.2f}" for name in ("painted", "map", "methods", "cpu")), flush=True)
            timer.stop()
            window.close()
timer = QTimer()
timer.timeout.connect(look)
timer.start(5)
run_window(None, settings_file=sys.argv[2])
"""

BARE = """
import os, resource, sys, time
os.environ["QT_API"] = "pyside6"
begin = float(sys.argv[1])
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication, QMainWindow
application = QApplication([])
import pyvista
from pyvistaqt import QtInteractor
window = QMainWindow()
view = QtInteractor(window, auto_update=False, multi_samples=0)
window.setCentralWidget(view)
window.resize(1560, 940)
view.add_mesh(pyvista.Plane())
window.show()
def look():
    if window.windowHandle().isExposed():
        used = resource.getrusage(resource.RUSAGE_SELF)
        print(f"{time.time() - begin:.2f} {used.ru_utime + used.ru_stime:.2f}", flush=True)
        view.close()
        application.quit()
    else:
        QTimer.singleShot(5, look)
QTimer.singleShot(0, lambda: QTimer.singleShot(0, look))
application.exec()
"""


def seconds(code: str, folder: Path) -> list[str]:
    """What a program prints that is told when it was begun and where its settings are."""
    environment = {**os.environ, "XDG_DATA_HOME": str(folder / "data"), "XDG_STATE_HOME": str(folder / "state")}
    call = [sys.executable, "-c", code, str(time.time()), str(folder / "settings.ini")]
    result = subprocess.run(call, capture_output=True, text=True, env=environment, timeout=PATIENCE, check=False)
    if result.returncode or not result.stdout:
        raise RuntimeError(result.stderr[-2000:])
    return result.stdout.split()


def main(arguments: list[str]) -> None:
    """One line a round."""
    rounds = int(arguments[0]) if arguments else ROUNDS
    with screen() as is_there, tempfile.TemporaryDirectory() as folder:
        for number in range(rounds + 1 if is_there else 0):
            painted, drawn, methods, used = seconds(OURS, Path(folder))
            bare, bare_used = seconds(BARE, Path(folder))
            print(
                f"{'first: ' if not number else ''}painted {painted} s, map {drawn} s, methods {methods} s, "
                f"processor {used} s;  bare window {bare} s, processor {bare_used} s",
                flush=True,
            )


if __name__ == "__main__":
    main(sys.argv[1:])
