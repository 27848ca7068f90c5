"""A formula as a function of positive singular values, with bounds of its own rounding."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.distortion import Distortion
from workbench.core.expression import Graph, Op
from workbench.core.tape import Tape, compile_tape

UNIT = float(np.finfo(np.float64).eps)
ROUNDING = 1e-12
"""Relative differences below this are rounding, whatever the formula."""
ARRAY_OPERATIONS = {
    Op.ADD: np.add, Op.SUBTRACT: np.subtract, Op.MULTIPLY: np.multiply, Op.DIVIDE: np.divide, Op.POWER: np.power,
    Op.SQRT: np.sqrt, Op.EXP: np.exp, Op.LOG: np.log, Op.ABS: np.abs, Op.MAXIMUM: np.maximum, Op.MINIMUM: np.minimum,
}  # fmt: skip
"""What a formula is made of; the other operations appear in derivatives only."""


@dataclass(frozen=True, eq=False)
class Density:
    """The node `root` of `graph` as D(sigma) on sigma_1 >= ... >= sigma_n > 0.

    Undefined values are NaN, what overflows is infinite; nothing warns.
    """

    graph: Graph
    root: int

    @staticmethod
    def of(distortion: Distortion, dimension: int) -> Density:
        """The formula of `distortion` on simplices that were not inverted at the start. Raises `FormulaError`."""
        if distortion.formula_on_inverted:
            distortion = replace(distortion, formula_on_inverted="")
        compiled = distortion.compiled(dimension)
        return Density(compiled.graph, compiled.root)

    @property
    def dimension(self) -> int:
        return self.graph.variable_count

    @cached_property
    def order(self) -> list[int]:
        """Nodes that the root needs, arguments first."""
        return self.graph.reachable([self.root])

    @cached_property
    def _value_tape(self) -> Tape:
        return compile_tape(self.graph, [self.root])

    def __call__(self, sigma: Floats) -> Floats:
        """(m, n) descending -> (m,)."""
        return self._value_tape.evaluate(np.atleast_2d(sigma))[:, 0]

    def signed(self, q: Floats) -> Floats:
        """D(|q| sorted in descending order), (m, n) -> (m,): the function of Theorem 8.3."""
        return self(descending(np.abs(np.atleast_2d(q))))

    def nodes(self, sigma: Floats) -> dict[int, Floats]:
        """Values of every node in `order`, each (m,)."""
        sigma = np.atleast_2d(sigma)
        values: dict[int, Floats] = {}
        with np.errstate(all="ignore"):
            for node in self.order:
                op, value, arguments = self.graph.nodes[node]
                if op is Op.CONSTANT:
                    values[node] = np.full(len(sigma), value)
                elif op is Op.VARIABLE:
                    values[node] = sigma[:, int(value)]
                else:
                    values[node] = ARRAY_OPERATIONS[op](*(values[a] for a in arguments))
        return values

    def with_rounding(self, sigma: Floats) -> tuple[Floats, Floats]:
        """Values and a bound of their rounding errors, both (m,), by running error analysis along the expression.

        Dear: ask for the few points that matter.
        """
        values = self.nodes(sigma)
        errors: dict[int, Floats] = {}
        with np.errstate(all="ignore"):
            for node in self.order:
                op, _, arguments = self.graph.nodes[node]
                inherited = _inherited(op, [values[a] for a in arguments], [errors[a] for a in arguments], values[node])
                errors[node] = inherited + 2.0 * UNIT * np.abs(values[node])
        return values[self.root], errors[self.root]


def _inherited(op: Op, v: list[Floats], e: list[Floats], out: Floats) -> Floats:
    """First-order effect of the arguments' errors `e` on the result of one operation."""
    if op in (Op.CONSTANT, Op.VARIABLE, Op.SIGN):
        return np.zeros_like(out)
    if op in (Op.ADD, Op.SUBTRACT):
        return e[0] + e[1]
    if op is Op.MULTIPLY:
        return np.abs(v[0]) * e[1] + np.abs(v[1]) * e[0]
    if op is Op.DIVIDE:
        return (e[0] + np.abs(out) * e[1]) / np.abs(v[1])
    if op is Op.POWER:
        # A power loses as many digits as its exponent times the logarithm of its base has before the point.
        return np.abs(out) * (np.abs(v[1]) * e[0] / np.abs(v[0]) + np.abs(np.log(np.abs(v[0]))) * (e[1] + UNIT * np.abs(v[1])))
    if op is Op.SQRT:
        return e[0] / (2.0 * np.abs(out))
    if op is Op.EXP:
        return np.abs(out) * (e[0] + UNIT * np.abs(v[0]))
    if op is Op.LOG:
        return e[0] / np.abs(v[0])
    if op is Op.ABS:
        return e[0]
    return np.maximum(e[-1], e[-2])


def margin(value: Floats, error: Floats) -> Floats:
    """What rounding may account for in values (k,) with these bounds of their error (k,), generously: (k,)."""
    result: Floats = 16.0 * error + ROUNDING * np.abs(value)
    return result


def descending(sigma: Floats) -> Floats:
    """Rows of singular values (..., n) sorted from the largest to the smallest."""
    return -np.sort(-np.asarray(sigma, dtype=np.float64), axis=-1)


def log_uniform(generator: np.random.Generator, count: int, dimension: int, reach: float) -> Floats:
    """(count, n) descending singular values whose logarithms are uniform in [-reach, reach]."""
    return descending(np.exp(generator.uniform(-reach, reach, size=(count, dimension))))


def spread(generator: np.random.Generator, count: int, dimension: int, reaches: tuple[float, ...]) -> Floats:
    """`count` points for each reach: from close to (1, ..., 1) to far away."""
    return np.concatenate([log_uniform(generator, count, dimension, reach) for reach in reaches])
