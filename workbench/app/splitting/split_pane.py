"""A view that a user has split off: of the source or of the target, chosen in its title line."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.quantities.quantity_book import QuantityBook
from workbench.app.views.pane import ViewPane

SIDES = {"source": "Source", "target": "Target", "carried": "Carried surface"}
"""What a pane can show: the mesh as it was opened, the map, or what the map of a solid carries, without the solid."""

NARROW, NARROWEST = 210, 132
"""Pixels below which one of the two lists gives way, and width at least."""


class SplitPane(ViewPane):
    """As the two views of the window, with a list in the place of the title; `side_chosen` carries an id of `SIDES`."""

    side_chosen = Signal(str)

    def __init__(
        self, name: str, side: str, styles: Mapping[str, str], book: QuantityBook, theme: Theme, parent: QWidget | None = None
    ) -> None:
        """`name` tells it from other leaves of a layout; `styles` are the patterns that this side offers: id -> label."""
        super().__init__(SIDES[side], dict(styles), book, theme, parent)
        self.setObjectName(name)
        self.side = side
        self.set_theme(theme)
        self.sides = QComboBox(self.header)
        for id, label in SIDES.items():
            self.sides.addItem(label, id)
        self.sides.setCurrentIndex(self.sides.findData(side))
        self.sides.setToolTip("What this view shows: the mesh as it was opened, the map, or the carried surface alone")
        self.sides.activated.connect(lambda row: self.side_chosen.emit(str(self.sides.itemData(row))))
        layout = self.header.layout()
        assert isinstance(layout, QHBoxLayout)
        layout.replaceWidget(self.name, self.sides)
        self.name.hide()
        self.chooser.setMinimumContentsLength(10)
        self.chooser.setMinimumWidth(60)
        self.setMinimumWidth(NARROWEST)
        self.chooser.setVisible(not self.shows_carried_alone)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """Where it is narrow, what it shows stands without its side."""
        self.sides.setVisible(event.size().width() >= NARROW or self.shows_carried_alone)
        super().resizeEvent(event)

    @property
    def is_source(self) -> bool:
        return self.side == "source"

    @property
    def shows_carried_alone(self) -> bool:
        """Whether the solid itself is left out."""
        return self.side == "carried"
