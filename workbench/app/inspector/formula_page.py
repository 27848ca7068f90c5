"""The first page: the formula as mathematics, where it comes from, its parameters, its properties."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from PySide6.QtCore import Qt, QTimer
from PySide6.QtWidgets import QFrame, QLabel, QScrollArea, QVBoxLayout, QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.inspector.badges import Badges
from workbench.app.inspector.formula_picture import FormulaPicture
from workbench.app.inspector.latest import Latest
from workbench.app.inspector.page import Page
from workbench.app.inspector.subject import Key, Subject
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.formula import names_in_formula
from workbench.core.registry import Registry
from workbench.core.typeset import latex_terms

REST = 300
"""Milliseconds without a change after which the properties are looked for: a slider does not wait for them."""
KEPT = 64
"""Analyses that are kept, for coming back to."""
Analyser = Callable[[Distortion, int], Any]


def analysed(distortion: Distortion, dimension: int) -> Any:
    """`Analysis` of a distortion; the import is late, for it is wanted on a thread only."""
    from workbench.core.analysis import analyse

    return analyse(distortion, dimension)


class FormulaPage(Page):
    """Formula, words and badges; what takes time comes from threads."""

    def __init__(self, subject: Subject, parent: QWidget | None = None, analyser: Analyser = analysed) -> None:
        super().__init__(subject, parent)
        self._analyser = analyser
        self._analyses: OrderedDict[Key, Any] = OrderedDict()
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(REST)
        self._rest.timeout.connect(self._ask)
        self._latest = Latest(self)
        self._latest.done.connect(self._take_analysis)
        self._latest.failed.connect(self._analysis_failed)
        self.picture = FormulaPicture(self)
        self.text = _label(self)
        self.text.setObjectName("formula-text")
        self.citation = _label(self)
        self.citation.setObjectName("citation")
        self.description = _label(self)
        self.inversions = _label(self)
        self.parameters = _label(self)
        self.badges = Badges(self)
        words = QVBoxLayout()
        words.setContentsMargins(8, 6, 8, 8)
        words.setSpacing(7)
        for widget in (self.text, self.parameters, self.description, self.inversions, self.citation, self.badges):
            words.addWidget(widget)
        body = QWidget(self)
        layout = QVBoxLayout(body)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self.picture)
        layout.addLayout(words)
        layout.addStretch(1)
        area = QScrollArea(self)
        area.setWidgetResizable(True)
        area.setFrameShape(QFrame.Shape.NoFrame)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        area.setWidget(body)
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        outer.addWidget(area)

    def set_theme(self, theme: Theme) -> None:
        self.picture.set_theme(theme)
        self.badges.set_theme(theme)
        super().set_theme(theme)

    def wait(self) -> None:
        self._rest.stop()
        self.picture.wait()
        self._latest.wait()

    # ------------------------------------------------------------------------------------------ showing

    def refresh(self) -> None:
        item, registry = self.subject.distortion, self.subject.registry
        if item is None or registry is None:
            self._rest.stop()
            self._show_nothing()
            return
        self.picture.show_formula(formula_lines(item, registry), f"D = {item.formula}")
        self.text.setText(f"<code>{_spaced(item.formula)}</code>")
        self._show(self.inversions, unsigned_note(item, self.subject.dimension))
        self._show(self.citation, item.citation)
        self._show(self.description, item.description)
        values = item.parameter_values
        notes = {p.name: p.description for p in item.parameters}
        lines = [f"<b>{name} = {value:g}</b> {notes[name]}" for name, value in values.items()]
        self._show(self.parameters, "<br>".join(lines))
        self._show_badges()

    def _show_nothing(self) -> None:
        self.picture.show_formula((), "")
        for label in (self.text, self.citation, self.description, self.inversions, self.parameters):
            label.hide()
        self.badges.say(self.subject.sentence)

    @staticmethod
    def _show(label: QLabel, text: str) -> None:
        label.setText(text)
        label.setVisible(bool(text))

    # ------------------------------------------------------------------------------------------ badges

    def _show_badges(self) -> None:
        self.text.show()
        key = self.subject.key
        if key in self._analyses:
            self._rest.stop()
            self._analyses.move_to_end(key)
            self.badges.show_analysis(self._analyses[key])
            return
        self.badges.say("Looking at its properties…")
        self._rest.start()

    def _ask(self) -> None:
        item = self.subject.distortion
        if item is not None and self.isVisible():
            self._latest.ask(partial(_answer, self._analyser, item, self.subject.key))
        elif item is not None:
            self._is_stale = True

    def _take_analysis(self, answer: tuple[Key, Any, str]) -> None:
        key, analysis, sentence = answer
        if analysis is not None:
            self._analyses[key] = analysis
            while len(self._analyses) > KEPT:
                self._analyses.popitem(last=False)
        if key != self.subject.key:
            return  # that of an earlier choice
        if analysis is None:
            self.badges.say(sentence)
        else:
            self.badges.show_analysis(analysis)

    def _analysis_failed(self, error: Exception) -> None:
        self.badges.say(f"The properties could not be found: {error}.")


def _answer(analyser: Analyser, item: Distortion, key: Key) -> tuple[Key, Any, str]:
    try:
        return key, analyser(item, key[2]), ""
    except WorkbenchError as error:
        return key, None, error.sentence


def unsigned_note(item: Distortion, dimension: int) -> str:
    """What becomes of an inverted simplex, in one sentence."""
    if item.has_barrier(dimension):
        return "Counts as ∞ where det J ≤ 0."
    return "Taken at |σ|: an inverted simplex counts as its mirror image does."


def formula_lines(item: Distortion, registry: Registry) -> tuple[str, ...]:
    """LaTeX of "D = ..." in pieces between which it may be broken."""
    try:
        terms = latex_terms(item.formula, short_names(item, registry))
    except WorkbenchError:
        return ()  # the plain text stays
    return (rf"D(\sigma) = {terms[0]}", *terms[1:])


def short_names(item: Distortion, registry: Registry) -> Mapping[str, str]:
    """Short names of the other distortions that a formula refers to."""
    own = {p.name for p in item.parameters}
    found = {}
    for name in names_in_formula(item.formula):
        other = registry.distortions.get(name.replace("_", "-")) or registry.distortions.get(name)
        if other is not None and name not in own:
            found[name] = other.short or other.id
    return found


def _label(parent: QWidget) -> QLabel:
    label = QLabel(parent)
    label.setWordWrap(True)
    label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
    return label


def _spaced(formula: str) -> str:
    """A formula that may be wrapped after its operators and brackets."""
    safe = formula.replace("&", "&amp;").replace("<", "&lt;")
    return safe.replace("(", "(\u200b").replace("/", "/\u200b").replace("*", "*\u200b")
