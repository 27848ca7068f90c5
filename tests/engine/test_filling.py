"""Filling closed surfaces: what is refused, limits, and the solid that comes of it."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

from workbench.core.errors import MeshError, WorkbenchError
from workbench.core.fillable import check_fillable
from workbench.core.injectivity import global_injectivity
from workbench.core.mesh import Mesh
from workbench.core.samples import make_sample
from workbench.engine import filling
from workbench.engine.filling import FillCancelledError, FillOptions, can_fill, fill_surface

needs_mesher = pytest.mark.skipif(not can_fill(), reason="the extra `fill` is not installed")


def moved(first: Mesh, second: Mesh, shift: tuple[float, float, float], scale: float = 1.0) -> Mesh:
    """Two surfaces in one mesh."""
    vertices = np.vstack([first.vertices, scale * second.vertices + shift])
    return Mesh(vertices, np.vstack([first.simplices, second.simplices + first.vertex_count]), "two")


@pytest.mark.parametrize("id", ["blob", "torus"])
def test_closed_surfaces_can_be_filled(id: str) -> None:
    check_fillable(make_sample(id))


def test_what_bounds_no_solid_is_refused_in_a_sentence(cube: Mesh) -> None:
    blob = make_sample("blob")
    small = make_sample("blob", 300)
    turned = blob.simplices.copy()
    turned[7] = turned[7, ::-1]
    for mesh, words in (
        (cube, "tetrahedra already"),
        (make_sample("gingerbread"), "in the plane"),
        (make_sample("fingers"), "open, with 1 boundary loop,"),
        (Mesh(blob.vertices, blob.simplices[1:]), "open"),
        (Mesh(blob.vertices, turned), "oriented alike"),
        (moved(small, small, (0.5, 0.2, 0.1)), "meets itself"),
    ):
        with pytest.raises(MeshError, match=words):
            check_fillable(mesh)
    check_fillable(moved(small, small, (0.0, 0.0, 0.0), 0.5))  # a cavity
    check_fillable(moved(small, small, (4.0, 0.0, 0.0)))


def test_without_the_mesher_the_command_that_installs_it_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(filling, "can_fill", lambda: False)
    with pytest.raises(WorkbenchError, match=r"pip install .*\[fill\]"):
        fill_surface(make_sample("blob", 300))


def test_edge_lengths_that_do_not_fit_are_refused_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(filling, "can_fill", lambda: True)
    blob = make_sample("blob", 300)
    for edge_length, words in ((1e-4, "ask for edges of at least"), (99.0, "does not fit"), (-1.0, "does not fit")):
        with pytest.raises(WorkbenchError, match=words):
            fill_surface(blob, FillOptions(edge_length=edge_length))


@needs_mesher
def test_a_filled_blob_is_a_solid_of_its_volume(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    blob = make_sample("blob", 800)
    said: list[str] = []
    solid = fill_surface(blob, FillOptions(edge_length=0.5), tell=said.append)
    assert solid.dimension == 3 and said
    topology = solid.topology
    assert topology.is_manifold and topology.component_count == 1 and not len(topology.negative)
    assert global_injectivity(solid, solid.vertices).holds is True
    inside = float(np.linalg.det(blob.vertices[blob.simplices]).sum())
    corners = solid.vertices[solid.simplices]
    assert np.linalg.det(corners[:, 1:] - corners[:, :1]).sum() == pytest.approx(inside, rel=0.02)
    assert not list(tmp_path.iterdir()), "the mesher leaves nothing where one works"


@needs_mesher
def test_filling_ends_at_its_limits_and_leaves_no_child() -> None:
    import multiprocessing

    blob = make_sample("blob")
    begin = time.monotonic()
    with pytest.raises(WorkbenchError, match=r"more than 0\.5 s"):
        fill_surface(blob, FillOptions(edge_length=0.05, time_limit=0.5))
    with pytest.raises(FillCancelledError):
        fill_surface(blob, FillOptions(edge_length=0.05), cancelled=lambda: True)
    with pytest.raises(WorkbenchError, match="memory"):
        fill_surface(blob, FillOptions(edge_length=0.05, memory_limit=-(2**31) + 2**26))
    assert time.monotonic() - begin < 200.0  # a bound, not a measurement: it would take minutes more
    assert not [child for child in multiprocessing.active_children() if child.name == "workbench-fill"]
