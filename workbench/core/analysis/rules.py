"""Rules that prove convexity from the shape of an expression.

On sigma_1 >= ... >= sigma_n > 0 two facts together prove D(|q| sorted) convex in q: D is convex in sigma, and D_1 >= ... >= D_n
>= 0, so that every tangent of D stays below D under any change of signs and order (rearrangement). The second says that D rises
in the order of weak majorisation, and that is closed under sums, maxima, products and every rising function.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

from workbench.core.analysis.density import Density
from workbench.core.analysis.normal_form import Form, Monomial, NormalForms
from workbench.core.expression import Graph, Op


@dataclass(frozen=True)
class Facts:
    """What is proved of one node on descending positive singular values; False is "not proved"."""

    convex: bool = False
    concave: bool = False
    rising: bool = False  # in each singular value
    majorised: bool = False  # in the order of weak majorisation: D_1 >= ... >= D_n >= 0


CONSTANT = Facts(convex=True, concave=True, rising=True, majorised=True)


def is_proved_convex(density: Density) -> bool:
    """Whether the rules prove Theorem 8.3's condition."""
    facts = Rules(density.graph, density.order).facts[density.root]
    return facts.convex and facts.majorised


class Rules:
    """Facts of every node, arguments first."""

    def __init__(self, graph: Graph, order: list[int]) -> None:
        self.graph = graph
        self.forms = NormalForms(graph, order)
        self.facts: dict[int, Facts] = {}
        self._shapes: dict[int, str | None] = {}
        self._variable: dict[int, int | None] = {}
        self._leader: dict[int, int] = {}  # a max -> the argument that it always is
        for node in order:
            self._describe(node)
            form = self.forms.forms[node]
            self.facts[node] = self._own(node) if ((node, 1.0),) in form else self._of_form(form)

    # ------------------------------------------------------------------------------- one function of other nodes

    def _own(self, node: int) -> Facts:
        op, _, arguments = self.graph.nodes[node]
        if op is Op.VARIABLE:
            return Facts(convex=True, concave=True, rising=True, majorised=node == self.graph.variables[0])
        inner = [self.facts[a] for a in arguments]
        rising, majorised = all(f.rising for f in inner), all(f.majorised for f in inner)
        if op is Op.EXP:
            return Facts(convex=inner[0].convex, rising=rising, majorised=majorised)
        if op is Op.LOG:
            grown = self._is_sum_of_exponentials(self.forms.forms[arguments[0]])
            return Facts(convex=grown, concave=inner[0].concave, rising=rising, majorised=majorised)
        leader = self._leading(*arguments) if op is Op.MAXIMUM else None
        if leader is not None:
            self._leader[node] = leader
            return self.facts[leader]
        if op is Op.MAXIMUM:
            return Facts(convex=all(f.convex for f in inner), rising=rising, majorised=majorised)
        if op is Op.MINIMUM:
            return Facts(concave=all(f.concave for f in inner), rising=rising, majorised=majorised)
        if op is Op.ABS:
            return Facts(convex=inner[0].convex and inner[0].concave)
        return self._of_form(self.forms.forms[node], node)

    def _leading(self, a: int, b: int) -> int | None:
        """The larger one of h(sigma_i) and h(sigma_j) for a rising h, None for others."""
        a, b = self._leader.get(a, a), self._leader.get(b, b)
        i, j = self._variable[a], self._variable[b]
        same = self._shapes[a] is not None and self._shapes[a] == self._shapes[b]
        if not same or i is None or j is None or not self.facts[a].rising:
            return None
        return a if i <= j else b

    def _is_sum_of_exponentials(self, form: Form) -> bool:
        for monomial, coefficient in form.items():
            bases = [base for base, exponent in monomial if exponent > 0.0 and self.graph.nodes[base][0] is Op.EXP]
            if coefficient <= 0.0 or len(bases) != len(monomial):
                return False
            if not all(self.facts[self.graph.nodes[base][2][0]].convex for base in bases):
                return False
        return True

    # ---------------------------------------------------------------------------------------- sums of products

    def _of_form(self, form: Form, itself: int | None = None) -> Facts:
        """Facts of a sum of products; a node that is its own only term has none."""
        if itself is not None and ((itself, 1.0),) in form:
            return Facts()
        terms = {m: (self._of_product(m), c) for m, c in form.items()}
        return Facts(
            convex=all(f.convex if c > 0.0 else f.concave for f, c in terms.values()),
            concave=all(f.concave if c > 0.0 else f.convex for f, c in terms.values()),
            rising=all(c > 0.0 and f.rising for m, (f, c) in terms.items() if m),
            majorised=self._is_majorised(terms),
        )

    def _of_product(self, monomial: Monomial) -> Facts:
        if not monomial:
            return CONSTANT
        if len(monomial) == 1 and monomial[0][1] == 1.0:
            return self.facts[monomial[0][0]]
        nonnegative = all(self.forms.nonnegative[base] for base, _ in monomial)
        upward = nonnegative and all(exponent > 0.0 for _, exponent in monomial)
        return Facts(
            convex=self._is_convex_product(monomial),
            concave=nonnegative
            and all(e > 0.0 and self.facts[b].concave for b, e in monomial)
            and sum(e for _, e in monomial) <= 1.0,
            rising=upward and all(self.facts[base].rising for base, _ in monomial),
            majorised=upward and all(self.facts[base].majorised for base, _ in monomial),
        )

    def _is_convex_product(self, monomial: Monomial) -> bool:
        """Powers, norms, and a convex power over concave factors of less degree (a perspective)."""
        above = [(b, e) for b, e in monomial if e > 0.0]
        below = [(b, -e) for b, e in monomial if e < 0.0]
        if not all(self.forms.nonnegative[b] and self.facts[b].concave for b, _ in below):
            return False
        degree = sum(e for _, e in below)
        if not above:
            return True
        if len(above) > 1:
            return False
        base, exponent = above[0]
        facts = self.facts[base]
        if not below and self.graph.nodes[base][0] is Op.EXP:  # exp(u)^e = exp(e u)
            return self.facts[self.graph.nodes[base][2][0]].convex
        if facts.convex and facts.concave and exponent % 2.0 == 0.0 and exponent >= 1.0 + degree:
            return True
        if self.forms.nonnegative[base] and facts.convex and exponent >= 1.0 + degree:
            return True
        return not below and exponent * self._norm_exponent(base) >= 1.0 - 1e-12  # 1/p times p, rounded

    def _norm_exponent(self, node: int) -> float:
        """The largest p >= 1 for which the node is a sum of p-th powers of nonnegative convex functions; 0: there is none."""
        smallest = 0.0
        for monomial, coefficient in self.forms.forms[node].items():
            if coefficient < 0.0:
                return 0.0
            if not monomial:
                continue
            base, exponent = monomial[0]
            if len(monomial) > 1 or exponent < 1.0 or not (self.forms.nonnegative[base] and self.facts[base].convex):
                return 0.0
            smallest = min(smallest, exponent) if smallest else exponent
        return smallest

    # ------------------------------------------------------------------------------------- weak majorisation

    def _is_majorised(self, terms: dict[Monomial, tuple[Facts, float]]) -> bool:
        """Terms that rise by themselves, and sums of c_i h(sigma_i) with c descending and h convex and rising."""
        groups: dict[str, list[float]] = {}
        for monomial, (facts, coefficient) in terms.items():
            if not monomial:
                continue
            shape, variable = self._shape_of(monomial)
            if shape is not None and variable is not None and facts.convex and facts.rising:
                groups.setdefault(shape, [0.0] * self.graph.variable_count)[variable] += coefficient
            elif not (coefficient > 0.0 and facts.majorised):
                return False
        return all(weights[-1] >= 0.0 and all(a >= b for a, b in pairwise(weights)) for weights in groups.values())

    def _describe(self, node: int) -> None:
        """Shape of a node with its one variable left blank, and that variable; None, None for more than one."""
        op, value, arguments = self.graph.nodes[node]
        if op is Op.VARIABLE:
            self._shapes[node], self._variable[node] = "x", int(value)
            return
        shapes = [self._shapes[a] for a in arguments]
        variables = {self._variable[a] for a in arguments if self._variable[a] is not None}
        known = [shape for shape in shapes if shape is not None]
        if len(known) < len(shapes) or len(variables) > 1 or sum(map(len, known)) > 500:
            self._shapes[node] = self._variable[node] = None
            return
        self._shapes[node] = f"{value!r}" if op is Op.CONSTANT else f"{op.name}({','.join(known)})"
        self._variable[node] = variables.pop() if variables else None

    def _shape_of(self, monomial: Monomial) -> tuple[str | None, int | None]:
        variables = {self._variable[base] for base, _ in monomial}
        shapes = [self._shapes[base] for base, _ in monomial]
        if len(variables) != 1 or None in shapes:
            return None, None
        return "*".join(f"{shape}^{exponent!r}" for shape, (_, exponent) in zip(shapes, monomial, strict=True)), variables.pop()
