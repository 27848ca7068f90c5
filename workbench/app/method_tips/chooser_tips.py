"""The tips of the panel's lists: formulas are drawn on a thread, once somebody comes near."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtWidgets import QComboBox

from workbench.app.inspector.formula_page import formula_lines
from workbench.app.inspector.formula_picture import Drawing, draw_formula
from workbench.app.inspector.latest import Latest
from workbench.app.method_tips.tips import WIDTH, picture_of, tip_of_distortion, tip_of_method
from workbench.core.distortion import Distortion
from workbench.core.method import Method
from workbench.core.registry import Registry, registry

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

Key = tuple[str, str]
"""Id and formula: one's own formulas change."""


class ChooserTips(QObject):
    """Fills the lists of distortions, solvers and starts with tips when the pointer enters one, or it is opened."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._drawings: dict[Key, Drawing | None] = {}
        self._tips: dict[tuple[Key, str], str] = {}
        self._latest = Latest(self)
        self._latest.done.connect(self._take)
        panel = window.panel
        self.boxes: tuple[QComboBox, ...] = (panel.distortion.combo, panel.solver.combo, panel.start.combo)
        for box in self.boxes:
            box.installEventFilter(self)
            box.view().installEventFilter(self)
            box.currentIndexChanged.connect(lambda _, b=box: self._tell_current(b))

    @property
    def _registry(self) -> Registry | None:
        """None until the methods were found: looking for them takes a while, on a thread of its own."""
        return registry() if self.boxes[1].count() else None

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() in (QEvent.Type.Enter, QEvent.Type.Show) and self._registry is not None:
            self.fill()
        return False

    def fill(self) -> None:
        """Give every entry its tip; formulas that are not drawn yet stand there as text until they are."""
        for box in self.boxes:
            for row in range(box.count()):
                tip = self._tip_of(box, row)
                if tip and tip != box.itemData(row, Qt.ItemDataRole.ToolTipRole):
                    box.setItemData(row, tip, Qt.ItemDataRole.ToolTipRole)
            self._tell_current(box)
        self._ask()

    def _tell_current(self, box: QComboBox) -> None:
        box.setToolTip(self._tip_of(box, box.currentIndex()))

    def _tip_of(self, box: QComboBox, row: int) -> str:
        found, id = self._registry, box.itemData(row)
        if found is None or not id:
            return ""
        if box is self.boxes[0]:
            item = found.distortions.get(id)
            return "" if item is None else self._tip_of_distortion(item)
        method: type[Method] | None = (found.solvers if box is self.boxes[1] else found.initializers).get(id)
        return "" if method is None else tip_of_method(method)

    def _tip_of_distortion(self, item: Distortion) -> str:
        key, colour = (item.id, item.formula), self._window.theme.text
        drawing = self._drawings.get(key)
        if drawing is None:
            return tip_of_distortion(item)
        if (key, colour) not in self._tips:
            self._tips[key, colour] = tip_of_distortion(item, picture_of(drawing, colour))
        return self._tips[key, colour]

    def _ask(self) -> None:
        found = self._registry
        if found is None:
            return
        missing = [item for item in found.distortions.values() if (item.id, item.formula) not in self._drawings]
        if missing and not self._latest.is_busy:
            ratio = self._window.devicePixelRatioF()
            self._latest.ask(lambda: {(item.id, item.formula): _drawn(item, found, ratio) for item in missing})

    def _take(self, drawings: dict[Key, Drawing | None]) -> None:
        self._drawings |= drawings
        self.fill()


def _drawn(item: Distortion, found: Registry, ratio: float) -> Drawing | None:
    """A formula as mathematics; None where it cannot be drawn."""
    terms = formula_lines(item, found)
    try:
        return draw_formula(terms, WIDTH, ratio) if terms else None
    except ValueError:
        return None
