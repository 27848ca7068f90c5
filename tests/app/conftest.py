"""A window of its own settings for each test, and a check that nothing stays behind."""

from __future__ import annotations

import functools
import gc
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import shiboken6
from pytestqt.qtbot import QtBot

pytest.importorskip("PySide6.QtWidgets", exc_type=ImportError)

import numpy as np
from PySide6.QtCore import QEvent, QPoint, Qt
from PySide6.QtGui import QImage
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget

from tests.app.fake_engine import FakeWorker
from workbench.app.appearance.theme import ThemeSwitch
from workbench.app.document.engine_bridge import WorkerMaker
from workbench.app.inspector.body import InspectorBody
from workbench.app.main_window import MainWindow
from workbench.app.settings import Settings
from workbench.app.views.mesh_view import MeshView
from workbench.core.solid_look.look import VolumeLook
from workbench.session.session import Session

WindowMaker = Callable[..., MainWindow]


def leaked_widgets(known: frozenset[int] = frozenset()) -> list[QWidget]:
    """Top-level widgets that are alive, but those `known`, after everything that waits to be deleted is gone."""
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    QApplication.processEvents()
    found = _unowned(known)
    if found:
        del found
        gc.collect()  # in this thread: Qt's objects must not end in another one
        found = _unowned(known)
    return found


def _unowned(known: frozenset[int]) -> list[QWidget]:
    widgets = QApplication.topLevelWidgets()
    return [w for w in widgets if w.parent() is None and not w.objectName().startswith("qt_") and _address(w) not in known]


def _address(widget: QWidget) -> int:
    """Of Qt's own object: Python makes a new wrapper each time it asks."""
    return int(shiboken6.getCppPointer(widget)[0])


CHOICES = ("distortion", "distortion_parameters", "solver", "fixed_boundary", "allow_inversions", "match_area")
"""Fields of the session that a test may change."""


PATIENCE = 200_000
"""Milliseconds: whatever comes first on a machine waits for kernels that are compiled once."""


@pytest.fixture(autouse=True, scope="session")
def no_clock_runs_out() -> Iterator[None]:
    """What the window gives up, or takes for another step, after seconds: a slow machine would come to that in mid-test."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("workbench.app.handling.anchor_desk.PATIENCE", 60.0)
        patch.setattr("workbench.app.sessions.undoing.PAUSE", 60.0)
        yield


CALM = 6
"""Looks at a window in a row, between which nothing has changed its size: it will keep it."""


def pause(milliseconds: float) -> None:
    """Let the window go on, and threads beside it, from whom `QTest.qWait` would keep the interpreter."""
    until = time.monotonic() + 1e-3 * milliseconds
    while True:
        QApplication.processEvents()
        if time.monotonic() >= until:
            return
        time.sleep(0.002)


@pytest.fixture
def qtbot(qtbot: QtBot) -> QtBot:
    """That of pytest-qt, with patience: a wait that is over early costs nothing."""
    qtbot.waitUntil = functools.partial(qtbot.waitUntil, timeout=PATIENCE)
    qtbot.waitSignal = functools.partial(qtbot.waitSignal, timeout=PATIENCE)
    return qtbot


@pytest.fixture(autouse=True)
def nothing_leaks(qapp: QApplication) -> Iterator[None]:
    """Fail where a test leaves a top-level widget: it would crash a later test, far from its cause."""
    before = frozenset(_address(w) for w in _unowned(frozenset()))
    yield
    leaked = leaked_widgets(before)
    assert not leaked, f"top-level widgets were left behind: {leaked}"


def new_window(settings: Path, make_worker: WorkerMaker, theme: str) -> MainWindow:
    """A window that is shown and active, with nothing open."""
    application = QApplication.instance()
    assert isinstance(application, QApplication)
    application.setStyle("Fusion")
    window = MainWindow(ThemeSwitch(application, theme), Settings(settings), make_worker)
    window.resize(1200, 800)
    window.show()
    window.late.finish()  # some of it would be taken for what a test has left behind
    window.activateWindow()  # keys go to the active window only
    QTest.qWaitForWindowActive(window)
    return window


def end_window(window: MainWindow) -> None:
    window.close()
    window.deleteLater()
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    del window
    gc.collect()  # in this thread: Qt's objects must not end in that of the next engine


@pytest.fixture
def make_window(tmp_path: Path) -> Iterator[WindowMaker]:
    """Windows with a settings file of the test's own; closed and deleted at the end."""
    windows: list[MainWindow] = []

    def make(make_worker: WorkerMaker = FakeWorker, theme: str = "light", source: str = "grid") -> MainWindow:
        window = new_window(tmp_path / "window.ini", make_worker, theme)
        windows.append(window)
        window.start(source)
        return window

    yield make
    for window in windows:
        if shiboken6.isValid(window):
            end_window(window)


