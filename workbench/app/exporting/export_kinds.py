"""What can be exported: words, ending, and of the pictures which panel of a figure they are."""

from __future__ import annotations

from dataclasses import dataclass

PICTURES = "PNG, carries the session (*.png);;SVG (*.svg);;PDF (*.pdf)"


@dataclass(frozen=True)
class ExportKind:
    """One entry of File > Export.

    `name` ends the name that is offered; `filters` are those of the dialog, the first one its default. `panel` is the start
    of the words by which figures call what is drawn; empty for tables and meshes.
    """

    text: str
    tip: str
    name: str
    filters: str
    panel: str = ""


MAP_KINDS = {
    "export-obj": ExportKind("&OBJ…", "The map; vertex order and faces of the source kept", "-map.obj", "OBJ (*.obj)"),
    "export-vtu": ExportKind("&VTU with all fields…", "The map with every measure of each simplex", "-map.vtu", "VTK (*.vtu)"),
    "export-case": ExportKind("&Case, npz…", "Source, map and anchors as NumPy arrays", "-case.npz", "NumPy case (*.npz)"),
    "export-measures": ExportKind("&Measures of each simplex…", "A row a simplex, as CSV", "-measures.csv", "CSV (*.csv)"),
}
"""Written as File > Save map writes them."""
UNIT_KIND = ExportKind(
    "OBJ with UVs from &0 to 1…",
    "The surface with its map shifted and scaled into the unit square, where programs that paint look for it",
    "-uvs.obj",
    "OBJ (*.obj)",
)
HISTORY_KIND = ExportKind("&History…", "A row an iteration since the last start, as CSV", "-history.csv", "CSV (*.csv)")
SCRIPT_KIND = ExportKind("&Python script…", "Repeats the run with workbench.api", "-run.py", "Python (*.py)")
OTHER_KINDS = {"export-unit": UNIT_KIND, "export-history": HISTORY_KIND, "export-script": SCRIPT_KIND}
PICTURE_KINDS = {
    "export-target": ExportKind("Picture of the &target…", "The map as it is shown", "-target.png", PICTURES, "Target"),
    "export-source": ExportKind("Picture of the so&urce…", "The source as it is shown", "-source.png", PICTURES, "Source"),
    "export-histogram": ExportKind("Hi&stogram…", "With its axes, as a picture", "-histogram.png", PICTURES, "Histogram"),
    "export-curve": ExportKind("&Energy over iterations…", "As a picture", "-energy.png", PICTURES, "Curve: energy"),
}
"""Drawn as figures are: one panel on a page."""
KINDS: dict[str, ExportKind] = {**MAP_KINDS, **OTHER_KINDS, **PICTURE_KINDS}
