"""From what a user asks for to a problem with its start: everything that can be refused is refused here."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.constraints import Anchors
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.initializer import Initializer
from workbench.core.linear_equations import with_equations
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.solver import Solver
from workbench.engine.compiling import compile_kernels
from workbench.engine.parameter_owners import assign
from workbench.engine.starts import adjusted_start, default_initializer, make_start
from workbench.io.anchors import read_anchors, vertices_after_fixes
from workbench.io.equations import read_equation_file
from workbench.io.opening import OpenedSource, open_source

GIVEN = "given"
"""What stands for the id of the initializer where the start itself was given."""


@dataclass(frozen=True, eq=False, kw_only=True)
class Wishes:
    """What is minimised and from where, as a command or a script names it.

    Parameters
    ----------
    kind, fixes, tets            how a mesh is read (see `workbench.io.opening.open_source`)
    distortion : str | Distortion     an id, a formula, or the distortion itself
    settings : (name, value)     of the distortion, the solvers or the initializer, the first that has it
    init : str | (n, d) float64  an initializer, a file, or the start; None: that of the case, of the solver, of the kind
    init_parameters : dict       of the initializer alone, beside `settings`
    match_area : bool            scale the start to the area of the source, where its own scale means nothing
    anchors : str | Anchors      a CSV file, or the anchors; None: those of the case
    pin_boundary : bool          hard anchors at all boundary vertices, where the start has them
    equations : str | lines      linear constraints: a file of them, or a line each (see `workbench.core.linear_equations`)
    seed : int                   for methods that draw random numbers
    """

    kind: str = "auto"
    fixes: Sequence[str] = ()
    tets: bool = False
    distortion: str | Distortion = "symmetric-dirichlet"
    settings: Sequence[tuple[str, Any]] = ()
    init: str | Floats | None = None
    init_parameters: Mapping[str, Any] = field(default_factory=dict)
    match_area: bool = True
    anchors: str | Anchors | None = None
    pin_boundary: bool = False
    allow_inversions: bool = False
    equations: str | Sequence[str] = ()
    seed: int = 0


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


def prepare(wishes: Wishes, source: str | OpenedSource, solver: str | Solver) -> Prepared:
    """Read the mesh, resolve the methods, make the start. Raises `WorkbenchError` for whatever does not fit.

    source : a file, `sample:ID`, or what is open already;  solver : an id, set by the wishes, or the solver as it is
    """
    if isinstance(solver, str):
        method = registry().solver(solver)
        given, values = prepare_problem(wishes, source, (method,))
        chosen = configured(method, values, wishes.seed)
    else:
        given, _ = prepare_problem(wishes, source, (type(solver),), takes_settings=False)
        chosen = solver
    with _timed(given.seconds, "compile"):
        compile_kernels(given.problem, chosen)
    return Prepared(**vars(given), solver=chosen)


def prepare_problem(
    wishes: Wishes,
    source: str | OpenedSource,
    methods: Sequence[type[Solver]],
    unfit: dict[type[Solver], str] | None = None,
    *,
    takes_settings: bool = True,
) -> tuple[PreparedProblem, dict[str, Any]]:
    """The problem of a mesh for these solvers, with its start, and the settings that are left for the solvers.

    Raises `WorkbenchError` for whatever does not fit; solvers that do not are put into `unfit` instead, where it is given,
    each with the sentence that says why. Without `takes_settings` the solvers are set already.
    """
    seconds: dict[str, float] = {}
    with _timed(seconds, "read"):
        opened = _opened(wishes, source)
    refused = {method: sentence for method in methods if (sentence := _mismatch(method, opened.kind))}
    if refused and unfit is None:
        raise WorkbenchError(next(iter(refused.values())))
    fitting = [method for method in methods if method not in refused]
    initializer, start_file = _initializer(wishes.init, opened, fitting)
    starter = None if initializer == GIVEN else registry().initializer(initializer)
    groups = (methods if takes_settings else (), () if starter is None else (starter,))
    for_distortion, for_solvers, for_start = assign(wishes.settings, wishes.distortion, groups)
    distortion = _distortion(wishes.distortion, for_distortion)
    for method in fitting:
        if takes_settings:
            configured(method, for_solvers, wishes.seed)
        try:
            method.check_distortion(distortion)
        except WorkbenchError as error:
            if unfit is None:
                raise
            refused[method] = error.sentence
    if unfit is not None:
        unfit.update(refused)
    equations = read_equation_file(wishes.equations) if isinstance(wishes.equations, str) else tuple(wishes.equations)
    problem = Problem.create(
        opened.mesh,
        opened.kind,
        distortion,
        _anchors(wishes.anchors, opened),
        allow_inversions=wishes.allow_inversions,
    )
    problem = with_equations(problem, equations)
    with _timed(seconds, "start"):
        if starter is None:
            start = _given_start(wishes.init, problem)
        else:
            values = {**_seed(starter, wishes.seed), **for_start, **wishes.init_parameters}
            start = _start(problem, opened, initializer, values, start_file, wishes.match_area)
    if wishes.pin_boundary:
        boundary = opened.mesh.topology.boundary_vertices
        problem = problem.with_anchors(problem.anchors.with_added(boundary, start[boundary]))
    given = PreparedProblem(
        path=source if isinstance(source, str) else opened.file.path,
        opened=opened,
        problem=problem,
        initializer=initializer,
        start=start,
        seconds=seconds,
    )
    return given, for_solvers


def _opened(wishes: Wishes, source: str | OpenedSource) -> OpenedSource:
    if isinstance(source, OpenedSource):
        return source
    return open_source(source, kind=wishes.kind, fixes=wishes.fixes, tets=wishes.tets)


def _distortion(wished: str | Distortion, values: Mapping[str, Any]) -> Distortion:
    return Distortion.resolve(wished, values) if isinstance(wished, str) else wished.with_values(values)


def _mismatch(method: type[Solver], kind: str) -> str:
    """Why a solver cannot take part, by the kind of map; empty where it can."""
    return "" if kind in method.kinds else f"{method.label} does not solve {kind} maps; choose another solver."


def configured(method: type[Solver], values: Mapping[str, Any], seed: int) -> Solver:
    """The solver with those of `values` that it has, and the seed where it has one. Raises `WorkbenchError`."""
    names = {item.name for item in method.parameters()}
    own = {name: value for name, value in values.items() if name in names}
    return method.configured({**_seed(method, seed), **own})


def _initializer(wished: str | Floats | None, opened: OpenedSource, methods: Sequence[type[Solver]]) -> tuple[str, str]:
    """(id, file) of the start: what the user named, else that of the case, of the solver, or of the kind of map."""
    if wished is None and opened.start is not None:
        return "file", ""
    if wished is None:
        favourites = {method.initializer for method in methods}
        return default_initializer(opened.kind, favourites.pop() if len(favourites) == 1 else ""), ""
    if not isinstance(wished, str):
        return GIVEN, ""
    known = registry().initializers
    if wished in known:
        return wished, ""
    if os.path.exists(wished):
        return "file", wished
    raise WorkbenchError(f"There is no initializer and no file {wished!r}; initializers: {', '.join(sorted(known))}.")


def _given_start(start: Any, problem: Problem) -> Floats:
    """A start as it was given, not turned or scaled. Raises `WorkbenchError` where it is no map of the mesh."""
    positions = np.ascontiguousarray(start, dtype=np.float64)
    wanted = (problem.mesh.vertex_count, problem.dimension)
    if positions.shape != wanted or not np.isfinite(positions).all():
        what = "has numbers that are not finite" if positions.shape == wanted else f"has the shape {positions.shape}"
        raise WorkbenchError(f"The start {what}; this mesh needs finite numbers of the shape {wanted}.")
    return positions


def _start(
    problem: Problem, opened: OpenedSource, initializer: str, parameters: Mapping[str, Any], file: str, match_area: bool
) -> Floats:
    if initializer == "file" and not file and opened.start is not None:
        return adjusted_start(opened.mesh, opened.kind, opened.start, match_area=False)
    try:
        return make_start(opened.mesh, opened.kind, initializer, parameters, file, match_area, problem)
    except (WorkbenchError, MemoryError):
        raise
    except (Exception, SystemExit) as error:
        raise WorkbenchError(
            f"The initializer {initializer} failed ({type(error).__name__}: {error}); choose another with --init."
        ) from error


def _seed(method: type[Solver] | type[Initializer], seed: int) -> dict[str, int]:
    """The seed for a method that has a parameter of that name."""
    return {"seed": seed} if any(item.name == "seed" for item in method.parameters()) else {}


def _anchors(wished: str | Anchors | None, opened: OpenedSource) -> Anchors:
    """Anchors as they are, or of a CSV file, which names vertices of the mesh file, else those of the case."""
    mesh = opened.mesh
    if isinstance(wished, Anchors):
        return wished
    if wished is None:
        if opened.anchor_vertices is None or opened.anchor_targets is None:
            return Anchors.none(mesh.dimension)
        return Anchors(opened.anchor_vertices, opened.anchor_targets)
    table = read_anchors(wished, opened.file.mesh.vertex_count, mesh.dimension).in_force
    vertices = vertices_after_fixes(wished, table.vertices, mesh)
    return Anchors(vertices, table.targets, table.weights, table.groups)


@contextmanager
def _timed(seconds: dict[str, float], part: str) -> Iterator[None]:
    begin = time.perf_counter()
    yield
    seconds[part] = time.perf_counter() - begin
