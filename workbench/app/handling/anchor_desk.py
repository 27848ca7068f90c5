"""What is done to anchors: taken up, moved together, let go, made in groups."""

from __future__ import annotations

import math
import time

import numpy as np
from PySide6.QtCore import QObject, QTimer, Signal

from workbench.app.anchor_set import AnchorSet
from workbench.app.document import Document
from workbench.app.handling.motion import Motion
from workbench.app.handling.pacing import TurnPacer
from workbench.app.handling.rigid_motion import RigidMotion
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

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self._document = document
        self._vertices: Integers = np.empty(0, np.int64)
        self._before = AnchorSet.none()
        self._wanted: Motion | None = None
        self._pacer: TurnPacer | None = None
        self._is_held = False
        self._best, self._best_at = 0.0, 0.0
        self._timer = QTimer(self)
        self._timer.setInterval(TICK)
        self._timer.timeout.connect(self._go_on)
        document.opened.connect(self.forget)

    @property
    def is_turning(self) -> bool:
        """Whether a turn still waits for the map to come after."""
        return self._timer.isActive()

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
        anchors = self._document.anchors
        targets = motion.of(self._before.targets_of(self._vertices))
        self._document.set_anchors(anchors.moved(self._vertices, targets), dragging=is_held, at=at)

    def cancel(self) -> None:
        """Back to where they were taken up."""
        if len(self._vertices):
            self.move(RigidMotion(), False)
        self.forget()

    def forget(self) -> None:
        """Nothing is held any longer; what was sent stays."""
        self._timer.stop()
        self._vertices, self._wanted, self._pacer = np.empty(0, np.int64), None, None

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
