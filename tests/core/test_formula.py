"""Laws of the formula language: what is good gives the right numbers, what is hostile is refused and never runs."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest
import sympy

from workbench.core.distortion import Distortion
from workbench.core.errors import FormulaError, WorkbenchError
from workbench.core.formula import compile_formula, names_in_formula

GOOD = {
    "sum(sigma^2 + 1/sigma^2)": lambda s: (s**2 + s**-2).sum(),
    "max(sigma)/min(sigma)": lambda s: s[0] / s[-1],
    "sum(sigma^2)/prod(sigma)^(2/n)": lambda s: (s**2).sum() / s.prod() ** (2 / len(s)),
    "exp(0.5*max(prod(sigma), 1/prod(sigma)))": lambda s: math.exp(0.5 * max(s.prod(), 1 / s.prod())),
    "sum((sigma - 1)**2)": lambda s: ((s - 1) ** 2).sum(),
    "sum(abs(log(sigma)))": lambda s: np.abs(np.log(s)).sum(),
    "sqrt(sum(sigma^4)) - -1": lambda s: math.sqrt((s**4).sum()) + 1,
    "sum(largest(2))": lambda s: s[:2].sum(),
    "sigma1^2.5 + sigman^-1.5": lambda s: s[0] ** 2.5 + s[-1] ** -1.5,
    "2*det + 1e-3/det": lambda s: 2 * s.prod() + 1e-3 / s.prod(),
    "lam*symmetric_dirichlet + (1 - lam)*condition_number": lambda s: 0.25 * (s**2 + s**-2).sum() + 0.75 * s[0] / s[-1],
    "-2^2 + sum(sigma)": lambda s: -4 + s.sum(),
}

HOSTILE = [
    "__import__('os').system('true')",
    "__import__",
    "sigma.__class__",
    "sigma.shape",
    "(1).real",
    "sigma[0]",
    "[s for s in sigma]",
    "(s for s in sigma)",
    "{1: 2}",
    "lambda: sigma1",
    "sigma1 if sigma2 else 1",
    "sigma1 and sigma2",
    "not sigma1",
    "sigma1 < sigma2",
    "sigma1 == 1",
    "x := sigma1",
    "sigma1; sigma2",
    "import os",
    "f'{sigma1}'",
    "'sigma1'",
    "b'x'*sigma1",
    "sigma1 // 2",
    "sigma1 % 2",
    "sigma1 << 2",
    "sigma1 @ sigma2",
    "~sigma1",
    "sum(*sigma)",
    "sum(sigma, axis=0)",
    "sum(**sigma)",
    "sum()",
    "eval(sigma1)",
    "exec(sigma1)",
    "open(sigma1)",
    "quux + sigma1",
    "1j*sigma1",
    "True*sigma1",
    "None",
    "...",
    "9^9^9^9^9*sigma1",
    "sigma1^10000000",
    "sigma1^(1e3*1e4)",
    "1e400*sigma1",
    "1e7*sigma1",
    "2^(2^(2^(2^(2^2))))*sigma1",
    "(" * 80 + "sigma1" + ")" * 80,
    "-" * 1500 + "sigma1",
    "exp(" * 65 + "sigma1" + ")" * 65,
    "sigma1+" * 400 + "sigma1",
    "sigma1" + "*sigma1" * 400,
    "sigma1^" * 100 + "2",
    "sum(sigma" + " " * 3000 + ")",
    "sigma1\x00",
    "sigma1\n+ 1",
    "ſigma1",
    "sigma99",
    "sigma0",
    "largest(9)",
    "largest(sigma1)",
    "sum(largest(1.5))",
    "max",
    "sigma",
    "largest(2)",
    "1",
    "n*2",
    "",
    "   ",
    ")(",
    "sigma1 +",
    "log(0)*sigma1",
    "sqrt(-sigma1)",
    "1/(sigma1 - sigma1)",
    "exp(exp(exp(exp(sigma1))))",
    "log(sigma1 - 1)",
    "sigma1(2)",
    "sum(sigma)(2)",
    "1if 1else sigma1",
]


@pytest.mark.parametrize("text", GOOD)
@pytest.mark.parametrize("dimension", [2, 3])
def test_good_formulas_have_the_right_values(text: str, dimension: int) -> None:
    values = {"lam": 0.25} if "lam" in text else {}
    distortion = Distortion.resolve(text, values)
    for sigma in ([1.0, 1.0, 1.0], [2.5, 1.25, 0.4], [0.9, 0.8, 0.7]):
        point = np.array(sigma[:dimension])
        assert distortion.value(point)[0] == pytest.approx(GOOD[text](point), rel=1e-13)


@pytest.mark.parametrize("text", HOSTILE)
def test_hostile_texts_are_refused_with_a_sentence(text: str) -> None:
    begin = time.perf_counter()
    with pytest.raises(WorkbenchError) as caught:
        Distortion.resolve(text)
    assert caught.value.sentence.strip().endswith((".", "?"))
    assert time.perf_counter() - begin < 30  # none hangs (not a measurement)
    if isinstance(caught.value, FormulaError):
        assert 0 <= caught.value.position <= len(text)


def test_a_deep_but_allowed_formula_has_derivatives() -> None:
    text = "exp(" * 20 + "-sum(sigma^2)" + ")" * 20
    with pytest.raises(FormulaError, match="finite"):
        compile_formula(text, 3)
    compiled = compile_formula("sqrt(1 + " * 30 + "sum(sigma^2)" + ")" * 30, 3)
    assert np.isfinite(compiled.hessian.evaluate(np.array([[2.0, 1.0, 0.5]]))).all()


@pytest.mark.parametrize("text", [t for t in GOOD if "largest" not in t and "_" not in t])
def test_derivatives_agree_with_sympy(text: str) -> None:
    s = sympy.symbols("sigma1:4", positive=True)
    names = {"sigma1": s[0], "sigman": s[2], "n": 3, "det": s[0] * s[1] * s[2]}
    outside = {
        "sum(sigma^2 + 1/sigma^2)": sum(x**2 + x**-2 for x in s),
        "max(sigma)/min(sigma)": s[0] / s[2],
        "sum(sigma^2)/prod(sigma)^(2/n)": sum(x**2 for x in s) / names["det"] ** sympy.Rational(2, 3),
        "exp(0.5*max(prod(sigma), 1/prod(sigma)))": sympy.exp(names["det"] / 2),  # det > 1 at the point below
        "sum((sigma - 1)**2)": sum((x - 1) ** 2 for x in s),
        "sum(abs(log(sigma)))": sympy.log(s[0]) + sympy.log(s[1]) - sympy.log(s[2]),
        "sqrt(sum(sigma^4)) - -1": sympy.sqrt(sum(x**4 for x in s)) + 1,
        "sigma1^2.5 + sigman^-1.5": s[0] ** 2.5 + s[2] ** -1.5,
        "2*det + 1e-3/det": 2 * names["det"] + sympy.Float("1e-3") / names["det"],
        "-2^2 + sum(sigma)": sum(s) - 4,
    }[text]
    point = dict(zip(s, (2.5, 1.25, 0.5), strict=True))
    ours = compile_formula(text, 3).hessian.evaluate(np.array([[2.5, 1.25, 0.5]]))[0]
    theirs = [outside.subs(point)]
    theirs += [outside.diff(x).subs(point) for x in s]
    theirs += [outside.diff(s[i], s[j]).subs(point) for i in range(3) for j in range(i, 3)]
    assert ours == pytest.approx([float(v) for v in theirs], rel=1e-12, abs=1e-14)


def test_the_place_of_a_fault_counts_in_the_typed_text() -> None:
    with pytest.raises(FormulaError) as caught:
        compile_formula("  sigma1^2 + sigma2^2 + quux", 2)
    assert caught.value.position == len("  sigma1^2 + sigma2^2 + ")


@pytest.mark.parametrize("text", ["sum(sigma^2) + lam*n/det^", "sigma1^2 +", "sigma1 - ", "  -"])
def test_a_formula_that_breaks_off_is_at_fault_at_its_end(text: str) -> None:
    with pytest.raises(FormulaError, match="breaks off") as caught:
        compile_formula(text, 2)
    assert caught.value.position == len(text.rstrip())


@pytest.mark.parametrize(("text", "place"), [("(sigma1^2 + 1", 0), ("sigma1^2 + 1)", 12), ("sigma1^2 +* 2", 10)])
def test_other_faults_are_where_they_are_seen(text: str, place: int) -> None:
    with pytest.raises(FormulaError, match="not a formula") as caught:
        compile_formula(text, 2)
    assert caught.value.position == place


def test_names_that_are_left_are_parameters() -> None:
    assert names_in_formula("lam*sum(sigma) + mu*det") == ("lam", "mu")
    distortion = Distortion.resolve("lam*sum(sigma^2)", {"lam": 3})
    assert distortion.value(np.array([1.0, 1.0]))[0] == 6.0
    assert distortion.with_values({"lam": 1}).value(np.array([1.0, 1.0]))[0] == 2.0


def test_a_distortion_that_refers_to_itself_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(FormulaError, match="itself"):
        compile_formula("a_b", 2, {}, lambda name: ("1 + a_b", {}))
    with pytest.raises(FormulaError, match="deep"):
        compile_formula("x0", 2, {}, lambda name: (" + ".join([f"x{int(name[1:]) + 1}"] + ["1"] * 50), {}))
    with pytest.raises(FormulaError, match="more than"):
        compile_formula("x0", 2, {}, lambda name: (" + ".join([f"x{int(name[1:]) + 1}"] * 3), {}))


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(
    "text",
    [
        "3*exp(mips)/2", "exp(mips) + exp(symmetric_dirichlet)", "exp(mips) + arap", "1 + exp(mips)", "exp(mips)^3*exp(arap)",
        "0.3*amips + 0.7*condition_number", "sqrt(exp(mips))/exp(arap)", "max(exp(mips), 5)", "sum(exp(sigma))",
    ],
)  # fmt: skip
def test_a_formula_made_of_exponentials_has_a_logarithm_with_its_derivatives(text: str, dimension: int) -> None:
    distortion = Distortion.resolve(text)
    logarithm, root = distortion.tempered(dimension), distortion.tempered(dimension, 0.25)
    assert logarithm is not None and root is not None
    sigma = np.array([[1.7, 1.2, 0.6], [1.0, 1.0, 1.0], [3.0, 2.0, 0.9]])[:, :dimension]
    value, first, second = distortion.value(sigma), distortion.gradient(sigma), distortion.hessian(sigma)
    relative = first / value[:, None]
    assert np.allclose(logarithm.value(sigma), np.log(value), rtol=1e-13, atol=1e-13)
    assert np.allclose(logarithm.gradient(sigma), relative, rtol=1e-12, atol=1e-13)
    expected = second / value[:, None, None] - relative[:, :, None] * relative[:, None, :]
    assert np.allclose(logarithm.hessian(sigma), expected, rtol=1e-9, atol=1e-9)
    assert np.allclose(root.value(sigma), value**0.25, rtol=1e-13)
    far = np.array([[1e3, 1.0, 1e-3]])[:, :dimension]  # the exponential itself may overflow
    assert np.isfinite(logarithm.value(far)).all() and np.isfinite(logarithm.gradient(far)).all()


def test_what_is_not_made_of_exponentials_has_no_logarithm() -> None:
    for text in (
        "2*sum(sigma)",
        "exp(mips) - 1",
        "exp(mips)*arap",
        "-exp(mips) + 2*exp(mips)*arap",
        "log(exp(mips))",
        "exp(2)*det",
    ):
        assert Distortion.resolve(text).tempered(2) is None
    begin = time.perf_counter()
    assert Distortion.resolve("(" * 20 + "exp(sigma1/1e6)" + "^2)" * 20).tempered(3) is not None
    assert time.perf_counter() - begin < 5  # shared parts are looked at once (not a measurement)


def test_a_formula_may_have_a_meaning_in_one_dimension_alone() -> None:
    for text, values in (("sigma1/sigma3", {}), ("sum(largest(3))", {}), ("ky-fan", {"k": 3})):
        distortion = Distortion.resolve(text, values)
        assert distortion.dimensions == (3,)
        assert np.isfinite(distortion.value(np.array([[2.0, 1.5, 0.5]]))).all()
        with pytest.raises(FormulaError, match="2"):
            distortion.compiled(2)
    assert Distortion.resolve("arap").dimensions == (2, 3)
