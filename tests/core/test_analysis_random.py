"""Random formulas: what is proved is never refuted, and every formula gets its answers without a fault."""

from __future__ import annotations

import random

import numpy as np
import pytest

from workbench.core.analysis import analyse
from workbench.core.analysis.chords import violating_chord
from workbench.core.analysis.density import Density
from workbench.core.analysis.identity import is_proved_symmetric
from workbench.core.analysis.log_convexity import is_proved_log_convex
from workbench.core.analysis.normal_form import NormalForms
from workbench.core.analysis.rules import is_proved_convex
from workbench.core.distortion import Distortion
from workbench.core.errors import FormulaError


def vector(draw: random.Random, depth: int) -> str:
    """Text of a vector as long as sigma, or of the largest ones."""
    kind = draw.random()
    if depth <= 0 or kind < 0.4:
        return "sigma"
    inner = vector(draw, depth - 1)
    if kind < 0.6:
        return f"({inner})^{draw.choice(['2', '3', '0.5', '-1', '1.5', '-2', '0.7'])}"
    if kind < 0.7:
        return f"({inner}{draw.choice('+-*/')}{draw.choice(['1', '2', '0.5', 'det'])})"
    if kind < 0.8:
        return f"{draw.choice(['exp', 'sqrt', 'abs'])}({inner})"
    return f"max({inner},{number(draw, depth - 1)})" if kind < 0.9 else f"largest({draw.choice('12')})"


def number(draw: random.Random, depth: int) -> str:
    """Text of one number a simplex."""
    kind = draw.random()
    if depth <= 0 or kind < 0.12:
        return draw.choice(["sigma1", "sigma2", "det", "max(sigma)", "min(sigma)"])
    if kind < 0.45:
        return f"{draw.choice(['sum', 'sum', 'sum', 'max', 'min', 'prod'])}({vector(draw, depth - 1)})"
    first, second = number(draw, depth - 1), number(draw, depth - 1)
    if kind < 0.62:
        return f"({first}{draw.choice('++-*/')}{second})"
    if kind < 0.72:
        return f"{draw.choice(['exp', 'sqrt', 'abs', 'log'])}({first})"
    if kind < 0.82:
        return f"({first})^{draw.choice(['2', '0.5', '-1', '1.5', '3', '(2/n)', '1.2'])}"
    return f"{draw.choice(['max', 'min'])}({first},{second})" if kind < 0.9 else f"{draw.choice(['2', '1e-2', '-1'])}*{first}"


def formulas(seed: int, count: int, n: int) -> list[Density]:
    """Random formulas that are accepted in dimension n."""
    draw, found = random.Random(seed), []
    while len(found) < count:
        text = number(draw, draw.choice([2, 3, 4]))
        try:
            found.append(Density.of(Distortion.from_formula(text), n))
        except FormulaError:
            continue
    return found


@pytest.mark.parametrize("n", [2, 3])
def test_what_is_proved_is_not_refuted(n: int) -> None:
    generator = np.random.default_rng(0)
    proved = {"convex": 0, "log convex": 0}
    for density in formulas(n, 120, n):
        sigma = -np.sort(-np.exp(generator.normal(size=(300, n))), axis=1)
        other = -np.sort(-np.exp(generator.normal(size=(300, n))), axis=1)
        if is_proved_convex(density):
            proved["convex"] += 1
            assert violating_chord(density)[0] is None
        with np.errstate(all="ignore"):
            if is_proved_log_convex(density):
                proved["log convex"] += 1
                values = [density.with_rounding(point) for point in (np.sqrt(sigma * other), sigma, other)]
                rise = values[0][0] - 0.5 * (values[1][0] + values[2][0])
                assert not (rise > sum(1e-9 * np.abs(v) + 20.0 * e for v, e in values)).any()
            if is_proved_symmetric(density):
                (a, ea), (b, eb) = density.with_rounding(sigma), density.with_rounding(1.0 / sigma[:, ::-1])
                assert not (np.abs(a - b) > 1e-9 * np.abs(a) + 20.0 * (ea + eb)).any()
            signs = NormalForms(density.graph, density.order).nonnegative
            for node, values in density.nodes(sigma).items():
                finite = values[np.isfinite(values)]
                assert not signs[node] or not len(finite) or finite.min() >= -1e-9 * max(1.0, np.abs(finite).max())
    assert proved["convex"] >= 10 and proved["log convex"] >= 20


@pytest.mark.parametrize("n", [2, 3])
def test_every_formula_gets_its_answers(n: int) -> None:
    draw, count = random.Random(10 + n), 0
    while count < 25:
        text = number(draw, draw.choice([3, 4, 5]))
        try:
            analysis = analyse(Distortion.from_formula(text), n)
        except FormulaError:
            continue
        count += 1
        for _, found in analysis.items():
            assert found.sentence and (found.witness is None) == (found.holds is not False), text
