"""Typed and named formulas on the command line: names that are not declared, formulas of the user's own."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from workbench.core.method import Parameter
from workbench.core.named_formulas import NamedFormula
from workbench.io.formula_store import save_formula

BLEND = "lam*symmetric_dirichlet + (1 - lam)*condition_number"


@pytest.fixture
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """The id of a formula that is kept in a home of the test's own."""
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))
    return save_formula(NamedFormula("My blend", BLEND, (Parameter("lam", float, 0.25, "", 0.0, 1.0),), "tried on faces"))


@pytest.mark.parametrize("command", [["check"], ["solve", "SQUARE", "--out", "OUT.obj", "--distortion"]], ids=lambda c: c[0])
@pytest.mark.parametrize(
    ("formula", "said"),
    [
        (BLEND, ["'lam'", "--set lam="]),
        ("sum(sigma^p) + weight*det", ["'p'", "--set p="]),
        ("sum(sgima^2)", ["'sgima'", "sigma is", "character 5"]),
        ("lambda*arap", ["lambda", "lam instead"]),
        ("symetric_dirichlet + det", ["symmetric_dirichlet is"]),
    ],
)
def test_names_that_are_not_declared_are_answered_with_the_way_out(
    command, formula, said, cli, square_file, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    result = cli(*[str(square_file) if item == "SQUARE" else item for item in command], formula)
    assert result.status == 2 and len(result.err.strip().splitlines()) == 1
    assert all(word in result.err for word in said)
    assert not (tmp_path / "OUT.obj").exists()


def test_what_it_says_helps(cli):
    assert cli("check", BLEND, "--set", "lam=0.5").status == 0
    assert cli("check", "alpha*amips", "--set", "alpha=0.5").status == 0
    assert cli("check", "alpha*amips").status == 0, "a parameter of a distortion that it refers to has its default"


def test_a_formula_may_begin_with_a_minus(cli, square_file, tmp_path):
    formula = "-log(det)+dirichlet"
    result = cli("check", formula)
    assert result.status == 0 and result.out.startswith(f"{formula}:")
    out, report = tmp_path / "out.obj", tmp_path / "report.json"
    options = ("--out", out, "--iterations", "2", "--quiet", "--report", report)
    assert cli("solve", square_file, "--distortion", formula, *options).status == 0
    assert json.loads(report.read_text())["distortion"]["formula"] == formula
    assert cli("solve", square_file, "--out", out, "-o").status == 2


def test_a_formula_of_space_alone_is_refused_in_the_plane_and_solved_in_space(cli, square_file, tmp_path):
    out = tmp_path / "out.npz"
    for options in (["--distortion", "sigma1/sigma3"], ["--distortion", "ky-fan", "--set", "k=3"]):
        flat = cli("solve", square_file, *options, "--out", out)
        assert flat.status == 2 and "2" in flat.err and not out.exists()
        assert cli("solve", "sample:bar-3d", *options, "--out", out, "--iterations", "1", "--quiet").status == 0
        out.unlink()


def test_own_formulas_are_listed_checked_and_solved_by_name(own, cli, square_file, tmp_path):
    (entry,) = [item for item in cli("list", "distortions", "--json").json if item["id"] == own]
    assert entry["label"] == "My blend" and entry["formula"] == BLEND and entry["description"] == "tried on faces"
    assert entry["parameters"][0]["default"] == 0.25
    assert own in cli("list", "distortions").out
    for text in (own, f"2*{own.replace('-', '_')} + det"):
        assert cli("check", text, "--set", "lam=0.5").status == 0
    assert "outside" in cli("check", own, "--set", "lam=2").err
    out = tmp_path / "out.obj"
    assert cli("solve", square_file, "--distortion", own, "--out", out, "--iterations", "2", "--quiet").status == 0
    assert out.exists()


def test_a_damaged_list_of_formulas_stops_nothing(own, cli, tmp_path):
    path = tmp_path / "data" / "distortion-workbench" / "formulas.json"
    path.write_text("{", encoding="utf-8")
    assert cli("check", "sum(sigma^2)").status == 0
    assert cli("check", own).status == 2
    assert any(str(path) in (item.get("path") or "") for item in cli("list", "plugins", "--json").json)


def test_formulas_are_saved_renamed_and_deleted(own, cli):
    text = "sum(sigma^p) + weight/det"
    refused = cli("formula", "save", "Powers", text, "--set", "p=4")
    assert refused.status == 2 and "--set weight=" in refused.err
    given = ("--set", "p=4", "--set", "weight=2", "--range", "p=1:8", "--note", "a try")
    assert cli("formula", "save", "Powers", text, *given).out == "powers\n"
    assert cli("check", "powers", "--json").json["parameters"] == {"p": 4, "weight": 2}
    assert "outside" in cli("check", "powers", "--set", "p=9").err
    again = cli("formula", "save", "Powers", text, *given)
    assert again.status == 2 and "--replace" in again.err
    assert cli("formula", "save", "Powers", "sum(sigma^6)", "--replace").status == 0
    assert cli("check", "powers", "--json").json["parameters"] == {}
    assert cli("formula", "rename", "powers", "Sixth powers").out == "sixth-powers\n"
    assert cli("formula", "delete", "sixth-powers").status == 0
    gone = cli("formula", "delete", "sixth-powers")
    assert gone.status == 2 and own in gone.err


@pytest.mark.parametrize(
    "arguments",
    [
        ["save", "mips", "sum(sigma^2)"],
        ["save", "x", "sum(sigma^2"],
        ["save", "x", "sum(sigma^p)", "--set", "p=2", "--range", "p=low:high"],
        ["save", "x", "sum(sigma^p)", "--set", "p=2", "--range", "p=3:1"],
        ["save", "x", "sum(sigma^p)", "--set", "p=2", "--range", "q=1:3"],
        ["rename", "my-blend", "arap"],
        ["delete", "mips"],
        ["forget", "my-blend"],
        [],
    ],
    ids=" ".join,
)
def test_what_cannot_be_kept_is_refused_with_one_sentence(arguments, own, cli):
    before = cli("list", "distortions").out
    result = cli("formula", *arguments)
    assert result.status == 2 and len(result.err.strip().splitlines()) == 1 and result.out == ""
    assert cli("list", "distortions").out == before
