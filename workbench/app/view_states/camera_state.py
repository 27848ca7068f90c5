"""A camera as plain values in the units of the mesh, so that it finds its place in any other display of the same mesh."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from workbench.app.views.camera import ViewCamera
from workbench.app.views.mesh_view import MeshView

FARTHEST = 1e4
"""Units of the display, in which a mesh has diameter 1: nothing can be seen from beyond."""


def camera_state(view: MeshView) -> dict[str, Any]:
    """From where a view is looked at; only how it is turned where it shows everything."""
    geometry, camera = view.geometry_shown, view.camera
    turned = {"axes": [[float(entry) for entry in line] for line in camera.axes]}
    if geometry is None or view.shows_everything:
        return turned
    frame = geometry.frame
    focal = [float(entry) for entry in frame.from_display(camera.focal)]
    return turned | {"focal": focal, "half_height": float(camera.half_height / frame.scale)}


def take_camera_state(view: MeshView, state: Mapping[str, Any]) -> None:
    """Look from there; a figure is looked at from the front, whatever the state says."""
    geometry = view.geometry_shown
    if geometry is None or "axes" not in state:
        return
    axes = np.eye(3) if geometry.is_flat else np.asarray(state["axes"], dtype=np.float64)
    frame, focal = geometry.frame, state.get("focal")
    if focal is None or len(focal) != len(frame.centre):
        view.camera = ViewCamera(axes=axes)
        view.fit()
        return
    place = np.clip(frame.to_display(np.asarray([focal], dtype=np.float64))[0], -FARTHEST, FARTHEST)
    view.set_camera(ViewCamera(place, axes, float(np.clip(state["half_height"] * frame.scale, 1e-7, FARTHEST))))
