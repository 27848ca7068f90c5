"""The distortion that the inspector is about: the one in force, resolved only when somebody looks."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from workbench.app.document.document import Document
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.registry import Registry

Key = tuple[str, tuple[tuple[str, float], ...], int]
"""Formula, parameter values, dimension: all that a result depends on."""


class Subject(QObject):
    """The document's distortion with its parameters, in dimension 2 or 3; `changed` says that it may be another."""

    changed = Signal()

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self._document = document
        self._dimension = 0
        self._seen: Key | None = None
        self._distortion: Distortion | None = None
        self._sentence = ""
        self.registry: Registry | None = None
        document.session_changed.connect(self._session_changed)
        document.opened.connect(self._opened)

    def set_registry(self, registry: Registry) -> None:
        """The methods were found; before that nothing can be resolved."""
        self.registry = registry
        self._seen = None
        self.changed.emit()

    @property
    def dimension(self) -> int:
        """That of the mesh, until another one is chosen."""
        mesh = self._document.mesh
        return self._dimension or (mesh.dimension if mesh is not None else 2)

    @dimension.setter
    def dimension(self, dimension: int) -> None:
        if dimension != self.dimension:
            self._dimension = dimension
            self.changed.emit()

    @property
    def distortion(self) -> Distortion | None:
        """None where the choice is no distortion; `sentence` says why."""
        self._resolve()
        return self._distortion

    @property
    def sentence(self) -> str:
        self._resolve()
        return self._sentence

    @property
    def key(self) -> Key:
        """What tells two subjects apart; empty where there is none."""
        item = self.distortion
        if item is None:
            return ("", (), self.dimension)
        return (item.formula, tuple(sorted(item.parameter_values.items())), self.dimension)

    def _opened(self) -> None:
        self._dimension = 0  # that of the new mesh
        self.changed.emit()

    def _choice(self) -> Key:
        session = self._document.session
        return session.distortion, tuple(sorted(session.distortion_parameters.items())), self.dimension

    def _session_changed(self) -> None:
        if self._choice() != self._seen:
            self.changed.emit()

    def _resolve(self) -> None:
        choice = self._choice()
        if choice == self._seen or self.registry is None:
            return
        self._seen = choice
        self._distortion, self._sentence = None, ""
        try:
            item = Distortion.resolve(choice[0], dict(choice[1]))
            item.compiled(self.dimension)
            self._distortion = item
        except WorkbenchError as error:
            self._sentence = error.sentence
