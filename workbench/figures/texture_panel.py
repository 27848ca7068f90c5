"""The texture of a panel: where its triangles are in it, and the picture that it may be."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from workbench.core.arrays import Floats
from workbench.core.errors import WorkbenchError
from workbench.figures.mesh_pictures import FINER, OFF_CORNERS, Frame, texture_square, textured_picture
from workbench.figures.picture_sampling import fitting
from workbench.figures.recipe import PICTURE, Panel
from workbench.io.picture import read_picture

if TYPE_CHECKING:
    from workbench.figures.mesh_panel import Scene


def texture_places(scene: Scene) -> Floats:
    """(p, c) of all points that are drawn, as `TextureLook` has them. Raises `WorkbenchError` for a look that does not fit."""
    map, look = scene.map, scene.panel.texture
    if look is None:
        square = texture_square(map.mesh, float(map.elements.rest_measures.sum()))
        return scene.drawn(map.positions) / square + OFF_CORNERS
    points = scene.drawn(map.mesh.vertices if look.of == "source" else map.positions)
    matrix = np.array(look.matrix)
    if matrix.shape[1] != points.shape[1]:
        raise WorkbenchError(
            f"The texture of a panel is laid out in {matrix.shape[1]} coordinates, and the {look.of} has {points.shape[1]}; "
            "give its matrix as many columns."
        )
    return np.asarray(points @ matrix.T + np.array(look.offset))


def picture_of(panel: Panel) -> NDArray[np.uint8] | None:
    """The picture that lies on a panel; None for another texture. Raises `WorkbenchError` where it cannot be read."""
    if panel.colour != PICTURE:
        return None
    if panel.texture is None or not panel.texture.picture:
        raise WorkbenchError("A panel shows a picture and names none; name a PNG or JPEG in its texture.")
    return read_picture(panel.texture.picture)


class TexturedScene:
    """Draws one part after the other; places and picture are made once."""

    def __init__(self, scene: Scene, whole: Frame, picture: NDArray[np.uint8] | None) -> None:
        self._scene, self._places = scene, texture_places(scene)
        self._picture: Floats | None = None
        if picture is not None:
            density = FINER * whole.pixels[0] / (2 * whole.half[0])
            self._picture = fitting(picture, self._places, scene.points * density, scene.skin.triangles)

    def draw(self, part: Frame) -> Floats:
        """An image (h, w, 4)."""
        scene = self._scene
        return textured_picture(scene.points, scene.skin, self._places, part, scene.panel.colour, self._picture)
