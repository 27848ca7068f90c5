"""Running the command line inside the test's process."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from workbench.cli import main
from workbench.core.mesh import Mesh
from workbench.core.threads import set_thread_count, thread_count


@dataclass(frozen=True)
class Outcome:
    """Exit status and what was said."""

    status: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        """Standard output as strict JSON."""
        return strict_json(self.out)


def strict_json(text: str) -> Any:
    """JSON without NaN or Infinity, which Python's reader would let through."""

    def refuse(word: str) -> None:
        raise AssertionError(f"{word} is not JSON")

    return json.loads(text, parse_constant=refuse)


@pytest.fixture
def cli(capsys) -> Callable[..., Outcome]:
    """`cli("solve", file, ...)` -> Outcome."""

    def call(*arguments: object) -> Outcome:
        capsys.readouterr()
        status = main([str(item) for item in arguments])
        said = capsys.readouterr()
        return Outcome(status, said.out, said.err)

    return call


@pytest.fixture(autouse=True)
def same_threads():
    """The number of threads is the process's own: put it back."""
    before = thread_count()
    yield
    set_thread_count(before)


def write_obj(path: Path, mesh: Mesh) -> Path:
    """A plain OBJ file of a mesh."""
    lines = ["v " + " ".join(f"{c:.17g}" for c in (*row, *[0.0] * (3 - len(row)))) for row in mesh.vertices.tolist()]
    lines += ["f " + " ".join(str(v + 1) for v in row) for row in mesh.simplices.tolist()]
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.fixture
def dome_file(tmp_path, dome) -> Path:
    """A disc in space, as OBJ."""
    return write_obj(tmp_path / "dome.obj", dome)


@pytest.fixture
def square_file(tmp_path, square) -> Path:
    """The unit square, as OBJ."""
    return write_obj(tmp_path / "square.obj", square)
