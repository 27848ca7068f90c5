"""Leading terms: how an expression behaves along sigma_i = c_i t^(a_i) as t -> inf, without any numbers running over.

A leading term is c * exp(x) * t^e * (log t)^l. Sums, products, powers, max and min of such terms follow exactly; exponentials
are kept by the leading term of their argument only. What would need a second term (a cancellation) is left open.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from workbench.core.analysis.density import Density
from workbench.core.expression import Op

NONE = (0.0, 0.0, 0.0, 0.0)
"""No exponential. Else (sign, e, l, c) of the argument's leading term, all with that sign: larger tuples grow faster."""
MAXIMUM_WORK = 12_000
"""Nodes times paths beyond which nothing is told, so that no text makes this slow."""


@dataclass(frozen=True)
class Leading:
    """c * exp(x) * t^e * (log t)^l; `rough` where c is only known by its sign, `exact` where no lower terms follow."""

    coefficient: float
    exponential: tuple[float, float, float, float] = NONE
    power: float = 0.0
    logarithm: float = 0.0
    rough: bool = False
    exact: bool = False

    @property
    def rank(self) -> tuple[tuple[float, float, float, float], float, float]:
        """Larger ranks grow faster."""
        return self.exponential, self.power, self.logarithm

    @property
    def is_infinite(self) -> bool:
        """Whether it tends to +inf."""
        return self.coefficient > 0.0 and self.rank > (NONE, 0.0, 0.0)


class Open(Exception):  # noqa: N818 - not an error: the calculus tells nothing here
    """The leading terms cancel, or mean nothing."""


def tends_to_infinity(density: Density, paths: Sequence[tuple[Sequence[float], Sequence[float]]]) -> list[bool | None]:
    """For each path (exponents, factors): whether D -> inf along it, None where the leading terms do not tell."""
    if len(paths) * len(density.order) > MAXIMUM_WORK:
        return [None] * len(paths)
    return [_along(density, exponents, factors) for exponents, factors in paths]


def _along(density: Density, exponents: Sequence[float], factors: Sequence[float]) -> bool | None:
    terms: dict[int, Leading | None] = {}  # None is 0
    try:
        for node in density.order:
            op, value, arguments = density.graph.nodes[node]
            if op is Op.CONSTANT:
                terms[node] = Leading(value, exact=True) if value else None
            elif op is Op.VARIABLE:
                terms[node] = Leading(float(factors[int(value)]), power=float(exponents[int(value)]), exact=True)
            else:
                terms[node] = _combined(op, [terms[a] for a in arguments])
        found = terms[density.root]
    except (Open, OverflowError, ZeroDivisionError, ValueError):
        return None
    return found is not None and found.is_infinite


def _combined(op: Op, v: list[Leading | None]) -> Leading | None:
    if op is Op.ADD:
        return _sum(v[0], v[1])
    if op is Op.SUBTRACT:
        return _sum(v[0], _scaled(v[1], -1.0))
    if op is Op.MULTIPLY:
        return _product(v[0], v[1])
    if op is Op.DIVIDE:
        return _product(v[0], _power(v[1], -1.0))
    if op is Op.SQRT:
        return _power(v[0], 0.5)
    if op is Op.POWER:
        exponent = v[1]
        if exponent is None or exponent.rank != (NONE, 0.0, 0.0) or exponent.rough:
            raise Open
        return _power(v[0], exponent.coefficient)
    if op is Op.EXP:
        return _exponential(v[0])
    if op is Op.LOG:
        return _logarithm(v[0])
    if op is Op.ABS:
        return _scaled(v[0], -1.0) if v[0] is not None and v[0].coefficient < 0.0 else v[0]
    if op is Op.MAXIMUM:
        return v[0] if _signed_rank(v[0]) >= _signed_rank(v[1]) else v[1]
    if op is Op.MINIMUM:
        return v[0] if _signed_rank(v[0]) <= _signed_rank(v[1]) else v[1]
    raise Open


def _scaled(v: Leading | None, factor: float) -> Leading | None:
    return None if v is None else replace(v, coefficient=factor * v.coefficient)


def _sum(a: Leading | None, b: Leading | None) -> Leading | None:
    if a is None or b is None:
        return b if a is None else a
    if a.rank != b.rank:
        return replace(a if a.rank > b.rank else b, exact=False)
    total = a.coefficient + b.coefficient
    opposite = a.coefficient * b.coefficient < 0.0
    exact = a.exact and b.exact
    if exact and total == 0.0:
        return None
    if opposite and (a.rough or b.rough or abs(total) <= 1e-9 * abs(a.coefficient)):
        raise Open
    return Leading(total, *a.rank, rough=a.rough or b.rough, exact=exact)


