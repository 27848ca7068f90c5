"""What is found out about a distortion: nine facts, each with a sentence and, where it fails, a witness."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Literal

Method = Literal["symbolic", "numeric", "both", ""]


@dataclass(frozen=True)
class Property:
    """One property of a distortion, decided or not.

    Parameters
    ----------
    holds : bool | None     None: neither a proof nor a witness was found
    method : str            "symbolic" by rules on the expression, "numeric" by a search, "both", "" where others decide
    sentence : str          for a person
    witness : dict | None   numbers that anybody can check, where the property fails
    value : float | None    a number that goes with it, such as D(1, ..., 1)
    """

    holds: bool | None
    method: Method
    sentence: str
    witness: dict[str, Any] | None = None
    value: float | None = None


@dataclass(frozen=True)
class Analysis:
    """Properties of Corollary 2.1 and the convexity of Theorem 8.3, of one formula in one dimension."""

    formula: str
    dimension: int
    normalised: Property
    symmetric: Property
    bottom_barrier: Property
    top_barrier: Property
    smooth_almost_everywhere: Property
    regular: Property
    convex: Property

    def items(self) -> Iterator[tuple[str, Property]]:
        """(name, property) in the order of the corollary, then `regular` and `convex`."""
        for name in NAMES:
            yield name, getattr(self, name)


NAMES = (
    "normalised",
    "symmetric",
    "bottom_barrier",
    "top_barrier",
    "smooth_almost_everywhere",
    "regular",
    "convex",
)
"""Fields of `Analysis` that are properties."""


def point_text(sigma: Any) -> str:
    """(2, 1, 0.5), as people write it."""
    return "(" + ", ".join(f"{float(s):.6g}" for s in sigma) + ")"
