"""Menus and tool bar, filled from the actions."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QAction, QActionGroup
from PySide6.QtWidgets import QMenu, QToolBar, QWidget

from workbench.app.appearance.theme import Theme, ThemeSwitch
from workbench.app.document.first_anchors import SAMPLE
from workbench.app.glyphs.glyph_menu import GlyphMenu
from workbench.app.mnemonics import settle_menus
from workbench.app.status.reporter import source_name
from workbench.core.samples import sample_label

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow


LINE_ACTIONS = ("edges", "wireframe", "seams", "boundary", "scale-bar")
CARRIED_SAMPLE = "salamander"


def fill_menus(window: MainWindow) -> None:
    """File, Edit, Solver, Race, Analyse, View, Help."""
    actions, bar = window.actions_by_name, window.menuBar()
    file_menu = bar.addMenu("&File")
    file_menu.addAction(actions["open"])
    recent = file_menu.addMenu("Open &recent")
    recent.aboutToShow.connect(lambda: fill_recent(window, recent))
    samples = file_menu.addMenu("S&amples")
    samples.aboutToShow.connect(lambda: fill_samples(window, samples))
    file_menu.addSeparator()
    for name in ("open-session", "save-session", "save-session-as"):
        file_menu.addAction(actions[name])
    sessions = file_menu.addMenu("Recent sessio&ns")
    sessions.aboutToShow.connect(lambda: window.sessions.fill_recent(sessions))
    file_menu.addSeparator()
    file_menu.addAction(actions["save"])
    exports = file_menu.addMenu("Ex&port")
    exports.aboutToShow.connect(lambda: window.commands.exporting.fill_menu(exports))
    file_menu.addAction(actions["fill"])
    carried = file_menu.addMenu("Carry a sur&face")
    carried.aboutToShow.connect(lambda: fill_carried(window, carried))
    file_menu.addAction(actions["figure"])
    presets = file_menu.addMenu("Figure as in the survey")
    presets.aboutToShow.connect(lambda: window.commands.presets.fill_menu(presets))
    file_menu.addAction(actions["film"])
    screenshots = file_menu.addMenu("S&creenshot of")
    screenshots.aboutToShow.connect(lambda: fill_screenshots(window, screenshots))
    file_menu.addSeparator()
    file_menu.addAction(actions["quit"])
    edit = bar.addMenu("&Edit")
    for name in ("undo", "redo"):
        edit.addAction(actions[name])
    edit.addSeparator()
    window.handling.fill_menu(edit)
    for name in ("remove", "clear", "import-anchors", "export-anchors"):
        edit.addAction(actions[name])
    edit.addSeparator()
    for name in ("equations", "refine"):
        edit.addAction(actions[name])
    edit.addSeparator()
    edit.addAction(actions["preferences"])
    solver = bar.addMenu("&Solver")
    for name in ("run", "step", "reset", "stop"):
        solver.addAction(actions[name])
    race = bar.addMenu("Ra&ce")
    race.addAction(actions["race"])
    analyse = bar.addMenu("&Analyse")
    for name in ("signatures", "dissect"):
        analyse.addAction(actions[name])
    analyse.addSeparator()
    for name in ("judge", "next-place", "last-place", "worst", "less-bad"):
        analyse.addAction(actions[name])
    view = bar.addMenu("&View")
    view.addAction(actions["palette"])
    for name in ("fit", "lock", "unbrush", "", *LINE_ACTIONS, "", "cut", "uncut"):
        view.addAction(actions[name]) if name else view.addSeparator()
    view.addSeparator()
    for name in ("split-right", "split-below", "close-view", "", "readings", "copy-readings"):
        view.addAction(actions[name]) if name else view.addSeparator()
    views = view.addMenu("V&iews")
    views.aboutToShow.connect(lambda: window.splitting.fill_views(views))
    view.addSeparator()
    window.textures.fill_menu(view.addMenu("Pa&ttern"))
    window.time_line.fill_menu(view.addMenu("&Time line"))
    GlyphMenu(window.glyphs, actions, view.addMenu("&Glyphs"))
    _add_themes(window, view.addMenu("&Appearance"))
    panels = view.addMenu("&Panels")
    for dock in window.docks:
        shown = dock.toggleViewAction()
        shown.triggered.connect(lambda is_shown, d=dock: d.raise_() if is_shown else None)  # not behind others
        panels.addAction(shown)
    layout = view.addMenu("La&yout")
    layout.aboutToShow.connect(lambda: window.layouts.fill_menu(layout))
    help_menu = bar.addMenu("&Help")
    for name in ("help", "shortcuts", "log", "cite", "report", "about"):
        help_menu.addAction(actions[name])
    settle_menus(bar)


def fill_carried(window: MainWindow, menu: QMenu) -> None:
    """Where a surface comes from that the solid carries, and where it goes."""
    menu.clear()
    commands, carried = window.commands, window.carried
    entries: tuple[tuple[str, bool, Callable[[], None]], ...] = (
        ("&From a file…", carried.is_possible, commands.ask_carry),
        (f"&Sample: {sample_label(CARRIED_SAMPLE)}", carried.is_possible, lambda: carried.read(SAMPLE + CARRIED_SAMPLE)),
        ("", False, lambda: None),
        ("Save the &carried surface…", carried.surface is not None, commands.ask_save_carried),
        ("&Let it go", carried.surface is not None, carried.let_go),
    )
    for text, is_possible, deed in entries:
        action = menu.addAction(text) if text else menu.addSeparator()
        action.setEnabled(is_possible)
        action.triggered.connect(lambda _=False, d=deed: d())


def fill_screenshots(window: MainWindow, menu: QMenu) -> None:
    """The window, its views, and the panels by what they show now."""
    menu.clear()
    menu.addAction(window.actions_by_name["shot-window"])
    parts: list[tuple[str, QWidget]] = [("source", window.source.view), ("target", window.target.view)]
    parts += [(f"{pane.title}, split off: {pane.chooser.currentText()}", pane.view) for pane in window.splitting.panes]
    parts += [(dock.windowTitle(), dock) for dock in window.docks[1:]]
    for name, widget in parts:
        action = menu.addAction(f"{name[0].upper()}{name[1:]}…")
        action.triggered.connect(lambda _=False, w=widget, n=name: window.commands.ask_screenshot(w, n))


def _add_themes(window: MainWindow, menu: QMenu) -> None:
    group = ThemeActions(menu, window.theme_switch)
    for choice, text in (("system", "Follow the system"), ("light", "Light"), ("dark", "Dark")):
        action = menu.addAction(text)
        action.setCheckable(True)
        action.setData(choice)
        group.addAction(action)
        action.triggered.connect(lambda _=False, c=choice: window.commands.choose_theme(c))
    group.tick(window.theme)
    window.theme_switch.changed.connect(group.tick)


class ThemeActions(QActionGroup):
    """The choice in force is ticked; the switch outlives the window, and so calls a method of what ends with it."""

    def __init__(self, menu: QMenu, switch: ThemeSwitch) -> None:
        super().__init__(menu)
        self._switch = switch

    def tick(self, _: Theme) -> None:
        for action in self.actions():
            action.setChecked(action.data() == self._switch.choice)


def fill_recent(window: MainWindow, menu: QMenu) -> None:
    """The files of the settings, those that are still there."""
    menu.clear()
    paths = window.settings.recent_files
    for path in paths:
        action = menu.addAction(path)
        action.triggered.connect(lambda _=False, p=path: window.open(p))
    if paths:
        menu.addSeparator()
        menu.addAction("Forget these").triggered.connect(lambda: window.settings.forget_files())
    else:
        menu.addAction("No files yet").setEnabled(False)


def fill_samples(window: MainWindow, menu: QMenu) -> None:
    """Meshes of our own generator."""
    from workbench.core.samples import sample_ids, sample_kind

    menu.clear()
    kind = ""
    for id in sample_ids():
        if kind and kind != sample_kind(id):
            menu.addSeparator()
        kind = sample_kind(id)
        action = menu.addAction(source_name(f"sample:{id}"))
        action.setObjectName(f"sample:{id}")  # found by what the command line calls it, too
        action.triggered.connect(lambda _=False, i=id: window.document.open_sample(i))


def fill_tool_bar(window: MainWindow) -> None:
    """What is wanted often."""
    bar = QToolBar("Tools", window)
    bar.setObjectName("tools")
    bar.setMovable(False)
    bar.setIconSize(QSize(18, 18))
    bar.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
    for name in ("open", "save", "", "run", "step", "reset", "stop", "", "pin", "clear", "mirror", "falloff", "", "fit"):
        bar.addAction(window.actions_by_name[name]) if name else bar.addSeparator()
    bar.addAction(window.inspector.toggle)
    window.addToolBar(bar)
    unlisted: list[QAction] = [a for a in window.actions_by_name.values() if not a.associatedObjects()]
    window.addActions(unlisted)
