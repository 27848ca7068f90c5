"""`workbench list`: every method, sample and format that there is."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import Any

from workbench.io.json_text import json_text
from workbench.io.tables import table

Entry = dict[str, Any]


def add_parser(name: str, commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = commands.add_parser(name, help="what there is: " + ", ".join(LISTINGS))
    parser.add_argument("kind", nargs="?", metavar="KIND", choices=tuple(LISTINGS), help="only these: " + ", ".join(LISTINGS))
    parser.add_argument("--json", action="store_true", help="a JSON list of {kind, id, label, citation, kinds, ...}")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print the entries of one kind or of all."""
    kinds = [options.kind] if options.kind else list(LISTINGS)
    entries = [entry for kind in kinds for entry in LISTINGS[kind]()]
    if options.json:
        print(json_text(entries), end="")
        return 0
    for kind in kinds:
        rows = [[f"  {entry['id']}", entry["label"], _remark(entry)] for entry in entries if entry["kind"] == kind]
        print(f"{kind}" if rows else f"{kind}: none yet")
        if rows:
            print(table(rows))
    return 0


def _remark(entry: Entry) -> str:
    remark = entry.get("error") or entry.get("formula") or entry.get("description") or ""
    return f"{remark}  [{entry['citation']}]" if entry["citation"] else remark


def _entry(kind: str, id: str, label: str, citation: str = "", kinds: tuple[str, ...] = (), **more: Any) -> Entry:
    return {"kind": kind, "id": id, "label": label, "citation": citation, "kinds": list(kinds), **more}


def _parameters(form: Any) -> list[Entry]:
    names = ("name", "default", "description", "minimum", "maximum", "choices")
    return [{"type": item.type.__name__, **{name: getattr(item, name) for name in names}} for item in form]


def distortions() -> list[Entry]:
    """Every registered distortion, with its formula."""
    from workbench.core.registry import registry

    return [
        _entry(
            "distortions",
            item.id,
            item.label,
            item.citation,
            item.kinds,
            short=item.short,
            formula=item.formula,
            description=item.description,
            parameters=_parameters(item.parameters),
        )
        for item in registry().distortions.values()
    ]


def solvers() -> list[Entry]:
    """Every registered solver."""
    return _methods("solvers")


def initializers() -> list[Entry]:
    """Every registered initializer."""
    return _methods("initializers")


def _methods(folder: str) -> list[Entry]:
    from workbench.core.registry import registry

    return [
        _entry(
            folder,
            item.id,
            item.label,
            item.citation,
            item.kinds,
            description=(item.__doc__ or "").strip().partition("\n")[0],
            parameters=_parameters(item.parameters()),
        )
        for item in getattr(registry(), folder).values()
    ]


def cuts() -> list[Entry]:
    """The operations of `--fix` that cut a mesh open."""
    return [
        _entry("cuts", "seams", "Cut along the texture seams of the file", kinds=("parameterize",), option="--fix seams"),
        _entry(
            "cuts",
            "cut",
            "Cut a closed or higher-genus surface open to a disc",
            kinds=("parameterize",),
            option="--fix cut",
        ),
    ]


def maps() -> list[Entry]:
    """The kinds of map."""
    return [
        _entry("maps", "plane", "Plane figure to the plane", "(43), n = 2", ("plane",)),
        _entry("maps", "parameterize", "Surface in space to the plane", "(44)", ("parameterize",)),
        _entry("maps", "volume", "Tetrahedral mesh to space", "(43), n = 3", ("volume",)),
        _entry("maps", "carried-surface", "Surface carried by a volume map", "Fig. 8", ("volume",), option="solve --carry"),
    ]


