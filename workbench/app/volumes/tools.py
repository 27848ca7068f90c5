"""The controls of a look into a solid: above the source those of the plane, above the target those of the rest."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QSignalBlocker, Qt
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QMenu, QSizePolicy, QSlider, QToolButton, QWidget

from workbench.app.quantities.quantity_book import QuantityBook
from workbench.app.volumes.volume_view import VolumeView

STEPS = 1000
"""Steps of a slider."""
FURTHEST = 1.5
"""How far tetrahedra can be pulled apart; see `VolumeLook`."""
SHELLS = (("None", 0.0, False), ("Faint", 0.12, False), ("Stronger", 0.3, False), ("Wires", 0.35, True))
"""How the boundary can be drawn round what is left of a solid: words, opacity, whether as edges."""


class _Tools(QWidget):
    """A row of small controls, to be seen while there is a solid."""

    def __init__(self, volume: VolumeView, parent: QWidget) -> None:
        super().__init__(parent)
        self._volume = volume
        self._row = QHBoxLayout(self)
        self._row.setContentsMargins(10, 0, 6, 4)
        self._row.setSpacing(5)
        volume.changed.connect(self.show_look)
        volume.opened.connect(self.show_look)
        self.hide()

    def show_look(self) -> None:
        """Bring every control in line with the look."""
        self.setVisible(self._volume.is_on)

    def _label(self, text: str, tip: str) -> None:
        label = QLabel(text, self)
        label.setToolTip(tip)
        self._row.addWidget(label)

    def _slider(self, tip: str, deed: Callable[[float], None]) -> QSlider:
        slider = QSlider(Qt.Orientation.Horizontal, self)
        slider.setRange(0, STEPS)
        slider.setPageStep(STEPS // 20)
        slider.setSingleStep(STEPS // 200)
        slider.setMinimumWidth(36)
        slider.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        slider.setToolTip(tip)
        slider.valueChanged.connect(lambda value: deed(value / STEPS))
        self._row.addWidget(slider, 1)
        return slider

    def _switch(self, text: str, tip: str, deed: Callable[[bool], None]) -> QToolButton:
        button = QToolButton(self)
        button.setObjectName("switch")
        button.setText(text)
        button.setCheckable(True)
        button.setToolTip(tip)
        button.toggled.connect(deed)
        self._row.addWidget(button)
        return button

    def _menu(self, tip: str, fill: Callable[[QMenu], None]) -> None:
        button = QToolButton(self)
        button.setText("⋯")
        button.setToolTip(tip)
        button.setAutoRaise(True)
        button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        button.setStyleSheet("QToolButton::menu-indicator { image: none; }")
        menu = QMenu(button)
        menu.aboutToShow.connect(lambda: (menu.clear(), fill(menu)))
        button.setMenu(menu)
        self._row.addWidget(button)


class CutTools(_Tools):
    """The plane: which way it faces, where it stands, what it leaves."""

    def __init__(self, volume: VolumeView, cut_along: Callable[[str], None], parent: QWidget) -> None:
        """`cut_along` is told the name of an axis, `view` for that of sight, or nothing for no plane."""
        super().__init__(volume, parent)
        self._label("Cut", "A plane takes away what lies before it; drag its handle in the view.")
        self.axis = QComboBox(self)
        for id, text in (("", "Whole"), ("x", "X"), ("y", "Y"), ("z", "Z"), ("view", "View")):
            self.axis.addItem(text, id)
        self.axis.setToolTip("Normal of the plane; View cuts across the line of sight.")
        self.axis.setMinimumWidth(52)
        self.axis.activated.connect(lambda _: cut_along(self.axis.currentData()))
        self._row.addWidget(self.axis)
        self.place = self._slider("Where the plane stands.", lambda share: volume.choose(place=share))
        self.flip = self._switch("⇄", "Keep the other side.", lambda on: volume.choose(is_flipped=on))
        tip = "Cut through tetrahedra, or leave each whole."
        self.exact = self._switch("Section", tip, lambda on: volume.choose(is_exact=on))
        self._menu("Whose plane it is", self._fill_menu)
        self.show_look()

    def _fill_menu(self, menu: QMenu) -> None:
        for text, of_target in (("Plane of the source", False), ("Plane of the target", True)):
            action = menu.addAction(text)
            action.setCheckable(True)
            action.setChecked(self._volume.look.cuts_target == of_target)
            action.triggered.connect(lambda _=False, t=of_target: self._volume.choose(cuts_target=t))

    def show_look(self) -> None:
        super().show_look()
        look = self._volume.look
        name = (look.axis or "view") if look.is_cut else ""
        self.axis.setCurrentIndex(self.axis.findData(name))
        with QSignalBlocker(self.place), QSignalBlocker(self.flip), QSignalBlocker(self.exact):
            self.place.setValue(round(STEPS * look.place))
            self.flip.setChecked(look.is_flipped)
            self.exact.setChecked(look.is_exact)
        for widget in (self.place, self.flip, self.exact):
            widget.setEnabled(look.is_cut)


class PeelTools(_Tools):
    """Peeling by a quantity, what is marked, pulling apart, the veil round the rest."""

    def __init__(self, volume: VolumeView, book: QuantityBook, parent: QWidget) -> None:
        super().__init__(volume, parent)
        self._book = book
        self._label("Peel", "Takes away the tetrahedra with least distortion; the menu says of which kind.")
        self.peel = self._slider("Which share of the tetrahedra is taken away, those of least distortion.", volume.peel)
        self.threshold = QLabel("", self)
        self.threshold.setObjectName("citation")
        self._row.addWidget(self.threshold)
        self._label("Spread", "Pulls the tetrahedra apart.")
        tip = "How far the tetrahedra are pulled apart."
        self.spread = self._slider(tip, lambda share: volume.choose(spread=FURTHEST * share))
        tip = "Draw only the tetrahedra that are marked: drag across the histogram."
        self.marked = self._switch("Marked", tip, lambda on: volume.choose(only_marked=on))
        self._menu("Quantity to peel by, veil", self._fill_menu)
        self.show_look()

    def _fill_menu(self, menu: QMenu) -> None:
        quantities = menu.addMenu("Peel by")
        for quantity in self._book.quantities:
            action = quantities.addAction(quantity.title)
            action.setCheckable(True)
            action.setChecked(quantity.id == self._volume.peel_by)
            action.triggered.connect(lambda _=False, id=quantity.id: self._volume.peel_by_quantity(id))
        veil = menu.addMenu("Boundary round the rest")
        look = self._volume.look
        for text, opacity, as_wires in SHELLS:
            action = veil.addAction(text)
            action.setCheckable(True)
            action.setChecked((look.ghost, look.is_wired) == (opacity, as_wires))
            action.triggered.connect(lambda _=False, o=opacity, w=as_wires: self._volume.choose(ghost=o, is_wired=w))
        menu.addSeparator()
        menu.addAction("Show all").triggered.connect(self._volume.show_all)

    def show_look(self) -> None:
        super().show_look()
        look = self._volume.look
        with QSignalBlocker(self.peel), QSignalBlocker(self.spread), QSignalBlocker(self.marked):
            self.peel.setValue(round(STEPS * self._volume.peeled))
            self.spread.setValue(round(STEPS * look.spread / FURTHEST))
            self.marked.setChecked(look.only_marked)
        self.threshold.setText("" if look.threshold is None else f"≥ {look.threshold:.3g}")
