"""What a notebook shows of sources, results, measures and figures."""

from __future__ import annotations

import io
import json
from pathlib import Path

import numpy as np
import pytest

from workbench.api import Mesh, WorkbenchError, figure, load, make_sample, measure, references, solve
from workbench.cli.main import main
from workbench.core.measure import Measure
from workbench.figures.composer import title_of

SVG = "http://www.w3.org/2000/svg"


def picture(png: bytes) -> np.ndarray:
    """Pixels (rows, columns, 4) of a PNG, each from 0 to 1."""
    from matplotlib.image import imread

    return imread(io.BytesIO(png))


def colourful(pixels: np.ndarray) -> float:
    """Part of the pixels that are no grey."""
    return float((np.ptp(pixels[..., :3], axis=2) > 0.15).mean())


@pytest.fixture(scope="module")
def solved():
    source = load("sample:bumpy-disc")
    return solve(source, iterations=3, progress=False)


def test_a_source_shows_itself_and_the_map_in_its_file(solved, tmp_path: Path) -> None:
    source = solved.source
    assert source.map is None
    assert "3,169 vertices" in repr(source)
    assert "parameterize" in repr(source)
    solved.save(tmp_path / "map.obj")
    again = load(tmp_path / "map.obj")
    np.testing.assert_allclose(again.map, solved.positions, atol=1e-12)
    assert "with a map" in repr(again)
    alone, both = picture(source._repr_png_()), picture(again._repr_png_())
    assert colourful(both) > 0.2 > 0.02 > colourful(alone)
    assert both.shape[1] > 1.5 * alone.shape[1]


def test_a_result_shows_its_map_beside_its_numbers(solved) -> None:
    assert colourful(picture(solved._repr_png_())) > 0.2
    page = solved._repr_html_()
    assert page.count("data:image/png;base64,") == 1
    for words in ("Projected Newton", "MAX_ITERATIONS", f"{solved.energy:.10g}", "symmetric-dirichlet"):
        assert words in page
        assert words in repr(solved)


def test_names_cannot_smuggle_markup(square: Mesh) -> None:
    result = solve(Mesh(square.vertices, square.simplices, "<script>alert(1)</script>"), iterations=0, progress=False)
    assert "<script>" not in result._repr_html_()
    assert "&lt;script&gt;" in result._repr_html_()


def test_the_picture_of_a_solid_shows_it(cube: Mesh) -> None:
    result = solve(cube, anchors={0: (-0.3, 0, 0), 26: (1.3, 1, 1)}, progress=False)
    assert colourful(picture(result.png)) > 0.05


def test_measures_are_those_of_the_command_line(solved, tmp_path: Path, capsys) -> None:
    solved.save(tmp_path / "map.obj")
    assert main(["measure", str(tmp_path / "map.obj"), "--json"]) == 0
    theirs = json.loads(capsys.readouterr().out)
    from_file, both = measure(tmp_path / "map.obj"), measure((tmp_path / "map.obj", from_npz(solved, tmp_path)))
    assert dict(from_file) == theirs
    assert both["measures"] == from_file["measures"]
    assert main(["measure", str(tmp_path / "map.obj")]) == 0
    assert repr(from_file) == capsys.readouterr().out.rstrip("\n")
    row = f"<td>symmetric-dirichlet</td><td>{from_file['measures']['symmetric-dirichlet']['mean']:.6g}</td>"
    assert row in from_file._repr_html_()
    assert len(from_file.simplices["det"]) == solved.mesh.simplex_count
    mean = solved.measure()["measures"]["symmetric-dirichlet"]["area_weighted_mean"]
    assert mean == pytest.approx(solved.mean_distortion, rel=1e-12)


def from_npz(solved, folder: Path) -> Path:
    np.savez(folder / "map.npz", V=solved.mesh.vertices, S=solved.mesh.simplices, X=solved.positions)
    return folder / "map.npz"


def test_a_map_may_be_positions() -> None:
    bar = make_sample("bar")
    twice = measure(bar, 2 * bar.vertices[:, :2])
    assert twice["measures"]["dirichlet"]["mean"] == pytest.approx(8.0)
    with pytest.raises(WorkbenchError, match="rows"):
        measure(bar, bar.vertices[1:])
    with pytest.raises(WorkbenchError, match="no map"):
        measure(load("sample:bar"))


def test_maps_become_figures_with_one_scale(dome: Mesh, tmp_path: Path) -> None:
    solved = solve(dome, progress=False)
    before = (solved.source, solved.start)
    drawing = figure({"before": before, "after": solved}, colour=["arap", "det"], width=120, dpi=60, title="Two maps")
    assert len(drawing.recipe.panels) == 6
    bars = [panel for panel in drawing.recipe.panels if panel.bar]
    assert [panel.colour for panel in bars] == ["arap", "det"]
    words = {text.get_text() for text in drawing.figure.findobj(lambda item: hasattr(item, "get_text"))}
    assert {"before", "after", "Two maps", title_of(Measure("arap"))} <= words
    for ending in ("png", "pdf", "svg"):
        drawing.save(tmp_path / f"maps.{ending}")
    assert (tmp_path / "maps.pdf").read_bytes().startswith(b"%PDF")
    svg = drawing._repr_svg_()
    assert svg is None or SVG in svg
    with pytest.raises(WorkbenchError, match="recipe"):
        drawing.save(tmp_path / "maps.json")


def test_presets_and_recipes_are_those_of_the_command_line(square: Mesh, tmp_path: Path) -> None:
    mesh, theirs, ours = str(tmp_path / "square.npz"), tmp_path / "theirs", tmp_path / "ours"
    moved = square.vertices[[0, 48]] + [[0.0, 0.0], [0.4, 0.2]]
    np.savez(mesh, V=square.vertices, S=square.simplices, anchors=[0, 48], targets=moved)
    command = ["figure", "before-after", "--mesh", mesh, "--out", str(theirs), "--recipe", "--quiet"]
    assert main([*command, "--width", "85", "--dpi", "100"]) == 0
    ours.mkdir()
    figure("before-after", mesh=mesh, width=85.0, dpi=100).save(ours / "ours.svg")
    figure(theirs / "before-after.json").save(ours / "again.json")
    for mine, other in (("ours.svg", "before-after.svg"), ("again.json", "before-after.json")):
        assert (ours / mine).read_bytes() == (theirs / other).read_bytes()
    with pytest.raises(WorkbenchError, match="no-such-figure"):
        figure("no-such-figure")


def test_what_was_used_is_cited(solved, tmp_path: Path, capsys) -> None:
    found = references(solved)
    assert all(f"{{{key}," in found for key in ("NNZ21", "SS15", "TSIF05", "LBK16", "Tut63"))
    references(solved, "slim").save(tmp_path / "used.bib")
    assert "{RPPSH17," in (tmp_path / "used.bib").read_text()
    assert main(["cite", "slim", "lscm"]) == 0
    assert capsys.readouterr().out == references("slim", "lscm")
