"""How the solid of a document is looked at, now: the look, what it needs of each map, what is drawn."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject, Signal

from workbench.app.document.document import Document
from workbench.app.quantities.quantities import IN_FORCE
from workbench.app.quantities.quantity_book import QuantityBook
from workbench.app.simplex_brush import SimplexBrush
from workbench.core.solid_look.drawn_faces import DrawnFaces, drawn_faces
from workbench.core.solid_look.look import AXES, VolumeLook
from workbench.core.solid_look.solid import Solid
from workbench.session.schema import LARGEST_COORDINATE

OWNER = "peel"
"""Name under which the quantity to peel by is watched."""


class VolumeView(QObject):
    """One look for all views of the window; `changed` tells that it is another one, `opened` that there is another mesh."""

    changed = Signal()
    opened = Signal()

    def __init__(self, document: Document, book: QuantityBook, brush: SimplexBrush) -> None:
        super().__init__(document)
        self._document = document
        self._book = book
        self._brush = brush
        self.look = VolumeLook()
        self.solid: Solid | None = None
        self.peel_by = IN_FORCE.id
        self.peeled = 0.0
        self._waits_for_values = False
        self._drawn: DrawnFaces | None = None
        self._drawn_for: tuple[object, ...] = ()
        document.snapshot_taken.connect(self._peel_when_known)
        brush.changed.connect(self._brushed)
        book.listed.connect(self._offer)

    @property
    def is_on(self) -> bool:
        """Whether there is a solid to look into."""
        return self.solid is not None

    # ------------------------------------------------------------------------------------------ what is drawn

    def begin(self) -> None:
        """Another mesh: its solid is whole at first."""
        loaded = self._document.loaded
        assert loaded is not None
        is_solid = loaded.mesh.dimension == 3
        self.solid = Solid(loaded.mesh, loaded.neighbours) if is_solid else None
        self._drawn = None if is_solid else drawn_faces(loaded.mesh.simplices)
        self._drawn_for = ()
        self.look = self.look.whole()
        self.peeled = 0.0
        self._waits_for_values = False
        self._watch()
        self.opened.emit()

    def faces(self) -> DrawnFaces:
        """What is drawn of the newest map; the same object while nothing else is to be seen."""
        if self.solid is not None:
            snapshot = self._document.shown
            number = snapshot.number if snapshot is not None and self.look.follows_map else -1
            marked = self._brush.simplices if self.look.only_marked else None
            needed = (replace(self.look, ghost=0.0, is_wired=False), number, marked if marked is None else marked.tobytes())
            if needed != self._drawn_for or self._drawn is None:
                self._drawn_for = needed
                positions = None if snapshot is None else snapshot.positions
                self._drawn = self.solid.faces(self.look, positions, self.values(), marked)
        assert self._drawn is not None
        return self._drawn

    def values(self) -> NDArray[Any] | None:
        """The quantity to peel by, where the newest map carries it: (m,) float32."""
        snapshot = self._document.shown
        if snapshot is None or self.peel_by not in self._book:
            return None
        found = snapshot.fields.get(self._book[self.peel_by].field)
        return found if isinstance(found, np.ndarray) else None

    # ------------------------------------------------------------------------------------------ choices

    def choose(self, **changes: Any) -> None:
        """Look in another way: fields of `VolumeLook`."""
        look = replace(self.look, **changes)
        if look != self.look:
            self.look = look
            self.changed.emit()

    def show_all(self) -> None:
        """Neither cut, peeled nor pulled apart."""
        self.peeled = 0.0
        self._watch()
        self.choose(is_cut=False, threshold=None, only_marked=False, spread=0.0)

    def peel(self, share: float) -> None:
        """Take away this share of the tetrahedra, those with least of the quantity; the value found so is held from then on."""
        self.peeled = min(max(share, 0.0), 1.0)
        self._waits_for_values = self.peeled > 0
        self._watch()
        if self.peeled > 0:
            self._peel_when_known()
        else:
            self.choose(threshold=None)

    def peel_by_quantity(self, id: str) -> None:
        """Peel by another quantity: the same share goes."""
        self.peel_by = id
        self.peel(self.peeled)

    # ------------------------------------------------------------------------------------------ memory

    def kept(self) -> dict[str, Any]:
        """What is there again at the next start, as plain values."""
        look = self.look
        return {
            "section": look.is_exact,
            "plane": "target" if look.cuts_target else "source",
            "veil": look.ghost,
            "wires": look.is_wired,
            "peel_by": self.peel_by,
        }

    def take_kept(self, kept: Mapping[str, Any]) -> None:
        """Take up what `kept` gave; values of another kind are passed over."""
        veil, peel_by = kept.get("veil"), kept.get("peel_by")
        is_number = isinstance(veil, int | float) and 0 <= veil <= 1
        self.choose(
            is_exact=kept.get("section") is True,
            cuts_target=kept.get("plane") == "target",
            is_wired=kept.get("wires") is True,
            ghost=float(veil) if is_number else VolumeLook.ghost,  # type: ignore[arg-type]
        )
        if isinstance(peel_by, str):
            self.peel_by = peel_by

    def _peel_when_known(self) -> None:
        values = self.values()
        if not self._waits_for_values or values is None:
            return
        self._waits_for_values = False
        finite = values[np.isfinite(values)]
        if len(finite):
            self.choose(threshold=float(np.quantile(finite, min(self.peeled, 1.0 - 1.0 / len(finite)))))

    def _offer(self) -> None:
        """The quantities are listed now: one that is no longer there is given up."""
        if self._book.is_listed and self.peel_by not in self._book:
            self.peel_by = IN_FORCE.id
        self._watch()

    def _watch(self) -> None:
        """Ask for the quantity to peel by while it is needed."""
        wanted = self.is_on and self.peeled > 0 and self.peel_by in self._book
        self._document.watch(OWNER, [self._book[self.peel_by]] if wanted else [])

    def _brushed(self) -> None:
        if self.look.only_marked and self.is_on:
            self.changed.emit()

    def seen(self) -> dict[str, Any]:
        """How this solid is looked into now, as plain values for its session; empty where it is seen whole."""
        look = self.look
        if not self.is_on or look.is_whole:
            return {}
        seen = self.kept() | {
            "cut": look.is_cut,
            "normal": [float(part) for part in look.normal],
            "place": float(look.place),
            "flipped": look.is_flipped,
            "peeled": float(self.peeled),
            "spread": float(look.spread),
        }
        if look.threshold is not None and abs(look.threshold) <= LARGEST_COORDINATE:
            seen["threshold"] = look.threshold
        return seen

    def see(self, seen: Mapping[str, Any]) -> None:
        """Look into the solid as checked values of `seen` say; what they do not name is as in a whole one."""
        if not self.is_on:
            return
        self.take_kept(self.kept() | dict(seen))
        normal = np.asarray(seen.get("normal", AXES["x"]), dtype=np.float64)
        length = float(np.linalg.norm(normal))
        x, y, z = (normal / length).tolist() if length > 0 else AXES["x"]
        self.choose(
            is_cut=seen.get("cut", False),
            normal=(x, y, z),
            place=seen.get("place", VolumeLook.place),
            is_flipped=seen.get("flipped", False),
            spread=seen.get("spread", 0.0),
        )
        self.peel(seen.get("peeled", 0.0))
        if self.peeled > 0 and "threshold" in seen:  # what was held, though the share of another map that it was found on
            self._waits_for_values = False
            self.choose(threshold=seen["threshold"])
