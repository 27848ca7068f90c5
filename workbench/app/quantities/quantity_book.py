"""Every quantity that views can show, each with its one colour range."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from contextlib import suppress
from functools import partial

from PySide6.QtCore import QObject, Signal

from workbench.app.colouring.colour_range import ColourRange
from workbench.app.quantities.quantities import (
    IN_FORCE,
    Quantity,
    factors,
    live_quantities,
    quantity_in_force,
    quantity_of_distortion,
    quantity_of_formula,
)
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError


class QuantityBook(QObject):
    """Quantities by id, in the order of the lists; `listed` tells that there are others now, `range_changed` names one.

    A formula of one's own that is shown may be renamed or deleted: `replaced` then names what to show in its place.
    """

    listed = Signal()
    replaced = Signal(str, str)
    range_changed = Signal(str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.dimension = 2
        self._quantities: dict[str, Quantity] = {q.id: q for q in (IN_FORCE, *live_quantities(2), *factors(2))}
        self._offered: tuple[list[Distortion], Container[str]] = ([], ())
        self._ranges: dict[str, ColourRange] = {}
        self._own: dict[str, Distortion] = {}
        self._holds_all = False
        self._chosen: tuple[str, dict[str, float]] | None = None
        self.is_listed = False

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

    def set_dimension(self, dimension: int) -> None:
        """Triangles (2) or tetrahedra (3): what can be shown of them, and where its colours begin."""
        if dimension == self.dimension:
            return
        self.dimension = dimension
        typed = [q for q in self._quantities.values() if q.group == "typed"]
        in_force, chosen = self._quantities[IN_FORCE.id], self._chosen
        self._quantities = {q.id: q for q in (in_force, *live_quantities(dimension), *factors(dimension))}
        for quantity in typed:
            with suppress(WorkbenchError):  # one that this dimension does not have
                same = quantity_of_formula(quantity.text, dict(quantity.parameters), dimension)
                self._quantities[same.id] = same
        if self.is_listed:
            self.list_distortions(*self._offered)
        else:
            self._redefine_all()
            self.listed.emit()
        if chosen is not None:
            self._chosen = None
            self.set_in_force(*chosen)
        for id in [id for id in self._ranges if id not in self._quantities]:
            self.replaced.emit(id, IN_FORCE.id)

    def list_distortions(self, items: Iterable[Distortion], own: Container[str] = ()) -> None:
        """Offer these registered distortions, those whose ids are in `own` by themselves; others offered before go."""
        items = list(items)
        self._offered = (items, own)
        fixed = {id: q for id, q in self._quantities.items() if q.group in ("in force", "live", "factors")}
        offered = []
        before, self._own = self._own, {}
        for item in items:
            if item.id in fixed:
                continue
            if item.id in own:
                self._own[item.id] = item
            try:
                offered.append(quantity_of_distortion(item, "own" if item.id in own else "distortions", self.dimension))
            except WorkbenchError:
                continue  # not one of this dimension
        offered.sort(key=lambda q: (q.group, q.label.lower()))
        typed = {id: q for id, q in self._quantities.items() if q.group == "typed"}
        self._quantities = fixed | {q.id: q for q in offered} | typed
        self._redefine_all()  # a formula of one's own may have been changed
        self.is_listed = True
        self._chosen = None
        heirs = [(id, self._heir(item)) for id, item in before.items() if id in self._ranges and id not in self._quantities]
        self.listed.emit()
        for id, heir in heirs:
            if heir is not None:
                self.replaced.emit(id, heir)

    def _heir(self, item: Distortion) -> str | None:
        """What is left of a formula of one's own: the same by another name, else its text as if it were typed."""
        for id, other in self._own.items():
            is_same = (other.formula, other.parameter_values) == (item.formula, item.parameter_values)
            if is_same and id in self._quantities:
                return id
        try:
            quantity = quantity_of_formula(item.formula, item.parameter_values, self.dimension)
        except WorkbenchError:
            return None  # it names a formula that is gone, too
        self._quantities.setdefault(quantity.id, quantity)
        return quantity.id

    def set_in_force(self, text: str, parameters: Mapping[str, float]) -> None:
        """The distortion that is minimised is another one, or has other parameters."""
        chosen = (text, dict(parameters))
        if chosen == self._chosen:
            return
        self._chosen = chosen
        try:
            quantity = quantity_in_force(text, parameters, self.dimension)
        except WorkbenchError:
            return  # whoever chose it is told
        if quantity != self._quantities[IN_FORCE.id]:
            is_other = quantity.title != self._quantities[IN_FORCE.id].title
            self._quantities[IN_FORCE.id] = quantity
            if IN_FORCE.id in self._ranges:
                self._redefine(quantity)
            if is_other:
                self.listed.emit()

    def _redefine_all(self) -> None:
        for id in self._ranges:
            if id in self._quantities:
                self._redefine(self._quantities[id])

    def _redefine(self, quantity: Quantity) -> None:
        """The same id stands for something else: its range keeps what the user chose, and is fitted anew."""
        colour_range = self._ranges[quantity.id]
        if colour_range.quantity != quantity:
            colour_range.quantity = quantity
            colour_range.forget()
            colour_range.changed.emit()

    def add_formula(self, text: str, parameters: Mapping[str, float] | None = None) -> Quantity:
        """Offer a typed formula, too. Raises `WorkbenchError` where it is none."""
        text = text.strip()
        if text in self._quantities and not parameters:
            return self._quantities[text]
        quantity = quantity_of_formula(text, parameters, self.dimension)
        if quantity.id not in self._quantities:
            self._quantities[quantity.id] = quantity
            self.listed.emit()
        return self._quantities[quantity.id]

    def hold_all(self, locked: bool) -> None:
        """Keep every range as it is, also those that are not shown yet."""
        self._holds_all = locked
        for colour_range in self._ranges.values():
            colour_range.hold(locked)
