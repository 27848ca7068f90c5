"""Identities of formulas, proved by arithmetic in a finite field at random points.

Two expressions that agree at random points modulo a large prime are equal as rational functions, but for a chance of about
2^-100 (Schwartz-Zippel). Rational powers are exact as well: the singular values are squares modulo p = 2q + 1, and in the group
of squares, of prime order q, every power has a meaning under which the laws of powers hold. exp, log, max, min and abs are
names: each gives a number that depends on its argument (of max and min: on the set of their arguments) and on nothing else, so
that equal results still mean equal functions; of their own laws only exp(-x) = 1/exp(x) and log(1/x) = -log(x) are built in.
What is found equal is equal; what is not may be so by a law not known here.
"""

from __future__ import annotations

import hashlib
import random
from collections.abc import Sequence
from fractions import Fraction

from workbench.core.analysis.density import Density
from workbench.core.expression import Op

ORDER = 85070591730234615865843651857942051503
PRIME = 2 * ORDER + 1
"""Both are prime."""
DRAWS = 3


class UndefinedError(ArithmeticError):
    """A division by zero, or an operation without a meaning in the field."""


def is_proved_symmetric(density: Density) -> bool:
    """Whether D(sigma_1, ..., sigma_n) = D(1/sigma_n, ..., 1/sigma_1) is an identity."""
    generator = random.Random(22)
    try:
        for _ in range(DRAWS):
            sigma = [pow(generator.randrange(2, PRIME - 1), 2, PRIME) for _ in range(density.dimension)]
            inverse = [pow(value, -1, PRIME) for value in reversed(sigma)]
            if residue(density, sigma) != residue(density, inverse):
                return False
    except UndefinedError:
        return False
    return True


def residue(density: Density, sigma: Sequence[int]) -> int:
    """D modulo PRIME at squares `sigma`. Raises `UndefinedError`."""
    values: dict[int, int] = {}
    sets: dict[int, frozenset[int]] = {}  # arguments of nested max and min as one set
    for node in density.order:
        op, value, arguments = density.graph.nodes[node]
        if op is Op.CONSTANT:
            values[node] = _constant(value)
        elif op is Op.VARIABLE:
            values[node] = sigma[int(value)]
        elif op in (Op.MAXIMUM, Op.MINIMUM):
            chosen: frozenset[int] = frozenset()
            for a in arguments:
                chosen |= sets[a] if density.graph.nodes[a][0] is op else {values[a]}
            sets[node] = chosen
            values[node] = next(iter(chosen)) if len(chosen) == 1 else _name(op, sorted(chosen))
        else:
            exponent = density.graph.constant_value(arguments[1]) if op is Op.POWER else None
            values[node] = _combined(op, [values[a] for a in arguments], exponent)
    return values[density.root]


def _combined(op: Op, v: list[int], exponent: float | None) -> int:
    if op is Op.ADD:
        return (v[0] + v[1]) % PRIME
    if op is Op.SUBTRACT:
        return (v[0] - v[1]) % PRIME
    if op is Op.MULTIPLY:
        return v[0] * v[1] % PRIME
    if op is Op.DIVIDE:
        return v[0] * _power(v[1], Fraction(-1)) % PRIME
    if op is Op.SQRT:
        return _power(v[0], Fraction(1, 2))
    if op is Op.POWER and exponent is not None:
        return _power(v[0], _fraction(exponent))
    if op is Op.ABS:
        return _name(op, sorted((v[0], (PRIME - v[0]) % PRIME)))
    if op is Op.EXP:  # so that exp(-x) = 1/exp(x)
        return _name(op, v) * _power(_name(op, [-v[0] % PRIME]), Fraction(-1)) % PRIME
    if op is Op.LOG:  # so that log(1/x) = -log(x)
        return (_name(op, v) - _name(op, [_power(v[0], Fraction(-1))])) % PRIME
    if op is Op.POWER:
        return _name(op, v)
    raise UndefinedError


def _power(base: int, exponent: Fraction) -> int:
    if base == 0:
        raise UndefinedError
    if exponent.denominator == 1:
        return pow(base, int(exponent), PRIME)
    # The square is in the group of order q, where 2 and every denominator below q have an inverse.
    root = exponent.numerator * pow(2 * exponent.denominator, -1, ORDER) % ORDER
    return pow(base * base % PRIME, root, PRIME)


def _constant(value: float) -> int:
    exact = _fraction(value)
    return exact.numerator * pow(exact.denominator, -1, PRIME) % PRIME


def _fraction(value: float) -> Fraction:
    """The short fraction that a number stands for, such as 2/3 for 0.666..., else the number exactly."""
    try:
        exact = Fraction(value)
    except (ValueError, OverflowError):
        raise UndefinedError from None
    short = exact.limit_denominator(10_000)
    return short if float(short) == value else exact


def _name(op: Op, arguments: Sequence[int]) -> int:
    text = op.name + ",".join(map(str, arguments))
    return int.from_bytes(hashlib.blake2b(text.encode(), digest_size=32).digest(), "big") % PRIME
