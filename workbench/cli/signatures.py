"""`workbench signatures`: how alike several maps are, by the distribution of their average singular values (78)."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from workbench.cli.options import add_source_options, positive_count
from workbench.cli.output import check_places
from workbench.core.errors import WorkbenchError
from workbench.io.json_text import json_text
from workbench.io.tables import number, table
from workbench.io.text import shown_name

if TYPE_CHECKING:
    from workbench.core.signature import Distances, Signature


def add_parser(name: str, commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = commands.add_parser(name, help="compare maps by their shape signatures, the histograms of (78)")
    add = parser.add_argument
    add("maps", nargs="+", metavar="MAP", help="file that holds a source and its map: OBJ with vt, npz with X")
    add_source_options(parser)
    add("--normalise", action="store_true", help="bring each map to the scale where its mean is 1")
    add("--bins", type=positive_count, default=64, metavar="N", help="common bins of the histograms (default: 64)")
    add("--log", action="store_true", help="bins of equal factors")
    add("--distances", metavar="OUT.csv", help="write a row a pair: a, b, L1, Wasserstein-1")
    add("--histograms", metavar="OUT.csv", help="write a row a bin: its ends, the density of each map")
    add("--json", action="store_true", help="one JSON object")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Read the maps, compare, print, write."""
    from workbench.core.signature import common_edges, densities, distances
    from workbench.io.atomic import write_text
    from workbench.io.signatures import distances_text, histograms_text

    check_places(path for path in (options.distances, options.histograms) if path)
    found = _signatures(options)
    edges = common_edges(found, options.bins, logarithmic=options.log)
    apart = distances(found, edges)
    if options.distances:
        write_text(options.distances, distances_text(apart))
    if options.histograms:
        write_text(options.histograms, histograms_text(found, edges))
    if options.json:
        facts = [{"name": item.name, "mean": item.mean, "density": densities(item, edges)} for item in found]
        pairs = [{"a": a, "b": b, "l1": l1, "wasserstein1": w} for a, b, l1, w in apart.pairs()]
        print(json_text({"maps": facts, "edges": edges, "distances": pairs}), end="")
    else:
        print(_text(found, apart))
    return 0


def _signatures(options: argparse.Namespace) -> list[Signature]:
    from workbench.core.signature import signature
    from workbench.engine.map_file import open_map

    found: list[Signature] = []
    for file in options.maps:
        opened = open_map(file, kind=options.map, fixes=tuple(options.fixes), tets=options.tets)
        if opened.was_mirrored:
            print(f"{file}: the map is mirrored as a whole; its reflection is taken.", file=sys.stderr)
        item = signature(opened.mesh, opened.positions, shown_name(Path(file).stem))
        if any(item.name == other.name for other in found):
            item = item.named(file)
        found.append(item.normalised() if options.normalise else item)
    if len({item.name for item in found}) < len(found):
        raise WorkbenchError("A map is named twice; name each file once.")
    return found


def _text(found: list[Signature], apart: Distances) -> str:
    rows = [["map", "mean", "min", "max"]]
    rows += [[item.name, number(item.mean), number(item.values.min()), number(item.values.max())] for item in found]
    pairs = [["a", "b", "L1", "Wasserstein-1"]]
    pairs += [[a, b, number(l1), number(wasserstein)] for a, b, l1, wasserstein in apart.pairs()]
    return table(rows) + ("\n\n" + table(pairs) if len(pairs) > 1 else "")
