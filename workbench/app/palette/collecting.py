"""Everything that the window can do, found where it stands: in menus, lists of choices, views and panels."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QComboBox, QMenu

from workbench.app.palette.entry import Entry
from workbench.app.palette.reasons import EMPTY, reason_of
from workbench.app.preferences.catalogue import PREFERENCES

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow


def entries_of(window: MainWindow) -> list[Entry]:
    """All entries as they are now, each deed once: menus first, then choices, then what views can show."""
    entries: list[Entry] = []
    seen: set[QAction] = set()
    for top in window.menuBar().actions():
        menu = top.menu()
        if isinstance(menu, QMenu):
            entries += _of_menu(window, menu, (plain(top.text()),), seen)
    for action in window.actions():
        entries += _of_action(window, action, (), seen)
    entries += _choices(window)
    entries += _own_formulas(window, seen)
    entries += _shown(window)
    entries += _races(window)
    entries += _preferences(window)
    return entries


def plain(text: str) -> str:
    """Words of a menu without mnemonics and without the keys behind a tab."""
    return text.partition("\t")[0].replace("&&", "\0").replace("&", "").replace("\0", "&").strip()


def keys_of(action: QAction) -> str:
    """The first shortcut as a person writes it."""
    keys = action.shortcuts()
    return keys[0].toString(QKeySequence.SequenceFormat.NativeText) if keys else ""


# ---------------------------------------------------------------------------------------------- menus


def _of_menu(window: MainWindow, menu: QMenu, path: tuple[str, ...], seen: set[QAction]) -> Iterator[Entry]:
    menu.aboutToShow.emit()  # many are filled when they are opened
    for action in menu.actions():
        inner = action.menu()
        if isinstance(inner, QMenu):
            if action.isEnabled():
                yield from _of_menu(window, inner, (*path, plain(action.text())), seen)
        else:
            yield from _of_action(window, action, path, seen)


def _of_action(window: MainWindow, action: QAction, path: tuple[str, ...], seen: set[QAction]) -> Iterator[Entry]:
    if action.isSeparator() or not plain(action.text()) or action in seen or not action.isVisible():
        return
    seen.add(action)
    is_enabled = action.isEnabled()
    if not is_enabled and path and path[-1] in EMPTY:
        return
    tip = action.toolTip()
    yield Entry(
        plain(action.text()),
        path,
        partial(_trigger, action),
        name=action.objectName(),
        keys=keys_of(action),
        tip="" if plain(tip) == plain(action.text()) else tip,
        is_checked=action.isChecked() if action.isCheckable() else None,
        is_enabled=is_enabled,
        reason="" if is_enabled else reason_of(action.objectName(), path),
        also=f"{action.objectName()} {tip}",
    )


def _trigger(action: QAction) -> None:
    with suppress(RuntimeError):  # its menu has been filled anew meanwhile
        action.trigger()


# ---------------------------------------------------------------------------------------------- choices


def _choices(window: MainWindow) -> Iterator[Entry]:
    """The lists of the panel; a choice is that of the list itself."""
    panel = window.panel
    boxes = (
        ("Distortion", panel.distortion.combo),
        ("Solver", panel.solver.combo),
        ("Start", panel.start.combo),
        ("Kind of map", panel.kind),
        ("Boundary", panel.boundary),
        ("Inversions", panel.inversions),
        ("Scale of the start", panel.scale),
    )
    for name, box in boxes:
        yield from _of_box(box, ("Choices", name))


def _of_box(box: QComboBox, path: tuple[str, ...]) -> Iterator[Entry]:
    model = box.model()
    for row in range(box.count()):
        index = model.index(row, box.modelColumn())
        if not box.itemText(row) or not model.flags(index) & Qt.ItemFlag.ItemIsEnabled:
            continue
        yield Entry(
            box.itemText(row),
            path,
            partial(_choose, box, box.itemText(row)),
            tip=str(box.itemData(row, Qt.ItemDataRole.ToolTipRole) or ""),
            is_checked=row == box.currentIndex(),
            lift=1.0,
            also=f"{box.itemData(row)}",
        )


def _choose(box: QComboBox, text: str) -> None:
    row = box.findText(text, Qt.MatchFlag.MatchExactly | Qt.MatchFlag.MatchCaseSensitive)
    if row >= 0:
        box.setCurrentIndex(row)
        box.activated.emit(row)


def _own_formulas(window: MainWindow, seen: set[QAction]) -> Iterator[Entry]:
    tools = window.panel.distortion.tools
    for name, menu in (("Own formulas", tools.own_menu), ("Recent formulas", tools.recent_menu)):
        yield from _of_menu(window, menu, ("Choices", name), seen)


# ---------------------------------------------------------------------------------------------- views


def _shown(window: MainWindow) -> Iterator[Entry]:
    """Each quantity in each view and panel."""
    places: list[tuple[str, Callable[[str], None], str]] = [
        ("Source", window.set_source_style, window.colouring.style_of(window.source)),
        ("Target", window.set_target_style, window.colouring.style_of(window.target)),
    ]
    numbered = len(window.maps) > 1
    for number, dock in enumerate(window.maps, 1):
        places.append((f"Colour map {number}" if numbered else "Colour map", dock.show_quantity, dock.quantity))
    places.append(("Histogram", window.histogram.show_quantity, window.histogram.quantity))
    for place, show, shown in places:
        for quantity in window.quantities.quantities:
            yield Entry(
                quantity.title,
                ("Show", place),
                partial(show, quantity.id),
                tip=quantity.formula,
                is_checked=quantity.id == shown,
                lift=-1.0,
                also=quantity.id,
            )


def _preferences(window: MainWindow) -> Iterator[Entry]:
    """Each line of the dialog, which opens on its page."""
    for preference in PREFERENCES:
        yield Entry(
            f"{preference.label}…",
            ("Preferences", preference.page),
            partial(window.preferring.ask, preference.page),
            tip=preference.parameter.description,
            lift=-8.0,  # what does something at once comes first
            also=preference.name,
        )


def _races(window: MainWindow) -> Iterator[Entry]:
    from workbench.engine.race import PRESETS

    has_mesh = window.document.mesh is not None
    for preset in PRESETS.values():
        yield Entry(
            f"{preset.label}…",
            ("Race", "Comparisons"),
            partial(window.commands.racing.ask_contestants, preset.id),
            is_enabled=has_mesh,
            reason="" if has_mesh else reason_of("race", ()),
        )
