"""What can be shown of each simplex: the quantities that views offer, and what their colours stand for."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from workbench.app.document.resolved import resolved
from workbench.core.distortion import Distortion
from workbench.core.measure import DESCRIPTORS, Measure


@dataclass(frozen=True)
class Quantity:
    """Something that views show of each simplex: what it is, words for the title, smallest possible value.

    `text` with `parameters` is the measure, where the id is not; `field` is its name in `Snapshot.fields`.
    `least` is None where there is no smallest value: colours then begin where the values do. `centre` is the value that
    stands for no distortion, with different colours on its two sides. `least_span` is the narrowest range of colours:
    below it differences are not worth a colour. `group` parts the lists.
    """

    id: str
    label: str
    equation: str
    formula: str
    least: float | None = 0.0
    least_span: float = 0.1
    parameters: tuple[tuple[str, float], ...] = ()
    text: str = ""
    centre: float | None = None
    is_logarithmic: bool = False
    group: str = "live"

    @property
    def measure(self) -> Measure:
        """What the engine computes for it."""
        return Measure(self.text or self.id, self.parameters)

    @property
    def field(self) -> str:
        """Name of its values in `Snapshot.fields`."""
        return self.measure.id

    @property
    def title(self) -> str:
        return f"{self.label} {self.equation}".rstrip()


def _summed(power: str, dimension: int) -> str:
    return " + ".join(f"σ{index}{power}" for index in "₁₂₃"[:dimension])


def live_quantities(dimension: int) -> tuple[Quantity, ...]:
    """The colour maps that a window begins with, for triangles (2) or tetrahedra (3)."""
    squares, inverses = _summed("²", dimension), _summed("⁻²", dimension)
    ratio = f"σ₁ / σ{'₁₂₃'[dimension - 1]}"
    return (
        Quantity("dirichlet", "Dirichlet", "(25)", squares, 0.0, least_span=5.0),
        Quantity("condition-number", "Condition number", "(29)", ratio, 1.0),
        Quantity("symmetric-dirichlet", "Symmetric Dirichlet", "(32)", f"{squares} + {inverses}", 2.0 * dimension),
    )


def factors(dimension: int) -> tuple[Quantity, ...]:
    """Factors of length and area or volume: below and above 1 are told apart, a half as far from it as twice."""
    mean = f"({_summed('', dimension)}) / {dimension}, the approximate conformal factor"
    listed: tuple[tuple[str, str, str, str, float | None], ...] = (
        ("average-singular-value", "Average singular value", "(78)", mean, 0.0),
        ("det", "Determinant", "", DESCRIPTORS["det"], None),
        ("sigma1", "σ₁", "", DESCRIPTORS["sigma1"], 0.0),
        ("sigman", "σₙ", "", DESCRIPTORS["sigman"], None),
    )
    return tuple(Quantity(*words, centre=1.0, is_logarithmic=True, group="factors") for words in listed)


LIVE_QUANTITIES = live_quantities(2)
FACTORS = factors(2)
CONFORMAL_FACTOR = FACTORS[0]

IN_FORCE = Quantity(
    "in-force", "In force", "", "The distortion that is minimised now", 4.0, text="symmetric-dirichlet", group="in force"
)
"""Follows the choice of the distortion and its parameters."""


def quantity_of_distortion(item: Distortion, group: str = "distortions", dimension: int = 2) -> Quantity:
    """A registered distortion with its default parameters."""
    numbered = re.match(r"\(\d+\)(-\(\d+\))?", item.citation)
    equation = numbered.group() if numbered else ""
    least, centre = _sides(item, dimension)
    return Quantity(item.id, item.label, equation, item.formula, least, centre=centre, group=group)


def quantity_of_formula(text: str, parameters: Mapping[str, float] | None = None, dimension: int = 2) -> Quantity:
    """A typed formula. Raises `WorkbenchError` where it is none."""
    item = resolved(text, parameters)
    item.compiled(dimension)
    measure = Measure.of(text, parameters)
    least, centre = _sides(item, dimension)
    return Quantity(
        measure.id,
        measure.id,
        "",
        item.formula,
        least,
        centre=centre,
        parameters=measure.parameters,
        text=text,
        group="typed",
    )


def quantity_in_force(text: str, parameters: Mapping[str, float], dimension: int = 2) -> Quantity:
    """The distortion that is minimised, whichever it is. Raises `WorkbenchError` where the text is none."""
    item = resolved(text, parameters)
    least, centre = _sides(item, dimension)
    measure = Measure.of(text, parameters)
    words = item.short or item.label
    label = f"{IN_FORCE.label}: {words if len(words) <= 40 else words[:39] + '…'}"
    return replace(
        IN_FORCE, label=label, formula=item.formula, least=least, centre=centre, parameters=measure.parameters, text=text
    )


def _sides(item: Distortion, dimension: int) -> tuple[float | None, float | None]:
    """Smallest value and centre of a distortion in a dimension, as far as a look at some hundred matrices tells.

    A normalised one begins at its value for an isometry, another that is never negative at 0; one that takes both signs
    has its centre there.
    """
    with np.errstate(all="ignore"):
        at_isometry, *others = item.value(_trial_values(dimension))
    others = np.array(others)
    others = others[np.isfinite(others)]
    if not len(others) or not np.isfinite(at_isometry):
        return None, None
    slack = 1e-9 * max(abs(at_isometry), 1.0)
    if at_isometry <= others.min() + slack:
        return float(at_isometry), None
    if others.min() < -slack:
        return None, 0.0 if others.max() > slack else None
    return 0.0, None


@lru_cache(maxsize=2)
def _trial_values(dimension: int) -> np.ndarray:
    """Singular values (k, n), descending, of many sizes; first those of an isometry."""
    random = np.random.default_rng(7)
    exponents = np.concatenate([random.uniform(-reach, reach, (200, dimension)) for reach in (4, 0.3)])
    return np.vstack([np.ones((1, dimension)), -np.sort(-(10.0**exponents), axis=1)])
