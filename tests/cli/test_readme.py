"""What the README shows works as it stands there."""

from __future__ import annotations

import re
import runpy
import shlex

import pytest

from workbench.cli.main import build_parser
from workbench.core.registry import load_plugin, load_registry
from workbench.core.solver_laws import try_laws
from workbench.core.status import Status
from workbench.io.read import read_mesh

README = "README.md"


def code_lines(text: str) -> list[str]:
    """Lines of the indented blocks, without their remarks."""
    return [line[4:].partition("  #")[0].rstrip() for line in text.splitlines() if line.startswith("    ")]


@pytest.fixture(scope="module")
def readme(project_root) -> str:
    return (project_root / README).read_text(encoding="utf-8")


def test_every_command_line_is_understood(readme):
    commands = [line for line in code_lines(readme) if line.startswith("workbench ")]
    assert len(commands) >= 6
    for line in commands:
        assert build_parser().parse_args(shlex.split(line)[1:]).run


def test_every_make_target_exists(readme, project_root):
    makefile = (project_root / "Makefile").read_text(encoding="utf-8")
    targets = set(re.findall(r"\bmake ([a-z]+)\b", readme))
    assert {"run", "test", "bench"} <= targets
    assert all(re.search(rf"^{target}:", makefile, re.MULTILINE) for target in targets)


def test_the_example_of_a_plugin_is_one(readme, tmp_path):
    lines = code_lines(readme)
    first = lines.index("from workbench.api import Distortion")
    (tmp_path / "stretch.py").write_text("\n".join(lines[first : first + 3]) + "\n")
    found = load_registry((tmp_path,))
    assert not found.failures
    assert set(found.distortions) == {"stretch"}
    found.distortions["stretch"].compiled(2)


def test_the_example_of_a_solver_keeps_every_law(readme, tmp_path):
    lines = code_lines(readme)
    first = lines.index("from dataclasses import dataclass, replace")
    last = next(i for i in range(first, len(lines)) if lines[i].startswith("workbench "))
    path = tmp_path / "conjugate.py"
    path.write_text("\n".join(lines[first:last]) + "\n")
    found = load_plugin(path)
    assert not found.failures
    assert set(found.solvers) == {"conjugate-gradients"}
    broken = [finding for finding in try_laws(found.solvers["conjugate-gradients"]()) if not finding.holds]
    assert not broken


def test_the_ten_lines_of_a_notebook_run(readme, tmp_path, monkeypatch, capsys):
    lines = code_lines(readme)
    first = lines.index("from workbench.api import figure, load, measure, solve")
    last = next(i for i in range(first, len(lines)) if lines[i].startswith("result.save("))
    assert sum(bool(line) for line in lines[first : last + 1]) <= 10
    script = tmp_path / "notebook.py"
    script.write_text("\n".join(lines[first : last + 1]) + "\n")
    monkeypatch.chdir(tmp_path)
    found = runpy.run_path(str(script))
    assert found["result"].status is Status.CONVERGED
    assert capsys.readouterr().out.splitlines()[-1] == "0"
    positions = found["result"].positions
    for vertex, target in found["hold"].items():
        assert abs(positions[vertex] - target).max() < 1e-9
    assert read_mesh(tmp_path / "man.obj").mesh.vertex_count == len(positions)
    assert (tmp_path / "man.pdf").read_bytes().startswith(b"%PDF")


def test_the_example_of_a_notebook_runs(readme, tmp_path, monkeypatch, capsys):
    lines = code_lines(readme)
    first = lines.index("import numpy as np")
    last = next(i for i in range(first, len(lines)) if lines[i].startswith("write_surface("))
    script = tmp_path / "notebook.py"
    script.write_text("\n".join(lines[first : last + 1]) + "\n")
    monkeypatch.chdir(tmp_path)
    found = runpy.run_path(str(script))
    assert "'global': True" in capsys.readouterr().out
    assert found["result"].state.status is Status.CONVERGED
    moved = read_mesh(tmp_path / "figure.vtu")
    assert abs(moved.map_positions - moved.mesh.vertices).max() > 0.5


def test_links_lead_somewhere(readme, project_root):
    for target in re.findall(r"\]\(([^)#]+)\)", readme):
        if not target.startswith("http") and not target.startswith("assets/screenshots/"):
            assert (project_root / target).exists(), target
