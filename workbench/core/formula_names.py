"""Names in a typed formula that nothing declares: slips of the pen, or parameters to be."""

from __future__ import annotations

import difflib
import keyword
import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from workbench.core.distortion import Distortion
from workbench.core.errors import FormulaError
from workbench.core.formula import FUNCTIONS, names_in_formula
from workbench.core.method import Parameter
from workbench.core.registry import registry

VARIABLES = ("sigma", "sigma1", "sigma2", "sigma3", "sigman", "n", "det")
PARAMETER_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,30}")
NEARLY = 0.8
"""Part of two names that must agree for one to be a misspelt other."""
SHORTEST_SLIP = 4
"""Letters from which a name may be taken for a misspelt one; shorter ones are too near to each other."""


@dataclass(frozen=True)
class UndeclaredName:
    """A name that is no function, singular value, distortion or parameter.

    `position` : column (from 0) where it first stands;  `meant` : the known name that it is nearly, or empty
    """

    name: str
    position: int
    meant: str = ""

    @property
    def may_be_parameter(self) -> bool:
        """Whether it can be declared: a plain name that is not a misspelt one."""
        return not self.meant and PARAMETER_NAME.fullmatch(self.name) is not None

    @property
    def sentence(self) -> str:
        """What is wrong with it as it stands."""
        if self.meant:
            return f"The name {self.name!r} is not known; {self.meant} is."
        if not self.may_be_parameter:
            return f"{self.name!r} cannot be the name of a parameter: letters, digits and underscores, a letter first."
        return f"The name {self.name!r} is not known: neither a singular value, nor a distortion, nor a declared parameter."


def distortion_names() -> dict[str, Distortion]:
    """Registered distortions by the names that they have inside a formula: underscores for hyphens."""
    return {id.replace("-", "_"): item for id, item in registry().distortions.items()}


def undeclared_names(text: str, declared: Iterable[str] = ()) -> tuple[UndeclaredName, ...]:
    """Names of a formula that are nothing yet, in order of appearance. Raises `FormulaError` where it is none.

    Parameters of a distortion that the formula refers to are declared with it.
    """
    distortions = distortion_names()
    _check_keywords(text)
    used = names_in_formula(text)
    borrowed = {p.name for name in used if name in distortions for p in distortions[name].parameters}
    known = {*distortions, *borrowed, *declared}
    words = [*VARIABLES, *FUNCTIONS, *sorted(known)]
    found = [UndeclaredName(name, position_of(text, name), _meant(name, words)) for name in used if name not in known]
    return tuple(sorted(found, key=lambda item: item.position))


def check_names(text: str, declared: Iterable[str] = ()) -> None:
    """Raises `FormulaError` at the first name that is not declared, with the way to declare it where it can be one."""
    for item in undeclared_names(text, declared):
        remedy = f" To make it a parameter, give it a value with --set {item.name}=..." if item.may_be_parameter else ""
        raise FormulaError(f"{item.sentence}{remedy}", position=item.position)


def position_of(text: str, name: str) -> int:
    """Column where a name first stands as a word of its own; 0 where it does not."""
    match = re.search(rf"(?<![A-Za-z0-9_]){re.escape(name)}(?![A-Za-z0-9_])", text)
    return match.start() if match else 0


def _check_keywords(text: str) -> None:
    """Raises `FormulaError` at a word that Python keeps for itself, `lambda` above all, with a name that does."""
    for match in re.finditer(r"[A-Za-z_]+", text):
        word = match.group()
        if keyword.iskeyword(word) and position_of(text, word) == match.start():
            other = "lam" if word == "lambda" else f"{word}_"
            raise FormulaError(f"{word} cannot be a name in a formula; write {other} instead.", position=match.start())


def _meant(name: str, words: Iterable[str]) -> str:
    """The known word that a longer name is nearly."""
    if len(name) < SHORTEST_SLIP:
        return ""
    near = difflib.get_close_matches(name.lower(), [word for word in words if len(word) > 2], n=1, cutoff=NEARLY)
    return near[0] if near else ""


# What the names that papers give to their constants usually mean: value, least, largest.
_USUAL: Mapping[str, tuple[float, float, float]] = {
    "lam": (0.5, 0.0, 1.0),
    "t": (0.5, 0.0, 1.0),
    "w": (0.5, 0.0, 1.0),
    "weight": (0.5, 0.0, 1.0),
    "p": (2.0, 1.0, 10.0),
    "q": (2.0, 1.0, 10.0),
    "k": (1.0, 1.0, 2.0),
    "eps": (1e-3, 1e-6, 1.0),
    "epsilon": (1e-3, 1e-6, 1.0),
    "delta": (1e-3, 1e-6, 1.0),
    "pi": (math.pi, 1.0, 10.0),
    "e": (math.e, 1.0, 10.0),
}
_COUNTS = ("k",)


def suggested_parameter(name: str) -> Parameter:
    """A parameter of that name with a value and a range to begin with."""
    value, low, high = _USUAL.get(name, (1.0, 0.01, 100.0))
    kind = int if name in _COUNTS else float
    return Parameter(name, kind, kind(value), "parameter of the formula", minimum=low, maximum=high)
