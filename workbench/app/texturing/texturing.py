"""How patterns lie on the views of the window, and which picture is one of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any
from weakref import ref

import numpy as np
from PySide6.QtCore import QObject, Signal

from workbench.app.texturing.squares import squares_of
from workbench.app.views.camera import Points
from workbench.app.views.geometry import DisplayFrame, Geometry
from workbench.app.views.mesh_view import MeshView
from workbench.app.views.textures import Pattern, Pixels, Texture
from workbench.core.errors import WorkbenchError
from workbench.figures.recipe import TextureLook
from workbench.io.picture import read_picture

OTHER_SIZE = 1.8
"""Factor of the size of a map from which on the pattern is fitted to it anew: until then it does not swim."""
LARGEST = 20.0
"""Factor of the usual size up to which tiles can be chosen; the inverse is the smallest."""


@dataclass(frozen=True)
class PatternLayout:
    """How patterns lie: `size` and `degrees` as in `Texture`, `of_source` where they are laid out in the source.

    With `of_unit` a picture lies on u and v from 0 to 1 of a map, as in programs that draw textures.
    """

    size: float = 1.0
    degrees: float = 0.0
    of_source: bool = False
    of_unit: bool = False
    picture: str = ""


class Texturing(QObject):
    """One layout for all views, so that a place of the source and its image carry the same mark."""

    changed = Signal()

    def __init__(self, source: MeshView, target: MeshView, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._source, self._target = source, target
        self.layout = PatternLayout()
        self._picture: Pixels | None = None
        self._centre, self._unit = np.zeros(3, np.float32), 1.0
        self._fitted: ref[Geometry] | None = None

    @property
    def has_picture(self) -> bool:
        return self._picture is not None

    def choose(self, **changes: Any) -> None:
        """Other values of the layout, all but the picture."""
        layout = replace(self.layout, **changes)
        if layout != self.layout:
            self.layout = layout
            self.changed.emit()

    def take_picture(self, path: str) -> None:
        """Take the picture of a file. Raises `WorkbenchError` where it is none."""
        self._picture = read_picture(path)
        self.layout = replace(self.layout, picture=path)
        self.changed.emit()

    def texture(self, pattern: Pattern) -> Texture:
        """A pattern as it lies on every view."""
        layout = self.layout
        lies_on_unit = layout.of_unit and not layout.of_source and pattern == "picture"
        points = self._unit_points if lies_on_unit else self._points
        return Texture(pattern, layout.size, layout.degrees, self._picture, lies_on_unit, points)

    def _points(self) -> Points | None:
        """Points of the source or the map, about the middle, in units of their diameter.

        A surface in space has no flat place of its own: there it is always the map.
        """
        geometry = self._basis()
        return None if geometry is None else self._placed(geometry.points)

    def _basis(self) -> Geometry | None:
        """What the pattern is laid out in."""
        source, target = self._source.geometry_shown, self._target.geometry_shown
        if source is None or target is None:
            return None
        if self._is_of(source):
            return source
        self._fit(target)
        return target

    def _is_of(self, source: Geometry) -> bool:
        is_surface = source.simplices.shape[1] == 3 and not source.is_flat
        return self.layout.of_source and not is_surface

    def _placed(self, points: Points) -> Points:
        """Points of that in units of its diameter."""
        source = self._source.geometry_shown
        if source is not None and self._is_of(source):
            return points
        return np.asarray((points - self._centre) / np.float32(self._unit))

    def _unit_points(self) -> Points | None:
        """Points of the map about the middle of the square from 0 to 1, in its own units; a solid has no such square."""
        target = self._target.geometry_shown
        if target is None or not target.is_flat:
            return self._points()
        return _in_unit_square(target.points, target.frame)

    def look(self, pattern: Pattern) -> TextureLook | None:
        """The same on paper: how a point of the mesh comes to its place in the pattern; None while there is no mesh."""
        geometry = self._basis()
        if geometry is None:
            return None
        texture, frame = self.texture(pattern), geometry.frame
        count = len(frame.centre)
        probes = frame.to_display(frame.centre + np.vstack([np.zeros(count), np.eye(count) / frame.scale])).astype(np.float32)
        points = _in_unit_square(probes, frame) if texture.fills and geometry.is_flat else self._placed(probes)
        is_through = geometry.simplices.shape[1] == 4 and not texture.is_picture
        places = squares_of(texture, points, is_through=is_through)
        matrix = (places[1:] - places[0]).T * frame.scale
        return TextureLook(
            of="source" if geometry is self._source.geometry_shown else "map",
            matrix=tuple(map(tuple, matrix.tolist())),
            offset=tuple((places[0] - matrix @ frame.centre).tolist()),
            picture=self.layout.picture if texture.is_picture else "",
        )

    def _fit(self, target: Geometry) -> None:
        """Another mesh is displayed about a middle of its own, and a start may be far from the map before it in size."""
        points, is_other = target.points, self._fitted is None or self._fitted() is not target
        self._fitted = ref(target)
        low, high = (np.array([end(column) for column in points.T]) for end in (np.min, np.max))
        diameter = float(np.linalg.norm(high - low))
        if diameter > 0 and (is_other or not 1.0 / OTHER_SIZE < diameter / self._unit < OTHER_SIZE):
            self._centre, self._unit = (0.5 * (low + high)).astype(np.float32), diameter

    # ------------------------------------------------------------------------------------------ memory

    def kept(self) -> dict[str, Any]:
        """What differs from the usual layout and is there again at the next start, as plain values."""
        usual = vars(PatternLayout())
        return {name: value for name, value in vars(self.layout).items() if value != usual[name]}

    def take_kept(self, kept: Mapping[str, Any]) -> None:
        """Take up what `kept` gave; values of another kind, and a picture that is gone, are passed over."""
        path = kept.get("picture")
        self.choose(
            size=number_within(kept.get("size"), 1.0 / LARGEST, LARGEST, 1.0),
            degrees=number_within(kept.get("degrees"), -360.0, 360.0, 0.0),
            of_source=kept.get("of_source") is True,
            of_unit=kept.get("of_unit") is True,
        )
        if isinstance(path, str) and path:
            try:
                self.take_picture(path)
            except WorkbenchError:
                return


def _in_unit_square(points: Points, frame: DisplayFrame) -> Points:
    """Points of the display in the units of the mesh, about the middle of the square from 0 to 1."""
    placed = np.zeros_like(points)
    placed[:, :2] = points[:, :2] / frame.scale + (frame.centre - 0.5)
    return placed


def number_within(value: object, low: float, high: float, otherwise: float) -> float:
    """A kept number, where it is one within bounds."""
    is_number = isinstance(value, int | float) and not isinstance(value, bool) and low <= value <= high
    return float(value) if is_number else otherwise  # type: ignore[arg-type]
