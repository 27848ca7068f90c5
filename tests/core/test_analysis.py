"""Badges of every built-in distortion as the survey has them, and witnesses that are checked anew."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from workbench.core.analysis import Analysis, Property, analyse
from workbench.core.analysis.convexity import convexity
from workbench.core.analysis.density import Density
from workbench.core.analysis.properties import NAMES
from workbench.core.distortion import Distortion
from workbench.core.registry import registry

# normalised, symmetric, bottom barrier, top barrier, smooth almost everywhere, regular, convex
ALL = "yes yes yes yes yes yes no"
NOT_SYMMETRIC = "yes no yes yes yes no no"
GAUGE = "no no no yes yes no yes"
EXPECTED = {
    "dirichlet": (GAUGE, GAUGE),
    "mips": (ALL, NOT_SYMMETRIC),
    "condition-number": (ALL, ALL),
    "qc-dilatation": (ALL, ALL),
    "qc-inner": (ALL, NOT_SYMMETRIC),
    "qc-outer": (ALL, NOT_SYMMETRIC),
    "volume": ("yes yes no no yes no no",) * 2,
    "symmetric-dirichlet": (ALL, ALL),
    "symmetric-dirichlet-filtered": (ALL, ALL),
    "arap": ("yes no no yes yes no no",) * 2,
    "arap-barrier": ("yes no no yes yes no no",) * 2,
    "symmetric-arap": (ALL, ALL),
    "amips": (ALL, NOT_SYMMETRIC),
    "amips-smooth": (ALL, NOT_SYMMETRIC),
    "quasi-isometric": (ALL, ALL),
    "average-singular-value": (GAUGE, GAUGE),
    "lp-gauge": (GAUGE, GAUGE),
    "spectral": (GAUGE, GAUGE),
    "ky-fan": (GAUGE, GAUGE),
    "blend": (ALL, ALL),
    "exp-blend": (ALL, ALL),
}
"""id -> (n = 2, n = 3), as the survey's section 2.6, Corollary 2.1 and section 8 have it."""
ANSWERS = {"yes": True, "no": False}
BUILT_IN = sorted(id for id in registry().distortions if id in EXPECTED)


def verdicts(analysis: Analysis) -> dict[str, bool | None]:
    """name -> holds."""
    return {name: found.holds for name, found in analysis.items()}


@cache
def badges(id: str, n: int) -> Analysis:
    """Analysis of a built-in distortion, made once."""
    return analyse(registry().distortions[id], n)


def signed_value(distortion: Distortion, q: np.ndarray) -> float:
    """D of diag(q) through its singular values, without the search's own helpers."""
    sigma = np.linalg.svd(np.diag(q), compute_uv=False)
    return float(distortion.value(sigma[None])[0])


def test_every_built_in_distortion_is_in_the_table() -> None:
    assert set(registry().distortions) == set(BUILT_IN)


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("id", BUILT_IN)
def test_the_table(id: str, n: int) -> None:
    expected = dict(zip(NAMES, (ANSWERS[word] for word in EXPECTED[id][n - 2].split()), strict=True))
    assert verdicts(badges(id, n)) == expected


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("id", BUILT_IN)
def test_witnesses_hold_when_computed_anew(id: str, n: int) -> None:
    distortion, analysis = registry().distortions[id], badges(id, n)
    for _, found in analysis.items():
        assert (found.witness is None) == (found.holds is not False)
    at_ones = signed_value(distortion, np.ones(n))
    assert analysis.normalised.value == pytest.approx(at_ones, rel=1e-12)
    if (w := analysis.normalised.witness) is not None:
        assert signed_value(distortion, np.array(w["sigma"])) == pytest.approx(w["value"], rel=1e-12)
        assert w["value"] < at_ones
    if (w := analysis.symmetric.witness) is not None:
        assert np.allclose(np.sort(w["inverse"]), np.sort(1.0 / np.array(w["sigma"])), rtol=1e-15)
        assert signed_value(distortion, np.array(w["sigma"])) == pytest.approx(w["value"], rel=1e-12)
        assert signed_value(distortion, np.array(w["inverse"])) == pytest.approx(w["value_at_inverse"], rel=1e-12)
        assert abs(w["value"] - w["value_at_inverse"]) > 1e-6 * abs(w["value"])
    for which, column in (("bottom_barrier", -1), ("top_barrier", 0)):
        if (w := getattr(analysis, which).witness) is None:
            continue
        sigma = np.array(w["sigma"])
        assert (np.diff(sigma, axis=1) <= 1e-12 * sigma[:, :-1]).all() and (sigma > 0).all()
        if which == "bottom_barrier":
            assert sigma[-1, column] < 1e-6 and (sigma[:, 0] >= 0.1).all()
        else:
            assert sigma[-1, column] > 1e6 and (sigma[:, -1] <= 10.0).all()
        values = distortion.value(sigma)
        assert np.allclose(values, w["values"], rtol=1e-9)
        assert values[-1] <= 2.0 * np.abs(values[:3]).max() + 1.0
    if (w := analysis.convex.witness) is not None:
        start, middle, end = (np.array(q) for q in w["points"])
        t = w["weight"]
        assert 0.0 < t < 1.0 and np.allclose(middle, (1.0 - t) * start + t * end, atol=1e-15)
        assert all(np.linalg.det(np.array(matrix)) != 0.0 for matrix in w["matrices"])
        a, m, b = (signed_value(distortion, q) for q in (start, middle, end))
        assert np.allclose([a, m, b], w["values"], rtol=1e-12)
        assert m > (1.0 - t) * a + t * b + 1e-6


