"""Reading a mesh from any file that is understood."""

from __future__ import annotations

import hashlib
import os
import stat
from pathlib import Path

from workbench.core.errors import MeshError
from workbench.io import foreign
from workbench.io.cases import CaseParts, read_mat, read_npz
from workbench.io.mesh_file import MeshFile
from workbench.io.obj import read_obj
from workbench.io.off import read_off
from workbench.io.ply import read_ply
from workbench.io.stl import read_stl

LARGEST_FILE = 2**32
"""Bytes; a mesh of a hundred million triangles."""

READABLE = (".obj", ".off", ".ply", ".stl", *foreign.FORMATS, ".npz", ".mat")
"""Endings of the files that can be read."""


def read_mesh(path: str | os.PathLike[str], *, tets: bool = False, linearise: bool = False) -> MeshFile:
    """The mesh in a file, with its start and anchors where it is a case.

    Parameters
    ----------
    path : str or path     the ending tells the format: see `READABLE`
    tets : bool            take the faces of four corners of an OBJ as tetrahedra
    linearise : bool       make elements of higher order linear: their corners alone

    Raises `MeshError` with a sentence for whatever is wrong with the file: it never ends the program or prints.
    """
    path = Path(path)
    ending = path.suffix.lower()
    data = read_bytes(path)
    digest = hashlib.sha256(data).hexdigest()
    try:
        if ending == ".obj":
            mesh, notes = read_obj(path, data, tets=tets)
            return MeshFile(mesh, str(path), "OBJ", digest, notes=notes)
        if ending == ".off":
            mesh, notes = read_off(path, data)
            return MeshFile(mesh, str(path), "OFF", digest, notes=notes)
        if ending == ".ply":
            mesh, notes = read_ply(path, data)
            return MeshFile(mesh, str(path), "PLY", digest, notes=notes)
        if ending == ".stl":
            mesh, notes = read_stl(path, data)
            return MeshFile(mesh, str(path), "STL", digest, notes=notes)
        if ending in foreign.FORMATS:
            mesh, notes, moved = foreign.read_foreign(path, data, linearise=linearise)
            return MeshFile(mesh, str(path), foreign.FORMATS[ending][1], digest, moved, moved, notes=notes)
        if ending == ".npz":
            return _case_file(read_npz(path, data), path, "case (npz)", digest)
        if ending == ".mat":
            return _case_file(read_mat(path, data), path, "MATLAB", digest)
    except MemoryError:
        raise MeshError(f"{path}: it asks for more memory than there is; it is damaged, or too large.") from None
    raise MeshError(f"{path}: the ending {ending or '(none)'} is not known; these are read: {', '.join(READABLE)}.")


def read_bytes(path: Path) -> bytes:
    """The bytes of an ordinary file that is not empty; `MeshError` says why where that fails."""
    try:
        status = path.stat()
        if stat.S_ISDIR(status.st_mode):
            raise MeshError(f"{path} is a folder; name a file in it.")
        if not stat.S_ISREG(status.st_mode):
            raise MeshError(f"{path} is not an ordinary file; name one that holds data.")
        if status.st_size > LARGEST_FILE:
            raise MeshError(f"{path} has {status.st_size / 2**30:.0f} GiB, too much for one mesh.")
        data = path.read_bytes()
    except FileNotFoundError:
        raise MeshError(f"There is no file {path}; look at the spelling and the folder.") from None
    except PermissionError:
        raise MeshError(f"{path} may not be read (permission denied); change its permissions.") from None
    except (OSError, ValueError, MemoryError) as error:
        reason = getattr(error, "strerror", None) or str(error) or "out of memory"
        raise MeshError(f"{str(path)[:200]!r} cannot be read: {reason}.") from None
    if not data:
        raise MeshError(f"{path} is empty (0 bytes); save or copy it again.")
    return data


def _case_file(case: CaseParts, path: Path, name: str, digest: str) -> MeshFile:
    return MeshFile(
        case.mesh, str(path), name, digest, case.start, case.map_positions, case.anchor_vertices, case.anchor_targets
    )