def _product(a: Leading | None, b: Leading | None) -> Leading | None:
    if a is None or b is None:
        return None
    x, y = a.exponential, b.exponential
    if x == NONE or y == NONE:
        exponential = x if y == NONE else y
    elif x[0] == y[0]:
        # The argument that grows faster wins; equally fast ones add up.
        same = x[:3] == y[:3]
        exponential = (*x[:3], x[3] + y[3]) if same else max(x, y, key=lambda z: z[0] * z[1])
        if not same and x[1] == y[1]:
            raise Open
    else:
        up, down = (x, y) if x[0] > 0.0 else (y, x)
        opposite = tuple(-z for z in down)
        if up == opposite:
            raise Open
        exponential = up if up > opposite else down
        if up[:3] == opposite[:3]:
            difference = up[3] - opposite[3]
            sign = math.copysign(1.0, difference)
            exponential = (sign, sign * up[1], sign * up[2], difference)
    coefficient = a.coefficient * b.coefficient
    if not coefficient or not math.isfinite(coefficient):
        raise Open
    if exponential != NONE:  # lower terms of the argument would matter more than these powers
        return Leading(math.copysign(1.0, coefficient), exponential, rough=True)
    power, logarithm = _near(a.power + b.power), _near(a.logarithm + b.logarithm)
    return Leading(coefficient, NONE, power, logarithm, a.rough or b.rough, a.exact and b.exact)


def _power(v: Leading | None, exponent: float) -> Leading | None:
    if v is None:
        if exponent > 0.0:
            return None
        raise Open
    whole = exponent == int(exponent)
    if v.coefficient < 0.0 and not whole:
        raise Open
    coefficient = abs(v.coefficient) ** exponent
    if v.coefficient < 0.0 and exponent % 2.0:
        coefficient = -coefficient
    if not coefficient or not math.isfinite(coefficient):
        raise Open
    sign, *rest = v.exponential
    exponential = NONE
    if sign:
        turned = math.copysign(1.0, exponent)
        exponential = (sign * turned, rest[0] * turned, rest[1] * turned, rest[2] * exponent)
    return Leading(coefficient, exponential, _near(v.power * exponent), _near(v.logarithm * exponent), v.rough, v.exact)


def _exponential(v: Leading | None) -> Leading:
    if v is None or v.rank < (NONE, 0.0, 0.0):
        return Leading(1.0, rough=v is not None)
    if v.rank == (NONE, 0.0, 0.0):
        return Leading(math.exp(v.coefficient), rough=True)
    sign = math.copysign(1.0, v.coefficient)
    if v.exponential != NONE:
        return Leading(1.0, (sign, sign * math.inf, 0.0, sign), rough=True)
    if v.power == 0.0 and v.logarithm == 1.0:
        if v.rough:
            raise Open
        return Leading(1.0, power=v.coefficient, rough=True)
    return Leading(1.0, (sign, sign * v.power, sign * v.logarithm, v.coefficient), rough=True)


def _logarithm(v: Leading | None) -> Leading | None:
    if v is None or v.coefficient < 0.0:
        raise Open
    sign, power, logarithm, coefficient = v.exponential
    if sign:
        if math.isinf(power):
            raise Open
        return Leading(coefficient, power=sign * power, logarithm=sign * logarithm)
    if v.power:
        return Leading(v.power, logarithm=1.0, exact=v.exact and v.coefficient == 1.0)
    if v.exact and v.coefficient == 1.0 and not v.logarithm:
        return None
    if v.logarithm or v.rough or abs(v.coefficient - 1.0) < 1e-9:
        raise Open
    return Leading(math.log(v.coefficient), exact=v.exact)


def _signed_rank(v: Leading | None) -> tuple[float, tuple[tuple[float, float, float, float], float, float] | tuple[()], float]:
    """Orders terms as the real numbers that they become."""
    if v is None:
        return 0.0, (), 0.0
    if v.coefficient > 0.0:
        return 1.0, v.rank, v.coefficient
    first, second, third, fourth = v.exponential
    return -1.0, ((-first, -second, -third, -fourth), -v.power, -v.logarithm), v.coefficient


def _near(exponent: float) -> float:
    """An exponent without the rounding of 2/3 + 1/3, so that what is constant is seen to be so."""
    whole = round(exponent * 5040.0) / 5040.0
    return whole if abs(whole - exponent) <= 4e-15 * max(abs(exponent), 1.0) else exponent
