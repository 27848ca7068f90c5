"""What the document tells the engine, numbered so that an answer can be told from one to an earlier order."""

from __future__ import annotations

from dataclasses import replace

from workbench.app.document.anchor_set import AnchorSet
from workbench.app.document.engine_bridge import EngineBridge
from workbench.app.sessions.restoring import Wanted
from workbench.engine.messages import Reset, Run, SetAnchors, Watch
from workbench.engine.session_commands import problem_command, solver_command, take_up
from workbench.session.session import Session


def held_anchors(anchors: AnchorSet, dimension: int) -> SetAnchors:
    """Those of the anchors that are in force, for an engine."""
    held = anchors.in_force
    return SetAnchors(held.vertices, held.target_array(dimension), held.weight_array, groups=held.group_numbers)


class Orders:
    """Turns choices into commands and posts them; the newest serials are kept here."""

    def __init__(self, bridge: EngineBridge) -> None:
        self._bridge = bridge
        self.problem_serial = 0
        self.anchor_serial = 0
        self._watched = Watch()

    def problem(self, session: Session) -> None:
        self.problem_serial += 1
        self._bridge.post(problem_command(session, self.problem_serial))

    def solver(self, session: Session) -> None:
        self._bridge.post(solver_command(session))

    def choices(self, session: Session) -> None:
        """Problem and solver, ahead of a mesh."""
        self.problem(session)
        self.solver(session)

    def choices_unheard(self) -> None:
        """The default ones ahead of a mesh; nobody need hear that the map which goes does not suit them."""
        self.choices(Session())
        self.problem_serial += 1

    def anchors(self, anchors: AnchorSet, dimension: int, dragging: bool) -> None:
        self._bridge.post(replace(held_anchors(anchors, dimension), serial=self.anchor_serial, dragging=dragging))

    def number_anew(self) -> None:
        """What is under way answers something else from now on."""
        self.problem_serial, self.anchor_serial = self.problem_serial + 1, self.anchor_serial + 1

    def take_up(self, wanted: Wanted, generation: int) -> None:
        """Choices, anchors and map at once, under the present numbers; the counts go on where the curves end."""
        assert wanted.positions is not None
        command = take_up(wanted.session, wanted.positions, generation, self.anchor_serial, self.problem_serial)
        if wanted.curves is not None:
            command = replace(command, iteration=wanted.curves.iteration, seconds=wanted.curves.seconds)
        self._bridge.post(command)

    def start(self, session: Session) -> None:
        parameters = dict(session.initializer_parameters)
        self._bridge.post(Reset(session.initializer, parameters, session.start_file, session.match_area))

    def run(self, session: Session) -> None:
        self._bridge.post(Run(session.iterations, session.tolerance, session.time_limit))

    def watch(self, wanted: Watch) -> None:
        if wanted != self._watched:
            self._watched = wanted
            self.watch_again()

    def watch_again(self) -> None:
        self._bridge.post(self._watched)
