"""Preferences: changes are seen at once, Cancel takes them back, and no settings file keeps the window from starting."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QCheckBox, QComboBox, QDialogButtonBox, QToolBar, QWidget
from pytestqt.qtbot import QtBot

from tests.app.conftest import WindowMaker, pixel_of, pixels_of
from workbench.app.main_window import MainWindow
from workbench.app.preferences.catalogue import BY_NAME, PAGES, PREFERENCES, Preference
from workbench.app.preferences.environment import VARIABLES, set_environment
from workbench.app.preferences.preferences import Preferences
from workbench.app.preferences.preferences_dialog import PreferencesDialog
from workbench.app.settings import KEPT, Settings
from workbench.core.errors import WorkbenchError
from workbench.core.threads import COUNT

Buttons = QDialogButtonBox.StandardButton


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    return Settings(tmp_path / "window.ini")


@pytest.fixture
def dialog(window: MainWindow) -> Iterator[PreferencesDialog]:
    QTest.keyClick(window, Qt.Key.Key_Comma, Qt.KeyboardModifier.ControlModifier)
    dialog = window.preferring.dialog
    assert dialog is not None and dialog.isVisible()
    yield dialog
    if window.preferring.dialog is not None:
        window.preferring.dialog.reject()


def change(widget: QWidget) -> None:
    """Another value, by the keyboard or the mouse."""
    widget.setFocus()
    if isinstance(widget, QCheckBox):
        QTest.mouseClick(widget, Qt.MouseButton.LeftButton, pos=_box(widget))
    elif isinstance(widget, QComboBox):
        QTest.keyClick(widget, Qt.Key.Key_Down if widget.currentIndex() < widget.count() - 1 else Qt.Key.Key_Up)
    else:
        QTest.keyClick(widget, Qt.Key.Key_Up)


def _box(widget: QCheckBox) -> Any:
    return widget.style().subElementRect(widget.style().SubElement.SE_CheckBoxIndicator, _option(widget), widget).center()


def _option(widget: QCheckBox) -> Any:
    from PySide6.QtWidgets import QStyleOptionButton

    option = QStyleOptionButton()
    widget.initStyleOption(option)
    return option


def other_value(preference: Preference) -> Any:
    if preference.parameter.type is bool:
        return not preference.default
    if preference.parameter.type is str:
        return preference.parameter.choices[-1] if preference.parameter.choices else "something-else"
    return preference.parameter.type(preference.parameter.maximum)


# ---------------------------------------------------------------------------------------------- laws


@pytest.mark.parametrize("preference", PREFERENCES, ids=lambda preference: preference.name)
def test_every_preference_is_complete_and_refuses_what_does_not_fit(preference: Preference) -> None:
    assert preference.page in PAGES and preference.label and preference.parameter.description
    assert preference.check(preference.default) == preference.default
    if preference.words:
        assert all(preference.words.values())
    for wrong in (None, [], {}, 1e300, "no such value", -1, float("nan"), float("inf")):
        if preference.is_listed_late and isinstance(wrong, str):
            continue
        with pytest.raises(WorkbenchError):
            preference.check(wrong)


def test_what_is_kept_is_there_at_the_next_start_and_defaults_are_not_written(settings: Settings) -> None:
    preferences = Preferences(settings)
    wanted = {name: other_value(preference) for name, preference in BY_NAME.items()}
    preferences.set_all(wanted)
    assert Preferences(settings).values != wanted, "not before it is kept"
    preferences.keep()
    again = Preferences(settings)
    assert again.values == wanted
    again.restore_defaults(BY_NAME)
    again.keep()
    assert settings.preferences() == {}


def test_a_reset_leaves_only_what_can_be_opened_again(settings: Settings, tmp_path: Path) -> None:
    mesh = tmp_path / "mesh.obj"
    mesh.touch()
    settings.remember_file(str(mesh))
    settings.remember_formula("sum(sigma)")
    settings.theme = "dark"
    settings.save_preferences({"font_size": 14})
    settings.save_views({"views": {}})
    settings.reset()
    assert settings.recent_files == [str(mesh)] and settings.recent_formulas == ["sum(sigma)"]
    assert set(settings._store.allKeys()) <= set(KEPT)
    assert Preferences(settings).values == {name: preference.default for name, preference in BY_NAME.items()}


def test_processes_are_told_by_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    for variable in VARIABLES.values():
        monkeypatch.delenv(variable, raising=False)
    assert not set_environment({"threads": 0})
    assert set_environment({"threads": 3, "linear_solver": "superlu"})
    assert os.environ[COUNT] == "3"
    assert not set_environment({"threads": 3, "linear_solver": "superlu"})
    assert set_environment({})
    assert not set(VARIABLES.values()) & set(os.environ)


# ---------------------------------------------------------------------------------------------- hostile files

HOSTILE = {
    "no ini": b"\x00\xff\xfe\x89PNG\r\n" * 50,
    "empty": b"",
    "wrong types": (
        b"[General]\nrecent=7\nsessions=@Variant(\\0\\0\\0\\x7f\\0\\0\\0\\xePyQt_PyObject\\0\\0)\nformulas=@Point(1 2)\n"
        b"folder=@Rect(0 0 1 1)\ntheme=@ByteArray(\\0)\ngeometry=12\nstate=@ByteArray(nonsense)\nviews=[1]\npreferences=7\n"
        b"layouts=[]\ncommands=@Size(3 4)\n"
    ),
    "nested": b"[General]\npreferences=" + b"[" * 200_000 + b"\nviews=" + b'"{' * 5_000 + b"\n",
    "numbers": (
        b'[General]\npreferences="{\\"font_size\\": 1e400, \\"anchor_size\\": -5, \\"threads\\": 99999999999999999999, '
        b'\\"theme\\": {}, \\"distortion\\": 5, \\"linear_solver\\": \\"../x\\", \\"tool_tips\\": \\"no\\"}"\n'
    ),
    "geometry": (
        b"[General]\ngeometry=@ByteArray(\\x1\\xd9\\xd0\\xcb\\0\\x3\\0\\0\\xff\\xff)\n"
        b"state=@ByteArray(\\0\\0\\0\\xff\\0\\0\\0\\0)\n"
    ),
    "paths": b"[General]\nrecent=/dev/null/x, " + b"a" * 5000 + b", \\0, ~root\nsessions=//\n",
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_settings_file_of_any_kind_is_read(name: str, tmp_path: Path) -> None:
    path = tmp_path / "window.ini"
    path.write_bytes(HOSTILE[name])
    settings = Settings(path)
    for value in (settings.recent_files, settings.recent_sessions, settings.recent_formulas, settings.recent_commands):
        assert isinstance(value, list) and all(isinstance(text, str) for text in value)
    assert isinstance(settings.folder, str) and isinstance(settings.views(), dict)
    preferences = Preferences(settings)
    for key, preference in BY_NAME.items():
        assert preference.check(preferences[key]) == preferences[key]
    preferences.keep()


def test_the_window_starts_on_what_is_worst_of_all_with_what_is_still_there(
    tmp_path: Path, make_window: WindowMaker, qtbot: QtBot
) -> None:
    path = tmp_path / "window.ini"
    wrong = b"\n".join(
        line for line in HOSTILE["wrong types"].split(b"\n")[1:] if not line.startswith((b"geom", b"state", b"pref"))
    )
    path.write_bytes(HOSTILE["geometry"] + wrong)
    Settings(path).save_preferences({"distortion": "gone", "solver": "aqp", "font_size": "huge"})
    window = make_window()
    qtbot.waitUntil(lambda: window.document.positions is not None)
    assert (window.document.session.distortion, window.document.session.solver) == ("symmetric-dirichlet", "aqp")
    assert window.isVisible() and window.panel_dock.isVisible()
    assert window.width() >= 400


# ---------------------------------------------------------------------------------------------- the dialog


def test_escape_takes_everything_back(window: MainWindow, dialog: PreferencesDialog) -> None:
    preferences = window.preferring.preferences
    before = preferences.values
    sheet, font = window.styleSheet(), window.font()
    changed = set()
    for page in PAGES:
        dialog.show_page(page)
        for name, field in dialog.fields.items():
            if BY_NAME[name].page == page and (not isinstance(field.widget, QComboBox) or field.widget.count() > 1):
                change(field.widget)
                assert preferences[name] != before[name], f"{name} is in force at once"
                changed.add(name)
    assert len(changed) >= len(PREFERENCES) - 1
    QTest.keyClick(dialog, Qt.Key.Key_Escape)
    assert window.preferring.dialog is None
    assert preferences.values == before == Preferences(window.settings).values
    assert (window.styleSheet(), window.font()) == (sheet, font)


def test_ok_keeps_and_defaults_are_those_of_a_page(window: MainWindow, dialog: PreferencesDialog) -> None:
    preferences = window.preferring.preferences
    before = preferences.values
    dialog.show_page("Views and colours")
    change(dialog.fields["anchor_size"].widget)
    dialog.show_page("Saving and undo")
    change(dialog.fields["undo_megabytes"].widget)
    buttons = dialog.findChild(QDialogButtonBox)
    QTest.mouseClick(buttons.button(Buttons.RestoreDefaults), Qt.MouseButton.LeftButton)
    assert preferences["undo_megabytes"] == 256 and preferences["anchor_size"] == 7.0
    assert dialog.fields["undo_megabytes"].widget.value() == 256  # type: ignore[attr-defined]
    QTest.mouseClick(buttons.button(Buttons.Ok), Qt.MouseButton.LeftButton)
    assert Preferences(window.settings)["anchor_size"] == 7.0
    preferences.set_all(before)
    preferences.keep()


def test_views_and_letters_follow(window: MainWindow, dialog: PreferencesDialog, qtbot: QtBot) -> None:
    preferences, view = window.preferring.preferences, window.target.view
    window.document.add_anchor(0)
    qtbot.waitUntil(lambda: len(view.overlay.scene.anchor_vertices) == 1)

    def orange() -> int:
        return int((abs(pixels_of(view) - (255, 140, 26)).max(axis=2) < 12).sum())

    QTest.qWait(50)
    small, place = orange(), pixel_of(view, 0)
    assert small
    preferences.set("anchor_size", 13.0)
    QTest.qWait(50)
    assert orange() > 2.5 * small and pixel_of(view, 0) == place
    height = window.panel.kind.fontMetrics().height()
    preferences.set("font_size", 16)
    assert window.panel.kind.fontMetrics().height() > 1.3 * height
    preferences.set("tool_bar", "pictures")
    bar = window.findChild(QToolBar, "tools")
    assert bar.toolButtonStyle() == Qt.ToolButtonStyle.ToolButtonIconOnly
    legend = window.maps[0].legend
    before = legend.grab().toImage()
    preferences.set("colour_map", "CET_L12")
    QTest.qWait(50)
    assert legend.grab().toImage() != before
    dialog.reject()
    assert window.panel.kind.fontMetrics().height() == height
    window.document.clear_anchors()


def test_memory_and_autosave_reach_what_they_are_for(window: MainWindow, dialog: PreferencesDialog) -> None:
    preferences = window.preferring.preferences
    preferences.set("undo_megabytes", 32)
    preferences.set("autosave_seconds", 9)
    preferences.set("panel_rest", 7.5)
    assert window.undoing.history._limit == 32 * 2**20
    assert window.autosave._timer.interval() == 9000
    assert window.turns.rest_factor == 7.5
    preferences.set("autosave", False)
    assert not window.autosave._timer.isActive()
    dialog.reject()
    assert window.autosave._timer.interval() == 4000 and window.undoing.history._limit == 2**28


def test_the_theme_is_one_choice_wherever_it_is_made(window: MainWindow) -> None:
    window.commands.choose_theme("dark")
    assert Preferences(window.settings)["theme"] == "dark"
    assert window.theme.name == "dark"
    window.preferring.ask()
    assert window.preferring.dialog is not None
    field = window.preferring.dialog.fields["theme"].widget
    assert isinstance(field, QComboBox) and field.currentData() == "dark"
    window.preferring.dialog.reject()
    window.commands.choose_theme("light")
