"""The start of a surface whose file holds a map of it already: an artist's texture coordinates are seen as they are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from workbench.app.first_anchors import is_sample
from workbench.core.jacobians import build_elements, determinants
from workbench.core.seams import texture_at_vertices
from workbench.engine.messages import Loaded
from workbench.session.session import Session


def has_own_map(session: Session) -> bool:
    """Whether the start is the map that the mesh's own file holds."""
    return session.initializer == "file" and bool(session.source) and session.start_file == session.source


def with_own_start(loaded: Loaded, session: Session) -> Session:
    """The choices with the file's own map as the start, where it has one that leaves every triangle an area."""
    if loaded.kind != "parameterize" or is_sample(session.source):
        return session
    positions = texture_at_vertices(loaded.mesh)
    if positions is None or not np.abs(determinants(build_elements(loaded.mesh), positions)).min() > 0:
        return session
    return replace(session, initializer="file", start_file=session.source)
