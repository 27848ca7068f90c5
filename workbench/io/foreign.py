"""MEDIT, Gmsh, VTK and VTU through meshio, behind a guard.

meshio ends the program, prints, or raises anything at all on files that it cannot read; here every such end is a
`MeshError`, and nothing is printed.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import re
import tempfile
import threading
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.errors import MeshError
from workbench.core.mesh import Mesh
from workbench.io.linear_elements import Blocks, is_of_higher_order, linear_blocks, without_inner_vertices
from workbench.io.medit import read_medit_words
from workbench.io.memory_limit import limited_memory
from workbench.io.mesh_file import finite_rows, mesh_of_file
from workbench.io.polygons import fan
from workbench.io.vtk_legacy import read_vtk_legacy

FORMATS = {
    ".mesh": ("medit", "MEDIT"),
    ".meshb": ("medit", "MEDIT"),
    ".msh": ("gmsh", "Gmsh"),
    ".vtk": ("vtk", "VTK"),
    ".vtu": ("vtu", "VTU"),
}
"""Ending -> module of meshio, name for people."""

OWN = {".vtk": read_vtk_legacy, ".mesh": read_medit_words}
"""Readers of our own for what meshio cannot read: bytes -> points, elements."""
FLAT_CELLS = ("triangle", "quad", "polygon")
IGNORED_CELLS = ("vertex", "line", "line3")
NOT_READ = {
    b"vtkLZ4DataCompressor": "it is compressed by LZ4; save it with ZLib or without compression",
    b"TetrahedraP2": "its elements are of higher order, and maps are linear on each simplex; export it with order 1",
}
"""Marks of what meshio does not know, and what to do."""
ENTITIES = re.compile(rb"\$Entities\b.*?\$EndEntities\s*", re.DOTALL)
"""The part of a Gmsh file that says which groups its parts are in."""
_one_at_a_time = threading.RLock()
"""The console is of the whole process: of two threads that silence it, the later would put back the silence of the other."""


def read_foreign(path: Path, data: bytes, *, linearise: bool = False) -> tuple[Mesh, tuple[str, ...], Floats | None]:
    """The tetrahedra of a file where it has any, else its triangles (polygons are fanned), notes, and a map.

    There is a map where the points have a field `source`, as `write_map` makes it: these are the vertices then, and the
    map is where the points are. With `linearise`, elements of higher order become linear ones on their corners; their
    other vertices are dropped.
    """
    module, name = FORMATS[path.suffix.lower()]
    content = _read(path, str(path), module, len(data))
    if content is None and name == "Gmsh" and ENTITIES.search(data):
        # meshio refuses files of which some parts are in physical groups and some are not: read it without the groups
        with tempfile.TemporaryDirectory() as folder:
            plain = Path(folder) / path.name
            plain.write_bytes(ENTITIES.sub(b"", data, count=1))
            content = _read(path, str(plain), module, len(data))
    reason = next((words for mark, words in NOT_READ.items() if mark in data), "")
    if content is None and not reason and path.suffix.lower() in OWN:
        with contextlib.suppress(ValueError, OverflowError, LookupError, MemoryError), np.errstate(all="ignore"):
            content = (*OWN[path.suffix.lower()](data), 0, None)
    if content is None:
        raise MeshError(f"{path}: it cannot be read as {name}; {reason or 'it is damaged, cut short, or of another format'}.")
    points, blocks, regions, source = content
    if points.ndim != 2 or not len(points) or points.dtype.kind not in "fiu":
        raise MeshError(f"{path}: there are no vertices in it; is it cut short?")
    blocks, inner = linear_blocks(blocks) if linearise else (blocks, np.empty(0, dtype=np.int64))
    has_map = source is not None and not len(inner)
    mesh, notes = _mesh_of_blocks(path, source if has_map else points, blocks)
    if len(inner):
        mesh, note = without_inner_vertices(mesh, inner)
        notes = (note, *notes)
    if regions > 1:
        notes += (f"The {regions} regions that the file marks were taken as one mesh.",)
    if not has_map:
        return mesh, notes, None
    notes += ("The field `source` was taken for the source, and the points for a map of it.",)
    return mesh, notes, finite_rows(path, "of its points", points, len(points), (3,))


def _read(path: Path, place: str, module: str, size: int) -> tuple[Any, Blocks, int, Any] | None:
    """Points, elements, count of regions and field `source` of the file at `place`; None where meshio cannot read it."""
    with silenced(), np.errstate(all="ignore"), limited_memory(size):
        try:
            content = importlib.import_module(f"meshio.{module}").read(place)
            blocks = [(str(block.type), block.data) for block in content.cells]
            points = np.asarray(content.points)
            return points, blocks, _region_count(content), _source_of(content, points)
        except MemoryError:
            raise MeshError(f"{path}: it asks for far more memory than its size warrants; a number in it is damaged.") from None
        except (Exception, SystemExit):
            return None


def _mesh_of_blocks(path: Path, points: Any, blocks: Blocks) -> tuple[Mesh, tuple[str, ...]]:
    kinds = {kind for kind, data in blocks if len(data)}
    _refuse_unknown(path, kinds)
    if "tetra" in kinds:
        simplices = np.concatenate([_table(path, data) for kind, data in blocks if kind == "tetra" and len(data)])
        left_out = sorted(kinds & {*FLAT_CELLS, "wedge", "pyramid", "hexahedron"})
        notes = (f"Only the tetrahedra were taken; left out: {', '.join(left_out)}.",) if left_out else ()
        return mesh_of_file(path, points, simplices), notes
    return _surface(path, points, [(kind, data) for kind, data in blocks if kind in FLAT_CELLS and len(data)])


@contextlib.contextmanager
def silenced() -> Any:
    """Nothing that runs inside reaches the console, warnings included. One thread at a time; others wait."""
    with _one_at_a_time, warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
        warnings.simplefilter("ignore")
        with contextlib.redirect_stderr(io.StringIO()):
            yield


def _refuse_unknown(path: Path, kinds: set[str]) -> None:
    known = {*FLAT_CELLS, *IGNORED_CELLS, "tetra"}
    higher = sorted(kind for kind in kinds - known if is_of_higher_order(kind))
    if higher:
        raise MeshError(
            f"{path}: it holds elements of higher order ({', '.join(higher)}), and maps are linear on each simplex; "
            f"export the mesh with linear elements (order 1), or take their corners alone, apply --fix linearise.",
            fixes=("linearise",),
        )
    if "tetra" not in kinds and not kinds & set(FLAT_CELLS):
        found = ", ".join(sorted(kinds)) or "none"
        raise MeshError(f"{path}: there are no triangles or tetrahedra in it (elements found: {found}); save them, too.")
    solid = sorted(kinds - known)
    if solid:
        raise MeshError(f"{path}: it holds {', '.join(solid)}, and only triangles and tetrahedra are read; split them.")


def _source_of(content: Any, points: Any) -> Any:
    """Where the points are in the source, (n, 3); None where the file does not say."""
    source = content.point_data.get("source")
    is_table = source is not None and np.shape(source) == points.shape == (len(points), 3)
    return np.asarray(source) if is_table and np.asarray(source).dtype.kind == "f" else None


def _region_count(content: Any) -> int:
    """How many different regions the tetrahedra are marked with; 0 where they are not marked."""
    marks = [
        np.asarray(values)
        for name in ("gmsh:physical", "medit:ref", "RegionId", "MaterialIds")
        for block, values in zip(content.cells, content.cell_data.get(name, ()), strict=False)
        if str(block.type).startswith("tetra") and len(block.data)
    ]
    return len(np.unique(np.concatenate(marks))) if marks else 0


def _surface(path: Path, points: Any, blocks: Blocks) -> tuple[Mesh, tuple[str, ...]]:
    faces: list[list[int]] = []
    tables = []
    for _, data in blocks:
        if isinstance(data, np.ndarray) and data.ndim == 2:
            tables.append(_table(path, data))
        else:
            faces += [np.asarray(face, dtype=np.int64).tolist() for face in data]
    sizes = np.concatenate([np.full(len(table), table.shape[1]) for table in tables] + [[len(f) for f in faces]])
    sizes = sizes.astype(np.int64)
    corners = np.concatenate([table.ravel() for table in tables] + [np.array(f, dtype=np.int64) for f in faces])
    if sizes.min() < 3:
        raise MeshError(f"{path}: a face has fewer than three corners; the file is damaged.")
    triangles_of, polygons = fan(sizes)
    triangles = corners[triangles_of]
    fanned = polygons if sizes.max() > 3 else None
    notes = () if fanned is None else (f"{int((sizes > 3).sum())} polygons were fanned into triangles.",)
    return mesh_of_file(path, points, triangles, polygons=fanned), notes


def _table(path: Path, data: Any) -> Integers:
    table = np.asarray(data)
    if table.ndim != 2 or table.dtype.kind not in "iu":
        raise MeshError(f"{path}: the table of its elements is damaged.")
    return table.astype(np.int64)
