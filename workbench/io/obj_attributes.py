"""What an OBJ file says of its faces beside their corners: objects, groups, materials, smoothing, normals."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.mesh import FaceAttributes
from workbench.io.file_names import relative_name

KEYWORDS = ("o", "g", "usemtl", "s")
"""What stands before faces and holds until it is said anew, in the order of `FaceAttributes.parts`."""
LIBRARY = "mtllib"
NAMING = (*KEYWORDS, LIBRARY)
HEADS = {(word + " ")[:2] for word in NAMING}
"""How such lines begin."""
NOTHING = ("", "", "", "")


@dataclass
class NamedParts:
    """The parts of a file while it is read: `current` is the row of the one that the next face belongs to."""

    rows: dict[tuple[str, str, str, str], int] = field(default_factory=lambda: {NOTHING: 0})
    current: int = 0
    libraries: list[str] = field(default_factory=list)
    _names: list[str] = field(default_factory=lambda: list(NOTHING))

    def take(self, line: str) -> None:
        """A line that may name something; what does not is passed over."""
        word, _, name = line.strip().partition(" ")
        name = name.strip()
        if word == LIBRARY and name and name not in self.libraries:
            self.libraries.append(name)
        elif word in KEYWORDS:
            self._names[KEYWORDS.index(word)] = name
            o, g, material, smoothing = self._names
            self.current = self.rows.setdefault((o, g, material, smoothing), len(self.rows))


def attributes_of(
    path: Path, named: NamedParts, part: Integers, normals: Floats, corners: Integers, triangles_of: Integers, faces: Integers
) -> FaceAttributes | None:
    """The attributes of the triangles of a file; None where it has none.

    Parameters
    ----------
    part : (f,) int64                 row of `named.rows` of each face
    normals : (k, 3) float64          of the file; without any row, or with one that is not finite, there are none
    corners : (c,) int64              row of `normals` of each corner of each face, -1 where it has none
    triangles_of : (m, 3) int64       corners of the triangles
    faces : (m,) int64                face of each triangle
    """
    normal_corners = corners[triangles_of]
    if not (len(normals) and np.isfinite(normals).all() and normal_corners.max() < len(normals)):
        normals, normal_corners = np.empty((0, 3)), np.full(triangles_of.shape, -1)
    bare = np.unique(faces[(normal_corners < 0).any(axis=1)])
    normal_corners[np.isin(faces, bare)] = -1  # a face has them at all corners, or at none
    if len(named.rows) == 1 and not named.libraries and (normal_corners < 0).all():
        return None
    folder = os.path.abspath(path.parent)
    return FaceAttributes(tuple(named.rows), part[faces], normals, normal_corners, tuple(named.libraries), folder)


def library_lines(attributes: FaceAttributes, place: Path) -> str:
    """The lines that name the files of the materials, from a file at `place`."""
    return "".join(f"{LIBRARY} {_from(attributes.folder, name, place)}\n" for name in attributes.libraries)


def _from(folder: str, name: str, place: Path) -> str:
    """A name that leads from the folder of `place` to where it led from another folder, if it led anywhere."""
    there, here = os.path.join(folder, name), os.path.abspath(place.parent)
    if os.path.realpath(here) == os.path.realpath(folder) or os.path.isabs(name) or not os.path.isfile(there):
        return name
    return relative_name(there, here)


def naming_lines(before: Iterable[str], now: Iterable[str]) -> str:
    """The lines between faces of one part and of the next; what has no name any more cannot be said, but for smoothing."""
    changed = (
        f"{word} {name}\n" if name else "s off\n"
        for word, last, name in zip(KEYWORDS, before, now, strict=True)
        if name != last and (name or word == "s")
    )
    return "".join(changed)
