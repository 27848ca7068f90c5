"""Who goes along with anchors that are held: the user's choice of mirror and falloff, and what follows from it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy
from PySide6.QtCore import QObject, Signal

from workbench.app.document.anchor_set import AnchorSet
from workbench.app.document.document import Document
from workbench.app.handling.reflection import Reflection, Twins, fitted_reflection, found_plane, planes_of_box
from workbench.app.handling.train import Train, falloff
from workbench.core.arrays import Floats, Integers
from workbench.core.edge_graph import EdgeGraph

FIRST_RADIUS = 0.2
"""Of the diameter of the source: how far a falloff reaches until somebody turns the wheel."""
WHEEL = 1.15
"""Factor on the radius for a step of the wheel."""
LEAST_PAIRS = 3


@dataclass(frozen=True)
class Customs:
    """What the user chose.

    `mirror` : "x", "y", "z" across the axis, or "found" for the plane that suits best; empty for none
    `has_falloff` : anchors near by follow, up to `reach` (of the source's diameter), `along_edges` or straight
    """

    mirror: str = ""
    has_falloff: bool = False
    along_edges: bool = True
    reach: float = FIRST_RADIUS


@dataclass(frozen=True, eq=False)
class Gathered:
    """Who goes along with some anchors.

    `anchors` : all there are, with the twins that were `made` (k,) for it;  `missing` : how many have no twin
    `held`, `twins` : vertices (k,), (l,);  `away`, `away_twins` : (n,) distances from them in the source, None without falloff
    """

    anchors: AnchorSet
    held: Integers
    twins: Integers
    made: Integers
    missing: int
    image: Reflection | None
    away: Floats | None
    away_twins: Floats | None

    def train(self, radius: float, also: Integers | None = None) -> Train:
        """Those that move where a falloff reaches as far as `radius`, in units of the source.

        `also` : (j,) anchors that have moved before: where it no longer reaches them they go back
        """
        if self.away is None:
            vertices = np.unique(np.concatenate([self.held, self.twins]))
            shares, mirrored = (np.isin(vertices, chosen).astype(np.float64) for chosen in (self.held, self.twins))
        else:
            vertices = self.anchors.vertices
            shares = falloff(self.away[vertices], radius)
            mirrored = np.zeros_like(shares) if self.away_twins is None else falloff(self.away_twins[vertices], radius)
            moves = shares + mirrored > 0.0
            if also is not None:
                moves |= np.isin(vertices, also)
            vertices, shares, mirrored = vertices[moves], shares[moves], mirrored[moves]
        return Train(vertices, self.anchors.targets_of(vertices), shares, mirrored, self.image)


class Company(QObject):
    """Finds them, on the mesh of a document; tables of the mesh are made once."""

    changed = Signal()
    """The user chose otherwise, or the mesh is another one"""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self._document = document
        self.customs = Customs()
        document.opened.connect(self._forget)
        self._forget()

    def _forget(self) -> None:
        self._graph: EdgeGraph | None = None
        self._tree: scipy.spatial.cKDTree | None = None
        self._planes: dict[str, Reflection] = {}
        self._pairs: tuple[str, Integers] | None = None
        self.changed.emit()

    def choose(self, **changes: object) -> None:
        """Take other customs."""
        customs = replace(self.customs, **changes)  # type: ignore[arg-type]
        if customs != self.customs:
            self.customs = customs
            self.changed.emit()

    @property
    def radius(self) -> float:
        """How far a falloff reaches, in units of the source."""
        mesh = self._document.mesh
        return 0.0 if mesh is None else self.customs.reach * mesh.diameter

    def widen(self, steps: float) -> None:
        """Let a falloff reach farther, or, for negative `steps` of the wheel, less far."""
        self.choose(reach=float(np.clip(self.customs.reach * WHEEL**steps, 1e-4, 10.0)))

    # ------------------------------------------------------------------------------------------ symmetry

    @property
    def plane(self) -> Reflection | None:
        """The symmetry of the source that was chosen; None without one, or where the source has no such axis."""
        mesh, name = self._document.mesh, self.customs.mirror
        if mesh is None or not name:
            return None
        if not self._planes:
            self._planes = planes_of_box(mesh.vertices)
        if name == "found" and name not in self._planes:
            self._planes[name] = found_plane(mesh.vertices)
        return self._planes.get(name)

    def image(self) -> Reflection | None:
        """The same symmetry of the map: that of the source, or, in another dimension, the one that suits its pairs best."""
        mesh, positions, plane = self._document.mesh, self._document.positions, self.plane
        if mesh is None or positions is None or plane is None:
            return None
        if positions.shape[1] == len(plane.normal):
            return plane
        others = self._all_twins(plane)
        has_one = np.flatnonzero((others >= 0) & (others != np.arange(len(others))))
        return fitted_reflection(positions[has_one], positions[others[has_one]]) if len(has_one) >= LEAST_PAIRS else None

    def symmetry(self) -> float:
        """Part of the vertices, in [0, 1], that have a mirror twin."""
        plane = self.plane
        return 0.0 if plane is None else float(np.mean(self._all_twins(plane) >= 0))

    def _all_twins(self, plane: Reflection) -> Integers:
        """(n,) the twin of every vertex, -1 where there is none."""
        twins = self._twins(plane)
        if self._pairs is None or self._pairs[0] != self.customs.mirror:
            self._pairs = (self.customs.mirror, twins.of(np.arange(twins.count)))
        return self._pairs[1]

    def _twins(self, plane: Reflection) -> Twins:
        mesh = self._document.mesh
        assert mesh is not None
        if self._tree is None:
            self._tree = scipy.spatial.cKDTree(mesh.vertices)
        return Twins(mesh.vertices, plane, self._tree)

    # ------------------------------------------------------------------------------------------ gathering

    def gather(self, anchors: AnchorSet, held: Integers) -> Gathered:
        """Who goes along with the anchors `held` (k,); twins that are no anchors yet are made where they are now."""
        plane, positions, customs = self.plane, self._document.positions, self.customs
        image, none = self.image(), np.empty(0, np.int64)
        found = self._twins(plane).of(held) if plane is not None and image is not None else none
        twins = np.unique(found[found >= 0])
        made = np.array([t for t in twins.tolist() if t not in anchors], dtype=np.int64)
        if len(made) and positions is not None:
            anchors = anchors.joined(AnchorSet.at(made, positions))
            anchors = anchors.grouped(made) if len(made) > 1 else anchors
            for vertex, twin in zip(held.tolist(), found.tolist(), strict=True):
                if twin in made and vertex in anchors.weights:  # soft as what it mirrors
                    anchors = anchors.weighted([twin], anchors.weights[vertex])
        twins = np.unique(anchors.together_with(twins.tolist()))  # a group is not torn apart by its mirror twin
        away = self._distances(held) if customs.has_falloff else None
        away_twins = self._distances(twins) if customs.has_falloff and len(twins) else None
        missing = int(np.count_nonzero(found < 0))
        return Gathered(anchors, held, twins, made, missing, image if len(twins) else None, away, away_twins)

    def _distances(self, starts: Integers) -> Floats:
        """(n,) in the source, from the nearest of `starts` (k,)."""
        mesh = self._document.mesh
        assert mesh is not None
        if not self.customs.along_edges:
            return np.asarray(scipy.spatial.cKDTree(mesh.vertices[starts]).query(mesh.vertices)[0])
        if self._graph is None:
            self._graph = EdgeGraph(mesh.vertices, mesh.simplices)
        return self._graph.distances(starts)
