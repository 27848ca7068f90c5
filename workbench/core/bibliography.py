"""What methods are taken from, as BibTeX: citations name keys in brackets, and the entries stand in one file."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache

from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.method import Method
from workbench.core.named_formulas import ORIGIN
from workbench.core.registry import registry, resource_folder

SURVEY = "NNZ21"
"""Key of the survey that the program implements."""
WITHOUT_SOURCE = frozenset({"rest", "file"})
"""Starts that nobody had to invent."""
OTHERS: Mapping[str, tuple[str, str]] = {
    "shape-signature": ("Histograms of average singular values", "(78); Ben-Chen & Gotsman 2008 [BCG08]"),
    "refine-linear": ("Linear refinement", "Theorem 9.1"),
    "refine-loop": ("Loop's scheme", "Loop 1987 [L87]"),
    "refine-catmull-clark": ("Catmull and Clark's scheme", "Catmull & Clark 1978 [CC78]"),
    "fill": ("Tetrahedra inside a surface (fTetWild)", "Hu et al. 2020 [HSW*20]"),
}
"""Methods that are no plugins: id -> label, citation."""

_KEY = re.compile(r"\[([A-Z][A-Za-z]*\*?\d\d[a-z]?)\]")
_ENTRY = re.compile(r"^@\w+\{([^,\s]+),$.*?^\}$", re.MULTILINE | re.DOTALL)
_WORD = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_IN_SURVEY = re.compile(r"\(\d+\)|\b(section|Theorem|Fig\.|Figs\.) \d")


@dataclass(frozen=True)
class Cited:
    """A method with the keys of its entries; the survey's alone where it stands there and nowhere else, none for our own."""

    id: str
    label: str
    keys: tuple[str, ...]


@lru_cache(maxsize=1)
def bibliography() -> dict[str, str]:
    """Every entry of BibTeX by its key, as it stands in the file."""
    text = (resource_folder("assets") / "references.bib").read_text(encoding="utf-8")
    return {match[1]: match[0] for match in _ENTRY.finditer(text)}


def keys_of(citation: str) -> tuple[str, ...]:
    """Keys that a citation names in brackets, as BibTeX writes them; that of the survey where it names its equations alone."""
    keys = tuple(dict.fromkeys(key.replace("*", "+") for key in _KEY.findall(citation)))
    return keys or ((SURVEY,) if _IN_SURVEY.search(citation) else ())


def cited(method: Distortion | type[Method]) -> Cited:
    """What is to be cited for a method."""
    is_own = method.id in WITHOUT_SOURCE or method.citation == ORIGIN
    return Cited(method.id, method.label, () if is_own else keys_of(method.citation))


def methods_named(name: str) -> tuple[Cited, ...]:
    """What is to be cited for an id: of a distortion, a solver, an initializer, or one of `OTHERS`.

    Raises `WorkbenchError` for an id that there is not.
    """
    known = registry()
    found = [cited(methods[name]) for methods in (known.solvers, known.initializers) if name in methods]
    found += of_distortion(name) if name in known.distortions else []
    found += [Cited(name, OTHERS[name][0], keys_of(OTHERS[name][1]))] if name in OTHERS else []
    if not found:
        raise WorkbenchError(f"There is no method {name!r} to cite; `workbench list` names those that there are.")
    return tuple(found)


def of_distortion(text: str) -> list[Cited]:
    """What is to be cited for a distortion by its id, or for a formula: itself and the distortions that it is made of."""
    known = registry().distortions
    by_word = {id.replace("-", "_"): id for id in known}
    found: dict[str, Cited] = {}

    def add(id: str) -> None:
        if id not in found:
            found[id] = cited(known[id])
            add_parts(known[id].formula)

    def add_parts(formula: str) -> None:
        for word in _WORD.findall(formula):
            if word in by_word:
                add(by_word[word])

    if text in known:
        add(text)
    else:
        add_parts(text)
    return list(found.values())


def bibtex(methods: Iterable[Cited]) -> str:
    """A bibliography for methods: a remark a method, then each entry once, that of the survey first.

    Raises `WorkbenchError` for a key that the bibliography does not have (a plugin's own).
    """
    methods = list(dict.fromkeys(methods))
    entries = bibliography()
    lines = [f"% {_plain(item.id)}: {_plain(item.label)}: {', '.join(item.keys) or 'no source'}" for item in methods]
    keys = dict.fromkeys([SURVEY, *(key for item in methods for key in item.keys)])
    lines += [f"% {_plain(key)}: not in this bibliography; see the plugin that names it" for key in keys if key not in entries]
    return "\n".join(lines) + "\n\n" + "\n\n".join(entries[key] for key in keys if key in entries) + "\n"


def _plain(text: str) -> str:
    """A text as a remark in BibTeX: one line, with nothing that begins an entry."""
    return " ".join(text.replace("@", " at ").split())
