"""Every quantity that views can show, each with its one colour range."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import partial

from PySide6.QtCore import QObject, Signal

from workbench.app.colour_range import ColourRange
from workbench.app.quantities import (
    FACTORS,
    LIVE_QUANTITIES,
    Quantity,
    quantity_of_distortion,
    quantity_of_formula,
)
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError


class QuantityBook(QObject):
    """Quantities by id, in the order of the lists; `listed` tells that there are others now, `range_changed` names one."""

    listed = Signal()
    range_changed = Signal(str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._quantities: dict[str, Quantity] = {q.id: q for q in (*LIVE_QUANTITIES, *FACTORS)}
        self._ranges: dict[str, ColourRange] = {}
        self._holds_all = False

    def __contains__(self, id: object) -> bool:
        return id in self._quantities

    def __getitem__(self, id: str) -> Quantity:
        return self._quantities[id]

    @property
    def quantities(self) -> tuple[Quantity, ...]:
        return tuple(self._quantities.values())

    def range_of(self, id: str) -> ColourRange:
        """The range that all views of a quantity share; made when it is wanted first."""
        if id not in self._ranges:
            made = self._ranges[id] = ColourRange(self._quantities[id])
            made.setParent(self)
            made.is_locked = self._holds_all
            made.changed.connect(partial(self.range_changed.emit, id))
        return self._ranges[id]

    def ranges(self) -> tuple[ColourRange, ...]:
        return tuple(self._ranges.values())

    def list_distortions(self, items: Iterable[Distortion]) -> None:
        """Offer these registered distortions; those that were offered before and are gone go."""
        kept = {id: q for id, q in self._quantities.items() if q.group in ("live", "factors")}
        offered = []
        for item in items:
            if item.id in kept:
                continue
            try:
                offered.append(quantity_of_distortion(item))
            except WorkbenchError:
                continue  # not one of the plane
        formulas = {id: q for id, q in self._quantities.items() if q.group == "formulas"}
        self._quantities = kept | {q.id: q for q in sorted(offered, key=lambda q: q.label.lower())} | formulas
        for id, colour_range in self._ranges.items():
            if id in self._quantities:
                colour_range.quantity = self._quantities[id]  # a formula of one's own may have been changed
        self.listed.emit()

    def add_formula(self, text: str, parameters: Mapping[str, float] | None = None) -> Quantity:
        """Offer a typed formula, too. Raises `WorkbenchError` where it is none."""
        text = text.strip()
        if text in self._quantities and not parameters:
            return self._quantities[text]
        quantity = quantity_of_formula(text, parameters)
        if quantity.id not in self._quantities:
            self._quantities[quantity.id] = quantity
            self.listed.emit()
        return self._quantities[quantity.id]

    def hold_all(self, locked: bool) -> None:
        """Keep every range as it is, also those that are not shown yet."""
        self._holds_all = locked
        for colour_range in self._ranges.values():
            colour_range.hold(locked)
