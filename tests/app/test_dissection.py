"""The window that takes a step apart: what it draws is what the step holds."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from workbench.app.dissection.dissection_window import DissectionWindow
from workbench.app.main_window import MainWindow
from workbench.app.views.arrow_layer import spread
from workbench.core.constraints import Anchors
from workbench.core.dissection import Dissection, dissect
from workbench.core.distortion import Distortion
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.solver import restarted
from workbench.core.state import State
from workbench.engine.messages import Dissect, Dissected, Step


@pytest.fixture
def dissection(window: MainWindow) -> Iterator[DissectionWindow]:
    window.actions_by_name["dissect"].trigger()
    shown = window.commands.dissection
    assert shown is not None
    yield shown
    shown.close()
    QTest.qWait(20)
    assert window.commands.dissection is None


def step_on(window: MainWindow, id: str = "gradient-descent") -> Dissection:
    """A step on the window's own mesh, sheared."""
    mesh = window.document.mesh
    problem = Problem.create(mesh, "plane", Distortion.resolve("symmetric-dirichlet"), Anchors.none(2))
    x, y = mesh.vertices.T
    state = restarted(problem, State(np.c_[x + 0.4 * y * y, y * (1.0 + 0.3 * x)]))
    return dissect(registry().solver(id)(), problem, state)


def answer(window: MainWindow, step: Dissection) -> None:
    report = Dissected(window.document.loaded.generation, "Gradient descent", step, "message")
    window.bridge.dissected.emit(report)


def test_it_asks_for_the_next_step(window: MainWindow, dissection: DissectionWindow) -> None:
    commands = window.bridge._worker.commands
    assert sum(isinstance(command, Dissect) for command in commands) == 1
    dissection.next.click()
    QTest.qWait(60)
    assert any(isinstance(command, Step) for command in commands)
    assert sum(isinstance(command, Dissect) for command in commands) == 2


def test_the_plot_holds_the_curve_its_trials_and_the_step(window: MainWindow, dissection: DissectionWindow) -> None:
    step = step_on(window)
    answer(window, step)
    x, y = dissection.plot.curve.getOriginalDataset()
    np.testing.assert_array_equal(x, step.curve_sizes[np.isfinite(step.curve_energies)])
    assert y[0] == pytest.approx(step.before.energy)
    tried, energies = dissection.plot.trials.getOriginalDataset()
    np.testing.assert_array_equal(tried, step.trial_sizes[np.isfinite(step.trial_energies)])
    assert step.after.energy in energies
    taken, energy = dissection.plot.accepted.getOriginalDataset()
    assert taken[0] == step.step_size and energy[0] == step.after.energy
    assert f"{step.step_size:.4g}" in dissection.words.text()
    (low, high) = dissection.plot.getPlotItem().getViewBox().viewRange()[1]
    assert low < step.after.energy < step.before.energy < high


def test_trials_carry_their_numbers_and_the_legend_names_what_there_is(
    window: MainWindow, dissection: DissectionWindow
) -> None:
    step = step_on(window)
    answer(window, step)
    assert len(step.trial_sizes) > 1, "this step is one of several trials"
    plot = dissection.plot
    shown = {(item.toPlainText(), item.pos().x(), item.pos().y()) for item in plot._numbers}
    finite = np.flatnonzero(np.isfinite(step.trial_energies))
    assert shown == {(str(row + 1), step.trial_sizes[row], step.trial_energies[row]) for row in finite.tolist()}
    names = [label.text for _, label in plot.legend.items]
    assert "step taken" in names and ("trials off the line" in names) == (not step.trial_on_line.all())
    assert "inverts" in plot.bound.label.format


def test_anchors_stand_where_they_are_wanted(window: MainWindow, dissection: DissectionWindow) -> None:
    document = window.document
    document.add_anchor(0)
    document.move_anchor(0, document.positions[0] + [0.5, 0.1], False)
    try:
        answer(window, step_on(window))
        scene, frame = dissection.view.overlay.scene, dissection.view.geometry_shown.frame
        np.testing.assert_allclose(scene.anchor_points, frame.to_display(document.anchors.target_array(2)))
        np.testing.assert_array_equal(scene.vertex_points, dissection.view.geometry_shown.points[[0]])
    finally:
        document.clear_anchors()


def test_one_can_walk_along_the_step(window: MainWindow, dissection: DissectionWindow) -> None:
    step = step_on(window)
    answer(window, step)
    view, frame = dissection.view, dissection.view.geometry_shown.frame
    np.testing.assert_allclose(view.geometry_shown.points, frame.to_display(step.after.positions), atol=1e-6)
    dissection.plot.marker.setValue(0.0)
    np.testing.assert_allclose(view.geometry_shown.points, frame.to_display(step.before.positions), atol=1e-6)
    np.testing.assert_allclose(dissection.arrows._vectors[:, :2], step.direction * frame.scale, atol=1e-9)
    corners = view.geometry_shown.points[window.document.mesh.simplices[step.limiting_simplex]]
    np.testing.assert_array_equal(view.overlay.scene.limiting, corners)
    dissection.plot.marker.setValue(1e9)  # no farther than the curve goes
    assert dissection.plot.marker.value() == pytest.approx(step.curve_sizes[-1])
    dissection.grab()  # everything can be painted


def test_a_step_that_goes_nowhere_is_said(window: MainWindow, dissection: DissectionWindow, qtbot: QtBot) -> None:
    mesh = window.document.mesh
    problem = Problem.create(mesh, "plane", Distortion.resolve("symmetric-dirichlet"), Anchors.none(2))
    rest = restarted(problem, State(mesh.vertices[:, :2]))
    answer(window, dissect(registry().solver("projected-newton")(), problem, rest))
    assert "goes nowhere" in dissection.words.text()
    window.commands.choose_theme("dark")
    window.commands.choose_theme("light")


def test_arrows_are_spread_and_the_longest_stays() -> None:
    random = np.random.default_rng(5)
    pixels, lengths = random.uniform(0, 100, (500, 2)), random.uniform(0, 1, 500)
    rows = spread(pixels, lengths, 20.0)
    cells = np.floor(pixels / 20.0).astype(int)
    assert len(rows) == len(np.unique(cells, axis=0)) == len(np.unique(cells[rows], axis=0))
    for row in rows:
        same = (cells == cells[row]).all(axis=1)
        assert lengths[row] == lengths[same].max()
