"""Distortions: functions of singular values, given by one line of text."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.errors import FormulaError, WorkbenchError
from workbench.core.formula import CompiledFormula, compile_formula, names_in_formula
from workbench.core.method import KINDS, Kind, Parameter

if TYPE_CHECKING:
    from workbench.core.tape import Tape

KEPT_FENCES = 4
"""Fenced variants of a distortion that are kept compiled."""


@dataclass(frozen=True)
class Distortion:
    """A density D(sigma) on the singular values of the Jacobian of one simplex.

    Parameters
    ----------
    id : str               name in lists and files; the text itself for a typed formula
    label : str            long name
    formula : str          see `workbench.core.formula`
    parameters : tuple of Parameter
    values : dict          parameter values that differ from the defaults
    barrier : bool | None  whether D counts as +inf on det <= 0; None: decided from the formula at sigma_n = 0
    citation, short : str  source with its equation; short name
    description : str      what it is good for, for tool tips
    formula_on_inverted : str   the formula, without its barrier, for simplices that are inverted at the start; a barrier then
                           holds on the others only. Where there is no start, the sign of the last singular value decides
    power : float          D is raised to it, or is the logarithm of the formula where it is 0 (see `tempered`)
    softening : float      sqrt(sigma_i^2 + softening^2) stands for each sigma_i
    fence : float          fence/det is added
    """

    id: str
    label: str
    formula: str
    parameters: tuple[Parameter, ...] = ()
    values: Mapping[str, float] = field(default_factory=dict)
    barrier: bool | None = None
    citation: str = ""
    short: str = ""
    description: str = ""
    kinds: tuple[Kind, ...] = KINDS
    formula_on_inverted: str = ""
    power: float = 1.0
    softening: float = 0.0
    fence: float = 0.0

    def with_values(self, values: Mapping[str, Any]) -> Distortion:
        """The same distortion with other parameter values. Raises `WorkbenchError` for unknown names or ranges."""
        form = {p.name: p for p in self.parameters}
        checked = dict(self.values)
        for name, value in values.items():
            if name not in form:
                raise WorkbenchError(f"{self.label} has no parameter {name!r}; it has: {', '.join(form) or 'none'}.")
            checked[name] = float(form[name].check(value))
        return replace(self, values=checked)

    @property
    def parameter_values(self) -> dict[str, float]:
        """Every parameter with the value in force."""
        return {p.name: float(self.values.get(p.name, p.default)) for p in self.parameters}

    @cached_property
    def _compiled(self) -> dict[int, CompiledFormula]:
        return {}

    @cached_property
    def _fenced(self) -> dict[float, Distortion]:
        return {}

    @cached_property
    def _kinked_at_zero(self) -> dict[int, bool]:
        return {}

    def compiled(self, dimension: int) -> CompiledFormula:
        """The formula compiled for n = `dimension`. Raises `FormulaError`."""
        if dimension not in self._compiled:
            self._compiled[dimension] = compile_formula(
                self.formula,
                dimension,
                self.parameter_values,
                _formula_of,
                text_on_inverted=self.formula_on_inverted,
                power=self.power,
                softening=self.softening,
                fence=self.fence,
            )
        return self._compiled[dimension]

    @cached_property
    def dimensions(self) -> tuple[int, ...]:
        """Dimensions in which the formula has a meaning: sigma3 has none in the plane."""
        found = []
        for dimension in (2, 3):
            with suppress(FormulaError):
                self.compiled(dimension)
                found.append(dimension)
        return tuple(found)

    def tempered(self, dimension: int, power: float = 0.0) -> Distortion | None:
        """D^power, or log D where `power` is 0, with the same barrier, for a formula made of exponentials; else None.

        Exponentials overflow on maps far from the minimum; the logarithm orders simplices alike and does not.
        """
        if not self.compiled(dimension).has_logarithm:
            return None
        return replace(self, power=power, barrier=self.has_barrier(dimension))

    def fenced(self, fence: float) -> Distortion:
        """D + fence/det, a barrier; the last few are kept, as anchors that move ask for the same one again and again."""
        if fence not in self._fenced:
            while len(self._fenced) >= KEPT_FENCES:
                self._fenced.pop(next(iter(self._fenced)))
            self._fenced[fence] = replace(self, fence=fence, barrier=True)
        return self._fenced[fence]

    def is_kinked_at_zero(self, dimension: int) -> bool:
        """Whether D, like a norm, grows at a finite rate from where all singular values vanish, and has no barrier."""
        if dimension not in self._kinked_at_zero:
            first = self.compiled(dimension).gradient
            tiny = self._raw(first, np.full((1, dimension), 1e-12))[0, 1 : dimension + 1]
            kinked = not self.has_barrier(dimension) and bool(np.isfinite(tiny).all() and (tiny > 1e-6).any())
            self._kinked_at_zero[dimension] = kinked
        return self._kinked_at_zero[dimension]

    @property
    def looks_at_start(self) -> bool:
        """Whether D depends on which simplices are inverted at the start."""
        return bool(self.formula_on_inverted)

    def has_barrier(self, dimension: int) -> bool:
        """Whether D is +inf on det <= 0."""
        return self.rises_to_barrier(dimension) if self.barrier is None else self.barrier

    def rises_to_barrier(self, dimension: int) -> bool:
        """Whether the formula itself is +inf at a collapse; a declared barrier may be a jump instead."""
        # Infinite, undefined or steeper than any power root as sigma_n -> 0 with the others at 1.
        sigma = np.ones((2, dimension))
        sigma[:, -1] = (0.0, 1e-200)
        values = self._raw(self.compiled(dimension).value, sigma)[:, 0]
        return bool(not np.isfinite(values[0]) or not np.isfinite(values[1]))

    def value(self, sigma: Floats) -> Floats:
        """(m, n) signed singular values -> (m,); +inf on det <= 0 for a barrier distortion."""
        return self.derivatives(sigma, 0)[0]

    def gradient(self, sigma: Floats) -> Floats:
        """(m, n) signed singular values -> (m, n), derivatives by the signed values."""
        return self.derivatives(sigma, 1)[1]

    def hessian(self, sigma: Floats) -> Floats:
        """(m, n) signed singular values -> (m, n, n), second derivatives by the signed values."""
        return self.derivatives(sigma, 2)[2]

    def derivatives(self, sigma: Floats, order: int) -> tuple[Floats, ...]:
        """Value, and gradient and Hessian where `order` is 1 or 2; see `value`, `gradient`, `hessian`."""
        sigma = np.atleast_2d(np.asarray(sigma, dtype=np.float64))
        n = sigma.shape[1]
        compiled = self.compiled(n)
        tape = (compiled.value, compiled.gradient, compiled.hessian)[order]
        raw = self._raw(tape, sigma)
        sign = np.where(sigma < 0, -1.0, 1.0)
        value = raw[:, 0].copy()
        if self.has_barrier(n) and not self.looks_at_start:
            value[np.prod(sigma, axis=1) <= 0] = np.inf
        result: list[Floats] = [value]
        if order >= 1:
            result.append(raw[:, 1 : n + 1] * sign)
        if order == 2:
            hessian = np.empty((len(sigma), n, n))
            column = n + 1
            for i in range(n):
                for j in range(i, n):
                    hessian[:, i, j] = hessian[:, j, i] = raw[:, column] * sign[:, i] * sign[:, j]
                    column += 1
            result.append(hessian)
        return tuple(result)

    def _raw(self, tape: Tape, sigma: Floats) -> Floats:
        if not self.looks_at_start:
            return tape.evaluate(np.abs(sigma))
        # without a start to look at, the sign that a simplex has now stands for the one that it had
        return tape.evaluate(np.column_stack([np.abs(sigma), np.where(sigma[:, -1] >= 0, 1.0, 0.0)]))

    @staticmethod
    def resolve(text: str, values: Mapping[str, Any] | None = None) -> Distortion:
        """The registered distortion of that id, or the typed formula, with parameter values.

        A name in a typed formula that is nothing else becomes a parameter where `values` names it.
        What has a meaning in one dimension alone is refused where it is compiled for the other.
        Raises `FormulaError` for a formula that is refused, `WorkbenchError` for parameters that do not fit.
        """
        from workbench.core.registry import registry

        text, values = text.strip(" \t"), dict(values or {})
        known = registry().distortions
        if text in known:
            distortion = known[text].with_values(values)
        else:
            if looks_like_id(text):
                raise FormulaError(
                    f"There is no distortion {text!r}; there are: {', '.join(sorted(known))}, or type a formula in sigma."
                )
            distortion = Distortion.from_formula(text, values)
        try:
            distortion.compiled(2)
        except FormulaError:
            distortion.compiled(3)  # it may have a meaning in space alone; else this says what is wrong
        return distortion

    @staticmethod
    def from_formula(text: str, values: Mapping[str, Any] | None = None) -> Distortion:
        """A distortion out of a typed formula; names in `values` are its parameters."""
        values = dict(values or {})
        used = set(names_in_formula(text))
        borrowed: dict[str, Parameter] = {}
        for name in used:
            other = _distortion_of(name)
            if other is not None:
                borrowed.update({p.name: p for p in other.parameters})
        form = []
        for name, value in values.items():
            if name in borrowed:
                form.append(borrowed[name])
            elif name in used:
                form.append(Parameter(name, float, float(Parameter(name, float, 0.0).check(value)), "parameter of the formula"))
            else:
                raise WorkbenchError(f"The formula has no parameter {name!r}.")
        for name, item in borrowed.items():
            if name not in values:
                form.append(item)
        return Distortion(id=text, label=text, formula=text, parameters=tuple(form)).with_values(values)


def looks_like_id(text: str) -> bool:
    """Whether a text means a distortion by its id (words joined by hyphens) rather than a formula."""
    words = text.strip().split("-")
    is_plain = len(words) > 1 and all(word.isascii() and word.isalpha() and word.islower() for word in words)
    return is_plain and not any(word.startswith("sigma") or word == "det" for word in words)


def _distortion_of(name: str) -> Distortion | None:
    from workbench.core.registry import registry

    known = registry().distortions
    return known.get(name.replace("_", "-")) or known.get(name)


@lru_cache(maxsize=256)
def _formula_of(name: str) -> tuple[str, Mapping[str, float]] | None:
    other = _distortion_of(name)
    return None if other is None else (other.formula, other.parameter_values)
