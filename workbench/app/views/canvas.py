"""Where VTK draws: through the graphics card into the window, or into memory where there is none.

With a graphics card pyvistaqt's widget is used: nothing leaves the card. Without one, Qt would put the whole window
together in software for every picture (20 ms and more at 1600 x 1000); then each view is drawn into memory and only
its own rectangle is copied (a few ms).
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from functools import lru_cache
from math import ceil
from typing import Any, Protocol

import numpy as np
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  registers the OpenGL classes behind vtkRenderWindow
from numpy.typing import NDArray
from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor, QImage, QOffscreenSurface, QOpenGLContext, QPainter, QPaintEvent, QTransform
from PySide6.QtWidgets import QApplication, QVBoxLayout, QWidget
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkUnsignedCharArray
from vtkmodules.vtkRenderingCore import vtkLight, vtkRenderer, vtkRenderWindow

SOFTWARE = ("llvmpipe", "softpipe", "swrast", "swiftshader", "software", "gdi generic", "basic render")
GL_RENDERER = 0x1F01
CHOICE = "WORKBENCH_DRAWING"
"""Environment variable: `memory` or `card` decides, anything else leaves it to the program."""


Painter = Callable[[int, int], NDArray[np.uint32] | None]


class Canvas(Protocol):
    """A widget with one VTK renderer; `drawn` tells that a picture is on its way to the screen.

    `seconds` is what the last drawing took of this thread's time. `painter`, where there is one, draws in place of VTK:
    for a width and a height it returns pixels, rows from below, or None to leave that picture to VTK.
    """

    drawn: Any
    renderer: Any
    seconds: float
    painter: Painter | None

    def draw_again(self) -> None: ...
    def draw_now(self) -> None: ...
    def close_canvas(self) -> None: ...


class MemoryCanvas(QWidget):
    """Draws off screen and paints the picture; between changes the last picture is kept."""

    drawn = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self.renderer = vtkRenderer()
        self.renderer.SetBackgroundAlpha(1.0)  # else pictures of the view alone are seen through
        self.renderer.AddLight(_headlight())
        self._window: Any = vtkRenderWindow()
        self._window.SetOffScreenRendering(True)
        self._window.SetMultiSamples(0)
        self._window.AddRenderer(self.renderer)
        self._pixels = vtkUnsignedCharArray()
        self._image: QImage | None = None
        self._is_stale = True
        self.seconds = 0.0
        self.painter: Painter | None = None

    def draw_again(self) -> None:
        self._is_stale = True
        self.update()

    def draw_now(self) -> None:
        """What waits to be drawn, in a pass of its own."""
        if self._is_stale:
            self.repaint()

    def paintEvent(self, event: QPaintEvent) -> None:
        ratio = self.devicePixelRatioF()
        # where the screen is scaled by a fraction the last row and column are begun pixels: unpainted they would be black
        width, height = max(ceil(self.width() * ratio), 1), max(ceil(self.height() * ratio), 1)
        image = self._image
        if self._window is not None and (self._is_stale or image is None or image.size().toTuple() != (width, height)):
            begin = time.perf_counter()
            image = self._image = self._draw(width, height)
            self.seconds = time.perf_counter() - begin
            self._is_stale = False
        if image is None:
            return
        painter = QPainter(self)
        # VTK counts rows from below
        painter.setTransform(QTransform(1.0 / ratio, 0.0, 0.0, -1.0 / ratio, 0.0, height / ratio))
        painter.drawImage(0, 0, image)
        painter.end()
        self.drawn.emit()

    def _draw(self, width: int, height: int) -> QImage:
        memory = self.painter(width, height) if self.painter is not None else None
        if memory is None and not self.renderer.GetViewProps().GetNumberOfItems():
            return self._blank(width, height)
        if memory is None:
            self._window.SetSize(width, height)
            self._window.Render()
            self._window.GetRGBACharPixelData(0, 0, width - 1, height - 1, 0, self._pixels)
            memory = vtk_to_numpy(self._pixels)
        return QImage(memory.data, width, height, 4 * width, QImage.Format.Format_RGBX8888)

    def _blank(self, width: int, height: int) -> QImage:
        """The background alone, without VTK: the first picture of a window waits for five of these."""
        image = QImage(width, height, QImage.Format.Format_RGBX8888)
        image.fill(QColor.fromRgbF(*self.renderer.GetBackground()))
        return image

    def close_canvas(self) -> None:
        window, self._window = self._window, None
        if window is not None:
            self._image = None
            self.renderer.RemoveAllViewProps()
            window.Finalize()


class CardCanvas(QWidget):
    """pyvistaqt's interactor, composed; it draws through Qt's own OpenGL context."""

    drawn = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        from pyvistaqt import QtInteractor  # late: it takes a second to import, and is not always needed

        self.plotter = QtInteractor(self, auto_update=False, multi_samples=0)
        self.plotter.setAcceptDrops(False)  # files that are dropped go to the window
        self.plotter.reset_key_events()
        self.plotter.remove_all_lights()
        self.renderer: Any = self.plotter.renderer
        self.renderer.AddLight(_headlight())
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.plotter)
        self.plotter.frameSwapped.connect(self.drawn)
        self.seconds = 0.0  # what the card does goes on beside us
        self.painter: Painter | None = None  # not asked: the card is quicker
        self._is_closed = False

    def draw_again(self) -> None:
        # not `plotter.render`, which draws twice
        if not self._is_closed:
            self.plotter.update()

    def draw_now(self) -> None:
        """The card draws when it is its turn."""

    def close_canvas(self) -> None:
        if not self._is_closed:
            self._is_closed = True
            self.plotter.close()


def _headlight() -> vtkLight:
    light = vtkLight()
    light.SetLightTypeToHeadlight()
    return light


def make_canvas(parent: QWidget) -> MemoryCanvas | CardCanvas:
    """The canvas that is quicker here."""
    return CardCanvas(parent) if draws_with_card() else MemoryCanvas(parent)


@lru_cache(maxsize=1)
def draws_with_card() -> bool:
    """Whether Qt has OpenGL by a graphics card; asked once."""
    choice = os.environ.get(CHOICE, "")
    if choice in ("memory", "card"):
        return choice == "card"
    if QApplication.platformName() == "offscreen":
        return False
    name = graphics_name().lower()
    return bool(name) and not any(word in name for word in SOFTWARE)


def graphics_name() -> str:
    """What OpenGL calls itself here; empty where there is none."""
    context = QOpenGLContext()
    if not context.create():
        return ""
    surface = QOffscreenSurface()
    surface.setFormat(context.format())
    surface.create()
    if not context.makeCurrent(surface):
        return ""
    try:
        return str(context.functions().glGetString(GL_RENDERER) or "")
    finally:
        context.doneCurrent()
        surface.destroy()
