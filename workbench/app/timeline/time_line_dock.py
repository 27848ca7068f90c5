"""The panel of the time line: slider, buttons, and what is known of the moment that is shown."""

from __future__ import annotations

import math

from PySide6.QtCore import QTimer, Signal
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QComboBox, QDockWidget, QHBoxLayout, QLabel, QMenu, QPushButton, QToolButton, QVBoxLayout, QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.docks.dock_title import DockTitle
from workbench.app.status.status_line import ElidedLabel
from workbench.app.timeline.looking_back import LookingBack
from workbench.app.timeline.recorder import Recorder
from workbench.app.timeline.time_slider import TimeSlider

SPEEDS = (0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0)
MEMORIES = (64, 256, 1024)
"""Megabytes of maps that can be chosen."""
REDRAW = 150
"""Milliseconds between two pictures of a time line that grows."""

SHORT = {"past-go-on": "Go on", "past-compare": "Compare"}
"""Words for buttons: with those of the menu a small window would have to grow."""


class TimeLineDock(QDockWidget):
    """Shows the record, and says what the user wants of it.

    `play_wanted`, `mark_wanted` ("A" or "B"), `flip_wanted` and `memory_wanted` (megabytes) are buttons; what else can be done
    are actions of the window.
    """

    play_wanted = Signal()
    flip_wanted = Signal()
    mark_wanted = Signal(str)
    memory_wanted = Signal(int)

    def __init__(self, recorder: Recorder, looking: LookingBack, actions: list[QAction], parent: QWidget) -> None:
        super().__init__("Time line", parent)
        self.setObjectName("time-line")
        self.setTitleBarWidget(DockTitle(self, QLabel("Time line", self)))
        self._recorder, self._looking = recorder, looking
        self.marks: dict[str, QPushButton] = {}
        body = QWidget(self)
        self.slider = TimeSlider(recorder.record, body)
        layout = QVBoxLayout(body)
        layout.setContentsMargins(4, 3, 4, 3)
        layout.setSpacing(2)
        layout.addLayout(self._make_row(body, actions))
        layout.addWidget(self.slider, 1)
        self.setWidget(body)
        self._redraw = QTimer(self)
        self._redraw.setSingleShot(True)
        self._redraw.setInterval(REDRAW)
        self._redraw.timeout.connect(self.show_place)
        for signal in (recorder.grown, recorder.noted, recorder.cleared):
            signal.connect(self._show_later)
        looking.changed.connect(self.show_place)
        self.slider.place_wanted.connect(looking.show)
        self.slider.live_wanted.connect(looking.go_live)
        self.slider.play_wanted.connect(self.play_wanted)
        self.slider.flip_wanted.connect(self.flip_wanted)
        self.slider.mark_wanted.connect(self.mark_wanted)
        self.visibilityChanged.connect(lambda _: self.show_place())
        self.show_place()

    def _make_row(self, body: QWidget, actions: list[QAction]) -> QHBoxLayout:
        row = QHBoxLayout()
        row.setSpacing(4)
        self.first = self._button("|◀", "The first map (Home)", body)
        self.first.clicked.connect(lambda _: self._looking.show(0))
        self.play = self._button("▶ Play", "Play from here, or from the beginning (Space)", body)
        self.play.clicked.connect(lambda _: self.play_wanted.emit())
        self.speed = QComboBox(body)
        for speed in SPEEDS:
            self.speed.addItem(f"{speed:g}×", speed)
        self.speed.setCurrentIndex(SPEEDS.index(1.0))
        self.speed.setToolTip("How fast it is played: 1× as it was")
        self.live = self._button("Live", "The newest map, as it comes (L, End)", body)
        self.live.setCheckable(True)
        self.live.clicked.connect(lambda _: self._go_live())
        self.words = ElidedLabel(body)
        for widget in (self.first, self.play, self.speed, self.live):
            row.addWidget(widget)
        row.addSpacing(6)
        row.addWidget(self.words, 1)
        for name in ("A", "B"):
            self.marks[name] = self._button(name, f"Call the moment that is shown {name} ({name})", body)
            self.marks[name].clicked.connect(lambda _, n=name: self.mark_wanted.emit(n))
            row.addWidget(self.marks[name])
        self.flip = self._button("Flip", "From A to B and back (X)", body)
        self.flip.clicked.connect(lambda _: self.flip_wanted.emit())
        row.addWidget(self.flip)
        for action in actions:
            button = QToolButton(body)
            if action.objectName() in SHORT:
                action.setIconText(SHORT[action.objectName()])  # what stands on a button
            button.setDefaultAction(action)
            row.addWidget(button)
        self._add_menu(row, body)
        return row

    def _button(self, text: str, tip: str, body: QWidget) -> QPushButton:
        button = QPushButton(text, body)
        button.setToolTip(tip)
        button.setFixedWidth(button.fontMetrics().horizontalAdvance(text) + 18)
        return button

    def _add_menu(self, row: QHBoxLayout, body: QWidget) -> None:
        more = QToolButton(body)
        more.setText("⋯")
        more.setToolTip("Memory of the time line")
        more.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        more.setStyleSheet("QToolButton::menu-indicator { image: none; }")
        self._menu = QMenu(more)
        self._menu.aboutToShow.connect(self._fill_menu)
        more.setMenu(self._menu)
        row.addWidget(more)

    def _fill_menu(self) -> None:
        self._menu.clear()
        record = self._recorder.record
        used = f"{len(record)} maps, {record.byte_count / 2**20:.1f} MB"
        self._menu.addAction(used).setEnabled(False)
        for size in MEMORIES:
            action = self._menu.addAction(f"Keep up to {size} MB")
            action.setCheckable(True)
            action.setChecked(record.limit == size * 2**20)
            action.triggered.connect(lambda _=False, s=size: self.memory_wanted.emit(s))

    def _go_live(self) -> None:
        self._looking.go_live()
        self.show_place()  # the button is down again where it was live already

    # ------------------------------------------------------------------------------------------ showing

    def set_theme(self, theme: Theme) -> None:
        self.slider.theme = theme
        self.slider.update()

    def show_playing(self, is_playing: bool) -> None:
        self.play.setText("❚❚ Pause" if is_playing else "▶ Play")
        self.play.setFixedWidth(self.play.fontMetrics().horizontalAdvance("❚❚ Pause") + 18)

    def _show_later(self) -> None:
        if not self._redraw.isActive() and self.isVisible():
            self._redraw.start()

    def show_place(self) -> None:
        """Bring handle, buttons and words in line with the record."""
        if not self.isVisible():
            return
        looking, record = self._looking, self._recorder.record
        index = looking.index
        self.slider.show_place(index, looking.is_live)
        self.live.setChecked(looking.is_live)
        self.words.setText(self.sentence(index))
        for button in (self.first, self.play, *self.marks.values()):
            button.setEnabled(len(record) > 0)
        self.flip.setEnabled(len(self.slider.marked) == 2)

    def sentence(self, index: int) -> str:
        """What is known of a moment of the record."""
        record = self._recorder.record
        if not 0 <= index < len(record):
            return "Nothing is recorded yet."
        moment = record[index]
        energy = f"E {moment.energy:.6g}" if math.isfinite(moment.energy) else "E ∞"
        inverted = f" · {moment.inverted_count} inverted" if moment.inverted_count else ""
        note = f" · {'; '.join(moment.notes)}" if moment.notes else ""
        when = f"{moment.time:.2f} of {record.end:.2f} s"
        return f"iteration {moment.iteration} · {energy}{inverted}{note} · {when} · map {index + 1} of {len(record)}"
