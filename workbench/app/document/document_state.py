"""What the window is about at this moment: the choices, the mesh, its anchors, the newest map, and what is selected."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QObject, Signal

from workbench.app.document.anchor_set import AnchorSet
from workbench.app.sessions.restoring import with_anchors
from workbench.core.arrays import Floats, Integers
from workbench.core.mesh import Mesh
from workbench.engine.messages import Loaded, Snapshot
from workbench.session.session import Session


class DocumentState(QObject):
    """Session, mesh, newest snapshot and selection, for whoever shows them; signals tell what changed."""

    changing = Signal(str, str)
    """The user is about to change something: what it is called, and a key that quick changes of one kind share."""
    session_changed = Signal()
    opening = Signal(str)
    opened = Signal()
    anchors_changed = Signal()
    selection_changed = Signal()
    snapshot_taken = Signal()
    shown_changed = Signal()
    """Views have another map to show: the newest, or an earlier one while somebody looks back."""
    history_restarted = Signal()
    curves_returned = Signal(object)
    """An earlier map is back, and these are the `Curves` that led to it."""
    drag_sent = Signal(int, float)
    refused = Signal(object)
    dissected = Signal(object)

    def __init__(self, session: Session | None = None) -> None:
        super().__init__()
        self.session = session or Session()
        self.generation = 0
        self.loaded: Loaded | None = None
        self.snapshot: Snapshot | None = None
        self._past: tuple[Snapshot, AnchorSet] | None = None
        self._taken_up: tuple[int, Floats] | None = None
        self.anchors = AnchorSet.none()
        self.selection: tuple[int, ...] = ()
        self.wants_to_run = False
        self._has_finished = False

    @property
    def mesh(self) -> Mesh | None:
        """The source; None while there is none, or where the window cannot show it."""
        return self.loaded.mesh if self.loaded is not None else None

    @property
    def kind(self) -> str:
        return self.loaded.kind if self.loaded is not None else ""

    @property
    def positions(self) -> Floats | None:
        """The newest map (n, d): one that was brought back counts before the engine has answered."""
        if self._taken_up is not None:
            return self._taken_up[1]
        return self.snapshot.positions if self.snapshot is not None else None

    @property
    def shown(self) -> Snapshot | None:
        """What views show: the newest map, or an earlier one. Whatever is done, is done to the newest."""
        return self._past[0] if self._past is not None else self.snapshot

    @property
    def shown_anchors(self) -> AnchorSet:
        return self._past[1] if self._past is not None else self.anchors

    def look_back(self, snapshot: Snapshot | None, anchors: AnchorSet | None = None) -> None:
        """Let views show an earlier map with its anchors; with None the newest, as it comes."""
        before = self._past
        self._past = None if snapshot is None else (snapshot, anchors or AnchorSet.none())
        if self.shown is not None and (before, self._past) != (None, None):
            self.shown_changed.emit()

    @property
    def complete_session(self) -> Session:
        """The session with its anchors."""
        return with_anchors(self.session, self.anchors)

    @property
    def is_running(self) -> bool:
        """Whether the user wants the solver to run; it may have finished meanwhile."""
        return self.wants_to_run

    @property
    def is_at_work(self) -> bool:
        """Whether the solver runs, or is about to, and has not said that it is done."""
        return self.wants_to_run and not self._has_finished

    # ------------------------------------------------------------------------------------------ selection

    @property
    def selected_anchors(self) -> Integers:
        """(k,) int64: the selected anchors and those that move with them."""
        return self.anchors.together_with(self.selection)

    @property
    def selected(self) -> int:
        """Vertex of the anchor that was selected last, -1 where none is."""
        return self.selection[-1] if self.selection else -1

    def select(self, vertex: int) -> None:
        """Select one anchor, or none (-1)."""
        self._select((vertex,) if vertex >= 0 else ())

    def select_all(self, vertices: Iterable[int]) -> None:
        """Select several: those of `vertices` that are anchors."""
        self._select(tuple(int(v) for v in vertices if v in self.anchors))

    def _select(self, selection: tuple[int, ...]) -> None:
        if selection != self.selection:
            self.selection = selection
            self.selection_changed.emit()
