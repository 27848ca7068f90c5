"""All that a plugin may import, and what a notebook imports."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from workbench.core.analysis import analyse
from workbench.core.anchor_steps import approach_anchors
from workbench.core.anderson_mixing import anderson_step
from workbench.core.arrays import Floats, Integers
from workbench.core.best_start import best_start
from workbench.core.blocked_steps import unblocked_direction
from workbench.core.carried_surface import CarriedSurface, carry
from workbench.core.complex_hessian import complex_hessian
from workbench.core.constraints import Anchors, LinearConstraints
from workbench.core.convex_map import cotangent_weights, laplacian, map_disc, uniform_weights
from workbench.core.definite_solve import DefiniteFactor, solve_with_fixed
from workbench.core.descent import Derivatives, derivatives_at, descend, is_finite
from workbench.core.descent_solver import (
    DescentSolver,
    LaplacianDescentSolver,
    direction_in_laplacian,
    direction_in_metric,
    free_gradient,
    grown_step,
)
from workbench.core.disc_boundary import BoundaryShape, convex_outline, disc_boundary
from workbench.core.distortion import Distortion
from workbench.core.energy import Evaluation
from workbench.core.errors import FormulaError, MeshError, WorkbenchError
from workbench.core.extrapolation import Extrapolated, extrapolate, moved_state, with_previous_map
from workbench.core.initializer import Initializer, StartRequest
from workbench.core.injectivity import global_injectivity, local_injectivity
from workbench.core.laplacian_system import LaplacianSystem
from workbench.core.limited_memory import Pair, inner, make_pair
from workbench.core.line_search import SAFETY, armijo, largest_step, largest_step_without_inversion
from workbench.core.linear_back_end import SingularMatrixError
from workbench.core.linear_maps import (
    conformal_energy,
    dirichlet_matrix,
    harmonic_extension,
    match_source_frame,
    signed_areas,
    upright,
)
from workbench.core.mesh import Mesh
from workbench.core.method import Kind, Parameter, parameter
from workbench.core.metrics import killing_energy, reweighted_laplacian
from workbench.core.newton_solver import NewtonSolver
from workbench.core.problem import Problem
from workbench.core.progressive_solver import Progress, ProgressiveSolver
from workbench.core.quality import measure_map, simplex_table
from workbench.core.quasi_newton_solver import QuasiNewtonSolver
from workbench.core.radial_stretch import radial_stretch
from workbench.core.refine import Refined, refine
from workbench.core.rigid_start import rigid_map
from workbench.core.run import RunResult, run
from workbench.core.samples import make_sample
from workbench.core.solid_boundary import boundary_images, relaxed_inside, solid_boundary
from workbench.core.solver import ROUNDING, Interrupt, Solver, never
from workbench.core.state import State
from workbench.core.status import Status
from workbench.core.vertex_descent import descend_block

if TYPE_CHECKING:
    from collections.abc import Sequence

    from workbench.io.opening import OpenedSource
    from workbench.notebook import Drawing, Measured, References, Solution, Source, figure, load, measure, references, solve

FOR_NOTEBOOKS = ("Drawing", "Measured", "References", "Solution", "Source", "figure", "load", "measure", "references", "solve")
"""Names that are found when they are first asked for: plugins do without what they need."""


def __getattr__(name: str) -> Any:
    if name not in FOR_NOTEBOOKS:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    import workbench.notebook

    found = globals()[name] = getattr(workbench.notebook, name)
    return found


def map_from_file(path: str, mesh: Mesh, kind: Kind) -> Floats:
    """The map (n, d) that a file holds for the vertices of `mesh`. Raises `MeshError` where it does not fit."""
    from workbench.io.opening import map_from_file as read_map

    return read_map(path, mesh, kind)


def solver(id: str, **parameters: Any) -> Solver:
    """The registered solver of that id with these parameters. Raises `WorkbenchError` for what there is not."""
    from workbench.core.registry import registry

    configured: Solver = registry().solver(id).configured(parameters)
    return configured


def open_source(source: str, *, kind: str = "auto", fixes: Sequence[str] = (), tets: bool = False) -> OpenedSource:
    """A file, or `sample:ID`, opened as `workbench solve` opens it: `mesh`, `kind`, `start`, anchors. Raises `MeshError`."""
    from workbench.io.opening import open_source as open_file

    return open_file(source, kind=kind, fixes=fixes, tets=tets)


def write_map(path: str, mesh: Mesh, positions: Floats, kind: Kind) -> None:
    """Writes a map (n, d) of `mesh` in the format of the ending, as `workbench solve --out` does. Raises `WorkbenchError`."""
    from workbench.io.write import write_map as write

    write(path, mesh, mesh, positions, kind)


def write_surface(path: str, surface: Mesh, positions: Floats) -> None:
    """Writes a surface at the places (n, 3) where a map takes its vertices, as `--carried-out`. Raises `WorkbenchError`."""
    from workbench.io.write import write_surface as write

    write(path, surface, positions)


__all__ = [
    "ROUNDING",
    "SAFETY",
    "Anchors",
    "BoundaryShape",
    "CarriedSurface",
    "DefiniteFactor",
    "Derivatives",
    "DescentSolver",
    "Distortion",
    "Drawing",
    "Evaluation",
    "Extrapolated",
    "Floats",
    "FormulaError",
    "Initializer",
    "Integers",
    "Interrupt",
    "Kind",
    "LaplacianDescentSolver",
    "LaplacianSystem",
    "LinearConstraints",
    "Measured",
    "Mesh",
    "MeshError",
    "NewtonSolver",
    "Pair",
    "Parameter",
    "Problem",
    "Progress",
    "ProgressiveSolver",
    "QuasiNewtonSolver",
    "References",
    "Refined",
    "RunResult",
    "SingularMatrixError",
    "Solution",
    "Solver",
    "Source",
    "StartRequest",
    "State",
    "Status",
    "WorkbenchError",
    "analyse",
    "anderson_step",
    "approach_anchors",
    "armijo",
    "best_start",
    "boundary_images",
    "carry",
    "complex_hessian",
    "conformal_energy",
    "convex_outline",
    "cotangent_weights",
    "derivatives_at",
    "descend",
    "descend_block",
    "direction_in_laplacian",
    "direction_in_metric",
    "dirichlet_matrix",
    "disc_boundary",
    "extrapolate",
    "figure",
    "free_gradient",
    "global_injectivity",
    "grown_step",
    "harmonic_extension",
    "inner",
    "is_finite",
    "killing_energy",
    "laplacian",
    "largest_step",
    "largest_step_without_inversion",
    "load",
    "local_injectivity",
    "make_pair",
    "make_sample",
    "map_disc",
    "map_from_file",
    "match_source_frame",
    "measure",
    "measure_map",
    "moved_state",
    "never",
    "open_source",
    "parameter",
    "radial_stretch",
    "references",
    "refine",
    "relaxed_inside",
    "reweighted_laplacian",
    "rigid_map",
    "run",
    "signed_areas",
    "simplex_table",
    "solid_boundary",
    "solve",
    "solve_with_fixed",
    "solver",
    "unblocked_direction",
    "uniform_weights",
    "upright",
    "with_previous_map",
    "write_map",
    "write_surface",
]
