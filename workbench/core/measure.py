"""Numbers a simplex that are made of its singular values: descriptors, distortions, typed formulas, by one name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from workbench.core.arrays import Booleans, Floats
from workbench.core.distortion import Distortion

DESCRIPTORS: dict[str, str] = {
    "det": "Determinant, signed: the factor of area or volume",
    "sigma1": "Largest singular value",
    "sigman": "Smallest singular value, signed",
}
"""Measures that keep the sign of an inverted simplex, beside every distortion; id -> label."""


@dataclass(frozen=True, eq=False)
class SingularValues:
    """What every measure of one map is made of.

    `signed` (m, n) float64, descending by size;  `sizes` (m, n) without signs;  `inverted` (m,) bool: det <= 0
    """

    signed: Floats
    sizes: Floats = field(init=False)
    inverted: Booleans = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "sizes", np.abs(self.signed))
        object.__setattr__(self, "inverted", ~(self.signed[:, -1] > 0))

    @property
    def dimension(self) -> int:
        return int(self.signed.shape[1])


Evaluator = Callable[[SingularValues], Floats]
"""The values (m,) of a measure; +inf on inverted simplices where a distortion has a barrier."""


@dataclass(frozen=True)
class Measure:
    """One number a simplex.

    `text` is the id of a descriptor or of a registered distortion, or a formula; `parameters` are (name, value) pairs
    that differ from the defaults.
    """

    text: str
    parameters: tuple[tuple[str, float], ...] = ()

    @classmethod
    def of(cls, text: str, parameters: Mapping[str, Any] | None = None) -> Measure:
        """The measure of a text with parameter values in any order."""
        return cls(text, tuple(sorted((name, float(value)) for name, value in (parameters or {}).items())))

    @classmethod
    def of_distortion(cls, distortion: Distortion) -> Measure:
        """The measure of what is minimised: a registered distortion, with the values that differ, or a typed formula."""
        from workbench.core.registry import registry

        known = registry().distortions.get(distortion.id)
        usual = {} if known is None else known.parameter_values
        values = {name: value for name, value in distortion.parameter_values.items() if usual.get(name) != value}
        return cls.of(distortion.formula if known is None else distortion.id, values)

    @property
    def id(self) -> str:
        """Name of its values: the text, and the parameters where there are any."""
        values = ", ".join(f"{name}={value:.12g}" for name, value in self.parameters)
        return f"{self.text} [{values}]" if values else self.text

    def prepare(self, dimension: int) -> Evaluator:
        """What computes it for n = `dimension`. Raises `WorkbenchError` for what is no measure there."""
        if self.text in DESCRIPTORS and not self.parameters:
            return _DESCRIPTOR_VALUES[self.text]
        distortion = Distortion.resolve(self.text, dict(self.parameters))
        if distortion.looks_at_start:
            return lambda map: distortion.value(map.signed)
        # as `Distortion.value`, but sizes and signs are found once for all measures
        tape, has_barrier = distortion.compiled(dimension).value, distortion.has_barrier(dimension)

        def values(map: SingularValues) -> Floats:
            found = tape.evaluate(map.sizes)[:, 0]
            if has_barrier:
                found[map.inverted] = np.inf
            return found

        return values


def _determinant(map: SingularValues) -> Floats:
    product = map.signed[:, 0].copy()
    for column in range(1, map.dimension):  # several times quicker than a product along short rows
        product *= map.signed[:, column]
    return product


_DESCRIPTOR_VALUES: dict[str, Evaluator] = {
    "det": _determinant,
    "sigma1": lambda map: map.signed[:, 0],
    "sigman": lambda map: map.signed[:, -1],
}
