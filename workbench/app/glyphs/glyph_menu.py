"""The menu of glyphs: which, how many, how large, where."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtGui import QAction, QActionGroup
from PySide6.QtWidgets import QMenu

from workbench.app.glyphs.glyphs import KINDS, LARGEST, PLACES, Glyphs

STEP = 1.5
"""Factor of one step to more, or to larger ones."""


class GlyphMenu:
    """Actions of the window as a menu; their ticks follow what is chosen."""

    def __init__(self, glyphs: Glyphs, actions: Mapping[str, QAction], menu: QMenu) -> None:
        self._glyphs = glyphs
        self._kinds = {kind: actions[f"glyphs-{kind}"] for kind in KINDS}
        self._places = {place: actions[f"glyphs-on-{place}"] for place in PLACES}
        group = QActionGroup(menu)
        for kind, action in self._kinds.items():
            group.addAction(action)
            menu.addAction(action)
            action.triggered.connect(lambda _=False, k=kind: glyphs.choose(kind=k))
        menu.addSeparator()
        for place, action in self._places.items():
            menu.addAction(action)
            action.triggered.connect(lambda on, p=place: self._show_on(p, on))
        menu.addSeparator()
        self._amounts: list[QAction] = []
        for name, field, factor in (
            ("glyphs-more", "number", STEP),
            ("glyphs-fewer", "number", 1 / STEP),
            ("glyphs-larger", "size", STEP),
            ("glyphs-smaller", "size", 1 / STEP),
        ):
            menu.addAction(actions[name])
            self._amounts.append(actions[name])
            actions[name].triggered.connect(lambda _=False, f=field, by=factor: self._scale(f, by))
        glyphs.changed.connect(self._show)
        self._show()

    def _show_on(self, place: str, on: bool) -> None:
        chosen = set(self._glyphs.choice.places)
        chosen ^= {place} if (place in chosen) != on else set()
        self._glyphs.choose(places=tuple(name for name in PLACES if name in chosen))

    def _scale(self, field: str, factor: float) -> None:
        value = getattr(self._glyphs.choice, field) * factor
        self._glyphs.choose(**{field: min(max(value, 1 / LARGEST), LARGEST)})

    def _show(self) -> None:
        for kind, action in self._kinds.items():
            action.setChecked(kind == self._glyphs.choice.kind)
        for action in self._amounts:
            action.setEnabled(self._glyphs.choice.kind != "none")
        for place, action in self._places.items():
            action.setChecked(place in self._glyphs.choice.places)
