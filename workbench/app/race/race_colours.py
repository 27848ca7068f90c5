"""One colour scale for all views of a race: a quantity of each map, or how each map differs from a chosen one."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from PySide6.QtCore import QObject, QTimer, Signal

from workbench.app.colouring.colour_range import ColourRange
from workbench.app.quantities.quantities import Quantity
from workbench.app.quantities.quantity_book import QuantityBook
from workbench.app.race.difference import aligned, difference_to, displacement_from, displacements
from workbench.app.race.race_model import RaceModel

Mode = Literal["own", "displacement", "difference"]
FIT_INTERVAL = 250
"""Milliseconds between two fits of the range."""


class RaceColours(QObject):
    """Values and range; `restyled` tells that all views have other colours, `fitted` that there are new values."""

    restyled = Signal()
    fitted = Signal()

    def __init__(self, model: RaceModel, book: QuantityBook, quantity: str, parent: QObject) -> None:
        super().__init__(parent)
        self._model = model
        self._book = book
        self.mode: Mode = "own"
        self.reference = 0
        self.quantity = book[quantity]
        self.range = self._new_range()
        self.values = np.empty(0, np.float32)
        self._fit_timer = QTimer(self)
        self._fit_timer.setSingleShot(True)
        self._fit_timer.setInterval(FIT_INTERVAL)
        self._fit_timer.timeout.connect(self.fit)
        model.map_changed.connect(self._map_changed)

    # ------------------------------------------------------------------------------------------ choices

    def show_quantity(self, id: str) -> None:
        """Colour by another quantity; its values come with the next frames."""
        self.quantity = self._book[id]
        self._model.watch([self.quantity])
        self._restyle()

    def show_mode(self, mode: Mode, reference: int) -> None:
        """Colour by each map's own values, or by how it differs from the map of contestant `reference`."""
        if (mode, reference) != (self.mode, self.reference):
            self.mode, self.reference = mode, reference
            self._restyle()

    def begin_anew(self) -> None:
        """Others race now."""
        self._restyle()

    def is_plain(self, index: int) -> bool:
        """Whether a contestant has no colours: the one that the others are compared with."""
        return self.mode != "own" and index == self.reference

    def stop(self) -> None:
        self._fit_timer.stop()

    def _restyle(self) -> None:
        self.range = self._new_range()
        self.restyled.emit()
        self.fit()

    def _new_range(self) -> ColourRange:
        made = ColourRange(self._shown_quantity())
        made.setParent(self)
        made.changed.connect(self.restyled)
        return made

    def _shown_quantity(self) -> Quantity:
        if self.mode == "own":
            return self.quantity
        name = self._model.records[self.reference].label
        return displacement_from(name) if self.mode == "displacement" else difference_to(name, self.quantity)

    # ------------------------------------------------------------------------------------------ values

    def values_of(self, index: int) -> Any:
        """Values (m,) of a contestant's map in the present mode; None for plain, and where they have not come yet."""
        frame = self._model.records[index].frame
        if frame is None or frame.positions is None or self.is_plain(index):
            return None
        own = frame.fields.get(self.quantity.id)
        if self.mode == "own":
            return own
        reference = self._model.records[self.reference].frame
        if reference is None or reference.positions is None:
            return None
        if self.mode == "displacement":
            positions = frame.positions
            held = min(len(self._model.records[i].anchors.vertices) for i in (index, self.reference))
            if held < 2 and not self._model.set_up.problem.fixed_boundary:
                positions = aligned(positions, reference.positions)
            mesh = self._model.mesh
            return (displacements(positions, reference.positions, mesh.simplices) / mesh.diameter).astype(np.float32)
        others = reference.fields.get(self.quantity.id)
        if own is None or others is None:
            return None
        with np.errstate(over="ignore", invalid="ignore"):
            return own - others

    def _map_changed(self, index: int) -> None:
        if not self._fit_timer.isActive():
            self._fit_timer.start()

    def fit(self) -> None:
        """Fit the range to the values of all contestants together: one that outgrows it moves it for all."""
        found = [self.values_of(index) for index in range(len(self._model.records))]
        found = [values for values in found if values is not None]
        if found:
            self.values = np.concatenate(found)
            self.range.take(self.values)
            self.fitted.emit()
