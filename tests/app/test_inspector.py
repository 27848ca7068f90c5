"""The inspector with a fake engine: it follows the choice and the map, marks simplices both ways, and rests while hidden."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF, Qt
from PySide6.QtGui import QMouseEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDockWidget, QTabBar, QWidget
from pytestqt.qtbot import QtBot

from tests.app.conftest import Hand, WindowMaker, pixel_of
from workbench.app.inspector.inspector_dock import InspectorDock
from workbench.app.inspector.plane_field import to_places
from workbench.app.main_window import MainWindow
from workbench.engine.messages import Watch

pytestmark = pytest.mark.usefixtures("kept_inspector")

FORMULA, PLANE, CURVES, STAR, MIRROR = range(5)


@pytest.fixture
def inspector(window: MainWindow, qtbot: QtBot) -> Iterator[InspectorDock]:
    """The dock, open on its first page; closed at the end."""
    dock = window.inspector
    window.document.choose(distortion="symmetric-dirichlet", distortion_parameters={})
    dock.toggle.trigger()
    qtbot.waitUntil(dock.body.formula.isVisible)
    yield dock
    window.brush.clear()
    dock.body.tabs.setCurrentIndex(FORMULA)
    if dock.isVisible():
        dock.toggle.trigger()


@pytest.fixture
def plane(inspector: InspectorDock, window: MainWindow, qtbot: QtBot) -> InspectorDock:
    """The dock on the page of the plane, with the simplices of a stretched map in it."""
    inspector.body.tabs.setCurrentIndex(PLANE)
    hand = Hand(window.target.view)
    hand.click(pixel_of(window.target.view, 0))
    begin = pixel_of(window.target.view, 272)
    hand.drag(begin, begin + QPoint(-30, 20))
    qtbot.waitUntil(lambda: window.document.snapshot.singular_values is not None)
    qtbot.waitUntil(lambda: len(inspector.body.plane.plot.points.places) == 480)
    qtbot.waitUntil(lambda: inspector.body.plane.plot.field is not None)
    page, document = inspector.body.plane, window.document

    def is_at_rest() -> bool:
        sizes = np.abs(document.snapshot.singular_values[:, [0, -1]])
        shows_newest = document.snapshot.anchor_serial == document.anchor_serial
        shows_newest &= np.allclose(page._places, to_places(sizes, True), atol=1e-6)
        return shows_newest and not page._rest.isActive() and not page._latest.is_busy

    qtbot.waitUntil(is_at_rest)
    page.fit()
    qtbot.wait(20)
    qtbot.waitUntil(is_at_rest)
    return inspector


def drag(widget: QWidget, places: list[QPoint]) -> None:
    """A hand with the left button down from the first place to the last."""
    left, none = Qt.MouseButton.LeftButton, Qt.MouseButton.NoButton
    kinds = [QEvent.Type.MouseButtonPress] + [QEvent.Type.MouseMove] * (len(places) - 1) + [QEvent.Type.MouseButtonRelease]
    for kind, place in zip(kinds, [*places, places[-1]], strict=True):
        button = none if kind is QEvent.Type.MouseMove else left
        held = none if kind is QEvent.Type.MouseButtonRelease else left
        at = QPointF(place)
        event = QMouseEvent(kind, at, widget.mapToGlobal(at), button, held, Qt.KeyboardModifier.NoModifier)
        QApplication.sendEvent(widget, event)
        QTest.qWait(5)


def pixel_in_plot(plot, place) -> QPoint:
    """Pixel of the viewport at a place of the plane."""
    scene = plot.box.mapViewToScene(QPointF(*place))
    return plot.mapFromScene(scene)


# ---------------------------------------------------------------------------------------------- hidden and shown


def test_nothing_is_done_while_it_is_hidden(window: MainWindow, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch) -> None:
    work: list[str] = []
    for page in window.inspector.body.pages:
        monkeypatch.setattr(page, "refresh", lambda p=page: work.append(type(p).__name__))
    monkeypatch.setattr(window.inspector.body.plane, "draw_points", lambda: work.append("points"))
    window.document.choose(distortion="mips", distortion_parameters={})
    window.document.step()
    qtbot.wait(200)
    assert not work
    assert window.document.snapshot.singular_values is None
    assert not any(c.singular_values for c in window.bridge._worker.commands if isinstance(c, Watch))


def test_singular_values_are_asked_for_by_the_plane_alone(inspector: InspectorDock, window: MainWindow, qtbot: QtBot) -> None:
    def has_values() -> bool:
        return window.document.snapshot.singular_values is not None

    assert not has_values()
    inspector.body.tabs.setCurrentIndex(PLANE)
    qtbot.waitUntil(has_values)
    inspector.body.tabs.setCurrentIndex(CURVES)
    window.document.step()
    qtbot.waitUntil(lambda: not has_values())


def bars_to_be_seen(window: MainWindow) -> list[list[str]]:
    """The words on each bar of tabs that lies over the window."""
    bars = window.findChildren(QTabBar, options=Qt.FindChildOption.FindDirectChildrenOnly)
    seen = [bar for bar in bars if bar.isVisible() and bar.geometry().intersects(window.rect())]
    return [[bar.tabText(tab) for tab in range(bar.count())] for bar in seen]


def test_it_makes_room_and_gives_it_back(window: MainWindow, qtbot: QtBot) -> None:
    def stacked(docks: list[QDockWidget]) -> bool:
        return not any(window.tabifiedDockWidgets(dock) for dock in docks) and all(d.isVisible() for d in docks)

    maps = [dock for dock in window.maps if dock.isVisible()]
    assert stacked(maps)
    size, width = window.size(), window.target.view.width()
    QTest.keyClick(window, Qt.Key.Key_I, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(window.inspector.isVisible)
    qtbot.wait(100)
    assert not stacked(maps)
    assert window.inspector.height() > 0.4 * window.height()
    assert window.target.view.width() > 0.7 * width
    assert window.size() == size, "the window does not grow"
    qtbot.waitUntil(lambda: bars_to_be_seen(window) == [[dock.windowTitle() for dock in maps]])
    QTest.keyClick(window, Qt.Key.Key_I, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(lambda: not window.inspector.isVisible())
    qtbot.waitUntil(lambda: stacked(maps))
    qtbot.waitUntil(lambda: abs(window.target.view.width() - width) <= 4)
    qtbot.waitUntil(lambda: not bars_to_be_seen(window))


def test_it_floats_and_comes_back_into_the_same_window(inspector: InspectorDock, window: MainWindow, qtbot: QtBot) -> None:
    size = window.size()
    inspector.setFloating(True)
    qtbot.wait(100)
    inspector.setFloating(False)
    qtbot.wait(100)
    assert window.size() == size
    assert inspector.isVisible()
    inspector.toggle.trigger()
    qtbot.waitUntil(lambda: not any(window.tabifiedDockWidgets(dock) for dock in window.maps))


# ---------------------------------------------------------------------------------------------- formula and badges


def test_the_badges_follow_the_choice(inspector: InspectorDock, window: MainWindow, qtbot: QtBot) -> None:
    page = inspector.body.formula
    answers = {}
    for id in ("symmetric-dirichlet", "dirichlet"):
        window.document.choose(distortion=id, distortion_parameters={})
        qtbot.waitUntil(lambda: page.badges._analysis is not None)
        answers[id] = {name: chip.text()[0] for name, chip in page.badges.chips.items()}
        chip = page.badges.chips["regular"]
        QTest.mouseClick(chip, Qt.MouseButton.LeftButton)
        assert ("Regular: yes" in page.badges.detail.text()) == (id == "symmetric-dirichlet")
    assert answers["symmetric-dirichlet"] == dict.fromkeys(answers["dirichlet"], "✓") | {"convex": "✗"}
    assert answers["dirichlet"]["convex"] == "✓"
    assert answers["dirichlet"]["bottom_barrier"] == "✗"


def test_the_formula_is_drawn_and_drawn_anew_for_another(inspector: InspectorDock, window: MainWindow, qtbot: QtBot) -> None:
    pytest.importorskip("matplotlib")
    picture = inspector.body.formula.picture
    qtbot.waitUntil(lambda: picture.drawing is not None)
    first = picture.drawing
    assert (first.ink > 128).sum() > 100
    assert first.ink.shape[1] <= picture.width() * first.ratio
    window.document.choose(distortion="sum(sigma^4) + weight/det^2", distortion_parameters={"weight": 2.0})
    qtbot.waitUntil(lambda: picture.drawing is not None and picture.drawing is not first)
    assert r"\mathrm{weight}" in "".join(picture.drawing.terms)
    assert "weight = 2" in inspector.body.formula.parameters.text()


def test_an_analysis_that_comes_late_is_not_shown(inspector: InspectorDock, window: MainWindow, qtbot: QtBot) -> None:
    page = inspector.body.formula
    qtbot.waitUntil(lambda: page.badges._analysis is not None)
    old_key, old = inspector.subject.key, page.badges._analysis
    window.document.choose(distortion="volume", distortion_parameters={})
    qtbot.waitUntil(lambda: page.badges._analysis not in (None, old))
    page._take_analysis((old_key, old, ""))
    assert page.badges._analysis is not old


def test_each_analysis_is_made_once(inspector: InspectorDock, window: MainWindow, qtbot: QtBot) -> None:
    page, asked = inspector.body.formula, []
    analyser = page._analyser
    page._analyser = lambda item, n: asked.append((item.id, n)) or analyser(item, n)
    page._analyses.clear()
    try:
        for id in ("mips", "volume", "mips", "volume"):
            window.document.choose(distortion=id, distortion_parameters={})
            qtbot.waitUntil(lambda: page.badges._analysis is not None)
        inspector.dimension = 2
    finally:
        page._analyser = analyser
    assert asked == [("mips", 2), ("volume", 2)]


@pytest.mark.parametrize("page", [FORMULA, PLANE, CURVES, STAR, MIRROR])
def test_what_is_no_distortion_breaks_no_page(inspector: InspectorDock, window: MainWindow, qtbot: QtBot, page: int) -> None:
    inspector.body.tabs.setCurrentIndex(page)
    for text in ("sum(sigma", "nobody-knows-this", "1/0", "sum(sigma^2"):
        window.document.choose(distortion=text, distortion_parameters={})
        assert inspector.subject.distortion is None
        assert inspector.body.heading.error.text() == inspector.subject.sentence != ""
        assert inspector.body.heading.error.isVisible()
    window.document.choose(distortion="exp(exp(sum(sigma^2)))*sqrt(abs(sigma1 - sigma2))", distortion_parameters={})
    qtbot.wait(300)
    assert not inspector.body.heading.error.isVisible()
    window.document.choose(distortion="arap", distortion_parameters={})
    qtbot.wait(100)
    assert inspector.subject.distortion.id == "arap"


def test_a_formula_for_the_plane_alone_says_so_in_space(inspector: InspectorDock, window: MainWindow, qtbot: QtBot) -> None:
    window.document.choose(distortion="sum(largest(2)*sigma)", distortion_parameters={})
    assert inspector.subject.distortion is not None
    try:
        for page in range(inspector.body.tabs.count()):
            inspector.body.tabs.setCurrentIndex(page)
            inspector.subject.dimension = 3
            assert inspector.subject.distortion is None
            assert inspector.body.heading.error.isVisible()
            qtbot.wait(60)
            inspector.subject.dimension = 2
            assert not inspector.body.heading.error.isVisible()
    finally:
        inspector.subject.dimension = 2


def test_an_analysis_that_fails_is_a_sentence(inspector: InspectorDock, window: MainWindow, qtbot: QtBot) -> None:
    page = inspector.body.formula
    analyser = page._analyser

    def fail(item: object, n: int) -> object:
        raise ZeroDivisionError("by nothing")

    page._analyser = fail
    try:
        window.document.choose(distortion="sum(sigma^6)", distortion_parameters={})
        qtbot.waitUntil(lambda: "by nothing" in page.badges.detail.text())
    finally:
        page._analyser = analyser


# ---------------------------------------------------------------------------------------------- marking, both ways


def test_a_rectangle_in_the_plane_marks_simplices_in_the_views(plane: InspectorDock, window: MainWindow) -> None:
    plot = plane.body.plane.plot
    sigma = np.abs(window.document.snapshot.singular_values)
    places = np.log10(sigma[:, [0, -1]])
    middle = np.median(places[:, 0])
    low, high = np.array([middle, places[:, 1].min() - 0.2]), places.max(axis=0) + 0.15
    begin, end = pixel_in_plot(plot, low), pixel_in_plot(plot, high)
    drag(plot.viewport(), [begin, (begin + end) / 2, end])
    marked = set(window.brush.simplices.tolist())
    assert window.brush.origin == "inspector"
    x, y = plot.pixel_lengths()
    surely = np.flatnonzero(places[:, 0] > middle + 2 * x)
    perhaps = np.flatnonzero(places[:, 0] > middle - 2 * x)
    assert len(surely) and set(surely.tolist()) <= marked <= set(perhaps.tolist())
    np.testing.assert_allclose(np.sort(plot.brushed.places, axis=0), np.sort(places[sorted(marked)], axis=0), atol=1e-5)
    assert y > 0


def test_a_click_marks_one_simplex_and_a_click_beside_clears(plane: InspectorDock, window: MainWindow) -> None:
    plot = plane.body.plane.plot
    places = plane.body.plane._places
    lonely = int(np.argmax(places[:, 0]))
    QTest.mouseClick(plot.viewport(), Qt.MouseButton.LeftButton, pos=pixel_in_plot(plot, places[lonely]))
    assert len(window.brush.simplices) == 1
    chosen = int(window.brush.simplices[0])
    pixels = np.abs((places[chosen] - places[lonely]) / plot.pixel_lengths())
    assert pixels.max() <= 8
    assert f"simplex {chosen}" in plane.body.plane.readout.text()
    QTest.qWait(QApplication.doubleClickInterval() + 50)
    empty = pixel_in_plot(plot, places.min(axis=0)) + QPoint(4, 60)
    QTest.mouseClick(plot.viewport(), Qt.MouseButton.LeftButton, pos=empty)
    assert not len(window.brush.simplices)


def test_what_is_marked_elsewhere_lights_up_in_the_plane(plane: InspectorDock, window: MainWindow) -> None:
    rows = np.array([3, 77, 401])
    window.brush.brush(rows, "histogram")
    sigma = np.abs(window.document.snapshot.singular_values[rows][:, [0, -1]])
    np.testing.assert_allclose(plane.body.plane.plot.brushed.places, to_places(sigma, True), atol=1e-6)
    window.brush.clear()
    assert not len(plane.body.plane.plot.brushed.places)


def test_the_triangle_under_the_pointer_lights_up(plane: InspectorDock, window: MainWindow, qtbot: QtBot) -> None:
    view = window.target.view
    pixel = pixel_of(view, 136) + QPoint(4, 3)
    Hand(view).move(pixel)
    expected = view.triangle_at((pixel.x(), pixel.y()))
    assert expected >= 0
    qtbot.waitUntil(lambda: window.brush.simplices.tolist() == [expected])
    assert len(plane.body.plane.plot.brushed.places) == 1
    Hand(view).move(QPoint(1, 1))
    qtbot.waitUntil(lambda: not len(window.brush.simplices))


def test_pointing_leaves_a_choice_alone(plane: InspectorDock, window: MainWindow, qtbot: QtBot) -> None:
    window.brush.brush([5, 6], "histogram")
    Hand(window.target.view).move(pixel_of(window.target.view, 136) + QPoint(4, 3))
    qtbot.wait(150)
    assert window.brush.simplices.tolist() == [5, 6]


def test_points_follow_the_map_and_inverted_ones_are_apart(plane: InspectorDock, window: MainWindow, qtbot: QtBot) -> None:
    target = window.target.view
    hand = Hand(target)
    hand.click(pixel_of(target, 136))
    begin = pixel_of(target, 136)
    hand.drag(begin, begin + QPoint(150, 0), steps=4)
    qtbot.waitUntil(lambda: window.document.snapshot.inverted.any())
    plot = plane.body.plane.plot
    qtbot.waitUntil(lambda: len(plot.inverted.places) == int(window.document.snapshot.inverted.sum()))
    assert len(plot.points.places) == 480 - len(plot.inverted.places)
    assert "inverted" in plane.body.plane.note.text()


def test_axes_may_be_linear(plane: InspectorDock, window: MainWindow, qtbot: QtBot) -> None:
    page = plane.body.plane
    try:
        page.axes.setCurrentIndex(1)
        page.axes.activated.emit(1)
        qtbot.waitUntil(lambda: page.plot.field is not None and not page.plot.field.region.is_logarithmic)
        sigma = np.abs(window.document.snapshot.singular_values[:, [0, -1]])
        np.testing.assert_allclose(page._places, sigma, atol=1e-6)
    finally:
        page.axes.setCurrentIndex(0)
        page.axes.activated.emit(0)


# ---------------------------------------------------------------------------------------------- curves and paths


def test_curves_of_others_come_and_go(inspector: InspectorDock, qtbot: QtBot) -> None:
    inspector.body.tabs.setCurrentIndex(CURVES)
    page = inspector.body.curves
    qtbot.waitUntil(lambda: len(page._curves) == 1)
    ids = [page.others.item(row).data(Qt.ItemDataRole.UserRole) for row in range(page.others.count())]
    entry = page.others.item(ids.index("dirichlet"))
    entry.setCheckState(Qt.CheckState.Checked)
    qtbot.waitUntil(lambda: [curve.id for curve in page._curves] == ["symmetric-dirichlet", "dirichlet"])
    own, other = page._curves
    np.testing.assert_allclose(own.similar, 2 * own.s**2 + 2 / own.s**2)
    np.testing.assert_allclose(other.shearing, own.s**2 + 1 / own.s**2)
    entry.setCheckState(Qt.CheckState.Unchecked)
    qtbot.waitUntil(lambda: len(page._curves) == 1)


def test_the_vertex_of_the_star_is_pulled_by_hand(inspector: InspectorDock, qtbot: QtBot) -> None:
    inspector.body.tabs.setCurrentIndex(STAR)
    page = inspector.body.star
    qtbot.waitUntil(lambda: page.path is not None)
    page.pull(0.0)
    assert "no triangle is inverted" in page.sentence.text()
    picture = page.picture
    begin = QPoint(*picture.to_pixels(picture.scene.grip).round().astype(int).tolist())
    end = QPoint(*picture.to_pixels(np.array([1.4, 0.3])).round().astype(int).tolist())
    drag(picture, [begin, (begin + end) / 2, end])
    assert picture.scene.inverted.any()
    assert page.plot.marker.value() == pytest.approx(1.4, abs=0.05)
    assert picture.scene.points[0, 0] == pytest.approx(1.4, abs=0.05)
    assert picture.scene.points[0, 1] == 0.0, "the vertex stays on its line"
    assert "E = ∞" in page.sentence.text()


def test_a_distortion_without_barrier_says_so(inspector: InspectorDock, window: MainWindow, qtbot: QtBot) -> None:
    inspector.body.tabs.setCurrentIndex(STAR)
    window.document.choose(distortion="dirichlet", distortion_parameters={})
    qtbot.waitUntil(lambda: "no barrier" in inspector.body.star.sentence.text())


@pytest.mark.parametrize(("id", "words"), [("dirichlet", "convex along this path"), ("arap", "Not convex")])
@pytest.mark.parametrize("dimension", [2, 3])
def test_the_mirror_path_tells_about_convexity(
    inspector: InspectorDock, window: MainWindow, qtbot: QtBot, id: str, words: str, dimension: int
) -> None:
    inspector.body.tabs.setCurrentIndex(MIRROR)
    page = inspector.body.mirror
    try:
        inspector.subject.dimension = dimension
        window.document.choose(distortion=id, distortion_parameters={})
        qtbot.waitUntil(lambda: words in page.sentence.text())
        page.slider.setValue(page.slider.maximum())
        assert page.t == 1.0
        assert page.picture.scene.inverted.all()
        page.slider.setValue(0)
        assert not page.picture.scene.inverted.any()
    finally:
        inspector.subject.dimension = 2


def test_a_window_that_was_left_open_comes_back_so(make_window: WindowMaker, qtbot: QtBot) -> None:
    first = make_window()
    qtbot.waitUntil(lambda: first.document.positions is not None)
    first.inspector.toggle.trigger()
    qtbot.wait(100)
    first.close()
    second = make_window()
    assert second.inspector.toggle.isChecked() and second.inspector.isVisible()
    qtbot.waitUntil(lambda: second.inspector.subject.distortion is not None)
    second.inspector.toggle.trigger()
    qtbot.wait(100)
    assert not any(second.tabifiedDockWidgets(dock) for dock in second.maps)


def test_both_themes_have_every_page(make_window: WindowMaker, qtbot: QtBot) -> None:
    window = make_window(theme="dark")
    qtbot.waitUntil(lambda: window.document.positions is not None and window.inspector.subject.registry is not None)
    window.inspector.toggle.trigger()
    for theme in ("dark", "light"):
        window.commands.choose_theme(theme)
        for page in range(window.inspector.body.tabs.count()):
            window.inspector.body.tabs.setCurrentIndex(page)
            qtbot.wait(60)
            assert (window.inspector.grab().toImage().pixelColor(3, 60).lightness() < 80) == (theme == "dark")
