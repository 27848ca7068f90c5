"""The buttons above the formula: recent ones, own ones, help."""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QMenu, QMessageBox, QToolButton, QWidget

from workbench.app.panels.formula_help import FormulaHelp
from workbench.app.panels.parameter_range import ParameterRange
from workbench.app.panels.save_formula import NameDialog
from workbench.app.settings import Settings
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.method import Parameter
from workbench.core.named_formulas import NamedFormula
from workbench.core.registry import registry
from workbench.io.formula_store import delete_formula, rename_formula, save_formula


class FormulaTools(QWidget):
    """Knows what is in force by `show_in_force`; `text_wanted` carries a formula for the editor."""

    text_wanted = Signal(str)
    formulas_changed = Signal(str)
    """The named formulas are others now; the id to choose, or empty."""
    failed = Signal(str)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._settings: Settings | None = None
        self._recent: list[str] = []
        self._item: Distortion | None = None
        self._values: dict[str, float] = {}
        self._ranges: dict[str, ParameterRange] = {}
        self._last_own: NamedFormula | None = None  # a formula that is typed after it may be meant to replace it
        self.dialog: NameDialog | None = None
        self.help: FormulaHelp | None = None
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(2)
        layout.addWidget(QLabel("Formula", self), 1)
        self.recent_button = self._menu_button("Recent", "Formulas that were typed before")
        self.own_button = self._menu_button("Own", "Keep this formula under a name of its own; rename it, delete it")
        self.help_button = QToolButton(self)
        self.help_button.setText("?")
        self.help_button.setToolTip("What a formula may hold, with examples")
        self.help_button.clicked.connect(self.show_help)
        for button in (self.recent_button, self.own_button, self.help_button):
            button.setAutoRaise(True)
            layout.addWidget(button)
        self.recent_menu, self.own_menu = QMenu(self), QMenu(self)
        self.recent_button.setMenu(self.recent_menu)
        self.own_button.setMenu(self.own_menu)
        self.recent_menu.aboutToShow.connect(self.fill_recent)
        self.save_action = self.own_menu.addAction("Save as…", self.ask_save)
        self.rename_action = self.own_menu.addAction("Rename…", self.ask_rename)
        self.delete_action = self.own_menu.addAction("Delete…", self.ask_delete)

    def _menu_button(self, text: str, tip: str) -> QToolButton:
        button = QToolButton(self)
        button.setText(text)
        button.setToolTip(tip)
        button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        return button

    def use_settings(self, settings: Settings) -> None:
        """Where typed formulas are remembered from one use to the next."""
        self._settings = settings

    def show_in_force(self, item: Distortion, values: dict[str, float], ranges: dict[str, ParameterRange]) -> None:
        self._item, self._values, self._ranges = item, values, ranges
        own = registry().own_formulas.get(item.id)
        if own is not None or item.id in registry().distortions:
            self._last_own = own
        is_own = own is not None
        self.rename_action.setEnabled(is_own)
        self.delete_action.setEnabled(is_own)

    # ------------------------------------------------------------------------------------------ recent

    @property
    def recent(self) -> list[str]:
        return self._settings.recent_formulas if self._settings is not None else self._recent

    def remember(self, formula: str) -> None:
        """A typed formula was applied."""
        if self._settings is not None:
            self._settings.remember_formula(formula)
        else:
            self._recent = [formula, *(other for other in self._recent if other != formula)]

    def fill_recent(self) -> None:
        self.recent_menu.clear()
        for formula in self.recent:
            action = self.recent_menu.addAction(formula if len(formula) <= 60 else f"{formula[:57]}…")
            action.triggered.connect(lambda _=False, text=formula: self.text_wanted.emit(text))
        if not self.recent:
            self.recent_menu.addAction("None yet: type one and press Enter").setEnabled(False)

    # ------------------------------------------------------------------------------------------ own

    def ask_save(self) -> None:
        """Keep the formula in force with its parameters as they are now."""
        item = self._item
        if item is None:
            return
        parameters = tuple(self._as_saved(parameter) for parameter in item.parameters)
        own = self._last_own

        def attempt(name: str, note: str, replaces: bool) -> str:
            is_same = own is not None and own.formula == item.formula and own.name == name
            return save_formula(NamedFormula(name, item.formula, parameters, note), replaces=replaces or is_same)

        listed = ", ".join(f"{p.name} = {p.default:g}" for p in parameters)
        remark = f"{item.formula}" + (f"\nwith {listed}; the ranges of the sliders are kept, too." if listed else "")
        name, note_now = (own.name, own.note) if own is not None else ("", "")
        self._ask(NameDialog("Save formula", attempt, self.window(), name=name, note=note_now, remark=remark))

    def _as_saved(self, parameter: Parameter) -> Parameter:
        value = self._values.get(parameter.name, parameter.default)
        range = self._ranges.get(parameter.name) or ParameterRange.of(parameter, value)
        kind = int if range.is_whole else float
        return replace(parameter, type=kind, default=kind(value), minimum=range.low, maximum=range.high)

    def ask_rename(self) -> None:
        item = self._item
        if item is not None:
            self._ask(
                NameDialog("Rename formula", lambda name, *_: rename_formula(item.id, name), self.window(), name=item.label)
            )

    def _ask(self, dialog: NameDialog) -> None:
        self.dialog = dialog
        dialog.done_with.connect(self.formulas_changed)
        dialog.open()

    def ask_delete(self) -> None:
        item = self._item
        if item is None:
            return
        box = QMessageBox(
            QMessageBox.Icon.Question,
            "Delete formula",
            f"Delete the formula {item.label!r}? Its text stays in the editor.",
            QMessageBox.StandardButton.Yes | QMessageBox.StandardButton.No,
            self.window(),
        )
        box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        box.accepted.connect(lambda: self.delete(item.id))
        box.open()

    def delete(self, id: str) -> None:
        """Forget a named formula."""
        try:
            delete_formula(id)
        except WorkbenchError as error:
            self.failed.emit(error.sentence)
        else:
            self.formulas_changed.emit("")

    # ------------------------------------------------------------------------------------------ help

    def show_help(self) -> None:
        if self.help is None:
            self.help = FormulaHelp(self.window())
            self.help.example_wanted.connect(self.text_wanted)
            self.help.destroyed.connect(self._forget_help)
        self.help.show()
        self.help.raise_()

    def _forget_help(self) -> None:
        self.help = None
