"""Choosing a distortion: one of the list, or a formula that is checked while it is typed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtWidgets import QComboBox, QLabel, QVBoxLayout, QWidget

from workbench.app.document.resolved import resolved
from workbench.app.panels.formula_edit import FormulaEdit
from workbench.app.panels.formula_tools import FormulaTools
from workbench.app.panels.parameter_sliders import ParameterSliders
from workbench.app.panels.value_pacer import ValuePacer
from workbench.core.distortion import Distortion, looks_like_id
from workbench.core.errors import FormulaError, WorkbenchError
from workbench.core.formula import FUNCTIONS
from workbench.core.formula_names import (
    VARIABLES,
    UndeclaredName,
    suggested_parameter,
    undeclared_names,
)
from workbench.core.method import Parameter
from workbench.core.registry import registry

PAUSE = 120
"""Milliseconds of rest after a key before a formula is checked."""
TYPED = "Typed formula"


class DistortionBox(QWidget):
    """List of distortions, the formula in an editor, its source, a slider for each parameter.

    `chosen` carries the id or the formula, and the values that it needs.
    """

    chosen = Signal(str, dict)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._known: dict[str, Distortion] = {}
        self._kind = ""
        self._current = ""
        self._values: dict[str, Any] = {}
        self._shown = ""
        self._last_seen: dict[str, Parameter] = {}
        self._shown_choice: tuple[Any, ...] = ()
        self._accepted = ""
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(PAUSE)
        self._rest.timeout.connect(self.check)
        self.pacer = ValuePacer(self._send_values, self)
        self.combo = QComboBox(self)
        self.combo.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.combo.setMinimumContentsLength(12)
        self.combo.setMaxVisibleItems(30)
        self.combo.activated.connect(self._activated)
        self.tools = FormulaTools(self)
        self.tools.text_wanted.connect(self.type_text)
        self.tools.formulas_changed.connect(self._formulas_changed)
        self.tools.failed.connect(self._say_error)
        self.edit = FormulaEdit(self)
        self.edit.setPlaceholderText("sum(sigma^2 + 1/sigma^2)")
        self.edit.edited.connect(self._edited)
        self.edit.accepted.connect(self.accept_text)
        self.edit.given_up.connect(self.give_up)
        self.error, self.hint, self.source = (self._label(name) for name in ("form-error", "citation", "citation"))
        self.form = ParameterSliders(self)
        self.form.moved.connect(lambda values, rests: self.pacer.offer(values, rests))
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(4)
        for widget in (self.combo, self.tools, self.edit, self.error, self.hint, self.source, self.form):
            layout.addWidget(widget)

    def _label(self, name: str) -> QLabel:
        label = QLabel(self)
        label.setObjectName(name)
        label.setWordWrap(True)
        label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        label.hide()
        return label

    # ------------------------------------------------------------------------------------------ showing

    def show_choices(self, distortions: Mapping[str, Distortion], kind: str) -> None:
        """Fill the list with what serves a kind of map, the user's own formulas in a group at the end."""
        self._known, self._kind, self._shown_choice = dict(distortions), kind, ()
        own = registry().own_formulas
        fitting = [item for item in self._known.values() if not kind or kind in item.kinds]
        self.combo.blockSignals(True)
        self.combo.clear()
        self.combo.addItem(TYPED, "")
        self.combo.setItemData(0, "A formula of your own, in the editor below", Qt.ItemDataRole.ToolTipRole)
        self.combo.insertSeparator(1)
        self._add_items([item for item in fitting if item.id not in own])
        if own:
            self._add_heading("Own formulas")
            self._add_items([item for item in fitting if item.id in own])
        self.combo.blockSignals(False)
        words = dict.fromkeys(VARIABLES, "") | {f"{name}(": "" for name in FUNCTIONS}
        self.edit.set_words(words | {id.replace("-", "_"): title_of(item) for id, item in self._known.items()})
        self.edit.colours.set_distortions(id.replace("-", "_") for id in self._known)
        self.show_choice(self._current, self._values)

    def _add_items(self, items: list[Distortion]) -> None:
        for item in sorted(items, key=lambda item: item.label.lower()):
            self.combo.addItem(title_of(item), item.id)
            tip = "\n".join(text for text in (item.formula, item.description) if text)
            self.combo.setItemData(self.combo.count() - 1, tip, Qt.ItemDataRole.ToolTipRole)

    def _add_heading(self, text: str) -> None:
        self.combo.insertSeparator(self.combo.count())
        self.combo.addItem(text)
        item = self.combo.model().item(self.combo.count() - 1)  # type: ignore[attr-defined]
        item.setFlags(Qt.ItemFlag.NoItemFlags)

    def show_choice(self, text: str, values: Mapping[str, Any]) -> None:
        """Show what is in force, without telling anyone."""
        if text == self._current and (self.form.is_held or self.pacer.is_waiting):
            return  # what the hand is at is newer
        is_other = text != self._current
        is_typing = self.is_changed and not is_other
        self._current, self._values = text, dict(values)
        if is_other:
            self.pacer.forget()
        choice = (text, self._values, self._known)
        if not self._known or (choice == self._shown_choice and self.form.values.items() >= self._values.items()):
            return
        self._shown_choice = ()
        self.combo.setCurrentIndex(max(self.combo.findData(text), 0))
        try:
            item = resolved(text, values)
        except WorkbenchError as error:
            self._say_error(error.sentence)
            return
        self._shown = item.formula
        if not is_typing:
            self.edit.set_text(item.formula)
            self._say()
        self.source.setText(item.citation)
        self.source.setVisible(bool(item.citation))
        free = {} if text in self._known else {name.name: name for name in undeclared_names(text)}
        parameters = [self._last_seen.get(p.name) or suggested_parameter(p.name) if p.name in free else p
                      for p in item.parameters]  # fmt: skip
        self.form.show_parameters(parameters, item.parameter_values, free)
        self._last_seen |= {p.name: p for p in parameters}
        self._shown_choice = choice
        self.tools.show_in_force(item, self.form.values, self.form.ranges)

    def _say(self, error: str = "", hint: str = "") -> None:
        for label, text in ((self.error, error), (self.hint, hint)):
            label.setText(text)
            label.setVisible(bool(text))

    def _say_error(self, sentence: str) -> None:
        self._say(error=sentence)

    # ------------------------------------------------------------------------------------------ choosing

    def _activated(self, row: int) -> None:
        id = self.combo.itemData(row)
        if id and id != self._current:
            self.chosen.emit(id, {})
        elif not id:
            self.combo.setCurrentIndex(max(self.combo.findData(self._current), 0))
            self.edit.setFocus()
            self.edit.selectAll()

    def _formulas_changed(self, id: str) -> None:
        """Own formulas were saved, renamed or deleted."""
        text = self._shown if self._current not in registry().distortions and self._current in self._known else self._current
        values = dict(self.form.values) if text != self._current else self._values
        self.show_choices(registry().distortions, self._kind)
        if id:
            self.chosen.emit(id, {})
        elif text != self._current:
            self.chosen.emit(text, values)

    # ------------------------------------------------------------------------------------------ typing

    @property
    def is_changed(self) -> bool:
        """Whether the editor holds something else than what is in force."""
        return self.edit.text.strip() != self._shown.strip()

    def type_text(self, text: str) -> None:
        """Put a formula into the editor as if it were typed; Enter takes it."""
        self.edit.setPlainText(text)
        self.edit.moveCursor(self.edit.textCursor().MoveOperation.End)
        self.edit.setFocus()
        self.check()

    def give_up(self) -> None:
        """Esc: the formula in force stands there again."""
        self._rest.stop()
        self.edit.set_text(self._shown)
        self._say()

    def _edited(self) -> None:
        self._rest.start()

    def check(self) -> None:
        """While typing: say what is wrong and where, or what Enter would do."""
        self._rest.stop()
        text = self.edit.text.strip()
        if not text or not self.is_changed:
            self.edit.mark(None)
            self._say()
            return
        found = self._read(text)
        if found is None:
            return
        item, new = found
        begun = self.edit.begun if self.edit.completions.isVisible() else ""  # perhaps not all of a name yet
        names = ", ".join(name.name for name in new if name.name not in (*self.form.rows, begun))
        barrier = self._known.get(self._current)
        lost = barrier is not None and any(barrier.has_barrier(n) and not item.has_barrier(n) for n in item.dimensions)
        self.edit.mark(None)
        self._say(
            hint="Enter applies it, Esc brings back the one before."
            + (f" New parameters: {names}." if names else "")
            + (" It has no barrier against inversions." if lost else "")
        )

    def _read(self, text: str) -> tuple[Distortion, tuple[UndeclaredName, ...]] | None:
        """The typed formula with a value for each parameter; None where it is refused, which is said."""
        try:
            if text in self._known or looks_like_id(text):
                return resolved(text), ()
            new = undeclared_names(text)
            for name in new:
                if not name.may_be_parameter:
                    raise FormulaError(name.sentence, position=name.position)
            return resolved(text, self._values_for(text, new)), new
        except WorkbenchError as error:
            lead = len(self.edit.text) - len(self.edit.text.lstrip())
            self.edit.mark(lead + error.position if isinstance(error, FormulaError) else None)
            self._say_error(error.sentence)
            return None

    def _values_for(self, text: str, new: tuple[UndeclaredName, ...]) -> dict[str, float]:
        """What the sliders say where there are such, else what is usual."""
        now = self.form.values
        values = {}
        for name in new:
            seen = self._last_seen.get(name.name) or suggested_parameter(name.name)
            values[name.name] = now.get(name.name, float(seen.default))
        return values

    def accept_text(self) -> None:
        """Enter: take the typed formula, where it is one."""
        text = self.edit.text.strip()
        self.check()
        if not text or not self.is_changed:
            return
        found = self._read(text)
        if found is None:
            return
        item, new = found
        if item.id in self._known:
            self.chosen.emit(item.id, {})
            return
        self.tools.remember(text)
        values = {name.name: item.parameter_values[name.name] for name in new}
        self._accepted = text
        self._shown = text  # from now on it is no longer an edit of the one before
        self.chosen.emit(text, values)

    def show_refusal(self, sentence: str) -> None:
        """The engine refused what was chosen last: a typed formula stays in the editor, to be mended."""
        if self._accepted and self._accepted != self._current:
            self.edit.set_text(self._accepted)
        self._accepted = ""
        self._say_error(sentence)

    def _send_values(self, values: dict[str, Any]) -> None:
        item = self._known.get(self._current)
        if item is not None:
            values = {p.name: values[p.name] for p in item.parameters if values[p.name] != p.default}
        try:
            in_force = resolved(self._current, values)
        except WorkbenchError as error:  # 1/(1 - lam) at lam = 1, say
            self._say_error(f"Not at these values: {error.sentence}")
            return
        self._say()
        self.tools.show_in_force(in_force, self.form.values, self.form.ranges)
        self.chosen.emit(self._current, values)


def title_of(item: Distortion) -> str:
    """Long name and short name, where it has one."""
    return f"{item.label} ({item.short})" if item.short and item.short not in item.label else item.label
