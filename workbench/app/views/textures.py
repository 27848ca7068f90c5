"""Pictures that are repeated over the source at the map's positions."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkRenderingCore import vtkTexture

Pattern = Literal["checkerboard", "grid", "plain"]
PATTERNS: tuple[Pattern, ...] = ("checkerboard", "grid", "plain")
TILES_ACROSS = 14.0
"""Repetitions of the pattern along the diameter of the map."""


def pattern_image(pattern: Pattern, dark: bool) -> NDArray[np.uint8]:
    """One tile (64, 64, 3) of a pattern: two by two fields of a board, or one cell of a grid."""
    size = 64
    paper, ink = ((58, 66, 76), (118, 132, 148)) if dark else ((250, 251, 252), (150, 166, 186))
    image = np.empty((size, size, 3), np.uint8)
    image[:] = paper
    row, column = np.indices((size, size))
    if pattern == "checkerboard":
        image[(row < size // 2) != (column < size // 2)] = ink
    elif pattern == "grid":
        line = 4
        image[(row < line) | (column < line)] = ink
        middle = size // 2
        image[(row == middle) | (column == middle)] = ink
    return image


def pattern_texture(pattern: Pattern, dark: bool, fine: bool) -> vtkTexture:
    """A VTK texture that repeats; `fine` filters it when it is far away, which costs much without a graphics card."""
    image = pattern_image(pattern, dark)
    data = vtkImageData()
    data.SetDimensions(image.shape[1], image.shape[0], 1)
    data.GetPointData().SetScalars(numpy_to_vtk(image.reshape(-1, 3), deep=1))
    texture = vtkTexture()
    texture.SetInputData(data)
    texture.RepeatOn()
    texture.InterpolateOn()
    texture.SetMipmap(fine)
    return texture
