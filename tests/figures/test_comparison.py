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
from workbench.figures.contact_sheet import LAST, contact_sheet, sheet_columns
from workbench.figures.convergence_curves import QUANTITIES, convergence_curves, curves_of
from workbench.figures.level_curves import level_curves


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
    cells = [axes for axes in figure.axes if axes.images]
    assert len(cells) == 3 * len(rows) + 3  # and the sources
    images = [axes.images[0].get_array() for axes in cells[: 3 * len(rows)]]
    np.testing.assert_array_equal(images[-1], images[2])  # the given map is one and the same
    limits = {(round(np.ptp(axes.get_xlim()), 9), round(np.ptp(axes.get_ylim()), 9)) for axes in cells[: 3 * len(rows)]}
    assert len(limits) == 1  # one scale of length, too
    words = {text.get_text() for axes in cells for text in (axes.title, axes.yaxis.label)}
    assert {"iteration 0", "iteration 3", "last", "given", "source, aqp"} <= words
    assert f"ended at {newton.state.iteration}" in words


def test_names_of_files_are_no_mathematics(race):
    name = r"a$\q$.obj"
    curves = [replace(curve, label=name) for curve in curves_of(race)]
    columns = [replace(column, label=name) for column in sheet_columns(race, (LAST,))]
    levels = {"loop": [LevelMeasures(0, 4, 2, 0, {name: 1.0}), LevelMeasures(1, 9, 8, 0, {name: 2.0})]}
    sheet = contact_sheet(race.racers[0].problem, columns, (LAST,), name)
    for figure in (convergence_curves(curves, name), sheet, level_curves(levels, name)):
        figure.canvas.draw()  # where it is read as mathematics, there is no such symbol
        assert figure.get_suptitle().startswith(name)


def test_inverted_simplices_are_yellow_on_top(square):
    folded = square.vertices.copy()
    folded[24] += [0.3, 0.0]
    problem = problem_on(square, "dirichlet", reach=0.0)
    race = Race(problem, folded, [Contestant("folded", None, folded)])
    (cell, *_) = contact_sheet(problem, sheet_columns(race, (LAST,)), (LAST,)).axes
    image = np.asarray(cell.images[0].get_array())
    yellow = (np.abs(image[..., :3] - [1.0, 0.83, 0.0]) < 1e-6).all(axis=2) & (image[..., 3] == 1.0)
    edges = folded[square.simplices[:, 1:]] - folded[square.simplices[:, :1]]
    det = np.linalg.det(edges)
    area = -0.5 * det[det < 0].sum()
    assert area > 0
    left, right = cell.get_xlim()
    assert yellow.sum() * ((right - left) / image.shape[1]) ** 2 == pytest.approx(area, rel=0.25)


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
    assert ends(moved, *[rest] * 20) == pytest.approx((4.0, worst))  # far fewer than a hundredth
    low, high = ends(rest, rest)
    assert high - low >= 1e-3 * low  # what differs by rounding alone is one colour
