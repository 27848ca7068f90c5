"""Cases: a mesh with a start and anchors, as `.npz` or as the `.mat` of the field."""

from __future__ import annotations

import io
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.errors import MeshError
from workbench.core.mesh import Mesh
from workbench.io.foreign import silenced
from workbench.io.memory_limit import EXPANSION, limited_memory
from workbench.io.mesh_file import check_range, finite_rows, mesh_of_file, whole_numbers

LARGEST_UNPACKED = 2**32
SMALL_UNPACKED = 2**28
"""Bytes that an archive may unpack to however small it is; a larger one in proportion to its own."""


@dataclass(frozen=True, eq=False)
class CaseParts:
    """What a case holds beside its mesh; None where it does not."""

    mesh: Mesh
    start: Floats | None = None
    map_positions: Floats | None = None
    anchor_vertices: Integers | None = None
    anchor_targets: Floats | None = None


def read_npz(path: Path, data: bytes) -> CaseParts:
    """`V` (n, 2|3), `S` (m, 3|4) from 0 and, where they are there, `X0`, `X`, `anchors`, `targets`; never pickles."""
    arrays = npz_arrays(path, data)
    for name in ("V", "S"):
        if name not in arrays:
            raise MeshError(
                f"{path}: the array {name} is missing; a case has V (vertices) and S (simplices, from 0), "
                f"and this file has {', '.join(sorted(arrays)) or 'nothing'}."
            )
    simplices = whole_numbers(path, "S", arrays["S"])
    _check_base(path, "S", simplices, len(np.atleast_1d(arrays["V"])), 0)
    return _case(path, finite_rows(path, "V", arrays["V"], None, (2, 3)), simplices, arrays)


def read_mat(path: Path, data: bytes) -> CaseParts:
    """`V` with `T` (tetrahedra) or `F` (triangles), both from 1, and a start `fV` where it is there."""
    arrays = mat_arrays(path, data)
    name = next((name for name in ("T", "F") if name in arrays), "")
    if "V" not in arrays or not name:
        raise MeshError(
            f"{path}: a mesh in a .mat file has V (vertices) and F (triangles) or T (tetrahedra), from 1; "
            f"this one has {', '.join(sorted(arrays)) or 'none of them'}."
        )
    simplices = whole_numbers(path, name, arrays[name]) - 1
    _check_base(path, name, simplices, len(arrays["V"]), 1)
    vertices = finite_rows(path, "V", arrays["V"], None, (2, 3))
    known = {"X0": arrays["fV"]} if "fV" in arrays else {}
    return _case(path, vertices, simplices, known)


def _check_base(path: Path, name: str, simplices: Integers, count: int, base: int) -> None:
    """Raises `MeshError` for indices that seem to be counted from the other of 0 and 1."""
    if not simplices.size:
        return
    low, high = int(simplices.min()), int(simplices.max())
    beyond = high if high == count and low >= 1 else low if low == -1 and high < count else None
    if beyond is not None:
        raise MeshError(
            f"{path}: {name} names vertex {beyond} (from 0) of {count}: its indices seem to be counted from {1 - base}, "
            f"and here they count from {base}; {'add 1 to' if base else 'subtract 1 from'} them."
        )


def npz_arrays(path: Path, data: bytes) -> dict[str, Any]:
    """The arrays of an npz file by name; `MeshError` where it is damaged or holds objects."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            unpacked = sum(entry.file_size for entry in archive.infolist())
        if unpacked > min(LARGEST_UNPACKED, max(SMALL_UNPACKED, EXPANSION * len(data))):
            raise MeshError(
                f"{path}: its {len(data) / 2**20:.3g} MiB would unpack to {unpacked / 2**30:.3g} GiB, too much for one mesh; "
                f"it is damaged, or was made to fill the memory."
            )
        with np.load(io.BytesIO(data), allow_pickle=False) as content:
            return {name: content[name] for name in content.files}
    except MeshError:
        raise
    except (Exception, SystemExit):
        raise MeshError(f"{path}: it cannot be read as .npz; it is damaged, cut short, or holds objects.") from None


def mat_arrays(path: Path, data: bytes) -> dict[str, Any]:
    """The plain arrays of a MATLAB file (version 7 or older) by name."""
    if b"MATLAB 7.3" in data[:128]:
        raise MeshError(f"{path}: it is a MATLAB 7.3 file (HDF5); save it again with the option -v7.")
    with silenced(), limited_memory(len(data)):
        try:
            from scipy.io import loadmat

            content = loadmat(io.BytesIO(data), variable_names=("V", "T", "F", "fV"))
        except (Exception, SystemExit):
            content = None
    if content is None:
        raise MeshError(f"{path}: it cannot be read as a MATLAB file; it is damaged or cut short.")
    return {name: value for name, value in content.items() if isinstance(value, np.ndarray)}


def _case(path: Path, vertices: Floats, simplices: Integers, arrays: dict[str, Any]) -> CaseParts:
    mesh = mesh_of_file(path, vertices, simplices)
    known = {name: finite_rows(path, name, arrays[name], mesh.vertex_count, (2, 3)) for name in ("X0", "X") if name in arrays}
    for positions in known.values():
        check_range(path, positions)
    anchors, targets = _anchors(path, mesh, arrays)
    return CaseParts(
        mesh, known.get("X0", known.get("X")), known.get("X", known.get("X0")), anchors, targets
    )  # fmt: skip


def _anchors(path: Path, mesh: Mesh, arrays: dict[str, Any]) -> tuple[Integers | None, Floats | None]:
    if "anchors" not in arrays and "targets" not in arrays:
        return None, None
    if "anchors" not in arrays or "targets" not in arrays:
        raise MeshError(f"{path}: of anchors and targets only one is there; a case has both or none.")
    vertices = whole_numbers(path, "anchors", np.ravel(arrays["anchors"]))
    given = np.asarray(arrays["targets"])
    given = given if given.size else given.reshape(0, mesh.vertices.shape[1])
    targets = finite_rows(path, "targets", given, len(vertices), (2, 3))
    if len(vertices) and (vertices.min() < 0 or vertices.max() >= mesh.vertex_count):
        bad = int(vertices[(vertices < 0) | (vertices >= mesh.vertex_count)][0])
        raise MeshError(f"{path}: anchors name vertex {bad} (from 0), but the mesh has {mesh.vertex_count} vertices.")
    if len(np.unique(vertices)) != len(vertices):
        raise MeshError(f"{path}: anchors name the same vertex twice; one target a vertex is needed.")
    return vertices, targets
