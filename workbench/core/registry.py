"""Finding methods: the plugins that come along and those in the user's folder."""

from __future__ import annotations

import importlib.util
import inspect
import sys
import traceback
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any

import platformdirs

from workbench.core.distortion import Distortion, _formula_of
from workbench.core.errors import WorkbenchError
from workbench.core.initializer import Initializer
from workbench.core.named_formulas import NamedFormula, add_formulas, formulas_file, read_formulas
from workbench.core.solver import Solver

FOLDERS = {"distortions": Distortion, "initializers": Initializer, "solvers": Solver}
"""Folder of the plugins -> what a file in it must define at least one of."""


@dataclass(frozen=True)
class PluginFailure:
    """A plugin file that could not be used: it is listed, and harms nothing."""

    path: Path
    sentence: str
    traceback: str


@dataclass(frozen=True)
class Registry:
    """Every method by id; a later file replaces an earlier one of the same id (the user's folder comes last).

    The user's named formulas stand among the distortions, and in `own_formulas` as they were saved.
    """

    distortions: dict[str, Distortion] = field(default_factory=dict)
    initializers: dict[str, type[Initializer]] = field(default_factory=dict)
    solvers: dict[str, type[Solver]] = field(default_factory=dict)
    failures: tuple[PluginFailure, ...] = ()
    origins: dict[tuple[str, str], Path] = field(default_factory=dict)
    own_formulas: dict[str, NamedFormula] = field(default_factory=dict)

    def solver(self, id: str) -> type[Solver]:
        return self._named("solvers", id, "solver")

    def initializer(self, id: str) -> type[Initializer]:
        return self._named("initializers", id, "initializer")

    def _named(self, folder: str, id: str, noun: str) -> Any:
        methods = getattr(self, folder)
        if id not in methods:
            raise WorkbenchError(f"There is no {noun} {id!r}; there are: {', '.join(sorted(methods))}.")
        return methods[id]


def resource_folder(name: str) -> Path:
    """Folder `plugins` or `assets`: inside the installed package, or beside it in a checkout."""
    package = Path(__file__).resolve().parents[1]
    inside = package / name
    return inside if inside.is_dir() else package.parent / name


def user_plugin_folder() -> Path:
    """Folder where the user's own plugins are looked for: `distortions`, `initializers`, `solvers` in it, or files directly."""
    return platformdirs.user_data_path("distortion-workbench", appauthor=False) / "plugins"


def registry() -> Registry:
    """All methods: plugins are found once a process, the user's named formulas whenever their file has changed."""
    return _with_formulas(_file_stamp(formulas_file()))


@lru_cache(maxsize=1)
def _plugin_methods() -> Registry:
    return load_registry((resource_folder("plugins"), user_plugin_folder()))


def _file_stamp(path: Path) -> tuple[str, int, int, int]:
    """What tells one content of a file from the next: files are replaced whole, so that each has an inode of its own."""
    try:
        found = path.stat()
    except OSError:
        return str(path), 0, 0, 0
    return str(path), found.st_mtime_ns, found.st_size, found.st_ino


@lru_cache(maxsize=1)
def _with_formulas(stamp: tuple[str, int, int, int]) -> Registry:
    methods, path = _plugin_methods(), Path(stamp[0])
    formulas, faults = read_formulas(path)
    distortions = dict(methods.distortions)
    faults += add_formulas(formulas, distortions)
    _formula_of.cache_clear()  # a name may have another meaning now
    own = {item.id: item for item in formulas if item.id not in methods.distortions and item.id in distortions}
    return replace(
        methods,
        distortions=distortions,
        failures=methods.failures + tuple(PluginFailure(path, fault, fault) for fault in faults),
        origins=methods.origins | {("distortions", id): path for id in own},
        own_formulas=own,
    )


def load_registry(roots: tuple[Path, ...]) -> Registry:
    """Methods defined by the plugin files below `roots`, and the files that failed."""
    found = Registry()
    failures: list[PluginFailure] = []
    for index, root in enumerate(roots):
        for path in _plugin_files(root):
            _load_file(path, f"workbench_plugins_{index}.{path.parent.name}.{path.stem}", found, failures)
    return Registry(found.distortions, found.initializers, found.solvers, tuple(failures), found.origins)


def load_plugin(path: Path) -> Registry:
    """What one plugin file defines, or its failure, apart from all others."""
    found, failures = Registry(), list[PluginFailure]()
    _load_file(path, f"workbench_plugin_alone.{path.stem}", found, failures)
    return replace(found, failures=tuple(failures))


def _load_file(path: Path, name: str, found: Registry, failures: list[PluginFailure]) -> None:
    try:
        module = _import_file(path, name.replace("-", "_"))
        if not _collect(module, path, found):
            raise WorkbenchError("The file defines no Distortion, Initializer or Solver.")
    except (Exception, SystemExit) as error:
        failures.append(PluginFailure(path, f"{type(error).__name__}: {error}", traceback.format_exc()))


def _plugin_files(root: Path) -> list[Path]:
    if not root.is_dir():
        return []
    files = list(root.glob("*.py"))
    for folder in FOLDERS:
        files += (root / folder).glob("*.py")
    return sorted(p for p in files if not p.name.startswith("_"))


def _import_file(path: Path, name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise WorkbenchError(f"{path} cannot be imported.")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[name]
        raise
    return module


def _collect(module: ModuleType, path: Path, found: Registry) -> int:
    count = 0
    for value in vars(module).values():
        if isinstance(value, Distortion):
            found.distortions[value.id] = value
            found.origins["distortions", value.id] = path
            count += 1
        elif inspect.isclass(value) and value.__module__ == module.__name__ and not inspect.isabstract(value):
            for folder, base in (("initializers", Initializer), ("solvers", Solver)):
                if issubclass(value, base):
                    getattr(found, folder)[value.id] = value
                    found.origins[folder, value.id] = path
                    count += 1
    return count
