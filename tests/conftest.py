"""What all tests share: small meshes, the folder of trial data, and a home of their own."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

# Before anything reads them, here and in child processes: no test sees or touches the user's own plugins and settings.
_home = tempfile.TemporaryDirectory(prefix="workbench-tests-", ignore_cleanup_errors=True)
os.environ["XDG_DATA_HOME"] = str(Path(_home.name) / "data")
os.environ["XDG_CONFIG_HOME"] = str(Path(_home.name) / "config")
os.environ["XDG_STATE_HOME"] = str(Path(_home.name) / "state")
os.environ.setdefault("QT_API", "pyside6")

import hypothesis  # noqa: E402
import numpy as np  # noqa: E402
import pytest  # noqa: E402

from workbench.core.mesh import Mesh  # noqa: E402

ROOT = Path(__file__).resolve().parents[1]
DATA = ROOT.parent / "shared" / "data"

# A first example may import and compile what it calls, so none is timed. The same examples come every time, so that a run says
# something of the change and not of luck; `--hypothesis-profile=others` looks at others.
hypothesis.settings.register_profile("others", deadline=None)
hypothesis.settings.register_profile("laws", deadline=None, derandomize=True, database=None)
hypothesis.settings.load_profile("laws")


@pytest.fixture(scope="session")
def project_root() -> Path:
    """Root of the checkout."""
    return ROOT


@pytest.fixture(scope="session")
def data_folder() -> Path:
    """Folder of trial meshes beside the project; the test is skipped where it is missing."""
    if not DATA.is_dir():
        pytest.skip("the folder of trial meshes is not here")
    return DATA


@pytest.fixture(scope="session")
def square() -> Mesh:
    """The unit square as a grid of 6 x 6 cells, 72 triangles, in the plane."""
    return grid(6)


@pytest.fixture(scope="session")
def dome() -> Mesh:
    """A grid of 8 x 8 cells over the square, lifted to a dome: a disc in space."""
    flat = grid(8)
    x, y = flat.vertices.T
    return Mesh(np.column_stack([x, y, 2.0 * x * (1 - x) * y * (1 - y) * 4]), flat.simplices, "dome")


@pytest.fixture(scope="session")
def cube() -> Mesh:
    """The unit cube as 2 x 2 x 2 cells of six tetrahedra each, positively oriented."""
    return tetrahedral_grid(2)


def grid(cells: int) -> Mesh:
    """The unit square as `cells` x `cells` cells of two counter-clockwise triangles each."""
    side = np.linspace(0.0, 1.0, cells + 1)
    x, y = np.meshgrid(side, side)
    corner = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    right, above = corner + 1, corner + cells + 1
    lower = np.column_stack([corner, right, above + 1])
    upper = np.column_stack([corner, above + 1, above])
    return Mesh(np.column_stack([x.ravel(), y.ravel()]), np.vstack([lower, upper]), "square")


def tetrahedral_grid(cells: int) -> Mesh:
    """The unit cube as `cells`^3 cells, each cut into the six tetrahedra that share a diagonal (Kuhn's subdivision)."""
    count = cells + 1
    index = np.arange(count**3).reshape(count, count, count)  # [x, y, z]
    vertices = np.stack(np.meshgrid(*[np.linspace(0.0, 1.0, count)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    tets = []
    for order in ((0, 1, 2), (1, 2, 0), (2, 0, 1), (0, 2, 1), (2, 1, 0), (1, 0, 2)):
        path = [np.zeros(3, dtype=int)]
        for axis in order:
            path.append(path[-1] + np.eye(3, dtype=int)[axis])
        corners = [index[x : x + cells, y : y + cells, z : z + cells].ravel() for x, y, z in path]
        even = order in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
        tets.append(np.column_stack(corners if even else [corners[0], corners[2], corners[1], corners[3]]))
    return Mesh(vertices, np.vstack(tets), "cube")
