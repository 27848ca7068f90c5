"""Write the small samples as OBJ files: `python -m workbench.core.samples FOLDER`."""

from __future__ import annotations

import sys
from pathlib import Path

from workbench.core.mesh import Mesh
from workbench.core.samples.catalogue import make_sample, sample_ids

STORED_LIMIT = 5200
"""Samples of at most this many triangles at their default resolution are kept as files."""


def object_text(mesh: Mesh) -> str:
    """The mesh as OBJ text; 17 significant digits, so that reading it back gives the same numbers."""
    zero = " 0" if mesh.vertices.shape[1] == 2 else ""
    lines = [f"# {mesh.name}: made by python -m workbench.core.samples"]
    lines += ["v " + " ".join(f"{value:.17g}" for value in row) + zero for row in mesh.vertices]
    lines += ["f " + " ".join(str(index + 1) for index in row) for row in mesh.simplices]
    return "\n".join(lines) + "\n"


def stored_ids() -> tuple[str, ...]:
    """Ids of the samples that are kept as files."""
    meshes = {id: make_sample(id) for id in sample_ids()}
    return tuple(id for id, mesh in meshes.items() if mesh.dimension == 2 and mesh.simplex_count <= STORED_LIMIT)


def main(arguments: list[str]) -> int:
    """Write the files into the folder named, print their paths."""
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    folder = Path(arguments[0])
    folder.mkdir(parents=True, exist_ok=True)
    for id in stored_ids():
        path = folder / f"{id}.obj"
        path.write_text(object_text(make_sample(id)), encoding="ascii", newline="\n")
        print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
