"""`list`, `check`, `measure` and `doctor` tell what is there."""

from __future__ import annotations

import numpy as np
import pytest

from tests.cli.conftest import strict_json
from workbench.core.registry import registry
from workbench.engine import doctor, system_libraries

ALL_KINDS = (
    "distortions", "solvers", "initializers", "repairs", "convexifications", "cuts", "maps", "analyses", "samples",
    "formats", "figures", "plugins",
)  # fmt: skip


@pytest.mark.parametrize("kind", ALL_KINDS)
def test_every_kind_can_be_listed(kind, cli):
    entries = cli("list", kind, "--json").json
    assert all({"kind", "id", "label", "citation", "kinds"} <= entry.keys() and entry["kind"] == kind for entry in entries)
    said = cli("list", kind)
    assert said.status == 0 and all(entry["id"] in said.out for entry in entries)


def test_the_list_holds_every_registered_method(cli):
    entries = cli("list", "--json").json
    found = registry()
    for kind in ("distortions", "solvers", "initializers"):
        assert {entry["id"] for entry in entries if entry["kind"] == kind} == set(getattr(found, kind))
    assert {entry["kind"] for entry in entries} <= set(ALL_KINDS)


def test_samples_that_are_listed_can_be_solved(cli, tmp_path):
    sources = [entry["source"] for entry in cli("list", "samples", "--json").json]
    assert "sample:gingerbread" in sources
    assert cli("solve", sources[0], "--out", tmp_path / "o.obj", "--quiet").status == 0


@pytest.mark.parametrize(("text", "dim", "value"), [("sum(sigma^2 + 1/sigma^2)", 2, 4), ("sum(sigma^2 + 1/sigma^2)", 3, 6)])
def test_check_gives_the_value_at_a_similarity(text, dim, value, cli):
    facts = cli("check", text, "--dim", dim, "--json").json
    assert facts["value_at_ones"] == pytest.approx(value, rel=1e-15)
    assert facts["barrier"] is True
    assert f": {value}\n" in cli("check", text, "--dim", dim).out


def test_check_takes_parameters(cli):
    facts = cli("check", "sum(abs(sigma)^p)^(1/p)", "--set", "p=3", "--json").json
    assert facts["value_at_ones"] == pytest.approx(2 ** (1 / 3)) and facts["parameters"] == {"p": 3}


PROPERTIES = ("normalised", "symmetric", "bottom_barrier", "top_barrier", "smooth_almost_everywhere", "regular", "convex")


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("text", ["mips", "volume", "lp-gauge", "arap-barrier", "sqrt(5 - sigma1) + det", "1/(3 - sigma1)^2"])
def test_check_answers_every_property(text, dim, cli):
    facts = cli("check", text, "--dim", dim, "--json").json
    assert facts["dim"] == dim and facts["formula"]
    for name in PROPERTIES:
        found = facts[name]
        assert {"holds", "witness", "method", "sentence", "value"} == found.keys()
        assert found["holds"] in (True, False, None) and found["sentence"]
        assert (found["witness"] is not None) == (found["holds"] is False)
    said = cli("check", text, "--dim", dim).out
    assert all(name.replace("_", " ") in said and facts[name]["sentence"] in said for name in PROPERTIES)


def test_check_knows_the_parameters(cli):
    """(sum sigma^p)^(1/p) is a norm from p = 1 on, and not below."""
    formula = "sum(sigma^p)^(1/p)"
    assert cli("check", formula, "--set", "p=1.5", "--json").json["convex"]["holds"] is True
    assert cli("check", formula, "--set", "p=0.8", "--json").json["convex"]["holds"] is False
    assert cli("check", "mips", "--json").json["symmetric"]["holds"] is True
    assert cli("check", "mips", "--dim", 3, "--json").json["regular"]["holds"] is False


def test_check_marks_the_place(cli):
    refused = cli("check", "sum(sigma^2) + wrong")
    assert refused.status == 2 and "wrong" in refused.err and "character 16" in refused.err


def test_measures_of_a_known_map(cli, square, tmp_path):
    case = tmp_path / "stretched.npz"
    np.savez(case, V=square.vertices, S=square.simplices, X=square.vertices * [2.0, 0.5])
    measured = cli("measure", case, "--json").json
    assert set(measured["measures"]) == set(registry().distortions)
    for id, value in {"symmetric-dirichlet": 8.5, "condition-number": 4.0, "average-singular-value": 1.25}.items():
        for statistic in ("mean", "max", "min", "p50", "p95", "area_weighted_mean"):
            assert measured["measures"][id][statistic] == pytest.approx(value, rel=1e-12)
    assert measured["inverted"] == measured["degenerate"] == 0
    assert measured["injective"]["local"] is True and measured["injective"]["global"] is True
    assert sum(measured["histogram78"]["counts"]) == square.simplex_count
    assert len(measured["histogram78"]["edges"]) == len(measured["histogram78"]["counts"]) + 1


def test_measures_that_are_infinite_are_null(cli, square, tmp_path):
    folded = square.vertices.copy()
    folded[24] += 0.6
    case = tmp_path / "folded.npz"
    np.savez(case, V=square.vertices, S=square.simplices, X=folded)
    measured = cli("measure", case, "--json").json
    assert measured["inverted"] > 0 and measured["injective"]["local"] is False
    assert measured["measures"]["symmetric-dirichlet"]["max"] is None
    assert cli("measure", case).status == 0


def test_doctor_names_versions_and_folders(cli):
    said = cli("doctor")
    assert said.status == 0
    for word in ("python", "numpy", "cvxopt", "your plugins", "system libraries", "superlu"):
        assert word in said.out


def test_doctor_names_what_is_missing_and_the_command(cli, monkeypatch):
    lost = system_libraries.SystemLibrary("libdoes-not-exist.so.9", "libdoes-not-exist9", "window")
    monkeypatch.setattr(system_libraries, "LIBRARIES", (*system_libraries.LIBRARIES, lost))
    monkeypatch.setattr(system_libraries.sys, "platform", "linux")
    said = cli("doctor").out
    assert "libdoes-not-exist.so.9" in said and "apt-get install" in said and "libdoes-not-exist9" in said


def test_doctor_works_without_qt(cli, monkeypatch):
    known = doctor.installed_version
    monkeypatch.setattr(doctor, "installed_version", lambda name: "" if "pyside6" in name.lower() else known(name))
    said = cli("doctor")
    assert said.status == 0 and "not installed" in said.out


def test_the_strict_reader_of_json_can_fail():
    with pytest.raises(AssertionError):
        strict_json('{"energy": Infinity}')
