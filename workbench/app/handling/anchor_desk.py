"""What is done to anchors: taken up, moved together, let go, made in groups."""

from __future__ import annotations

import math
import time

import numpy as np
from PySide6.QtCore import QObject, QTimer, Signal

from workbench.app.document.anchor_set import AnchorSet
from workbench.app.document.document import Document
from workbench.app.handling.company import Company, Gathered
from workbench.app.handling.motion import Motion
from workbench.app.handling.pacing import TurnPacer
from workbench.app.handling.train import Train
from workbench.core.arrays import Integers

TICK = 30
"""Milliseconds between two looks at a turn that waits for the map."""
PATIENCE = 4.0
"""Seconds without any progress after which a turn that nobody holds any longer ends where it is."""
PROGRESS = 1e-3
"""Part of a turn that counts as some."""


class AnchorDesk(QObject):
    """Moves anchors of a document from where they were when they were taken up; the window's tools and menus ask for it."""

    given_up = Signal(float)
    """Degrees at which a turn has ended before its time"""
    train_changed = Signal()
    """Others go along now than did before, or nobody does"""
    twins_missed = Signal(int, int)
    """So many of so many anchors have no mirror twin"""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self._document = document
        self._vertices: Integers = np.empty(0, np.int64)
        self._before = AnchorSet.none()
        self.company = Company(document)
        self.gathered: Gathered | None = None
        self._train: Train | None = None
        self._wanted: Motion | None = None
        self._pacer: TurnPacer | None = None
        self._is_held, self._is_first = False, True
        self._best, self._best_at = 0.0, 0.0
        self._timer = QTimer(self)
        self._timer.setInterval(TICK)
        self._timer.timeout.connect(self._go_on)
        document.opened.connect(self.forget)

    @property
    def is_turning(self) -> bool:
        """Whether a turn still waits for the map to come after."""
        return self._timer.isActive()

    @property
    def is_at_one_place(self) -> bool:
        """Whether nothing that goes with the selected anchors would move, were they turned or scaled about their centre."""
        targets = self._document.anchors.targets_of(self._document.selected_anchors)
        return not self.company.customs.has_falloff and len(targets) > 0 and not np.ptp(targets, axis=0).any()

    # ------------------------------------------------------------------------------------------ moving

    def take_up(self) -> None:
        """The selected anchors are moved from now on, from where they are."""
        self.forget()
        self._vertices = self._document.selected_anchors
        self._before = self._document.anchors

    def move(self, motion: Motion, is_held: bool, at: float | None = None) -> None:
        """Move what was taken up; a turn goes ahead of the map no further than the map can tell which way it went round."""
        if not len(self._vertices):
            return
        self._wanted, self._is_held = motion, is_held
        if motion.angle and self._document.is_at_work:
            if self._pacer is None:
                self._pacer = TurnPacer(self._before.targets_of(self._vertices))
            self._best, self._best_at = 0.0, time.monotonic()
            self._go_on(at)
        else:
            self._pacer = None
            self._timer.stop()
            self._send(motion, is_held, at)

    def _go_on(self, at: float | None = None) -> None:
        if self._wanted is None or self._pacer is None or self._document.positions is None:
            self._timer.stop()
            return
        part = self._pacer.part(self._wanted, self._document.positions[self._vertices])
        if not self._document.is_at_work:
            part = 1.0  # nothing follows, so that there is nothing to wait for
        if part > self._best + PROGRESS:
            self._best, self._best_at = part, time.monotonic()
        waits = part < 1.0 and (self._is_held or time.monotonic() - self._best_at < PATIENCE)
        if waits:
            self._timer.start()
        else:
            self._timer.stop()
        self._send(self._wanted.part(part), self._is_held or waits, at)
        if part < 1.0 and not waits:
            self.given_up.emit(math.degrees(part * self._wanted.angle))

    def _send(self, motion: Motion, is_held: bool, at: float | None) -> None:
        train, anchors = self._train or self._gather(), self._document.anchors
        if self.gathered is not None and len(self.gathered.made):
            anchors = anchors.joined(self.gathered.anchors) if self._is_first else anchors
        self._is_first = False
        self._document.set_anchors(anchors.moved(train.vertices, train.after(motion)), dragging=is_held, at=at)

    def _gather(self) -> Train:
        """Who goes along is found when the first one moves."""
        self.gathered = self.company.gather(self._before, self._vertices)
        self._train, self._is_first = self.gathered.train(self.company.radius), True
        self.train_changed.emit()
        if self.gathered.missing:
            self.twins_missed.emit(self.gathered.missing, len(self._vertices))
        return self._train

    def widen(self, steps: float) -> None:
        """Let the falloff reach farther while anchors are held, or less far."""
        if self.gathered is not None and self.company.customs.has_falloff and self._wanted is not None:
            self.company.widen(steps)
            self._train = self.gathered.train(self.company.radius, None if self._train is None else self._train.vertices)
            self.train_changed.emit()
            self._send(self._wanted, self._is_held, time.perf_counter())

    @property
    def train(self) -> Train | None:
        """Those that move while some are held; None while nothing does."""
        return self._train

    def cancel(self) -> None:
        """Back to where they were taken up; what was made for it goes."""
        if self._train is not None and self.gathered is not None:
            anchors = self._document.anchors.moved(self._train.vertices, self._train.places)
            self._document.set_anchors(anchors.without(*self.gathered.made.tolist()))
        self.forget()

    def forget(self) -> None:
        """Nothing is held any longer; what was sent stays."""
        self._timer.stop()
        self._vertices, self._wanted, self._pacer = np.empty(0, np.int64), None, None
        had_some, self._train, self.gathered = self._train is not None, None, None
        if had_some:
            self.train_changed.emit()

    # ------------------------------------------------------------------------------------------ setting

    def add_group(self, vertices: Integers) -> None:
        """Hold these where they are now, as one group, and select it; anchors among them keep their targets."""
        document = self._document
        if document.positions is None or not len(vertices):
            return
        anchors = document.anchors.joined(AnchorSet.at(vertices, document.positions))
        document.set_anchors(anchors.grouped(vertices) if len(vertices) > 1 else anchors)
        document.select(int(vertices[0]))

    def remove_selected(self) -> None:
        """Let the selected anchors go."""
        self.remove(self._document.selected_anchors)

    def remove(self, vertices: Integers) -> None:
        """Let these anchors go."""
        if len(vertices):
            self._document.set_anchors(self._document.anchors.without(*vertices.tolist()))

    def split_selected(self) -> None:
        """Each of the selected anchors moves alone from now on."""
        document = self._document
        document.set_anchors(document.anchors.ungrouped(document.selected_anchors))
        document.selection_changed.emit()
