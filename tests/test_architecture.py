"""The shape of the code: imports point one way, files stay small, public functions say what they do."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PYTHON_FILES = sorted(p for folder in ("workbench", "plugins", "tests") for p in (ROOT / folder).rglob("*.py"))
PLUGIN_FILES = sorted((ROOT / "plugins").rglob("*.py"))
CORE_FILES = sorted((ROOT / "workbench" / "core").rglob("*.py"))
LONGEST_FILE = 500
DRAWING = {"PySide6", "qtpy", "vtk", "vtkmodules", "pyvista", "pyvistaqt", "pyqtgraph", "matplotlib"}
PLUGINS_MAY_IMPORT = {"workbench.api", "numpy", "scipy", "numba", "sympy"}


def name(path: Path) -> str:
    return path.relative_to(ROOT).as_posix()


def imported_modules(source: str) -> set[str]:
    """Modules named by any import statement of a source text, wherever it stands."""
    modules: set[str] = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            modules.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            modules.add("." * node.level + (node.module or ""))
    return modules


def foreign_to_plugins(source: str) -> set[str]:
    """Imports of a plugin beside `workbench.api`, the numerical libraries and Python's own."""
    return {
        module
        for module in imported_modules(source)
        if module not in PLUGINS_MAY_IMPORT and module.partition(".")[0] not in (PLUGINS_MAY_IMPORT | sys.stdlib_module_names)
    }


def undocumented(source: str) -> list[str]:
    """Public functions and classes of a module that have no docstring."""
    missing = []
    for node in ast.parse(source).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_") and not ast.get_docstring(node):
            missing.append(node.name)
    return missing


def test_import_contracts_hold():
    linter = Path(sys.executable).with_name("lint-imports")
    if not linter.exists():
        pytest.skip("import-linter is not installed")
    result = subprocess.run([linter], cwd=ROOT, capture_output=True, text=True, timeout=120, check=False)
    assert result.returncode == 0, result.stdout + result.stderr


@pytest.mark.parametrize("path", PLUGIN_FILES, ids=name)
def test_plugins_import_the_api_only(path):
    assert not foreign_to_plugins(path.read_text(encoding="utf-8"))


FOREIGN = ("import workbench.core.mesh", "from workbench import core", "import pyvista", "from . import x")


@pytest.mark.parametrize("line", FOREIGN)
def test_the_check_of_plugins_can_fail(line):
    assert foreign_to_plugins(line)


def test_files_stay_small():
    lengths = {name(path): len(path.read_text(encoding="utf-8").splitlines()) for path in PYTHON_FILES}
    assert not {path: length for path, length in lengths.items() if length > LONGEST_FILE}


@pytest.mark.parametrize("path", CORE_FILES, ids=name)
def test_public_names_of_core_have_docstrings(path):
    source = path.read_text(encoding="utf-8")
    assert ast.get_docstring(ast.parse(source)), "the module has no docstring"
    assert not undocumented(source)


def test_the_check_of_docstrings_can_fail():
    assert undocumented("def measure(mesh):\n    return 0\n\nclass Mesh:\n    pass\n") == ["measure", "Mesh"]


DISTRIBUTION_OF = {
    "PySide6": "pyside6-essentials",
    "PIL": "pillow",
    "igl": "libigl",
    "imageio_ffmpeg": "imageio-ffmpeg",
    "vtkmodules": "vtk",
}  # where the module's name is not that of the distribution
INSTALLED_WITH_ANOTHER = {"pyvista"}  # named for its version bounds: pyvistaqt is built on it


def declared(table: list[str]) -> set[str]:
    """Names of the distributions of a list of requirements."""
    return {re.split(r"[^A-Za-z0-9._-]", line, maxsplit=1)[0].lower() for line in table}


def test_dependencies_are_what_is_imported():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    shipped = [path for path in PYTHON_FILES if path.relative_to(ROOT).parts[0] != "tests"]
    modules = {m.partition(".")[0] for path in shipped for m in imported_modules(path.read_text(encoding="utf-8"))}
    foreign = {m for m in modules if m and m not in sys.stdlib_module_names and m != "workbench"}
    needed = {DISTRIBUTION_OF.get(module, module) for module in foreign}
    required = declared(project["dependencies"])
    optional = declared([line for extra in ("mkl", "film", "fill") for line in project["optional-dependencies"][extra]])
    assert needed <= required | optional
    assert required <= needed | INSTALLED_WITH_ANOTHER


def test_the_command_line_loads_nothing_heavy():
    code = "import sys, workbench.cli; print(*sys.modules)"
    result = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    loaded = {module.partition(".")[0] for module in result.stdout.split()}
    assert not loaded & (DRAWING | {"numpy", "scipy", "numba", "sympy"})


def test_nothing_but_the_window_loads_qt_or_vtk():
    code = "import sys, workbench.api, workbench.core.registry as r; r.registry(); print(*sys.modules)"
    result = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    if "No module named 'workbench.api'" in result.stderr:
        pytest.skip("workbench.api is not written yet")
    assert result.returncode == 0, result.stderr
    loaded = {module.partition(".")[0] for module in result.stdout.split()}
    assert not loaded & DRAWING
