"""What is to be cited: every method has an entry or is our own, and the bibliography is BibTeX."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from workbench.core.bibliography import (
    OTHERS,
    SURVEY,
    WITHOUT_SOURCE,
    Cited,
    bibliography,
    bibtex,
    cited,
    keys_of,
    methods_named,
)
from workbench.core.errors import WorkbenchError
from workbench.core.registry import Registry, load_registry, resource_folder
from workbench.engine.citing import cited_in
from workbench.session.journal import Leg
from workbench.session.record import SessionRecord
from workbench.session.session import Session

NEEDED = {
    "article": {"author", "title", "journal", "year"},
    "inproceedings": {"author", "title", "booktitle", "year"},
    "incollection": {"author", "title", "booktitle", "publisher", "year"},
    "book": {"author", "title", "publisher", "year"},
    "mastersthesis": {"author", "title", "school", "year"},
}


def entries_of(text: str) -> list[tuple[str, str, dict[str, str]]]:
    """(type, key, fields) of each entry, read brace by brace; `ValueError` for what is no BibTeX."""
    entries = []
    position = text.find("@")
    while position >= 0:
        head = re.compile(r"@(\w+)\{([^\s,{}]+),").match(text, position)
        if head is None:
            raise ValueError(f"no entry begins at {text[position : position + 30]!r}")
        fields, place = {}, head.end()
        while (name := re.compile(r"\s*(\w+)\s*=\s*\{").match(text, place)) is not None:
            depth, end = 1, name.end()
            while depth:
                if end == len(text):
                    raise ValueError(f"{head[2]}: a brace is not closed")
                depth += {"{": 1, "}": -1}.get(text[end], 0)
                end += 1
            if name[1] in fields:
                raise ValueError(f"{head[2]} has {name[1]} twice")
            fields[name[1]] = text[name.end() : end - 1]
            place = end + (text[end : end + 1] == ",")
        close = re.compile(r"\s*\}").match(text, place)
        if close is None:
            raise ValueError(f"{head[2]} does not end")
        between = text[close.end() : text.find("@", close.end()) if "@" in text[close.end() :] else len(text)]
        if "{" in between or "}" in between:
            raise ValueError(f"a brace stands behind {head[2]}")
        entries.append((head[1], head[2], fields))
        position = text.find("@", close.end())
    return entries


@pytest.fixture(scope="module")
def built_in() -> Registry:
    return load_registry((resource_folder("plugins"),))


@pytest.fixture(scope="module")
def text(project_root: Path) -> str:
    return (project_root / "assets" / "references.bib").read_text(encoding="utf-8")


def test_the_bibliography_is_well_formed(text: str) -> None:
    entries = entries_of(text)
    keys = [key for _, key, _ in entries]
    assert len(set(keys)) == len(keys) >= 35
    for type, key, fields in entries:
        assert fields.keys() >= NEEDED[type], key
        assert re.fullmatch(r"(19|20)\d\d", fields["year"]), key
        assert re.search(r"\d\d", key)[0] == fields["year"][2:], key
        assert all(re.match(r"[^,]+, \S", author) for author in re.split(r"\s+and\s+", fields["author"])), key
        assert re.fullmatch(r"[\w.:+/()-]+", fields.get("doi", "10.1/x")), key
        assert re.fullmatch(r"\d+--\d+", fields.get("pages", "1--2")), key
    assert len({fields["title"].lower() for _, _, fields in entries}) == len(entries)
    assert len({fields["doi"] for _, _, fields in entries if "doi" in fields}) == sum("doi" in f for _, _, f in entries)
    assert list(bibliography()) == keys


@pytest.mark.parametrize(
    "spoil",
    [
        lambda text: text.replace("}\n\n@", "\n\n@", 1),
        lambda text: text.replace("{How to", "{{How to"),
        lambda text: text + "}",
        lambda text: text.replace("@article{NNZ21,", "@article NNZ21,"),
    ],
)
def test_the_check_can_fail(text: str, spoil) -> None:
    with pytest.raises(ValueError, match=r"\w"):
        entries_of(spoil(text))


def test_every_method_has_an_entry_or_is_our_own(built_in: Registry) -> None:
    known = bibliography()
    methods = [*built_in.distortions.values(), *built_in.solvers.values(), *built_in.initializers.values()]
    assert len(methods) > 40
    found = [cited(method) for method in methods] + [item for id in OTHERS for item in methods_named(id)]
    for item in found:
        assert item.keys or item.id in WITHOUT_SOURCE, item.id
        assert set(item.keys) <= known.keys(), item.id
    used = {key for item in found for key in item.keys}
    assert known.keys() == used | {SURVEY}, "an entry that nothing names"


def test_every_citation_with_a_year_names_its_key(built_in: Registry) -> None:
    methods = [*built_in.distortions.values(), *built_in.solvers.values(), *built_in.initializers.values()]
    for method in methods:
        for part in method.citation.split(";"):
            year = re.search(r"\b(?:19|20)(\d\d)\b", part)
            assert year is None or any(year[1] in key for key in keys_of(part)), f"{method.id}: {part}"


def test_keys_are_found_in_citations() -> None:
    assert keys_of("(36); Fu, Liu, Guo 2015 [FLG15]") == ("FLG15",)
    assert keys_of("Shtengel et al. 2017 [SPSH*17]; again [SPSH*17]; [SS15]") == ("SPSH+17", "SS15")
    assert keys_of("(84)") == keys_of("section 4.3") == (SURVEY,)
    assert keys_of("Own formula") == keys_of("") == ()


def test_a_session_cites_what_its_way_used() -> None:
    session = Session("sample:bar", solver="slim", initializer="lscm", distortion="lam*mips + (1 - lam)*arap")
    legs = (Leg(Session(solver="aqp", distortion="symmetric-dirichlet"), "start", None, 3), Leg(session, "previous", None, 2))
    found = cited_in(SessionRecord(session, legs=legs))
    assert {item.id for item in found} == {"slim", "aqp", "symmetric-dirichlet", "mips", "arap", "lscm"}
    keys = [key for _, key, _ in entries_of(bibtex(found))]
    assert keys[0] == SURVEY
    assert set(keys) == {SURVEY, "RPPSH17", "KGL16", "SS15", "HG00", "SA07", "LPRM02"}


def test_a_formula_of_a_formula_is_followed_to_the_end() -> None:
    ids = {item.id for item in cited_in(SessionRecord(Session(distortion="2*exp_blend", solver="no-such-solver")))}
    assert "exp-blend" in ids
    assert ids >= {item.id for item in methods_named("exp-blend")}


def test_labels_of_plugins_are_no_entries() -> None:
    hostile = Cited("own", "x\n@article{NNZ21, title = {no}}", ("XYZ99",))
    entries = entries_of(bibtex([hostile]).replace("{no}}", ""))
    assert [key for _, key, _ in entries] == [SURVEY]
    assert "XYZ99: not in this bibliography" in bibtex([hostile])


def test_a_name_that_is_none_is_refused() -> None:
    with pytest.raises(WorkbenchError, match="no-such-method"):
        methods_named("no-such-method")
