"""Expressions as sums of products of powers, which is the form that rules about sign, growth and convexity speak of."""

from __future__ import annotations

import math

from workbench.core.expression import Graph, Op

Monomial = tuple[tuple[int, float], ...]
"""(node, exponent) in the order of the nodes; () is the constant 1."""
Form = dict[Monomial, float]
"""monomial -> coefficient, not 0; {} is 0."""

MAXIMUM_TERMS = 60
"""A longer sum is one opaque node to whatever uses it, so that no text makes this slow."""


class NormalForms:
    """Forms of the nodes of a graph on positive variables, and the signs that they show.

    Products of sums are not multiplied out: such a sum is itself a factor. Powers are merged only where that is an identity.
    """

    def __init__(self, graph: Graph, order: list[int]) -> None:
        self.graph = graph
        self.forms: dict[int, Form] = {}
        self.nonnegative: dict[int, bool] = {}
        for node in order:
            form = self._form(node)
            self.forms[node] = form if len(form) <= MAXIMUM_TERMS else {((node, 1.0),): 1.0}
            self.nonnegative[node] = self._is_nonnegative(node)

    # ------------------------------------------------------------------------------------------------- forms

    def _form(self, node: int) -> Form:
        op, value, arguments = self.graph.nodes[node]
        opaque: Form = {((node, 1.0),): 1.0}
        if op is Op.CONSTANT:
            return {(): value} if value else {}
        if op in (Op.ADD, Op.SUBTRACT):
            return _sum(self.forms[arguments[0]], self.forms[arguments[1]], 1.0 if op is Op.ADD else -1.0)
        if op is Op.MULTIPLY:
            return self._product(arguments[0], self.forms[arguments[1]], self._factor(arguments[1]))
        if op is Op.DIVIDE:
            inverse = self._power(arguments[1], -1.0)
            return opaque if inverse is None else self._product(arguments[0], inverse, inverse)
        exponent = 0.5 if op is Op.SQRT else self.graph.constant_value(arguments[1]) if op is Op.POWER else None
        if exponent is not None:
            return self._power(arguments[0], exponent) or opaque
        if op is Op.ABS and self.nonnegative[arguments[0]]:
            return self.forms[arguments[0]]
        if op in (Op.MAXIMUM, Op.MINIMUM):
            ordered = self._ordered(*arguments)
            return opaque if ordered is None else self.forms[ordered[0 if op is Op.MAXIMUM else 1]]
        return opaque

    def _ordered(self, a: int, b: int) -> tuple[int, int] | None:
        """(larger, smaller) where one of them is never less than the other; None elsewhere."""
        difference = _sum(self.forms[a], self.forms[b], -1.0)
        if self._is_nonnegative_form(difference):
            return a, b
        return (b, a) if self._is_nonnegative_form({monomial: -c for monomial, c in difference.items()}) else None

    def _factor(self, node: int) -> Form:
        """The node as one product: its form where that has one term, else the node itself."""
        form = self.forms[node]
        return form if len(form) <= 1 else {((node, 1.0),): 1.0}

    def _product(self, left: int, right: Form, right_factor: Form) -> Form:
        """The product of a node and a form; a product of singular values is spread over a sum's terms, others are factors."""
        a, b = self.forms[left], right
        if not (self._spreads(a) or self._spreads(b)):
            a, b = self._factor(left), right_factor
        result: Form = {}
        for first, x in a.items():
            for second, y in b.items():
                result = _sum(result, {_merged(first, second): x * y}, 1.0)
        return result

    def _spreads(self, form: Form) -> bool:
        """Whether a form is 0, or one product of singular values only."""
        return not form or (len(form) == 1 and all(base in self.graph.variables for base, _ in next(iter(form))))

    def _power(self, node: int, exponent: float) -> Form | None:
        """The form of a constant power, None where there is no such rule."""
        form = self.forms[node]
        if len(form) != 1:
            return {((node, exponent),): 1.0} if form else None
        ((monomial, coefficient),) = form.items()
        whole = exponent == int(exponent)
        if not whole and not (coefficient > 0.0 and all(self.nonnegative[base] for base, _ in monomial)):
            return {((node, exponent),): 1.0}
        try:
            scale = coefficient**exponent
        except (OverflowError, ZeroDivisionError):
            return None
        if isinstance(scale, complex) or not math.isfinite(scale) or not scale:
            return None
        return {tuple((base, _rounded(e * exponent)) for base, e in monomial): scale}

    # ------------------------------------------------------------------------------------------------- signs

    def _is_nonnegative(self, node: int) -> bool:
        op, _, arguments = self.graph.nodes[node]
        if op in (Op.VARIABLE, Op.EXP, Op.ABS, Op.SQRT):
            return True
        if op is Op.MAXIMUM:
            return any(self.nonnegative[a] for a in arguments)
        if op is Op.MINIMUM or (op is Op.POWER and self.graph.constant_value(arguments[1]) is None):
            return self.nonnegative[arguments[0]] and (op is Op.POWER or self.nonnegative[arguments[1]])
        form = self.forms[node]
        if ((node, 1.0),) in form:
            return False
        return self._is_nonnegative_form(form)

    def _is_nonnegative_form(self, form: Form) -> bool:
        """Whether each term is nonnegative, a product of nonnegative factors or even powers, or they are so together."""
        return self._is_ordered_sum(form) or all(
            c >= 0.0 and all(self.nonnegative[base] or exponent % 2.0 == 0.0 for base, exponent in monomial)
            for monomial, c in form.items()
        )

    def _is_ordered_sum(self, form: Form) -> bool:
        """Whether sum c_i sigma_i + c_0 is nonnegative because the singular values descend, as sigma_1 - sigma_n is."""
        weights = self.weights(form)
        if weights is None or form.get((), 0.0) < 0.0:
            return False
        total = 0.0
        for weight in weights:
            total += weight
            if total < 0.0:
                return False
        return True

    def weights(self, form: Form) -> list[float] | None:
        """c_1 .. c_n of an affine form c_0 + sum c_i sigma_i, None for any other."""
        single = {((variable, 1.0),): 0 for variable in self.graph.variables}
        if any(monomial not in single for monomial in form if monomial):
            return None
        return [form.get(((variable, 1.0),), 0.0) for variable in self.graph.variables]


def _sum(a: Form, b: Form, sign: float) -> Form:
    result = dict(a)
    for monomial, coefficient in b.items():
        total = result.get(monomial, 0.0) + sign * coefficient
        if total:
            result[monomial] = total
        else:
            result.pop(monomial, None)
    return result


def _merged(first: Monomial, second: Monomial) -> Monomial:
    exponents = dict(first)
    for base, exponent in second:
        exponents[base] = _rounded(exponents.get(base, 0.0) + exponent)
    return tuple(sorted((base, exponent) for base, exponent in exponents.items() if exponent))


def _rounded(exponent: float) -> float:
    """The exponent without the last digits' noise of 3 * (1/3), so that equal powers are equal."""
    near = round(exponent * 5040.0) / 5040.0
    return near if abs(near - exponent) <= 4e-15 * max(abs(exponent), 1.0) else exponent