def analyses() -> list[Entry]:
    """What can be asked of a map beside its measures, and of a distortion."""
    from workbench.core.method import KINDS
    from workbench.core.refine import SCHEMES

    verdicts = _entry("analyses", "verdicts", "Local and global injectivity, with the offenders", "(67), Theorem 5.1", KINDS)
    refinements = [
        _entry(
            "analyses",
            f"refine-{id}",
            f"Source and map refined together ({label}), distortion against level",
            "Theorem 9.1, Fig. 20" if id == "linear" else "Fig. 20",
            KINDS if id == "linear" else ("plane", "parameterize"),
            option=f"refine --scheme {id}",
        )
        for id, label in SCHEMES.items()
    ]
    badges = _entry("analyses", "badges", "Regularity of a distortion, with witnesses", "Corollary 2.1", KINDS, option="check")
    convexity = _entry(
        "analyses", "convexity", "Convexity of a distortion", "Theorem 8.3, Proposition 8.1", KINDS, option="check"
    )
    signatures = _entry(
        "analyses",
        "shape-signature",
        "Histograms of average singular values, compared across maps",
        "(78), Ben-Chen & Gotsman 2008 [BCG08]",
        KINDS,
        option="signatures",
    )
    return [verdicts, *refinements, badges, convexity, signatures]


def samples() -> list[Entry]:
    """The meshes of the project's own generator, opened as `sample:ID`."""
    from workbench.core.samples import sample_ids, sample_info

    infos = [sample_info(id) for id in sample_ids()]
    return [
        _entry("samples", i.id, i.label, kinds=(i.kind,), description=i.description, source=f"sample:{i.id}") for i in infos
    ]


def formats() -> list[Entry]:
    """File formats by suffix."""
    names = (
        (".obj", "Wavefront OBJ", "read, written"),
        (".npz", "NumPy case: V S X0 anchors targets", "read, written"),
        (".vtu", "VTK unstructured grid", "read, written"),
        (".csv", "Table: anchors in, measures of each simplex out", "read, written"),
        (".off", "Object File Format", "read"),
        (".ply", "Polygon File Format", "read"),
        (".stl", "Stereolithography", "read"),
        (".mesh", "MEDIT", "read, written"),
        (".msh", "Gmsh", "read, written"),
        (".vtk", "VTK legacy", "read"),
        (".mat", "MATLAB: V, F or T from 1", "read"),
    )
    return [_entry("formats", id, label, description=use, written="written" in use) for id, label, use in names]


def plugins() -> list[Entry]:
    """Every plugin file: what it defines, or why it could not be used."""
    from workbench.core.registry import registry

    found = registry()
    by_path: dict[str, list[str]] = {}
    for (folder, id), path in found.origins.items():
        by_path.setdefault(str(path), []).append(f"{folder}/{id}")
    good = [
        _entry("plugins", path.rpartition("/")[2], ", ".join(ids), path=path, status="loaded") for path, ids in by_path.items()
    ]
    bad = [
        _entry("plugins", item.path.name, "failed", path=str(item.path), status="failed", error=item.sentence)
        for item in found.failures
    ]
    return [*good, *bad]


def figures() -> list[Entry]:
    """Figures for print: presets of `workbench figure`, and what other commands write."""
    from workbench.figures.presets import PRESETS

    presets = [_entry("figures", item.id, item.label, item.citation, option="figure") for item in PRESETS.values()]
    return [
        *presets,
        _entry("figures", "level-curves", "Distortion against the level of refinement", "Fig. 20", option="refine --plot"),
        _entry("figures", "convergence-curves", "Convergence of solvers over iterations and seconds", option="compare --out"),
        _entry("figures", "contact-sheet", "Maps of solvers at chosen iterations", "Fig. 11", option="compare --out"),
    ]


def none() -> list[Entry]:
    """A kind of method that has no member yet."""
    return []


LISTINGS: dict[str, Callable[[], list[Entry]]] = {
    "distortions": distortions,
    "solvers": solvers,
    "initializers": initializers,
    "repairs": none,
    "convexifications": none,
    "cuts": cuts,
    "maps": maps,
    "analyses": analyses,
    "samples": samples,
    "formats": formats,
    "figures": figures,
    "plugins": plugins,
}
