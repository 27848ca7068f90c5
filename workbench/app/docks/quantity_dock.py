"""A dock that shows one quantity, which is chosen in its title."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QDockWidget, QWidget

from workbench.app.colouring.colour_range import ColourRange
from workbench.app.docks.dock_title import DockTitle
from workbench.app.quantities.quantity_book import QuantityBook
from workbench.app.quantities.quantity_chooser import QuantityChooser
from workbench.engine.messages import Snapshot


class QuantityDock(QDockWidget):
    """`range` is that of the quantity that is shown; `quantity_changed` tells that it is another quantity.

    Subclasses say in `_show_range` what a new range or quantity means to their picture.
    """

    quantity_changed = Signal()

    def __init__(
        self, book: QuantityBook, quantity: str, title_widgets: tuple[QWidget, ...] = (), parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._book = book
        self.range = book.range_of(quantity)
        self.own_range: ColourRange | None = None
        self.chooser = QuantityChooser(book, quantity, parent=self)
        self.chooser.chosen.connect(self.show_quantity)
        self.setTitleBarWidget(DockTitle(self, self.chooser, *title_widgets))
        self._set_title()
        book.range_changed.connect(self._range_changed)

    @property
    def quantity(self) -> str:
        """Id of what is shown."""
        return self.range.quantity.id

    def show_quantity(self, id: str) -> None:
        """Show another quantity; its values come with the next snapshot."""
        self.own_range = None
        self.range = self._book.range_of(id)
        self.chooser.show_choice(id)
        self._set_title()
        self.forget_values()
        self._show_range()
        self.quantity_changed.emit()

    def set_own(self, on: bool) -> None:
        """Give the dock a range of its own, which is as the shared one at first, or take it away."""
        if on and self.own_range is None:
            self.own_range = self.range.copy(self)
            self.own_range.changed.connect(self._show_range)
        elif not on:
            self.own_range = None
        self.range = self.own_range or self._book.range_of(self.quantity)
        self._show_range()

    def values_in(self, snapshot: Snapshot) -> Any:
        """The values (m,) float32 of the quantity, None where the snapshot has none."""
        return snapshot.fields.get(self.range.quantity.field)

    def forget_values(self) -> None:
        """What was shown belongs to another quantity."""
        raise NotImplementedError

    def _show_range(self) -> None:
        raise NotImplementedError

    def _range_changed(self, id: str) -> None:
        if id == self.quantity:
            if self.own_range is not None:
                self.own_range.quantity = self._book[id]
            self._set_title()
            self._show_range()

    def _set_title(self) -> None:
        self.setWindowTitle(self.range.quantity.title)
