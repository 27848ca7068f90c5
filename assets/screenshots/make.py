"""The pictures of the README: the window on its first sample in a lively pose, a race, the inspector on a formula, solids.

xvfb-run -s "-screen 0 1600x1000x24" python assets/screenshots/make.py [light|dark]
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from workbench.app.main import make_application

application = make_application()

import numpy as np  # noqa: E402
from PIL import Image  # noqa: E402
from PySide6.QtWidgets import QWidget  # noqa: E402

from workbench.app.appearance.theme import ThemeSwitch  # noqa: E402
from workbench.app.document.anchor_set import AnchorSet  # noqa: E402
from workbench.app.main_window import MainWindow  # noqa: E402
from workbench.app.race.set_up_dialog import RaceChoice  # noqa: E402
from workbench.app.settings import Settings  # noqa: E402
from workbench.core.samples import make_sample  # noqa: E402
from workbench.engine.race_messages import Entrant  # noqa: E402

SIZE = (1500, 920)
STEPS = 40
BEND = 1.9
"""Angle by which the ends of the bar that carries a figure are bent towards each other."""
RACERS = {"projected-newton": "Projected Newton", "aqp": "AQP", "slim": "SLIM", "l-bfgs": "L-BFGS"}
MOMENT = 6
"""Iteration at which the race is shown."""
FORMULA = "lam*symmetric_dirichlet + (1 - lam)*condition_number"
TURN = np.pi
"""Angle between the ends of the solid bar."""
POSE = ((0.06, 0.27), (-0.14, 0.10), (0.09, -0.01), (0.0, 0.0), (0.0, -0.26))
"""Moves of the sample's anchors, sorted from left to right, in diameters: a dancer."""


def main(theme: str = "light") -> None:
    """Open, drag the anchors one by one, wait for the solver, save."""
    here = Path(__file__).parent
    with tempfile.TemporaryDirectory() as folder:
        window = MainWindow(ThemeSwitch(application, theme), Settings(Path(folder) / "settings.ini"))
        window.resize(*SIZE)
        window.show()
        window.start()
        document = window.document
        until(lambda: len(document.anchors) > 0 and not document.is_at_work)
        window.set_target_style("symmetric-dirichlet")
        window.source.view.surface.set_edges(False)  # a smaller file
        diameter = document.mesh.diameter
        places = document.positions[document.anchors.vertices]
        for row, move in zip(places[:, 0].argsort(), POSE, strict=True):
            vertex = int(document.anchors.vertices[row])
            for step in range(1, STEPS + 1):
                share = step / STEPS
                target = places[row] + [diameter * share * move[0], diameter * share * move[1]]
                document.move_anchor(vertex, target, step < STEPS)
                rest(16)
            until(lambda: not document.is_at_work)
        window.commands.fit()
        window.turns.draw_all()
        rest(700)
        save(window, window, here / "window.png")
        show_tools(window, here / "tools.png")
        show_race(window, here / "race.png")
        show_inspector(window, here / "inspector.png")
        show_solid(window, Path(folder) / "bar.npz", here / "volume.png")
        show_carried(window, here / "carried.png")
        window.close()
    for name in ("window", "tools", "race", "inspector", "volume", "carried"):
        smaller(here / f"{name}.png")


def show_tools(window: MainWindow, path: Path) -> None:
    """What becomes of equal circles, the table of anchors, and the time line at an earlier moment."""
    actions, style = window.actions_by_name, window.colouring.style_of(window.target)
    panels = [dock for dock in window.docks if dock.windowTitle() in ("Anchors", "Time line")]
    window.set_target_style("plain")
    window.set_source_style("plain")
    actions["glyphs-ellipses"].trigger()
    for _ in range(3):
        actions["glyphs-fewer"].trigger()
    actions["scale-bar"].trigger()
    for panel in panels:
        panel.show()
        panel.raise_()
    document = window.document
    document.select(int(document.anchors.vertices[0]))
    rest(500)
    window.commands.fit()
    window.time_line.looking.show(round(0.8 * len(window.time_line.recorder.record)))
    window.turns.draw_all()
    rest(1500)
    save(window, window, path)
    window.time_line.looking.go_live()
    actions["glyphs-none"].trigger()
    actions["scale-bar"].trigger()
    window.set_source_style("checkerboard")
    for panel in panels:
        panel.hide()
    window.set_target_style(style)


def show_race(window: MainWindow, path: Path) -> None:
    """Four solvers on their way from the start to the pose, all as they were at an early moment."""
    racing = window.commands.racing
    racing.begin(RaceChoice(tuple(Entrant(label, id) for id, label in RACERS.items()), "", False, 1000, 1e-6))
    race = racing.race
    race.resize(1360, 820)
    until(lambda: race.model.is_ready and all(record.frame is not None for record in race.model.records))
    race.actions_by_name["run"].trigger()
    until(lambda: race.model.is_over)
    race.model.seek_to("iteration", MOMENT)
    until(lambda: all(record.frame.iteration <= MOMENT for record in race.model.records))
    rest(1500)
    save(window, race, path)
    race.close()


