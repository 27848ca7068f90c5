"""The anchors that a mesh comes with, when it is opened."""

from __future__ import annotations

import numpy as np

from workbench.app.document.anchor_set import AnchorSet
from workbench.core.anchor_motion import anchor_groups
from workbench.core.arrays import Floats, Integers
from workbench.core.errors import WorkbenchError
from workbench.core.samples import sample_info
from workbench.engine.messages import Loaded
from workbench.io.opening import SAMPLE


def is_sample(source: str) -> bool:
    """Whether a source is a mesh of our own generator."""
    return source.startswith(SAMPLE)


def first_anchors(loaded: Loaded, source: str, start: Floats) -> AnchorSet:
    """Anchors that the file or the sample comes with; without targets they hold the start (n, d) where it is."""
    vertices, targets = loaded.anchor_vertices, loaded.anchor_targets
    if vertices is None and is_sample(source):
        vertices = sample_anchors(source.removeprefix(SAMPLE))
    if vertices is None or not len(vertices):
        return AnchorSet.none()
    anchors = AnchorSet.at(vertices, start) if targets is None else AnchorSet.to(vertices, targets)
    if loaded.kind == "volume":  # faces that are anchored as a whole move as a whole
        for rows in anchor_groups(loaded.mesh.simplices, vertices):
            anchors = anchors.grouped(vertices[rows]) if len(rows) > 1 else anchors
    return anchors


def sample_anchors(id: str) -> Integers | None:
    """Vertices (k,) that a sample comes with; None where the sample is not known."""
    try:
        return np.array(sample_info(id).anchors, dtype=np.int64)
    except WorkbenchError:
        return None