@pytest.fixture(scope="module")
def kept_window(qapp: QApplication, tmp_path_factory: pytest.TempPathFactory) -> Iterator[MainWindow]:
    """One window for the tests of a module: making one takes a second without a graphics card."""
    window = new_window(tmp_path_factory.mktemp("settings") / "window.ini", FakeWorker, "light")
    window.bridge.start()
    window._finder.begin()  # it would wait for a map
    while not window.panel.solver.combo.count():  # until the methods are listed the panel changes its width
        pause(5)
    sizes = [window.target.view.size()]
    while len(sizes) < CALM or any(size != sizes[-1] for size in sizes[-CALM:]):  # it takes the new one when there is time
        pause(25)
        sizes.append(window.target.view.size())
    yield window
    end_window(window)


@pytest.fixture(scope="module")
def kept_inspector(kept_window: MainWindow) -> InspectorBody:
    """The pages of that window's inspector, for modules that show it."""
    return kept_window.inspector.body


@pytest.fixture
def window(kept_window: MainWindow, qtbot: QtBot) -> MainWindow:
    """A window with the grid of the fake engine in it, freshly opened."""
    kept_window.activateWindow()
    QTest.qWaitForWindowActive(kept_window)
    worker = kept_window.bridge._worker
    worker.commands.clear()
    kept_window.document.choose(**{f: getattr(Session(), f) for f in CHOICES})
    kept_window.open("grid")
    qtbot.waitUntil(lambda: kept_window.document.positions is not None and not kept_window.document.opening_source)
    qtbot.waitUntil(lambda: kept_window.target.view.geometry_shown is not None)
    pause(30)
    kept_window.error_bar.dismiss()
    kept_window.commands.fit()
    worker.commands.clear()
    return kept_window


@pytest.fixture
def solid_window(window: MainWindow, qtbot: QtBot) -> MainWindow:
    """The window with a solid in it."""
    window.open("solid")
    qtbot.waitUntil(lambda: window.document.kind == "volume" and window.document.positions is not None)
    qtbot.waitUntil(lambda: window.target.view.geometry_shown is not None)
    pause(30)
    window.volume.choose(**vars(VolumeLook()))  # whatever the test before looked at
    window.commands.fit()
    return window


def pixel_of(view: MeshView, vertex: int) -> QPoint:
    """Where a vertex is drawn."""
    geometry = view.geometry_shown
    assert geometry is not None
    x, y = view.project(geometry.points[[vertex]])[0]
    return QPoint(round(x), round(y))


def pixels_of(view: MeshView) -> np.ndarray:
    """Colours (height, width, 3) of what a view shows, with its anchors."""
    image = view.picture().toImage().convertToFormat(QImage.Format.Format_RGB888)
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    return rows[:, : 3 * image.width()].reshape(image.height(), image.width(), 3).astype(int)


class Hand:
    """A mouse over one view."""

    def __init__(self, view: MeshView) -> None:
        self.view = view

    def move(self, where: QPoint) -> None:
        QTest.mouseMove(self.view.overlay, where)

    def click(self, where: QPoint, button: Qt.MouseButton = Qt.MouseButton.LeftButton) -> None:
        self.move(where)
        QTest.mouseClick(self.view.overlay, button, Qt.KeyboardModifier.NoModifier, where)

    def press(self, where: QPoint, button: Qt.MouseButton = Qt.MouseButton.LeftButton) -> None:
        QTest.mousePress(self.view.overlay, button, Qt.KeyboardModifier.NoModifier, where)

    def release(self, where: QPoint, button: Qt.MouseButton = Qt.MouseButton.LeftButton) -> None:
        QTest.mouseRelease(self.view.overlay, button, Qt.KeyboardModifier.NoModifier, where)

    def drag(self, begin: QPoint, end: QPoint, button: Qt.MouseButton = Qt.MouseButton.LeftButton, steps: int = 8) -> None:
        self.press(begin, button)
        for step in range(1, steps + 1):
            self.move(begin + (end - begin) * step / steps)
            pause(20)
        self.release(end, button)
