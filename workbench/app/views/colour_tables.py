"""The tables of colorcet, each kept in a file of its own: importing all of them takes a third of a second."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from platformdirs import user_cache_path

from workbench.core.errors import WorkbenchError

LEAST, MOST = 2, 4096
"""Colours that a table may have."""


def colour_table(name: str, folder: Path | None = None) -> NDArray[np.float64]:
    """Colours (k, 3) in [0, 1] of one of colorcet's palettes; `folder` is that of the user's caches, or another one."""
    path = (folder or user_cache_path("distortion-workbench", appauthor=False)) / "colours" / f"{name}.npy"
    kept = _kept(path)
    if kept is not None:
        return kept
    import colorcet

    table = np.array([[int(text[i : i + 2], 16) / 255 for i in (1, 3, 5)] for text in colorcet.palette[name]])
    _keep(path, table)
    return table


def _kept(path: Path) -> NDArray[np.float64] | None:
    with suppress(OSError, ValueError, EOFError):
        table = np.load(path, allow_pickle=False)
        if table.dtype == np.float64 and table.ndim == 2 and table.shape[1] == 3 and LEAST <= len(table) <= MOST:
            return table if bool(np.all((table >= 0) & (table <= 1))) else None
    return None


def _keep(path: Path, table: NDArray[np.float64]) -> None:
    from workbench.io.atomic import replacing

    with suppress(OSError, WorkbenchError):  # else the library is asked the next time, too
        path.parent.mkdir(parents=True, exist_ok=True)
        with replacing(path) as part:
            np.save(part, table)
