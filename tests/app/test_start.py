"""What the window waits for before it is seen: nothing that takes long to import, and no plots."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

SLOW = (
    "numba",
    "scipy.sparse",
    "scipy.spatial",
    "scipy.linalg",
    "scipy.optimize",
    "pyqtgraph",
    "matplotlib",
    "pyvista",
    "sympy",
)
"""A tenth of a second and more each."""

START = """
import os, sys
os.environ["QT_API"] = "pyside6"
from workbench.app.main import make_application
application = make_application()
from workbench.app.document.engine_bridge import engine_worker
from workbench.app.main_window import MainWindow
from workbench.app.settings import Settings
from workbench.app.appearance.theme import ThemeSwitch
window = MainWindow(ThemeSwitch(application, "light"), Settings(sys.argv[1]), engine_worker)
window.show()
while not window.windowHandle().isExposed():
    application.processEvents()
window.grab()
seen = [name for name in sys.argv[2:] if name in sys.modules]
has_plots = window.histogram.place.is_made or window.convergence.place.is_made or window.inspector.widget() is not None
window.late.finish()
late = [name for name in sys.argv[2:] if name in sys.modules]
print(seen, has_plots, late, window.histogram.place.is_made and window.convergence.place.is_made)
window.close()
"""


def test_the_window_is_seen_before_what_is_slow_to_import(qapp: object, tmp_path: Path) -> None:
    call = [sys.executable, "-c", START, str(tmp_path / "settings.ini"), *SLOW]
    result = subprocess.run(call, capture_output=True, text=True, timeout=240, check=False)
    assert result.returncode == 0, result.stderr
    assert result.stdout.strip() == "[] False ['pyqtgraph'] True", "imported before, plots before, imported for plots, plots"
