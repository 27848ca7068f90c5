"""The list of samples."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.errors import WorkbenchError
from workbench.core.mesh import Mesh
from workbench.core.method import Kind
from workbench.core.samples import closed, extrusion, figure, fingers, grids, salamander, solids


@dataclass(frozen=True)
class SampleInfo:
    """What is known about a sample.

    Parameters
    ----------
    id, label, description : str
    kind : Kind                  kind of map that it is meant for; a closed surface has to be cut first
    anchors : tuple of int       vertices that are sensible first anchors; empty where there are none
    simplex_count : int          at the default resolution, about
    fixes : tuple of str         fixes that `kind` needs
    """

    id: str
    label: str
    kind: Kind
    description: str
    anchors: tuple[int, ...]
    simplex_count: int
    fixes: tuple[str, ...] = ()


@dataclass(frozen=True)
class _Recipe:
    label: str
    kind: Kind
    description: str
    make: Callable[[int], tuple[Floats, Integers]]
    simplices: int
    places: tuple[tuple[float, ...], ...] = ()  # where the anchors are, on the sample
    fixes: tuple[str, ...] = ()
    least: int = 50  # simplices; with fewer, triangles are larger than what they shall show


_BAR_ENDS = ((0.0, 0.0), (0.0, 1.0), (4.0, 0.0), (4.0, 1.0))
_SOLID_ENDS = tuple((x, y, z) for x in (0.0, 4.0) for y in (0.0, 1.0) for z in (0.0, 1.0))

_RECIPES: dict[str, _Recipe] = {
    "gingerbread": _Recipe(
        "Gingerbread man",
        "plane",
        "A figure in the plane, with anchors in hands, feet and head: drag one.",
        figure.gingerbread,
        2500,
        figure.ANCHOR_PLACES,
    ),
    "bar": _Recipe("Bar", "plane", "A rectangle, four times as long as high, to bend and twist.", grids.bar, 2000, _BAR_ENDS),
    "annulus": _Recipe(
        "Annulus",
        "plane",
        "A ring in the plane: two boundary loops.",
        grids.annulus,
        2000,
        ((1.0, 0.0), (-1.0, 0.0)),
    ),
    "bumpy-disc": _Recipe(
        "Bumpy disc", "parameterize", "A disc with hills and hollows, to be flattened.", grids.bumpy_disc, 6000
    ),
    "fingers": _Recipe(
        "Hemisphere with fingers",
        "parameterize",
        "A half ball with five fingers: the tips shrink to specks in a Tutte start.",
        fingers.fingers,
        6000,
        least=1200,
    ),
    "hilbert": _Recipe(
        "Hilbert strip",
        "parameterize",
        "A long ribbon along a Hilbert curve (Fig. 11), a very bad Tutte start.",
        grids.hilbert_strip,
        8000,
    ),
    "blob": _Recipe(
        "Blob",
        "parameterize",
        "A closed surface of genus 0: cut it open to flatten it.",
        closed.blob,
        5000,
        fixes=("cut",),
    ),
    "torus": _Recipe(
        "Torus",
        "parameterize",
        "A closed surface of genus 1: cut it open to flatten it.",
        closed.torus,
        4000,
        fixes=("cut",),
    ),
    "salamander": _Recipe(
        "Salamander",
        "parameterize",
        "A closed surface that lies inside the solid bar, to be carried by its maps (Fig. 8); cut it open to flatten it.",
        salamander.salamander,
        6000,
        fixes=("cut",),
    ),
    "bar-3d": _Recipe("Solid bar", "volume", "A bar of tetrahedra, to bend and twist.", grids.solid_bar, 3000, _SOLID_ENDS),
    "ball": _Recipe("Ball", "volume", "A ball of tetrahedra.", closed.ball, 4320, ((1.0, 0.0, 0.0), (-1.0, 0.0, 0.0))),
    "beam-3d": _Recipe(
        "Beam with a hole",
        "volume",
        "A solid beam with a round hole through its middle: genus 1.",
        extrusion.beam_with_hole,
        5000,
        tuple((x, y, z) for x in (0.0, extrusion.BEAM[0]) for y in (0.0, extrusion.BEAM[1]) for z in (0.0, extrusion.BEAM[2])),
    ),
    "gingerbread-3d": _Recipe(
        "Solid gingerbread man",
        "volume",
        "The figure with round limbs, of tetrahedra, with anchors in hands, feet and head.",
        solids.solid_gingerbread,
        6000,
        solids.FIGURE_PLACES,
    ),
    "blob-3d": _Recipe(
        "Solid blob",
        "volume",
        "A rounded lump of tetrahedra, star-shaped: the start radial-stretch maps it onto a ball (Fig. 1).",
        solids.solid_blob,
        6000,
        solids.BLOB_PLACES,
    ),
}


def sample_ids() -> tuple[str, ...]:
    """Ids of all samples, the one to open first at the front."""
    return tuple(_RECIPES)


def sample_label(id: str) -> str:
    """Name of a sample, without making it."""
    return _recipe(id).label


def sample_kind(id: str) -> Kind:
    """Kind of map that a sample is meant for, without making it."""
    return _recipe(id).kind


def make_sample(id: str, triangles: int | None = None) -> Mesh:
    """A sample with about `triangles` triangles (tetrahedra), by default as many as suit it.

    The same call gives the same mesh, bit for bit. Raises `WorkbenchError` for an unknown id or a count out of range.
    """
    recipe = _recipe(id)
    count = recipe.simplices if triangles is None else int(triangles)
    if not recipe.least <= count <= 5_000_000:
        raise WorkbenchError(f"The sample {id} cannot be made of {count} simplices; ask for {recipe.least} to 5000000.")
    return _made(id, count)


@lru_cache(maxsize=16)
def _made(id: str, count: int) -> Mesh:
    recipe = _recipe(id)
    vertices, simplices = recipe.make(count)
    return Mesh(vertices, simplices, name=recipe.label)


@lru_cache(maxsize=32)
def sample_info(id: str, triangles: int | None = None) -> SampleInfo:
    """What is known about a sample; the anchors are vertices of `make_sample(id, triangles)`."""
    recipe = _recipe(id)
    anchors: tuple[int, ...] = ()
    if recipe.places:
        vertices = make_sample(id, triangles).vertices
        anchors = tuple(int(np.argmin(np.linalg.norm(vertices - place, axis=1))) for place in np.array(recipe.places))
    return SampleInfo(id, recipe.label, recipe.kind, recipe.description, anchors, recipe.simplices, recipe.fixes)


def _recipe(id: str) -> _Recipe:
    if id not in _RECIPES:
        raise WorkbenchError(f"There is no sample {id!r}; there are: {', '.join(_RECIPES)}.")
    return _RECIPES[id]
