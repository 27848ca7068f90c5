"""Formulas under names of their own: what is kept comes back, what is damaged or hostile harms nothing."""

from __future__ import annotations

import json
import math
import os
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from workbench.core.distortion import Distortion, looks_like_id
from workbench.core.errors import FormulaError, WorkbenchError
from workbench.core.formula_names import check_names, suggested_parameter, undeclared_names
from workbench.core.method import Parameter
from workbench.core.named_formulas import (
    LARGEST_FILE,
    LONGEST_NAME,
    NamedFormula,
    formulas_file,
    id_of_name,
    read_formulas,
    text_of_formulas,
)
from workbench.core.registry import registry
from workbench.io.formula_store import NameTakenError, delete_formula, rename_formula, save_formula

LAM = Parameter("lam", float, 0.25, "share of the first", 0.0, 1.0)
BLEND = NamedFormula("My blend", "lam*symmetric_dirichlet + (1 - lam)*condition_number", (LAM,), "tried on faces")


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A home without formulas."""
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    return tmp_path


def value(text: str, *sigma: float, **values: float) -> float:
    return float(Distortion.resolve(text, values).value(np.array([sigma]))[0])


def test_what_is_saved_is_a_distortion_everywhere() -> None:
    assert save_formula(BLEND) == "my-blend"
    expected = 0.25 * (4 + 0.25 + 1 + 1) + 0.75 * 2
    assert value("my-blend", 2.0, 1.0) == pytest.approx(expected)
    assert value("2*my_blend + det", 2.0, 1.0) == pytest.approx(2 * expected + 2)
    assert value("my-blend", 2.0, 1.0, lam=1.0) == pytest.approx(6.25)
    assert value("my_blend*1", 2.0, 1.0, lam=0.0) == pytest.approx(2.0)
    with pytest.raises(WorkbenchError, match="outside"):
        Distortion.resolve("my-blend", {"lam": 2.0})
    assert registry().own_formulas == {"my-blend": BLEND}


def test_other_methods_stay_what_they_are() -> None:
    before = registry()
    save_formula(BLEND)
    after = registry()
    assert after.solvers is before.solvers
    assert set(after.distortions) == {*before.distortions, "my-blend"}
    delete_formula("my-blend")
    assert set(registry().distortions) == set(before.distortions)


def test_a_changed_formula_is_taken_up_also_inside_others() -> None:
    save_formula(NamedFormula("inner", "sum(sigma^2)"))
    save_formula(NamedFormula("outer", "inner + 1/det"))
    assert value("outer", 2.0, 1.0) == pytest.approx(5.5)
    with pytest.raises(NameTakenError):
        save_formula(NamedFormula("Inner", "sum(sigma^4)"))
    save_formula(NamedFormula("inner", "sum(sigma^4)"), replaces=True)
    assert value("outer", 2.0, 1.0) == pytest.approx(17.5)


def test_what_others_refer_to_stays() -> None:
    save_formula(NamedFormula("inner", "sum(sigma^2)"))
    save_formula(NamedFormula("outer", "inner + 1/det"))
    for attempt in (
        lambda: delete_formula("inner"),
        lambda: rename_formula("inner", "core"),
        lambda: save_formula(NamedFormula("inner", "outer + sigma1"), replaces=True),
    ):
        with pytest.raises(WorkbenchError, match=r"refers|not known"):
            attempt()
    assert set(registry().own_formulas) == {"inner", "outer"}
    delete_formula("outer")
    assert rename_formula("inner", "The core") == "the-core"
    assert set(registry().own_formulas) == {"the-core"}


@pytest.mark.parametrize(
    "name", ["MIPS", "symmetric dirichlet", "Symmetric-Dirichlet", "sigma", "sigma2", "det", "n", "max", "largest"]
)
def test_built_ins_and_words_of_the_language_cannot_be_hidden(name: str) -> None:
    with pytest.raises(WorkbenchError):
        save_formula(NamedFormula(name, "sum(sigma^2)"))
    assert not formulas_file().exists()


@pytest.mark.parametrize(
    "name", ["", "  ", "7up", "-", "ß", "a\nb", " a", "a  b", "x" * (LONGEST_NAME + 1), "\u202eabc", "../a\x00"]
)
def test_names_that_are_none_are_refused_with_a_sentence(name: str) -> None:
    with pytest.raises(WorkbenchError) as caught:
        id_of_name(name)
    assert caught.value.sentence.endswith(".")


@pytest.mark.parametrize("formula", ["sum(sigma^2", "sum(sigma^2) + quux", "7", "sigma", "__import__('os')", "log(-sigma1)"])
def test_a_formula_that_is_none_is_not_kept(formula: str) -> None:
    with pytest.raises(FormulaError):
        save_formula(NamedFormula("own", formula))
    assert not formulas_file().exists()


@pytest.mark.parametrize(
    "parameter",
    [
        Parameter("p", float, 1.0, "", 2.0, 1.0),
        Parameter("p", float, 5.0, "", 0.0, 1.0),
        Parameter("p", float, 1.0, "", 0.0, math.inf),
        Parameter("p", float, math.nan),
        Parameter("p", bool, True),
        Parameter("det", float, 1.0),
    ],
    ids=str,
)
def test_a_parameter_that_could_not_be_read_again_is_not_kept(parameter: Parameter) -> None:
    with pytest.raises(WorkbenchError):
        save_formula(NamedFormula("own", f"{parameter.name}*sum(sigma^2)", (parameter,)))
    assert not formulas_file().exists()


PARAMETERS = st.lists(
    st.builds(
        lambda name, default, whole: Parameter(
            name, int if whole else float, int(default) if whole else default, "what it does", math.floor(default) - 1.0, None
        ),
        st.from_regex(r"p[a-z0-9_]{0,8}", fullmatch=True).filter(lambda name: name != "prod"),
        st.floats(-1e6, 1e6),
        st.booleans(),
    ),
    max_size=4,
    unique_by=lambda p: p.name,
)


@given(parameters=PARAMETERS, note=st.text(max_size=40).filter(lambda t: t.isprintable() and t.isascii()))
@settings(max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_file_gives_back_what_was_written(parameters: list[Parameter], note: str, tmp_path: Path) -> None:
    items = [NamedFormula("One", "sum(sigma^2)", tuple(parameters), note), BLEND]
    path = tmp_path / "list.json"
    path.write_text(text_of_formulas(items), encoding="utf-8")
    assert read_formulas(path) == (items, [])


JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(max_size=8),
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(
            st.sampled_from(["name", "formula", "parameters", "note", "default", "minimum", "schema", "x"]), inner
        )
    ),
    max_leaves=12,
)


@given(content=JSON)
@settings(max_examples=60, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_no_content_raises(content: object, tmp_path: Path) -> None:
    path = tmp_path / "list.json"
    for text in (
        content,
        {"schema": 1, "formulas": content},
        {"schema": 1, "formulas": [content, {"name": "a", "formula": "det", "parameters": content}]},
    ):
        path.write_text(json.dumps(text), encoding="utf-8")
        good, faults = read_formulas(path)
        assert all(isinstance(item, NamedFormula) for item in good)
        assert all(fault.endswith(".") for fault in faults)


@pytest.mark.parametrize(
    "text",
    [
        b"",
        b"{",
        b"\xff\xfe\x00",
        b"[" * 100_000,
        b'{"schema": 1}',
        b'{"schema": 2, "formulas": []}',
        b'{"schema": 1, "formulas": NaN}',
        b'{"schema": 1, "formulas": [{"name": "a", "formula": "det", "parameters": [{"name": "p", "default": 1e999}]}]}',
        b'{"schema": 1, "formulas": [' + b"9" * 5000 + b"]}",
        b" " * (LARGEST_FILE + 1),
        b'{"schema": 1, "formulas": [{"name": "a", "formula": "det", "__class__": "os.system"}]}',
        b'{"schema": 1, "formulas": [{"name": "a", "formula": "det", "parameters": [{"name": "p", "default": 1, "type": 3}]}]}',
    ],
    ids=lambda text: repr(text[:40]),
)
def test_a_damaged_file_is_said_and_the_rest_lives(text: bytes) -> None:
    path = formulas_file()
    path.parent.mkdir(parents=True)
    path.write_bytes(text)
    found = registry()
    assert "symmetric-dirichlet" in found.distortions and not found.own_formulas
    assert any(failure.path == path for failure in found.failures)
    save_formula(BLEND)
    assert set(registry().own_formulas) == {"my-blend"} and not [f for f in registry().failures if f.path == path]
    aside = [p for p in path.parent.iterdir() if "damaged" in p.name]
    assert len(aside) == 1 and aside[0].read_bytes() == text, "what could not be read is kept aside"


def test_one_bad_entry_costs_the_others_nothing() -> None:
    path = formulas_file()
    path.parent.mkdir(parents=True)
    good = json.loads(text_of_formulas([BLEND]))["formulas"][0]
    entries = [
        {"name": "circle", "formula": "round_trip + det"},
        {"name": "round trip", "formula": "circle + det"},
        {"name": "mips", "formula": "det"},
        {"name": "bad", "formula": "sum(sigma"},
        {"name": "twice", "formula": "p*det", "parameters": [{"name": "p", "default": 1}, {"name": "p", "default": 2}]},
        {"name": "late", "formula": "my_blend + det"},
        good,
        {**good, "formula": "det"},
    ]
    path.write_text(json.dumps({"schema": 1, "formulas": entries}))
    found = registry()
    assert set(found.own_formulas) == {"late", "my-blend"}, "the order in which they stand does not matter"
    assert found.own_formulas["my-blend"] == BLEND
    assert found.distortions["mips"].citation != "Own formula"
    assert len([f for f in found.failures if f.path == path]) == 6


def test_a_write_that_fails_leaves_the_old_file(monkeypatch: pytest.MonkeyPatch) -> None:
    save_formula(BLEND)
    before = formulas_file().read_bytes()

    def refuse(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", refuse)
    with pytest.raises(WorkbenchError, match="No space"):
        save_formula(NamedFormula("other", "sum(sigma^2)"))
    assert formulas_file().read_bytes() == before
    assert [p.name for p in formulas_file().parent.iterdir()] == [formulas_file().name]


# ------------------------------------------------------------------------------------------------- names


@pytest.mark.parametrize(
    ("text", "names", "meant"),
    [
        ("lam*symmetric_dirichlet + (1 - lam)*condition_number", ["lam"], [""]),
        ("sum(sgima^p)", ["sgima", "p"], ["sigma", ""]),
        ("alpha*amips", [], []),
        ("symetric_dirichlet + Sigma1", ["symetric_dirichlet", "Sigma1"], ["symmetric_dirichlet", "sigma1"]),
        ("my_area*det^weight", ["my_area", "weight"], ["", ""]),
        ("conditon_number", ["conditon_number"], ["condition_number"]),
    ],
)
def test_slips_of_the_pen_are_told_from_parameters(text: str, names: list[str], meant: list[str]) -> None:
    found = undeclared_names(text)
    assert [item.name for item in found] == names
    assert [item.meant for item in found] == meant
    assert all(text[item.position :].startswith(item.name) for item in found)


def test_declared_names_are_no_news() -> None:
    assert not undeclared_names("sum(sigma^p)", ["p"])
    check_names("sum(sigma^p)", ["p"])
    with pytest.raises(FormulaError, match="--set p="):
        check_names("sum(sigma^p)")
    with pytest.raises(FormulaError, match="cannot be the name"):
        check_names("sum(sigma^__p)")


@pytest.mark.parametrize(("text", "word"), [("lambda*arap", "lam "), ("arap + is*det", "is_ "), ("det or 1", "or_ ")])
def test_words_of_python_are_named_with_a_way_out(text: str, word: str) -> None:
    with pytest.raises(FormulaError) as caught:
        undeclared_names(text)
    assert word in caught.value.sentence
    assert text[caught.value.position :].startswith(caught.value.sentence.split()[0])


@pytest.mark.parametrize(
    ("text", "expected"), [("magic-wand", True), ("arap", False), ("lam-sigman", False), ("det-a", False), ("a - b", False)]
)
def test_ids_are_told_from_differences(text: str, expected: bool) -> None:
    assert looks_like_id(text) is expected


@pytest.mark.parametrize("name", ["lam", "p", "k", "eps", "weight", "anything"])
def test_suggested_values_lie_in_their_range(name: str) -> None:
    item = suggested_parameter(name)
    assert item.check(item.default) == item.default
    assert item.minimum is not None and item.maximum is not None and item.minimum < item.maximum
