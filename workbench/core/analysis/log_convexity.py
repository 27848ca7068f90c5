"""Rules that prove convexity in log sigma: there a product of powers is the exponential of a linear function.

Posynomials, their maxima and exponentials are convex in log sigma, whatever they are in sigma: a local minimum of theirs is the
global one.
"""

from __future__ import annotations

from dataclasses import dataclass

from workbench.core.analysis.density import Density
from workbench.core.analysis.normal_form import Form, Monomial, NormalForms
from workbench.core.expression import Op


@dataclass(frozen=True)
class LogFacts:
    """What is proved of a node as a function of log sigma; False is "not proved"."""

    affine: bool = False
    convex: bool = False
    log_affine: bool = False
    log_convex: bool = False


def is_proved_log_convex(density: Density) -> bool:
    """Whether the rules prove D convex in log sigma."""
    return LogRules(density).facts[density.root].convex


class LogRules:
    """Facts of every node of a density, arguments first."""

    def __init__(self, density: Density) -> None:
        self.graph = density.graph
        self.forms = NormalForms(density.graph, density.order)
        self.facts: dict[int, LogFacts] = {}
        for node in density.order:
            form = self.forms.forms[node]
            self.facts[node] = self._own(node) if ((node, 1.0),) in form else self._of_form(form)

    def _own(self, node: int) -> LogFacts:
        op, _, arguments = self.graph.nodes[node]
        inner = [self.facts[a] for a in arguments]
        if op is Op.VARIABLE:
            return LogFacts(convex=True, log_affine=True, log_convex=True)
        if op is Op.EXP:
            return LogFacts(convex=inner[0].convex, log_affine=inner[0].affine, log_convex=inner[0].convex)
        if op is Op.LOG:
            return LogFacts(affine=inner[0].log_affine, convex=inner[0].log_convex)
        if op is Op.MAXIMUM:
            return LogFacts(convex=all(f.convex for f in inner), log_convex=all(f.log_convex for f in inner))
        if op is Op.ABS:
            return LogFacts(convex=inner[0].affine)
        return LogFacts()

    def _of_form(self, form: Form) -> LogFacts:
        terms = [(self._of_product(monomial), coefficient) for monomial, coefficient in form.items()]
        positive = all(coefficient > 0.0 for _, coefficient in terms)
        return LogFacts(
            affine=all(facts.affine for facts, _ in terms),
            convex=all(facts.convex if coefficient > 0.0 else facts.affine for facts, coefficient in terms),
            log_affine=positive and len(terms) == 1 and terms[0][0].log_affine,
            log_convex=positive and bool(terms) and all(facts.log_convex for facts, _ in terms),
        )

    def _of_product(self, monomial: Monomial) -> LogFacts:
        if not monomial:
            return LogFacts(affine=True, convex=True, log_affine=True, log_convex=True)
        if len(monomial) == 1 and monomial[0][1] == 1.0:
            return self.facts[monomial[0][0]]
        factors = [(self.facts[base], exponent) for base, exponent in monomial]
        log_affine = all(facts.log_affine for facts, _ in factors)
        log_convex = all(facts.log_affine or (facts.log_convex and exponent > 0.0) for facts, exponent in factors)
        convex = log_convex
        if len(factors) == 1 and factors[0][1] >= 1.0:
            facts, exponent = factors[0]
            nonnegative = self.forms.nonnegative[monomial[0][0]]
            convex |= (facts.convex and nonnegative) or (facts.affine and exponent % 2.0 == 0.0)
        return LogFacts(convex=convex, log_affine=log_affine, log_convex=log_convex)
