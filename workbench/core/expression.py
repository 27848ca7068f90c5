"""Scalar expressions as a graph that shares equal parts, with exact derivatives.

A node is an index into the graph; equal operations are one node, so that value, gradient and Hessian of a formula share
what they have in common and a derivative never grows exponentially. Constants are folded as they appear.

max and min are not differentiable where their arguments meet. There, within a relative distance of `SWITCH`, derivatives are
those of the function with |a - b| replaced by Huber's function, which is a parabola near 0: at the switch itself that is the
mean of both sides, a subgradient. A derivative that *majorises* also carries, at any distance, the curvature 1/|a - b| of the
parabola that touches |a - b| from above, as in iteratively reweighted least squares: a Newton step then stops at the switch
where the exact second derivative, which is 0 there, would jump across it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from enum import IntEnum


class Op(IntEnum):
    """Operations of a node; the numbers are those of the tape (see `workbench.core.tape`)."""

    CONSTANT = 0
    VARIABLE = 1
    ADD = 2
    SUBTRACT = 3
    MULTIPLY = 4
    DIVIDE = 5
    POWER = 6
    SQRT = 7
    EXP = 8
    LOG = 9
    ABS = 10
    SIGN = 11
    MAXIMUM = 12
    MINIMUM = 13
    SELECT = 14  # (a, b, c, d): c where a >= b, else d
    BLEND = 15  # (a, b, c, d): c where a > b, d where a < b, linear between where they nearly meet
    SLOPE = 16  # (a, b): derivative of the share of c in a blend by a - b
    CURVATURE = 17  # (a, b): second derivative of the parabola above max(a, b)


SWITCH = 1e-5
"""Part of |a| + |b| within which a and b count as meeting."""
LEAST_ABSOLUTE = 1e-9
"""|a| counts as no less than this where its curvature is bounded from above."""
LEAST_ROOT = 1e-150
"""A square root counts as no less than this in its derivatives: at the minimum 0 of a norm, the gradient is 0."""


Key = tuple[Op, float, tuple[int, ...]]


class Graph:
    """Expressions in the variables 0 .. `variable_count` - 1."""

    def __init__(self, variable_count: int) -> None:
        self.variable_count = variable_count
        self.input_count = variable_count
        self.nodes: list[Key] = []
        self._index: dict[Key, int] = {}
        self._derivatives: dict[tuple[int, int, bool], int] = {}
        self.zero = self.constant(0.0)
        self.one = self.constant(1.0)
        self.variables = [self._node(Op.VARIABLE, float(i), ()) for i in range(variable_count)]
        self.singular_values = self.variables  # what a formula means by sigma

    def _node(self, op: Op, value: float, arguments: tuple[int, ...]) -> int:
        key = (op, value, arguments)
        if key not in self._index:
            self._index[key] = len(self.nodes)
            self.nodes.append(key)
        return self._index[key]

    def constant(self, value: float) -> int:
        return self._node(Op.CONSTANT, float(value) + 0.0, ())

    def datum(self) -> int:
        """A further input, a number a simplex that is no singular value; it comes after the variables."""
        self.input_count += 1
        return self._node(Op.VARIABLE, float(self.input_count - 1), ())

    def constant_value(self, node: int) -> float | None:
        """Value of a constant node, None for any other."""
        op, value, _ = self.nodes[node]
        return value if op is Op.CONSTANT else None

    # ------------------------------------------------------------------------------------ operations

    def _folded(self, op: Op, *arguments: int) -> int | None:
        values = [self.constant_value(a) for a in arguments]
        if any(v is None for v in values):
            return None
        return self.constant(evaluate(op, *[v for v in values if v is not None]))

    def add(self, a: int, b: int) -> int:
        folded = self._folded(Op.ADD, a, b)
        if folded is not None:
            return folded
        if a == self.zero:
            return b
        if b == self.zero:
            return a
        return self._node(Op.ADD, 0.0, (min(a, b), max(a, b)))

    def subtract(self, a: int, b: int) -> int:
        folded = self._folded(Op.SUBTRACT, a, b)
        if folded is not None:
            return folded
        if b == self.zero:
            return a
        if a == b:
            return self.zero
        return self._node(Op.SUBTRACT, 0.0, (a, b))

    def multiply(self, a: int, b: int) -> int:
        folded = self._folded(Op.MULTIPLY, a, b)
        if folded is not None:
            return folded
        if self.zero in (a, b):
            return self.zero
        if a == self.one:
            return b
        if b == self.one:
            return a
        return self._node(Op.MULTIPLY, 0.0, (min(a, b), max(a, b)))

    def divide(self, a: int, b: int) -> int:
        folded = self._folded(Op.DIVIDE, a, b)
        if folded is not None:
            return folded
        if a == self.zero or b == self.one:
            return a
        return self._node(Op.DIVIDE, 0.0, (a, b))

    def power(self, a: int, b: int) -> int:
        folded = self._folded(Op.POWER, a, b)
        if folded is not None:
            return folded
        exponent = self.constant_value(b)
        if exponent == 0.0:
            return self.one
        if exponent is not None:
            cheap = self._cheap_power(a, exponent)
            if cheap is not None:
                return cheap
        return self._node(Op.POWER, 0.0, (a, b))

    def _cheap_power(self, a: int, exponent: float) -> int | None:
        """Small powers and half powers as products and roots, many times faster than a general power."""
        if exponent < 0:
            inverse = self._cheap_power(a, -exponent)
            return None if inverse is None else self.divide(self.one, inverse)
        if exponent == 0.5:
            return self.sqrt(a)
        if exponent != int(exponent) or exponent > 8:
            return None
        count = int(exponent)
        if count == 1:
            return a
        half = self._cheap_power(a, count // 2)
        assert half is not None
        square = self.multiply(half, half)
        return self.multiply(square, a) if count % 2 else square

    def _unary(self, op: Op, a: int) -> int:
        folded = self._folded(op, a)
        return self._node(op, 0.0, (a,)) if folded is None else folded

    def sqrt(self, a: int) -> int:
        return self._unary(Op.SQRT, a)

    def exp(self, a: int) -> int:
        return self._unary(Op.EXP, a)

    def log(self, a: int) -> int:
        return self._unary(Op.LOG, a)

    def abs(self, a: int) -> int:
        return self._unary(Op.ABS, a)

    def sign(self, a: int) -> int:
        return self._unary(Op.SIGN, a)

    def maximum(self, a: int, b: int) -> int:
        if a == b:
            return a
        folded = self._folded(Op.MAXIMUM, a, b)
        return self._node(Op.MAXIMUM, 0.0, (a, b)) if folded is None else folded

    def minimum(self, a: int, b: int) -> int:
        if a == b:
            return a
        folded = self._folded(Op.MINIMUM, a, b)
        return self._node(Op.MINIMUM, 0.0, (a, b)) if folded is None else folded

    @property
    def has_switches(self) -> bool:
        """Whether some expression is not differentiable where two arguments meet."""
        return any(op in (Op.MAXIMUM, Op.MINIMUM, Op.ABS) for op, _, _ in self.nodes)

    def select(self, a: int, b: int, then: int, otherwise: int) -> int:
        """`then` where a >= b, else `otherwise`."""
        if then == otherwise:
            return then
        return self._node(Op.SELECT, 0.0, (a, b, then, otherwise))

    def blend(self, a: int, b: int, then: int, otherwise: int) -> int:
        """`then` where a > b, `otherwise` where a < b, a mean of both where they nearly meet."""
        if then == otherwise:
            return then
        return self._node(Op.BLEND, 0.0, (a, b, then, otherwise))

    # ----------------------------------------------------------------------------------- derivatives

    def derivative(self, node: int, variable: int, *, majorise: bool = False) -> int:
        """Partial derivative of `node`; `majorise` matters for second derivatives at a switch of max or min."""
        # A graph lists arguments before what uses them, so one pass in order needs no recursion.
        for index in self.reachable([node]):
            if (index, variable, majorise) not in self._derivatives:
                self._derivatives[index, variable, majorise] = self._differentiate(index, variable, majorise)
        return self._derivatives[node, variable, majorise]

    def reachable(self, nodes: Iterable[int]) -> list[int]:
        """Every node that the given ones are made of, arguments before what uses them."""
        stack = list(nodes)
        seen = set(stack)
        while stack:
            for argument in self.nodes[stack.pop()][2]:
                if argument not in seen:
                    seen.add(argument)
                    stack.append(argument)
        return sorted(seen)

    def _differentiate(self, node: int, variable: int, majorise: bool) -> int:
        op, value, arguments = self.nodes[node]
        if op is Op.CONSTANT or (op is Op.SIGN and not majorise):
            return self.zero
        if op is Op.VARIABLE:
            return self.one if int(value) == variable else self.zero
        d = [self._derivatives[a, variable, majorise] for a in arguments]
        a = arguments[0]
        if all(x == self.zero for x in d):
            return self.zero
        if op is Op.ADD:
            return self.add(d[0], d[1])
        if op is Op.SUBTRACT:
            return self.subtract(d[0], d[1])
        if op is Op.MULTIPLY:
            return self.add(self.multiply(d[0], arguments[1]), self.multiply(a, d[1]))
        if op is Op.DIVIDE:
            return self.divide(self.subtract(d[0], self.multiply(node, d[1])), arguments[1])
        if op is Op.POWER:
            return self._differentiate_power(node, a, arguments[1], d[0], d[1])
        if op is Op.SQRT:
            least = self.constant(LEAST_ROOT)
            return self.divide(self.multiply(self.constant(0.5), d[0]), self.select(node, least, node, least))
        if op is Op.EXP:
            return self.multiply(node, d[0])
        if op is Op.LOG:
            return self.divide(d[0], a)
        if op is Op.ABS:
            return self.multiply(self.sign(a), d[0])
        if op is Op.SIGN:
            return self.divide(d[0], self.maximum(self.abs(a), self.constant(LEAST_ABSOLUTE)))
        if op is Op.MAXIMUM:
            return self.blend(a, arguments[1], d[0], d[1])
        if op is Op.MINIMUM:
            return self.blend(arguments[1], a, d[0], d[1])
        if op is Op.SELECT:
            return self.select(a, arguments[1], d[2], d[3])
        if op is Op.BLEND:
            return self._differentiate_blend(arguments, d, majorise)
        raise AssertionError(op)  # slopes and curvatures stand in second derivatives only

    def _differentiate_blend(self, arguments: tuple[int, ...], d: list[int], majorise: bool) -> int:
        a, b, then, otherwise = arguments
        share = self._node(Op.CURVATURE if majorise else Op.SLOPE, 0.0, (a, b))
        across = self.multiply(self.subtract(then, otherwise), self.subtract(d[0], d[1]))
        along = self.blend(a, b, d[2], d[3])
        return along if across == self.zero else self.add(along, self.multiply(share, across))

    def _differentiate_power(self, node: int, base: int, exponent: int, d_base: int, d_exponent: int) -> int:
        total = self.zero
        if d_base != self.zero:
            reduced = self.power(base, self.subtract(exponent, self.one))
            total = self.multiply(self.multiply(exponent, reduced), d_base)
        if d_exponent != self.zero:
            total = self.add(total, self.multiply(self.multiply(node, self.log(base)), d_exponent))
        return total


def evaluate(op: Op, *v: float) -> float:
    """One operation on numbers; what is not defined is NaN or an infinity, never an exception."""
    try:
        if op is Op.ADD:
            return v[0] + v[1]
        if op is Op.SUBTRACT:
            return v[0] - v[1]
        if op is Op.MULTIPLY:
            return v[0] * v[1]
        if op is Op.DIVIDE:
            return v[0] / v[1] if v[1] != 0 else (math.nan if v[0] == 0 else math.copysign(math.inf, v[0]))
        if op is Op.POWER:
            return math.pow(v[0], v[1])
        if op is Op.SQRT:
            return math.sqrt(v[0])
        if op is Op.EXP:
            return math.exp(v[0])
        if op is Op.LOG:
            return math.log(v[0]) if v[0] != 0 else -math.inf
        if op is Op.ABS:
            return abs(v[0])
        if op is Op.SIGN:
            return math.copysign(1.0, v[0]) if v[0] != 0 else 0.0
        if op is Op.MAXIMUM:
            return max(v)
        if op is Op.MINIMUM:
            return min(v)
    except OverflowError:
        return math.inf
    except ValueError:
        return math.nan
    raise AssertionError(op)
