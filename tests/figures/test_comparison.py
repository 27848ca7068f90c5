"""Curves and contact sheets of a race: what is drawn is what was found."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.engine.test_race import problem_on
from workbench.core.jacobians import signed_singular_values
from workbench.core.refine import LevelMeasures
from workbench.core.registry import registry
from workbench.engine.race import Contestant, Limits, Race
from workbench.figures.colour_scale import INVERTED
from workbench.figures.composer import compose
from workbench.figures.contact_sheet import LAST, contact_sheet, sheet_columns
from workbench.figures.convergence_curves import QUANTITIES, convergence_curves, curves_of
from workbench.figures.figure_maps import FigureMap
from workbench.figures.level_curves import level_curves
from workbench.figures.recipe import Recipe
from workbench.figures.solver_sheet import SheetCell, sheet_page, sheet_panels


@pytest.fixture(scope="module")
def race(square):
    contestants = [Contestant.of("projected-newton"), Contestant.of("aqp"), Contestant("given", None, square.vertices * 1.4)]
    found = Race(problem_on(square, reach=0.2), square.vertices, contestants, limits=Limits(8), pinned=(0, 3))
    found.run()
    found.racer("aqp").rebase("by Newton", solver=registry().solver("projected-newton")())
    found.run()
    return found


def test_every_curve_is_the_history_of_its_contestant(race):
    figure = convergence_curves(curves_of(race), "square")
    panels = np.array(figure.axes).reshape(len(QUANTITIES), 2)
    for row, name in zip(panels, QUANTITIES, strict=True):
        for panel, axis in zip(row, ("iteration", "seconds"), strict=True):
            lines = {line.get_label(): line for line in panel.lines if not line.get_label().startswith("_")}
            assert list(lines) == ["projected-newton", "aqp", "given"]
            for label in ("projected-newton", "aqp"):
                x, y = lines[label].get_data()
                rows = race.racer(label).rows
                np.testing.assert_array_equal(x, [getattr(r, axis) for r in rows])
                if name in ("energy", "inverted"):
                    np.testing.assert_array_equal(y, [getattr(r, name) for r in rows])
            styles = {(line.get_color(), line.get_linestyle()) for line in lines.values()}
            assert len(styles) == len({line.get_color() for line in lines.values()}) == 3
    assert all(panel.get_yscale() == "log" for panel in panels[:3].ravel())


def test_a_switch_is_marked_where_it_was(race):
    (energy, *_) = convergence_curves(curves_of(race)).axes
    marker = race.racer("aqp").markers[0]
    marks = [line for line in energy.lines if line.get_marker() == "|" and len(line.get_xdata())]
    assert [line.get_xdata().tolist() for line in marks] == [[marker.iteration]]


def test_the_legend_stands_outside_the_data(race):
    figure = convergence_curves(curves_of(race))
    figure.canvas.draw()
    box = figure.legends[0].get_window_extent()
    assert not any(box.overlaps(panel.get_window_extent()) for panel in figure.axes)


def test_a_sheet_has_a_cell_for_each_map_on_one_scale(race):
    rows = (0, 3, 100, LAST)
    columns = sheet_columns(race, rows)
    newton = race.racer("projected-newton")
    assert columns[0].maps[1].positions is newton.maps.at_iteration(3).positions
    assert columns[0].maps[2].positions is columns[0].maps[3].positions is newton.positions
    figure = contact_sheet(race.racers[0].problem, columns, rows, "square")
    drawn = [axes for axes in figure.axes if triangles_of(axes)]
    assert len(drawn) == 3 * len(rows)
    assert len([axes for axes in figure.axes if axes.images]) == 3  # the textured sources
    given = [[path.vertices.tolist() for path in triangles_of(drawn[row])[0].get_paths()] for row in (2, -1)]
    assert given[0] == given[1]  # the given map is one and the same
    limits = {(round(np.ptp(axes.get_xlim()), 9), round(np.ptp(axes.get_ylim()), 9)) for axes in drawn}
    assert len(limits) == 1  # one scale of length, too
    lefts = np.array([axes.get_position().x0 for axes in drawn]).reshape(len(rows), 3)
    assert (np.ptp(lefts, axis=0) < 1e-9).all() and (np.diff(lefts[0]) > 0).all()  # a column a solver
    words = " ".join(" ".join(text.get_text().split()) for text in figure.texts)
    for said in ("square", "given, given", "source, aqp", "aqp, 3 ·", f"aqp, last: {columns[1].maps[-1].iteration} ·"):
        assert said in words
    assert f"projected-newton, ended at {newton.state.iteration}" in words


def triangles_of(axes):
    """The triangles of a panel, where it has some as vectors."""
    return [item for item in axes.collections if item.get_gid() == "triangles"]


def test_the_sheet_is_laid_out_as_the_preset_is(race):
    rows = (0, 3, LAST)
    figure = contact_sheet(race.racers[0].problem, sheet_columns(race, rows), rows)
    cells = [[SheetCell(f"{i} {j}", "words") for j in range(3)] for i in range(3)]
    count, panels = sheet_panels(cells, cells[-1])
    maps = {cell.map: FigureMap("", race.racers[0].problem.mesh, race.racers[0].positions, np.empty(0, int))
            for row in cells for cell in row}  # fmt: skip
    preset = compose(Recipe(sheet_page(count), (), panels), maps).figure
    ours, theirs = ([axes.get_position().x0 for axes in each.axes] for each in (figure, preset))
    np.testing.assert_allclose(ours, theirs)
    assert figure.get_figwidth() == pytest.approx(preset.get_figwidth())


def test_names_of_files_are_no_mathematics(race):
    name = r"a$\q$.obj"
    curves = [replace(curve, label=name) for curve in curves_of(race)]
    columns = [replace(column, label=name) for column in sheet_columns(race, (LAST,))]
    levels = {"loop": [LevelMeasures(0, 4, 2, 0, {name: 1.0}), LevelMeasures(1, 9, 8, 0, {name: 2.0})]}
    sheet = contact_sheet(race.racers[0].problem, columns, (LAST,), name)
    for figure in (convergence_curves(curves, name), sheet, level_curves(levels, name)):
        figure.canvas.draw()  # where it is read as mathematics, there is no such symbol
        titles = [figure.get_suptitle(), *(text.get_text() for text in figure.texts)]
        assert any(title.startswith(name) for title in titles)


def test_inverted_simplices_are_yellow_on_top(square):
    folded = square.vertices.copy()
    folded[24] += [0.3, 0.0]
    problem = problem_on(square, "dirichlet", reach=0.0)
    race = Race(problem, folded, [Contestant("folded", None, folded)])
    (cell, *_) = contact_sheet(problem, sheet_columns(race, (LAST,)), (LAST,)).axes
    (triangles,) = triangles_of(cell)
    yellow = (np.abs(triangles.get_facecolors()[:, :3] - INVERTED) < 1e-6).all(axis=1)
    edges = folded[square.simplices[:, 1:]] - folded[square.simplices[:, :1]]
    assert yellow.sum() == (np.linalg.det(edges) < 0).sum() > 0
    assert yellow[-yellow.sum() :].all()  # drawn last


def test_the_scale_reaches_the_few_where_nearly_all_are_at_the_least(square):
    rest = square.vertices[:, :2].copy()
    moved = rest.copy()
    moved[0] -= 0.4 * (rest[1] - rest[0])

    def ends(*maps: np.ndarray) -> tuple[float, float]:
        race = Race(problem_on(square, reach=0.0), rest, [Contestant(str(row), None, x) for row, x in enumerate(maps)])
        problem = race.racers[0].problem
        return contact_sheet(problem, sheet_columns(race, (LAST,)), (LAST,)).axes[-1].get_xlim()

    problem = problem_on(square, reach=0.0)
    worst = problem.distortion.value(signed_singular_values(problem.elements, moved)).max()
    assert worst > 4.1
    assert ends(moved, *[rest] * 7) == pytest.approx((4.0, worst))  # far fewer than a hundredth
    low, high = ends(rest, rest)
    assert high - low >= 1e-3 * low  # what differs by rounding alone is one colour
