"""What the parts of the window want to see of each map, together."""

from __future__ import annotations

from collections.abc import Iterable

from workbench.app.quantities.quantities import Quantity
from workbench.core.measure import Measure
from workbench.engine.messages import Watch


class Watches:
    """What each owner, by a name of its own, wants; `all` is what the engine is to be told."""

    def __init__(self) -> None:
        self._of_owner: dict[str, tuple[tuple[Measure, ...], bool]] = {}

    def set(self, owner: str, quantities: Iterable[Quantity], singular_values: bool) -> None:
        """`owner` wants these, in place of what it wanted before."""
        self._of_owner[owner] = (tuple(quantity.measure for quantity in quantities), singular_values)

    @property
    def all(self) -> Watch:
        measures = {measure for these, _ in self._of_owner.values() for measure in these}
        with_values = any(with_them for _, with_them in self._of_owner.values())
        return Watch(tuple(sorted(measures, key=lambda measure: measure.id)), with_values)
