"""The dialog of a film: views, size, pace, and a picture of what a frame looks like."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QImage, QPixmap
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QDoubleSpinBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QProgressBar,
    QPushButton,
    QSpinBox,
    QWidget,
)

from workbench.app.composing.offers import Offer
from workbench.app.composing.preview_dialog import PreviewDialog
from workbench.app.files.new_file import ask_new_file
from workbench.app.timeline.film_plan import PACES, PARTS, FilmPlan
from workbench.figures.film import LEAST, MOST, RATES, Film
from workbench.figures.film_page import GROUNDS
from workbench.figures.film_shading import Pixels

FILTERS = "GIF (*.gif);;MP4 (*.mp4)"
PREVIEW = (520, 420)


class FilmDialog(PreviewDialog):
    """`cancel_wanted` while a film is made.

    It does not stop the window, and goes on when it is closed while a film is being made.
    """

    cancel_wanted = Signal()

    def __init__(self, offers: Sequence[Offer], is_dark: bool, is_marked: bool, place: Path, parent: QWidget) -> None:
        super().__init__("Film", offers, PREVIEW, (360, 170), parent)
        self._place = place
        self.picture.setFrameShape(QLabel.Shape.StyledPanel)
        self.save_button.setToolTip("GIF, or MP4 where there is ffmpeg")
        self.bar = QProgressBar(self)
        self.bar.setRange(0, 1000)
        self.cancel = QPushButton("Cancel", self)
        self.cancel.setToolTip("End the film that is being made; nothing is written")
        self.cancel.setAutoDefault(False)
        self.cancel.clicked.connect(self.cancel_wanted)
        working = QHBoxLayout()
        working.addWidget(self.bar, 1)
        working.addWidget(self.cancel)
        self._lay_out(self._make_form(is_dark, is_marked), working)
        self.show_progress(-1.0)

    def _make_form(self, is_dark: bool, is_marked: bool) -> QFormLayout:
        usual = Film(())
        self.sides = tuple(QSpinBox(self) for _ in range(2))
        for box, side in zip(self.sides, (usual.width, usual.height), strict=True):
            box.setRange(LEAST, MOST)
            box.setSingleStep(2)
            box.setSuffix(" px")
            box.setValue(side)
        self.rate = QSpinBox(self)
        self.rate.setRange(int(RATES[0]), int(RATES[1]))
        self.rate.setValue(int(usual.rate))
        self.rate.setToolTip("Many programs show no GIF quicker than 50 frames a second")
        self.part, self.pace, self.ground = (self._list(words) for words in (PARTS, PACES, dict.fromkeys(GROUNDS)))
        self.part.setItemData(1, None if is_marked else 0, Qt.ItemDataRole.UserRole - 1)
        self.part.setCurrentIndex(1 if is_marked else 0)
        self.ground.setCurrentIndex(list(GROUNDS).index("dark" if is_dark else "white"))
        self.speed = QDoubleSpinBox(self)
        self.speed.setRange(0.05, 100.0)
        self.speed.setSingleStep(0.5)
        self.speed.setValue(1.0)
        self.ranges = self._list({"window": "Ranges of the window", "film": "Fitted to the film"})
        self.ranges.setToolTip("Either way a colour stands for one value in all frames")
        ticks = ("Captions", "Anchors", "Colour bars", "Repeat")
        self.captions, self.anchors, self.bars, self.repeats = (self._tick(text) for text in ticks)
        self.repeats.setToolTip("A GIF begins anew at its end")
        form = QFormLayout()
        form.addRow("Part", self._row(self.part))
        form.addRow("Pace", self._row(self.pace, self.speed))
        form.addRow("Size", self._row(*self.sides))
        form.addRow("Frames a second", self._row(self.rate))
        form.addRow("Ground", self._row(self.ground))
        form.addRow("Colours", self._row(self.ranges))
        form.addRow("Show", self._row(self.captions, self.anchors, self.bars))
        form.addRow("", self._row(self.repeats))
        self.pace.currentIndexChanged.connect(lambda _: self.speed.setEnabled(self.pace.currentData() == "time"))
        return form

    # ------------------------------------------------------------------------------------------ choices

    @property
    def plan(self) -> FilmPlan:
        """The film as it is chosen."""
        keeps, shown = self.ranges.currentData() == "window", self.anchors.isChecked()
        panels = tuple(
            replace(panel, anchors=shown, range=panel.range if keeps else None)
            for panel in self.panels.panels(bars=self.bars.isChecked())
        )
        width, height = (box.value() // 2 * 2 for box in self.sides)
        film = Film(
            panels, width, height, float(self.rate.value()), str(self.ground.currentData()),
            has_captions=self.captions.isChecked(), repeats=self.repeats.isChecked(),
        )  # fmt: skip
        return FilmPlan(film, str(self.part.currentData()), str(self.pace.currentData()), self.speed.value())

    def kept(self) -> dict[str, Any]:
        """Choices for the next film, but those that belong to this record."""
        return {
            **{name: box.value() for name, box in self._numbers.items()},
            **{name: tick.isChecked() for name, tick in self._ticks.items()},
            **{name: box.currentData() for name, box in self._lists.items()},
        }

    def take_kept(self, kept: Mapping[str, Any]) -> None:
        """Choose what was chosen for the last film; values that cannot be are passed over."""
        for name, number in self._numbers.items():
            value = kept.get(name)
            if isinstance(value, int | float) and not isinstance(value, bool) and number.minimum() <= value <= number.maximum():
                number.setValue(value if isinstance(number, QDoubleSpinBox) else int(value))
        for name, tick in self._ticks.items():
            wanted = kept.get(name)
            tick.setChecked(wanted if isinstance(wanted, bool) else tick.isChecked())
        for name, box in self._lists.items():
            place = box.findData(kept.get(name))
            box.setCurrentIndex(box.currentIndex() if place < 0 else place)

    @property
    def _numbers(self) -> dict[str, QSpinBox | QDoubleSpinBox]:
        return {"width": self.sides[0], "height": self.sides[1], "rate": self.rate, "speed": self.speed}

    @property
    def _ticks(self) -> dict[str, QCheckBox]:
        return {"captions": self.captions, "anchors": self.anchors, "bars": self.bars, "repeats": self.repeats}

    @property
    def _lists(self) -> dict[str, QComboBox]:
        return {"pace": self.pace, "ground": self.ground, "ranges": self.ranges}

    # ------------------------------------------------------------------------------------------ results

    def show_preview(self, pixels: Pixels, sentence: str) -> None:
        """Show a frame, and how long the film is."""
        height, width = pixels.shape[:2]
        self._show(QPixmap.fromImage(QImage(pixels.tobytes(), width, height, 3 * width, QImage.Format.Format_RGB888)))
        self.note.setText(sentence)
        self.save_button.setEnabled(self.bar.isHidden())

    def show_progress(self, share: float) -> None:
        """How much of the film is done; below 0 none is being made."""
        is_working = share >= 0.0
        for widget in (self.bar, self.cancel):
            widget.setVisible(is_working)
        self.save_button.setEnabled(not is_working)
        self.bar.setValue(round(1000 * max(share, 0.0)))

    def _ask_file(self) -> None:
        ask_new_file(self, "Save the film", str(self._place), FILTERS, "gif", self.save_wanted.emit, overwrites=True)