def test_mips_in_space_is_not_symmetric_by_the_known_numbers() -> None:
    witness = badges("mips", 3).symmetric.witness
    assert witness is not None and witness["sigma"] == [2.0, 1.0, 1.0]
    assert [witness["value"], witness["value_at_inverse"]] == pytest.approx([3.780, 3.572], abs=1e-3)


def convex(distortion: Distortion, n: int) -> Property:
    """That part of the analysis alone."""
    return convexity(Density.of(distortion, n), distortion.has_barrier(n))


GAUGES = [
    *(("lp-gauge", {"p": p}) for p in (1.0, 1.5, 2.0, 3.0, 7.3, 20.0)),
    *(("ky-fan", {"k": k}) for k in (1, 2)),
    ("spectral", {}),
    ("average-singular-value", {}),
    ("dirichlet", {}),
]


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize(("id", "values"), GAUGES)
def test_gauges_are_convex_for_every_parameter(id: str, values: dict[str, float], n: int) -> None:
    found = convex(registry().distortions[id].with_values(values), n)
    assert found.holds and found.method == "both"


CONVEX = [
    "sum(sigma)^2",
    "sum(sigma^p)",
    "sum(sigma^3)^(1/2)",
    "exp(sum(sigma))",
    "log(sum(exp(sigma)))",
    "2*sigma1 + sigma2",
    "max(sum(sigma), 2*max(sigma), 1)",
    "average_singular_value^3",
    "0.3*dirichlet + 0.7*spectral",
    "max(sigma^2)",
    "sum(sqrt(1 + sigma^2))",
    "sum(sigma^2)/2 + sum(sigma)/3 - 5",
    "sqrt(sum(largest(2)^2))",
]
NOT_CONVEX = [
    "min(sigma)",
    "sigma1 - sigma2",
    "sigma1 + 2*sigma2",
    "sum(sigma^0.5)",
    "sum(sqrt(sigma))^2",
    "sqrt(sum(sigma))",
    "det",
    "sum(sigma^2) - 0.01*sigma2",
    "max(sigma)^2 + 0.1*min(sigma)",
    "sum(sigma^2 + 1e-9/sigma^2)",
    "sum(sigma)^2 - sum(sigma^2)",
    "sum(abs(sigma - 1))",
    "max(sigma)^3/sum(sigma)",
    "log(sum(sigma))",
    "prod(1 + sigma)",
    "sum(sigma^2) + (1 - p/2.5)/max(sigma)",
]


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("text", CONVEX + NOT_CONVEX)
def test_convexity_of_formulas(text: str, n: int) -> None:
    values = {"p": 1.7} if "p" in text.replace("prod", "").replace("exp", "").replace("spectral", "") else {}
    assert convex(Distortion.resolve(text, values), n).holds is (text in CONVEX)


def test_a_convex_function_of_sorted_values_may_be_no_convex_function_of_the_map() -> None:
    """(32) and (33) are convex in sigma itself: what breaks convexity is the way through a collapse (Theorem 8.2)."""
    for id in ("arap", "symmetric-dirichlet"):
        witness = badges(id, 2).convex.witness
        assert witness is not None and min(min(q) for q in witness["points"]) < 0.0


@pytest.mark.parametrize("n", [2, 3])
def test_a_jump_at_the_collapse_is_never_convex_and_no_barrier_in_the_limit(n: int) -> None:
    walled = Distortion("walled", "walled", "sum(sigma^2)", barrier=True)
    analysis = analyse(walled, n)
    assert analysis.convex.holds is False and analysis.bottom_barrier.holds is False
    witness = analysis.convex.witness
    assert witness is not None and np.linalg.det(witness["matrices"][1]) == 0.0
    assert all(np.linalg.det(witness["matrices"][k]) > 0.0 for k in (0, 2))


def test_a_large_constant_hides_no_barrier() -> None:
    found = analyse(Distortion.from_formula("1e6 + log(1 + sigma1/sigma2)"), 2)
    assert found.bottom_barrier.holds and found.top_barrier.holds and found.normalised.holds


@pytest.mark.parametrize("n", [2, 3])
def test_analysis_is_deterministic(n: int) -> None:
    for id in ("lp-gauge", "volume", "amips"):
        assert analyse(registry().distortions[id], n) == badges(id, n)


def test_where_the_formula_means_nothing_it_says_so() -> None:
    from workbench.core.errors import FormulaError

    with pytest.raises(FormulaError, match="sigma3 does not exist"):
        analyse(Distortion.from_formula("sigma3 + det"), 2)
