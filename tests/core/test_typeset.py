"""Formulas as LaTeX: what is written is what is meant, and it can be drawn."""

from __future__ import annotations

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from workbench.core.errors import FormulaError
from workbench.core.registry import registry
from workbench.core.typeset import latex_of_formula, latex_of_name, latex_terms

TITLES = {"symmetric_dirichlet": "SD", "mips": "MIPS"}


@pytest.mark.parametrize(
    ("formula", "latex"),
    [
        ("max(sigma)/min(sigma)", r"\frac{\sigma_{1}}{\sigma_{n}}"),
        ("sum(sigma^2)", r"\sum_{i=1}^{n}\, \sigma_{i}^{2}"),
        ("sum(sigma^2 + 1)", r"\sum_{i=1}^{n}\, \left(\sigma_{i}^{2} + 1\right)"),
        ("sum(largest(k))", r"\sum_{i=1}^{k}\, \sigma_{i}"),
        ("max(sigma^2)", r"\max_{i}\, \sigma_{i}^{2}"),
        ("sigma1 - (sigma2 - 1)", r"\sigma_{1} - \left(\sigma_{2} - 1\right)"),
        ("sigma1 - sigma2 - 1", r"\sigma_{1} - \sigma_{2} - 1"),
        ("(sigma1 + 1)*2", r"\left(\sigma_{1} + 1\right) \cdot 2"),
        ("sum(sigma)*2", r"\left(\sum_{i=1}^{n}\, \sigma_{i}\right) \cdot 2"),
        ("-sigma1^2", r"-\sigma_{1}^{2}"),
        ("(-sigma1)^2", r"\left(-\sigma_{1}\right)^{2}"),
        ("(sigma1^2)^alpha", r"\left(\sigma_{1}^{2}\right)^{\alpha}"),
        ("sigma1^2^3", r"\sigma_{1}^{2^{3}}"),
        ("sigma1^(2/n)", r"\sigma_{1}^{2/n}"),
        ("det^2", r"\left(\det J\right)^{2}"),
        ("exp(det)", r"e^{\det J}"),
        ("abs(sigma1)", r"\left|\sigma_{1}\right|"),
        ("1e-6*sigma1", r"10^{-6}\, \sigma_{1}"),
        ("symmetric_dirichlet + t", r"D_{\mathrm{SD}} + t"),
    ],
)
def test_brackets_stand_where_they_change_the_meaning(formula: str, latex: str) -> None:
    assert latex_of_formula(formula, TITLES) == latex


def test_a_sum_within_a_sum_has_an_index_of_its_own() -> None:
    assert latex_of_formula("sum(sigma/sum(sigma))") == (r"\sum_{i=1}^{n}\, \frac{\sigma_{i}}{\sum_{j=1}^{n}\, \sigma_{j}}")


@pytest.mark.parametrize(
    ("name", "latex"),
    [("lam", r"\lambda"), ("alpha", r"\alpha"), ("t", "t"), ("a1", "a_{1}"), ("soft_factor", r"\mathrm{soft\ factor}")],
)
def test_names_of_parameters(name: str, latex: str) -> None:
    assert latex_of_name(name) == latex


def test_a_long_sum_can_be_broken_between_its_terms() -> None:
    terms = latex_terms("sigma1 - (sigma2 + 1) + det")
    assert terms == (r"\sigma_{1}", r"- \left(\sigma_{2} + 1\right)", r"+ \det J")


@pytest.mark.parametrize("text", ["", "sigma[0]", "__import__('os')", "sigma.real", "lambda: 1", "open(sigma)", "sum(k=1)"])
def test_what_is_no_formula_is_refused(text: str) -> None:
    with pytest.raises(FormulaError):
        latex_of_formula(text)


def test_a_chain_without_brackets_ends_in_a_sentence() -> None:
    with pytest.raises(FormulaError):
        latex_of_formula("*".join(["sigma1"] * 200))


def drawn_width(latex: str) -> float:
    mathtext = pytest.importorskip("matplotlib.mathtext")
    return mathtext.MathTextParser("agg").parse(f"${latex}$", dpi=72).width


def test_every_distortion_can_be_drawn() -> None:
    for item in registry().distortions.values():
        assert drawn_width(latex_of_formula(item.formula)) > 10, item.id


_leaves = st.sampled_from(["sigma", "sigma1", "sigman", "det", "n", "2", "0.5", "1e-5", "alpha", "mips", "weight"])
_formulas = st.recursive(
    _leaves,
    lambda inner: st.one_of(
        st.builds("({} {} {})".format, inner, st.sampled_from("+-*/^"), inner),
        st.builds("{}({})".format, st.sampled_from(["sum", "prod", "exp", "log", "sqrt", "abs", "max", "min"]), inner),
        st.builds("max({}, {})".format, inner, inner),
        st.builds("-{}".format, inner),
    ),
    max_leaves=8,
)


@settings(max_examples=60)
@given(_formulas)
def test_any_formula_can_be_drawn(text: str) -> None:
    latex = latex_of_formula(text, TITLES)
    assert drawn_width(latex) > 0
    assert latex == " ".join(latex_terms(text, TITLES))


@settings(max_examples=100)
@given(_formulas)
def test_typesetting_keeps_every_number_and_name(text: str) -> None:
    """Leaves come in their order; folding `max(sigma)` to the first value and counts of sums aside."""
    plain = re.sub(r"\b(max|min)\(sigma\)", "sigma", text)
    latex = re.sub(r"_\{[ijkl_{}0-9]+=1\}\^\{[^}]*\}", "", latex_of_formula(text, TITLES))
    assert latex.count(r"\sigma") == len(re.findall(r"\bsigma\w*", plain))
    assert latex.count(r"\det") == len(re.findall(r"\bdet\b", plain))
    assert latex.count("0.5") == text.count("0.5")
    assert latex.count(r"\mathrm{weight}") == text.count("weight")
