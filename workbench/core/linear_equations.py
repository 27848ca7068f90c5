"""Linear equations in the coordinates of a map as lines of text, such as `x[12] - x[30] = 0`.

The rows of A x = b (58) that a user writes. A line is read term by term; no text is ever executed.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import scipy

from workbench.core.constraints import LinearConstraints
from workbench.core.errors import WorkbenchError

if TYPE_CHECKING:
    from workbench.core.problem import Problem

AXES = "xyz"
MOST_EQUATIONS = 2000
LONGEST_EQUATION = 20_000
LARGEST_NUMBER = 1e70
MOST_MEMORY = 2**30
"""Bytes that the rows may take: solvers keep them, and what the metric answers to each, as full rows."""

_NUMBER = r"(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?"
_TERM = re.compile(
    rf"\s*(?P<sign>[+-])?\s*(?:(?P<factor>{_NUMBER})\s*(?P<times>\*)?\s*)?"
    r"(?:(?P<axis>[xyz])\s*\[\s*(?P<vertex>\d{1,10})\s*\])?\s*"
)

Term = tuple[int, int, float]
"""Vertex from 0, axis from 0, coefficient."""


@dataclass(frozen=True)
class LinearEquation:
    """sum of coefficient * coordinate = value; every coordinate once, none with coefficient 0."""

    terms: tuple[Term, ...]
    value: float

    @property
    def text(self) -> str:
        """The line that `read_equation` reads as this equation, to the last bit."""
        parts = [f"{factor!r}*{AXES[axis]}[{vertex}]" for vertex, axis, factor in self.terms]
        return " + ".join(parts).replace("+ -", "- ").replace(" 1.0*", " ").removeprefix("1.0*") + f" = {self.value!r}"


def read_equation(line: str) -> LinearEquation:
    """One equation: sums of `2.5*x[12]`, `-y[3]` and numbers on both sides of one `=`.

    Raises `WorkbenchError`, also where every coordinate cancels.
    """
    if len(line) > LONGEST_EQUATION:
        raise WorkbenchError(f"it has {len(line)} characters; at most {LONGEST_EQUATION} are taken")
    sides = line.split("=")
    if len(sides) != 2:
        raise WorkbenchError("it needs one '=', as in x[12] - x[30] = 0")
    found: dict[tuple[int, int], float] = {}
    value = 0.0
    for side, sign in zip(sides, (1.0, -1.0), strict=True):
        for vertex, axis, factor in _terms(side):
            if axis < 0:
                value -= sign * factor
            else:
                found[vertex, axis] = found.get((vertex, axis), 0.0) + sign * factor
    terms = tuple((vertex, axis, factor) for (vertex, axis), factor in found.items() if factor)
    if not terms:
        raise WorkbenchError("no coordinate is left in it")
    if not all(abs(number) <= LARGEST_NUMBER for number in (value, *(factor for _, _, factor in terms))):
        raise WorkbenchError(f"a number in it is larger than {LARGEST_NUMBER:g}")
    return LinearEquation(terms, value + 0.0)


def _terms(side: str) -> list[Term]:
    """The terms of one side; axis -1 for a number alone."""
    terms: list[Term] = []
    position = 0
    while position < len(side) or not terms:
        match = _TERM.match(side, position)
        rest = side[position : position + 20].strip()
        if match is None or not (match["factor"] or match["axis"]):
            raise WorkbenchError(f"{rest!r} is no term" if rest else "a side of it is empty")
        if terms and not match["sign"]:
            raise WorkbenchError(f"a + or - is missing before {rest!r}")
        if match["times"] and not match["axis"]:
            raise WorkbenchError(f"after * a coordinate is missing: {rest!r}")
        factor = float(match["factor"] or 1.0) * (-1.0 if match["sign"] == "-" else 1.0)
        if not math.isfinite(factor):
            raise WorkbenchError(f"the number {match['factor']} is too large")
        axis = AXES.index(match["axis"]) if match["axis"] else -1
        terms.append((int(match["vertex"] or 0), axis, factor))
        position = match.end()
    return terms


def read_equations(text: str) -> tuple[str, ...]:
    """The equations of a text, one a line, in the form that sessions keep; empty lines and what follows `#` are left out.

    Raises `WorkbenchError` that names the line.
    """
    equations: list[str] = []
    for number, line in enumerate(text.splitlines(), 1):
        line = line.split("#", 1)[0].strip()
        if not line:
            continue
        if len(equations) == MOST_EQUATIONS:
            raise WorkbenchError(f"At most {MOST_EQUATIONS} linear equations are taken; line {number} is one more.")
        try:
            equations.append(read_equation(line).text)
        except WorkbenchError as error:
            raise WorkbenchError(f"Linear equations, line {number}: {error.sentence}.") from None
    return tuple(equations)


def with_equations(problem: Problem, equations: Sequence[str]) -> Problem:
    """The problem with these linear constraints in place of those that it has. Raises as `linear_constraints` does."""
    return problem.with_constraints(linear_constraints(equations, problem.mesh.vertex_count, problem.dimension))


def linear_constraints(equations: Sequence[str], vertex_count: int, dimension: int) -> LinearConstraints | None:
    """The rows A, b of equations on a map (n, d), None where there are no equations.

    Raises `WorkbenchError` for a vertex or an axis that the map does not have, for an equation that contradicts those before
    it, and for more rows than memory is spent on.
    """
    if not equations:
        return None
    if 8 * len(equations) * vertex_count * dimension > MOST_MEMORY:
        raise WorkbenchError(
            f"{len(equations)} linear equations on {vertex_count} vertices take more memory than is spent on them; "
            f"at most {MOST_MEMORY // (8 * vertex_count * dimension)} go with this mesh."
        )
    rows, columns, factors, values = [], [], [], []
    for row, line in enumerate(equations):
        equation = read_equation(line)
        for vertex, axis, factor in equation.terms:
            if vertex >= vertex_count:
                raise WorkbenchError(
                    f"Linear equation {row + 1} has vertex {vertex}; the mesh has the vertices 0 to {vertex_count - 1}."
                )
            if axis >= dimension:
                raise WorkbenchError(f"Linear equation {row + 1} has the axis {AXES[axis]}; maps to the plane have x and y.")
            rows.append(row)
            columns.append(vertex * dimension + axis)
            factors.append(factor)
        values.append(equation.value)
    shape = (len(equations), vertex_count * dimension)
    constraints = LinearConstraints(scipy.sparse.csr_matrix((factors, (rows, columns)), shape), np.array(values))
    contradiction = constraints.first_contradiction()
    if contradiction is not None:
        row, value = contradiction
        raise WorkbenchError(
            f"Linear equation {row + 1} contradicts those before it, by which its left side is {value:g}, not {values[row]:g}; "
            "change it or take it out."
        )
    return constraints
