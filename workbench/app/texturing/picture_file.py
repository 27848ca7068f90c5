"""A picture that is laid over a mesh, from a file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QImage, QImageReader

from workbench.app.views.textures import Pixels
from workbench.core.errors import WorkbenchError

ENDINGS = (".png", ".jpg", ".jpeg")
FILTERS = "Pictures (*.png *.jpg *.jpeg)"
LARGEST_FILE = 64 << 20
"""Bytes of a file that is looked into at all."""
LARGEST_SIDE = 20_000
"""Pixels of a side of a picture that is decoded."""
KEPT_SIDE = 2048
"""Pixels of the longer side that are kept: more is not seen on a mesh."""
MEGABYTES = 1024
"""Memory that decoding may take."""


def is_picture(path: str) -> bool:
    """Whether a file is one by its ending."""
    return Path(path).suffix.lower() in ENDINGS


def read_picture(path: str) -> Pixels:
    """The colours (height, width, 3) of a PNG or JPEG; transparent parts are white.

    Raises `WorkbenchError` for a file that is missing, too large, or no such picture.
    """
    try:
        size = Path(path).stat().st_size
    except OSError as error:
        raise WorkbenchError(f"{path}: {error.strerror or error}; choose another picture.") from None
    if size > LARGEST_FILE:
        raise WorkbenchError(f"{path} has {size >> 20} MB, and {LARGEST_FILE >> 20} MB are the most; make the picture smaller.")
    reader = QImageReader(path)
    reader.setDecideFormatFromContent(True)
    if bytes(reader.format().data()) not in (b"png", b"jpeg"):
        raise WorkbenchError(f"{path} is no PNG and no JPEG; choose such a picture.")
    full = reader.size()
    if max(full.width(), full.height()) > LARGEST_SIDE:
        raise WorkbenchError(f"{path} has {full.width()} x {full.height()} pixels; {LARGEST_SIDE} a side are the most.")
    reader.setAutoTransform(True)
    before = QImageReader.allocationLimit()
    QImageReader.setAllocationLimit(MEGABYTES)
    try:
        if max(full.width(), full.height()) > KEPT_SIDE:
            reader.setScaledSize(full.scaled(QSize(KEPT_SIDE, KEPT_SIDE), Qt.AspectRatioMode.KeepAspectRatio))
        image = reader.read()
    finally:
        QImageReader.setAllocationLimit(before)
    if image.isNull():
        raise WorkbenchError(f"{path} cannot be read: {reader.errorString()}. Choose another picture.")
    return _pixels(image)


def _pixels(image: QImage) -> Pixels:
    image = image.convertToFormat(QImage.Format.Format_RGBA8888)
    width, height = image.width(), image.height()
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(height, image.bytesPerLine())[:, : 4 * width]
    colours = rows.reshape(height, width, 4).astype(np.uint16)
    opacity = colours[:, :, 3:]
    return ((colours[:, :, :3] * opacity + 255 * (255 - opacity)) // 255).astype(np.uint8)
