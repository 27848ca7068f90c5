"""Patterns through a solid: every point has the colour of its place in space, on sides, sections and gaps alike."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkPolyData

from workbench.app.views.textures import RINGS, Texture, pattern_image

NAME = "texturePlace"
OFFSET = 0.37
"""Of the pattern, in its cells: a flat side of a solid often lies at a round coordinate."""
LINE = 0.08
"""Half the width of the walls of a grid, in its cells."""
AMOUNTS = {
    "checkerboard": "mod(dot(floor(place), vec3(1.0)), 2.0)",
    "stripes": "mod(floor(place.x), 2.0)",
    "grid": f"1.0 - step({LINE}, min(min(aside.x, aside.y), aside.z))",
    "circles": f"step(around, {RINGS[0]}) + step({RINGS[1]}, around) * step(around, {RINGS[2]})",
}
"""How dark a pattern is at a place, as a shader says it."""
CELLS = {"checkerboard": 2.0, "stripes": 2.0, "grid": 1.0, "circles": 1.0}
"""Cells of a pattern along a side of its tile."""


class SolidTexture:
    """Colours one actor by where its points are; `lay` says where that is in the pattern."""

    def __init__(self, actor: Any, polydata: vtkPolyData) -> None:
        self._actor, self._polydata = actor, polydata
        self._places: NDArray[np.float32] = np.empty((0, 3), np.float32)
        self._data: Any = None
        self._texture: Texture | None = None

    def show(self, texture: Texture, count: int, dark: bool) -> None:
        """Draw a pattern on `count` points."""
        self.hide()
        self._texture = texture
        self._places = np.zeros((count, 3), np.float32)
        self._data = numpy_to_vtk(self._places, deep=0)
        self._data.SetName(NAME)
        self._polydata.GetPointData().AddArray(self._data)
        self._actor.GetMapper().MapDataArrayToVertexAttribute(NAME, NAME, vtkDataObject.FIELD_ASSOCIATION_POINTS, -1)
        shaders = self._actor.GetShaderProperty()
        for add, place, code in (
            (shaders.AddVertexShaderReplacement, "Dec", f"in vec3 {NAME};\nout vec3 placeVSOutput;"),
            (shaders.AddVertexShaderReplacement, "Impl", f"placeVSOutput = {NAME};"),
            # edges are drawn by way of a geometry shader, which hands on what it is told to
            (shaders.AddGeometryShaderReplacement, "Dec", "in vec3 placeVSOutput[];\nout vec3 placeGSOutput;"),
            (shaders.AddGeometryShaderReplacement, "Impl", "placeGSOutput = placeVSOutput[i];"),
            (shaders.AddFragmentShaderReplacement, "Dec", "in vec3 placeVSOutput;"),
        ):
            add(f"//VTK::Normal::{place}", True, f"//VTK::Normal::{place}\n{code}\n", False)
        colours = "//VTK::Color::Impl"
        shaders.AddFragmentShaderReplacement(colours, True, f"{colours}\n{_shading(texture, dark)}\n", False)

    def lay(self, points: NDArray[Any]) -> None:
        """Take the points (n, 3), in units of the display, on which the pattern is laid out."""
        if self._texture is not None and len(points) == len(self._places):
            cells = CELLS[self._texture.pattern]
            np.copyto(self._places, cells * self._texture.coordinates_in_space(points) + OFFSET, casting="same_kind")
            self._data.Modified()

    def hide(self) -> None:
        """Draw the actor as it was."""
        if self._texture is not None:
            self._texture = None
            self._actor.GetShaderProperty().ClearAllShaderReplacements()
            self._actor.GetMapper().RemoveVertexAttributeMapping(NAME)
            self._polydata.GetPointData().RemoveArray(NAME)


def _shading(texture: Texture, dark: bool) -> str:
    """Lines that mix the two colours of a pattern into those of the triangle."""
    tile = pattern_image("stripes", dark) / 255.0
    paper, ink = (f"vec3({', '.join(f'{part:.4f}' for part in tile[0, column])})" for column in (-1, 0))
    return (
        "{ vec3 place = placeVSOutput; vec3 aside = abs(fract(place) - 0.5); aside = 0.5 - aside;"
        " float around = length(fract(place) - 0.5);"
        f" vec3 tone = mix({paper}, {ink}, clamp({AMOUNTS[texture.pattern]}, 0.0, 1.0));"
        " diffuseColor *= tone; ambientColor *= tone; }"
    )
