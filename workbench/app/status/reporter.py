"""Words about what happens: status bar, error bar, progress, the state of the buttons."""

from __future__ import annotations

import logging
import re
import time
import traceback
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, QTimer

from workbench.app.actions import show_running
from workbench.app.document.first_anchors import SAMPLE, is_sample
from workbench.app.document.first_start import why_not_own_start
from workbench.app.status.meters import DragMeter, RateMeter
from workbench.core.errors import WorkbenchError
from workbench.core.samples import sample_label
from workbench.core.status import Status
from workbench.engine.messages import Failure, Progress, Ready, Refused, Restarted, Snapshot

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

LONG_STEP = 2.0
"""Seconds without a map after which a solver at work is called slow, with the way out."""
NUMBERS_INTERVAL = 150
"""Milliseconds between two sets of numbers in the status bar: faster ones cannot be read."""

APART = 1e-6
"""Part of the mesh's diameter by which an anchor is away from its place before the window speaks of it."""


class Reporter(QObject):
    """Listens to the engine and the document, and puts what they say into words."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._document = window.document
        self.drag_meter = DragMeter()
        self.rate_meter = RateMeter()
        self._is_ready = False
        self._last_iteration = -1
        self._drawn_serial = 0
        self._said = ""
        self._is_shown_at_work = False
        self._last_news = time.monotonic()
        self._timer = QTimer(self)
        self._timer.setInterval(NUMBERS_INTERVAL)
        self._timer.timeout.connect(self.show_numbers)
        self._timer.start()
        self._connect()
        window.status.say("Starting the engine…")

    def _connect(self) -> None:
        bridge, document, window = self._window.bridge, self._document, self._window
        bridge.ready.connect(self._ready)
        bridge.progress.connect(self._progress)
        bridge.failure.connect(self._failure)
        bridge.restarted.connect(self._restarted)
        document.refused.connect(self._refused)
        document.opening.connect(self._opening)
        document.opened.connect(self._opened)
        document.snapshot_taken.connect(self._snapshot)
        document.session_changed.connect(self.show_running)
        document.drag_sent.connect(self._drag_sent)
        document.history_restarted.connect(self._restart_meters)
        window.error_bar.fix_wanted.connect(self._apply_fixes)
        window.progress.cancelled.connect(document.stop)
        window.presenter.picture_sent.connect(self._picture_sent)
        window.target.view.drawn.connect(self._picture_drawn)

    def stop(self) -> None:
        self._timer.stop()

    # ------------------------------------------------------------------------------------------ engine

    def _ready(self, report: Ready) -> None:
        self._is_ready = True
        self._window.progress.end()
        if self._document.mesh is None and not self._document.opening_source:
            self._window.status.say(f"The engine is ready ({report.seconds:.1f} s).")

    def _progress(self, report: Progress) -> None:
        self._said = ""  # what is said of the next map takes this sentence's place
        if 0 <= report.fraction < 1 or report.fraction < 0:
            self._window.progress.begin(report.sentence, report.fraction)
            self._window.status.say(report.sentence)
        else:
            self._window.progress.end()

    def _failure(self, report: Failure) -> None:
        self._window.progress.end()
        self._window.error_bar.show_message(report.sentence, details=report.traceback)

    def _restarted(self, report: Restarted) -> None:
        self._window.progress.end()
        self._window.error_bar.show_message(report.sentence)
        self._window.status.say("The engine is starting again.")
        self._said = ""

    def _refused(self, report: Refused) -> None:
        self._window.progress.end()
        self._window.error_bar.show_message(in_window_words(report.sentence), report.fixes, "\n".join(report.lines))
        if report.command == "Load":
            self._window.status.say("Nothing was opened.")
        self._window.panel.show_session()

    def _apply_fixes(self, fixes: Any) -> None:
        self._document.try_again(tuple(fixes))

    def show_exception(self, error: BaseException) -> None:
        """A fault of ours or of a plugin, with its traceback in the details."""
        sentence = error.sentence if isinstance(error, WorkbenchError) else f"{type(error).__name__}: {error}"
        self._window.error_bar.show_message(sentence, details="".join(traceback.format_exception(error)))

    def show_plugin_failures(self, registry: Any) -> None:
        failures = registry.failures
        if failures:
            names = ", ".join(failure.path.name for failure in failures)
            details = "\n\n".join(f"{failure.path}\n{failure.traceback}" for failure in failures)
            self._window.error_bar.show_message(
                f"Plugins that could not be used, and are left out: {names}. Mend or remove them.",
                details=details,
            )

    # ------------------------------------------------------------------------------------------ mesh

    def _opening(self, source: str) -> None:
        self._window.error_bar.dismiss()
        name = source_name(source)
        self._window.progress.begin(f"Opening {name}…")
        self._window.status.say(f"Opening {name}…")

    def _opened(self) -> None:
        window, document = self._window, self._document
        window.progress.end()
        loaded = document.loaded
        assert loaded is not None
        source = document.session.source
        if not is_sample(source):
            window.settings.remember_file(source)
        name = source_name(source)
        window.sessions.show_title()
        mesh = loaded.mesh
        simplices = f"{counted(mesh.simplex_count)} {mesh.simplex_noun(mesh.simplex_count)}"
        vertices = f"{counted(mesh.vertex_count)} vertices"
        window.source.caption.setText(f"{simplices}, {vertices}")  # what is cut off first comes last
        window.source.caption.setToolTip("\n".join((f"{simplices}, {vertices}", *loaded.lines)))
        window.status.say(loaded.lines[0] if loaded.lines else f"{name} is open.")
        if refused_start := why_not_own_start(loaded, document.session):
            window.error_bar.show_message(refused_start, level=logging.INFO)  # the status bar tells of the map in a moment
        surface = window.source.view.surface
        window.actions_by_name["edges"].setChecked(surface is not None and surface.has_edges)

    # ------------------------------------------------------------------------------------------ numbers

    def _restart_meters(self) -> None:
        self._last_iteration = -1
        self.rate_meter.forget()

    def _snapshot(self) -> None:
        snapshot = self._document.snapshot
        assert snapshot is not None
        if not self._document.opening_source:
            self._window.progress.end()
        self._last_news = time.monotonic()
        iteration = snapshot.row.iteration
        if self._last_iteration >= 0 and iteration > self._last_iteration:
            self.rate_meter.take(iteration - self._last_iteration)
        self._last_iteration = iteration
        waits = self._anchors_wait(snapshot)
        key = f"{snapshot.phase}/{snapshot.status.name}/{snapshot.limiting_simplex >= 0}/{self._document.wants_to_run}/{waits}"
        if key != self._said:
            self._said = key
            self._say_state()
        if self._document.is_at_work != self._is_shown_at_work:
            self.show_running()

    def _say_state(self) -> None:
        snapshot = self._document.snapshot
        if snapshot is None:
            return
        mesh = self._document.mesh
        self._tell_what_unfolds(snapshot.phase == "finished" and snapshot.status is Status.INVERTED_START)
        if mesh is not None and snapshot.limiting_simplex >= 0 and snapshot.phase in ("running", "dragging"):
            which = f"{mesh.simplex_noun()} {snapshot.limiting_simplex}"
            self._window.status.say(f"An anchor lags: {which} would invert; the map follows as far as it can.")
        elif snapshot.phase == "finished":
            self._window.status.say(in_window_words(snapshot.status.value))
        elif snapshot.phase == "dragging":
            self._window.status.say("The map follows the hand.")
        elif snapshot.phase == "running":
            self._window.status.say(snapshot.status.value)
        elif self._document.wants_to_run:
            self._window.status.say("The solver is starting.")
        elif self._anchors_wait(snapshot):
            self._window.status.say("The solver rests: Space runs it, and the map follows the anchors.")
        else:
            self._window.status.say(
                "At rest. Space runs; a click sets an anchor, Alt+click those of a whole face; drag anchors in the target."
            )

    def _tell_what_unfolds(self, is_stuck: bool) -> None:
        """The status line has no room for what to do, and shows a tip while the pointer is on Run."""
        bar, sentence = self._window.error_bar, in_window_words(Status.INVERTED_START.value)
        if is_stuck:
            bar.show_message(sentence)
        elif not bar.isHidden() and bar.sentence.text() == sentence:
            bar.dismiss()

    def _anchors_wait(self, snapshot: Snapshot) -> bool:
        """Whether anchors were moved away from a map that rests: dragging alone does not run the solver."""
        mesh = self._document.mesh
        return snapshot.phase == "idle" and mesh is not None and snapshot.row.anchor_error > APART * mesh.diameter

    def show_numbers(self) -> None:
        """Bring the numbers of the status bar up to date."""
        snapshot, status = self._document.snapshot, self._window.status
        if snapshot is None:
            status.clear_numbers()
            status.show_field("state", "" if self._is_ready else "starting")
            self._window.target.caption.setText("")
            return
        self._say_that_it_lasts()
        row = snapshot.row
        is_moving = snapshot.phase in ("running", "dragging")
        is_stale = self._document.is_at_work and snapshot.phase in ("idle", "finished")
        status.show_field("state", "running" if is_stale else snapshot.phase)
        status.show_field("iteration", f"iteration {row.iteration}")
        status.show_field("rate", f"{self.rate_meter.rate():.0f} it/s" if is_moving else "")
        status.show_number("mean", row.mean_distortion, "mean D {:.5g}")
        status.show_tip("mean", f"Mean distortion: the energy, {row.energy:.12g}, over the total measure of the source")
        status.show_field("inverted", f"{row.inverted} inverted")
        delay = self.drag_meter.recent
        status.show_field("delay", f"drag {delay:.0f} ms" if delay is not None else "")
        count = len(self._document.anchors)
        self._window.target.caption.setText(f"{count} anchor{'s' * (count != 1)}" if count else "no anchors")

    def _say_that_it_lasts(self) -> None:
        """A step that takes seconds may be hard work or a loop without end: the user knows better."""
        if not self._document.is_at_work:
            self._last_news = time.monotonic()
            return
        seconds = time.monotonic() - self._last_news
        if seconds >= LONG_STEP and not self._document.opening_source:
            self._said = ""
            self._window.status.say(f"The solver has been at one step for {seconds:.0f} s. Stop ends it if it hangs.")

    def _drag_sent(self, serial: int, at: float) -> None:
        self.drag_meter.sent(serial, at)
        if not self._document.wants_to_run:
            self._said = ""
            self._window.status.say("The solver is at rest: Run (Space) lets the map follow its anchors.")

    def _picture_sent(self, serial: int) -> None:
        self._drawn_serial = serial

    def _picture_drawn(self) -> None:
        self.drag_meter.drawn(self._drawn_serial)

    # ------------------------------------------------------------------------------------------ buttons

    def show_running(self) -> None:
        """Run or Pause, and what can be done at all."""
        window, document = self._window, self._document
        has_mesh = document.mesh is not None
        self._is_shown_at_work = document.is_at_work
        show_running(window.actions_by_name["run"], document.is_at_work, window.theme)
        for name in ("run", "step", "reset", "save", "refine", "pin", "box", "clear", "fit"):
            window.actions_by_name[name].setEnabled(has_mesh)


def source_name(source: str) -> str:
    """What a person calls a source: the file's name, or the sample's."""
    if is_sample(source):
        try:
            return sample_label(source.removeprefix(SAMPLE))
        except WorkbenchError:
            return source.removeprefix(SAMPLE)
    return Path(source).name


def in_window_words(sentence: str) -> str:
    """A sentence of the engine without the options of the command line: here a button or a key stands for them."""
    sentence = re.sub(r"[;,]\s*apply --fix [a-z,]+( \([a-z ]+\) or --fix [a-z,]+)?", "", sentence)
    sentence = sentence.replace("symmetric-dirichlet-filtered", "Symmetric Dirichlet, filtered barrier")
    sentence = re.sub(r"raise --[a-z-]+ to go on", "run again to go on", sentence)
    return re.sub(rf"^{SAMPLE}([a-z0-9-]+)", lambda found: source_name(found.group(0)), sentence)


def counted(number: int) -> str:
    """A count with thin spaces between the thousands."""
    return f"{number:,}".replace(",", "\u2009")