def show_inspector(window: MainWindow, path: Path) -> None:
    """Three pages of the inspector side by side, on a formula of one's own and the map that is minimal for it."""
    document = window.document
    document.choose(distortion=FORMULA, distortion_parameters={"lam": 0.2})
    inspector = window.inspector
    inspector.toggle.trigger()
    inspector.setFloating(True)
    inspector.resize(430, 610)
    until(lambda: not document.is_at_work)
    pages = []
    with tempfile.TemporaryDirectory() as folder:
        for number in range(3):
            inspector.body.tabs.setCurrentIndex(number)
            rest(4000)
            until(
                lambda: (
                    "Looking" not in inspector.body.formula.badges.detail.text()
                    and inspector.body.formula.picture.drawing is not None
                )
            )
            file = Path(folder) / f"{number}.png"
            inspector.grab().save(str(file))
            pages.append(Image.open(file).convert("RGB"))
    sheet = Image.new("RGB", (sum(page.width for page in pages), pages[0].height))
    for number, page in enumerate(pages):
        sheet.paste(page, (number * page.width, 0))
    sheet.save(path)


def show_solid(window: MainWindow, case: Path, path: Path) -> None:
    """A solid bar whose ends are turned against each other, cut open."""
    document = window.document
    bar = make_sample("bar-3d", 20_000)
    along, middle = bar.vertices[:, 0], bar.vertices.mean(axis=0)
    ends = np.flatnonzero((along == along.min()) | (along == along.max()))
    np.savez(case, V=bar.vertices, S=bar.simplices, X0=bar.vertices, anchors=ends, targets=bar.vertices[ends])
    window.inspector.toggle.trigger()
    document.choose(distortion="symmetric-dirichlet", distortion_parameters={})
    window.open(str(case))
    until(lambda: document.kind == "volume" and len(document.anchors) > 0 and not document.is_at_work)
    document.run()
    sides = np.where(along[ends] > middle[0], 0.5, -0.5)
    for step in range(1, STEPS + 1):
        angle = TURN * step / STEPS * sides
        up, left = (bar.vertices[ends] - middle)[:, 1:].T
        turned = np.c_[up * np.cos(angle) - left * np.sin(angle), up * np.sin(angle) + left * np.cos(angle)] + middle[1:]
        document.set_anchors(AnchorSet.to(ends, np.c_[along[ends], turned]))
        until(lambda: document.snapshot.anchor_serial == document.anchor_serial and document.snapshot.phase == "finished")
    window.set_target_style("symmetric-dirichlet")
    window.look.cut_along("x")
    window.volume.choose(is_exact=True, place=0.62)
    window.commands.fit()
    window.turns.draw_all()
    rest(1000)
    save(window, window, path)


def show_carried(window: MainWindow, path: Path) -> None:
    """A bent bar and the salamander in it, as in Fig. 8: source and target alone."""
    document = window.document
    window.open("sample:bar-3d")
    until(lambda: window.document.session.source == "sample:bar-3d" and document.positions is not None)
    bar = document.mesh
    along, middle = bar.vertices[:, 0], bar.vertices.mean(axis=0)
    ends = np.flatnonzero((along == along.min()) | (along == along.max()))
    side = np.where(along[ends] > middle[0], 0.5, -0.5)
    angle = BEND * side
    up = bar.vertices[ends, 2] - middle[2]
    radius = np.ptp(along) / BEND  # the middle line keeps its length
    arm = radius - up
    bent = np.c_[arm * np.sin(angle), bar.vertices[ends, 1], radius - arm * np.cos(angle)]
    document.set_anchors(AnchorSet.to(ends, bent + [middle[0], 0.0, middle[2]]))
    document.run()
    window.carried.read("sample:salamander")
    until(lambda: window.carried.surface is not None)
    until(lambda: document.snapshot.anchor_serial == document.anchor_serial and document.snapshot.phase == "finished")
    window.set_source_style("plain")
    window.set_target_style("plain")
    window.commands.fit()
    window.turns.draw_all()
    rest(1000)
    window.grab(window.centralWidget().geometry()).save(str(path))


def save(window: MainWindow, widget: QWidget, path: Path) -> None:
    """Write a picture, and let nothing in the window speak of where to."""
    path.unlink(missing_ok=True)
    sentence = window.status.sentence.text()
    window.commands.save_screenshot(widget, str(path))
    until(path.exists)
    rest(300)
    window.status.say(sentence)


def smaller(path: Path) -> None:
    """The same picture in fewer bytes."""
    with Image.open(path) as picture:
        reduced = picture.convert("RGB")
    reduced.save(path, optimize=True)


def rest(milliseconds: float) -> None:
    """Let the window live; threads get the interpreter in between."""
    end = time.monotonic() + milliseconds / 1000
    while time.monotonic() < end:
        application.processEvents()
        time.sleep(0.002)


def until(holds: Callable[[], bool], seconds: float = 60.0) -> None:
    end = time.monotonic() + seconds
    while not holds():
        if time.monotonic() > end:
            raise TimeoutError("the engine did not answer")
        rest(20)


if __name__ == "__main__":
    main(*sys.argv[1:])
