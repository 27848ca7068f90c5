"""From the options of a solve to a problem with its start: everything that can be refused is refused here."""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from workbench.cli.settings import assign
from workbench.core.arrays import Floats
from workbench.core.constraints import Anchors
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.initializer import Initializer
from workbench.core.linear_solver import CHOICE, check_back_end
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.solver import Solver
from workbench.engine.compiling import compile_kernels
from workbench.engine.starts import adjusted_start, default_initializer, make_start
from workbench.io.anchors import read_anchors
from workbench.io.opening import OpenedSource, open_source


@dataclass(frozen=True, eq=False, kw_only=True)
class PreparedProblem:
    """A problem with its start, and how long the parts of getting there took."""

    path: str
    opened: OpenedSource
    problem: Problem
    initializer: str
    start: Floats
    seconds: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True, eq=False, kw_only=True)
class Prepared(PreparedProblem):
    """A problem ready to be solved by `solver`."""

    solver: Solver


def prepare(options: argparse.Namespace) -> Prepared:
    """Read the mesh, resolve the methods, make the start. Raises `WorkbenchError` for whatever does not fit."""
    method = registry().solver(options.solver)
    given, values = prepare_problem(options, options.file, (method,))
    solver = configured(method, values, options.seed)
    with _timed(given.seconds, "compile"):
        compile_kernels(given.problem, solver)
    return Prepared(**vars(given), solver=solver)


def prepare_problem(
    options: argparse.Namespace, file: str, methods: Sequence[type[Solver]], unfit: dict[type[Solver], str] | None = None
) -> tuple[PreparedProblem, dict[str, str]]:
    """The problem of a mesh file for these solvers, with its start, and the settings that are left for the solvers.

    Raises `WorkbenchError` for whatever does not fit; solvers that do not are put into `unfit` instead, where it is given,
    each with the sentence that says why.
    """
    if options.linear_solver:
        check_back_end(options.linear_solver)
        os.environ[CHOICE] = options.linear_solver  # for processes that are started from here, too
    seconds: dict[str, float] = {}
    with _timed(seconds, "read"):
        opened = open_source(file, kind=options.map, fixes=options.fixes, tets=options.tets)
    if options.repair not in ("auto", "none"):
        raise WorkbenchError(f"There is no repair {options.repair!r}; there are: auto, none.")
    refused = {method: sentence for method in methods if (sentence := _mismatch(method, opened.kind))}
    if refused and unfit is None:
        raise WorkbenchError(next(iter(refused.values())))
    fitting = [method for method in methods if method not in refused]
    initializer, start_file = _initializer(options.init, opened, fitting)
    starter = registry().initializer(initializer)
    for_distortion, for_solvers, for_start = assign(options.settings, options.distortion, (methods, (starter,)))
    distortion = Distortion.resolve(options.distortion, for_distortion)
    for method in fitting:
        configured(method, for_solvers, options.seed)
        try:
            method.check_distortion(distortion)
        except WorkbenchError as error:
            if unfit is None:
                raise
            refused[method] = error.sentence
    if unfit is not None:
        unfit.update(refused)
    problem = Problem.create(
        opened.mesh,
        opened.kind,
        distortion,
        _anchors(options.anchors, opened),
        allow_inversions=options.allow_inversions,
    )
    with _timed(seconds, "start"):
        start = _start(problem, opened, initializer, {**_seed(starter, options.seed), **for_start}, start_file)
    if options.pin_boundary:
        boundary = opened.mesh.topology.boundary_vertices
        problem = problem.with_anchors(problem.anchors.with_added(boundary, start[boundary]))
    given = PreparedProblem(
        path=str(file), opened=opened, problem=problem, initializer=initializer, start=start, seconds=seconds
    )
    return given, for_solvers


def _mismatch(method: type[Solver], kind: str) -> str:
    """Why a solver cannot take part, by the kind of map; empty where it can."""
    return "" if kind in method.kinds else f"{method.label} does not solve {kind} maps; choose another solver."


def configured(method: type[Solver], values: Mapping[str, Any], seed: int) -> Solver:
    """The solver with those of `values` that it has, and the seed where it has one. Raises `WorkbenchError`."""
    names = {item.name for item in method.parameters()}
    own = {name: value for name, value in values.items() if name in names}
    return method.configured({**_seed(method, seed), **own})


def _initializer(text: str | None, opened: OpenedSource, methods: Sequence[type[Solver]]) -> tuple[str, str]:
    """(id, file) of the start: what the user named, else that of the case, of the solver, or of the kind of map."""
    if text is None and opened.start is not None:
        return "file", ""
    if text is None:
        wished = {method.initializer for method in methods}
        return default_initializer(opened.kind, wished.pop() if len(wished) == 1 else ""), ""
    known = registry().initializers
    if text in known:
        return text, ""
    if os.path.exists(text):
        return "file", text
    raise WorkbenchError(f"There is no initializer and no file {text!r}; initializers: {', '.join(sorted(known))}.")


def _start(problem: Problem, opened: OpenedSource, initializer: str, parameters: Mapping[str, Any], file: str) -> Floats:
    if initializer == "file" and not file and opened.start is not None:
        return adjusted_start(opened.mesh, opened.kind, opened.start, match_area=False)
    try:
        return make_start(opened.mesh, opened.kind, initializer, parameters, file, problem=problem)
    except (WorkbenchError, MemoryError):
        raise
    except (Exception, SystemExit) as error:
        raise WorkbenchError(
            f"The initializer {initializer} failed ({type(error).__name__}: {error}); choose another with --init."
        ) from error


def _seed(method: type[Solver] | type[Initializer], seed: int) -> dict[str, int]:
    """The seed for a method that has a parameter of that name."""
    return {"seed": seed} if any(item.name == "seed" for item in method.parameters()) else {}


def _anchors(path: str | None, opened: OpenedSource) -> Anchors:
    """Anchors of a CSV file, which names vertices of the mesh file, else those of the case."""
    mesh = opened.mesh
    if path is None:
        if opened.anchor_vertices is None or opened.anchor_targets is None:
            return Anchors.none(mesh.dimension)
        return Anchors(opened.anchor_vertices, opened.anchor_targets)
    table = read_anchors(path, opened.file.mesh.vertex_count, mesh.dimension)
    return Anchors(_vertices_after_fixes(path, table.vertices, mesh), table.targets, table.weights)


def _vertices_after_fixes(path: str, vertices: np.ndarray, mesh: Mesh) -> np.ndarray:
    """Vertices of the file as vertices of the mesh that is solved on."""
    if mesh.vertex_origin is None:
        return vertices
    found = []
    for vertex in vertices.tolist():
        now = np.flatnonzero(mesh.vertex_origin == vertex)
        if len(now) != 1:
            what = "was dropped by a fix" if not len(now) else f"was cut into {len(now)} vertices by a fix"
            raise WorkbenchError(f"{path}: vertex {vertex} {what}; anchor another vertex.")
        found.append(int(now[0]))
    return np.array(found, dtype=np.int64)


@contextmanager
def _timed(seconds: dict[str, float], part: str) -> Iterator[None]:
    begin = time.perf_counter()
    yield
    seconds[part] = time.perf_counter() - begin
