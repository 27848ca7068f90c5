"""Arguments with checked values, and the options that every command that solves has in common."""

from __future__ import annotations

import argparse
import math
import os
from pathlib import Path
from typing import TYPE_CHECKING

from workbench.cli.settings import add_set_option
from workbench.core.errors import WorkbenchError
from workbench.io.text import shown_name

if TYPE_CHECKING:
    from workbench.engine.preparation import Wishes

FIXES = ("reorient", "largest", "unreferenced", "seams", "cut", "linearise", "tets")
KINDS = ("auto", "plane", "parameterize", "volume")


def count(text: str) -> int:
    """A whole number from 0 on."""
    try:
        value = int(text)
    except ValueError:
        value = -1
    if value < 0:
        raise argparse.ArgumentTypeError(f"{text!r} is not a whole number from 0 on")
    return value


def positive_count(text: str) -> int:
    """A whole number from 1 on."""
    value = count(text)
    if value == 0:
        raise argparse.ArgumentTypeError("at least 1 is needed")
    return value


def amount(text: str) -> float:
    """A number from 0 on; `inf` too."""
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not value >= 0:
        raise argparse.ArgumentTypeError(f"{text!r} is not a number from 0 on")
    return value


def fixes(text: str) -> tuple[str, ...]:
    """Names of fixes, separated by commas, in the order to apply them."""
    names = tuple(name.strip() for name in text.split(",") if name.strip())
    unknown = [name for name in names if name not in FIXES]
    if unknown:
        raise argparse.ArgumentTypeError(f"there is no fix {unknown[0]!r}; there are {', '.join(FIXES)}")
    return names


def label_and_file(text: str) -> tuple[str, str]:
    """The two parts of `[LABEL=]FILE`; the label is the file's name where there is none."""
    label, equals, file = text.partition("=")
    return (label, file) if equals and not os.path.exists(text) else (shown_name(Path(text).name), text)


def add_source_options(parser: argparse.ArgumentParser) -> None:
    """How a mesh is read and what is mended in it."""
    parser.add_argument("--map", choices=KINDS, default="auto", help="kind of map (default: auto)")
    parser.add_argument(
        "--fix",
        dest="fixes",
        type=fixes,
        action="extend",
        default=[],
        metavar="FIX,...",
        help=f"mend the mesh first, in the order given: {', '.join(FIXES)} (as --tets)",
    )
    parser.add_argument("--tets", action="store_true", help="read faces of four corners as tetrahedra")


def add_solve_options(parser: argparse.ArgumentParser) -> None:
    """Everything that describes one solve but its outputs."""
    add_problem_options(parser)
    parser.add_argument("--solver", default="projected-newton", metavar="ID", help="default: projected-newton")


def add_problem_options(parser: argparse.ArgumentParser) -> None:
    """What is minimised, from which start, until when."""
    add_source_options(parser)
    add = parser.add_argument
    add("--distortion", default="symmetric-dirichlet", metavar="ID|FORMULA", help="default: symmetric-dirichlet")
    add_set_option(parser, "the distortion, the solver or the initializer, the first that has it")
    defaults = "rest; surfaces: tutte, or auto with --solver fast; name the mesh itself for its own UVs"
    add("--init", metavar="ID|FILE", help=f"start: an initializer, or a map in a file (default: {defaults})")
    add("--anchors", metavar="FILE.csv", help="anchors: vertex,x,y[,z][,weight], vertices from 0")
    add("--equations", metavar="FILE.txt", help="linear constraints, a line each: x[12] - x[30] = 0")
    add("--pin-boundary", action="store_true", help="hard anchors at all boundary vertices, where the start has them")
    add("--repair", default="auto", metavar="ID|auto|none", help="of inverted starts (default: auto; none is there yet)")
    add("--iterations", type=count, default=1000, metavar="N", help="at most so many (default: 1000)")
    add("--tolerance", type=amount, default=1e-6, metavar="T", help="relative energy decrease (default: 1e-6)")
    add("--gradient-tolerance", type=amount, metavar="T", help="done as well at this characteristic gradient norm")
    add("--time-limit", type=amount, default=math.inf, metavar="SECONDS", help="stop after so long")
    add("--threads", type=positive_count, metavar="N", help="threads of the kernels and the linear algebra")
    add("--linear-solver", metavar="NAME", help="multifrontal, cholmod, pardiso, superlu, cg (default: by size)")
    add("--seed", type=count, default=0, metavar="N", help="for methods that draw random numbers (default: 0)")
    add("--allow-inversions", action="store_true", help="let distortions without a barrier invert simplices")
    add("--quiet", action="store_true", help="no progress; errors are still said")


def wishes_of(options: argparse.Namespace) -> Wishes:
    """What the options of `add_problem_options` ask for; the linear solver is chosen for this process and its children.

    Raises `WorkbenchError` for a linear solver that is not there, and for a repair.
    """
    from workbench.core.linear_solver import CHOICE, check_back_end
    from workbench.engine.preparation import Wishes

    if options.linear_solver:
        check_back_end(options.linear_solver)
        os.environ[CHOICE] = options.linear_solver
    if options.repair not in ("auto", "none"):
        raise WorkbenchError(f"There is no repair {options.repair!r}; there are: auto, none.")
    return Wishes(
        kind=options.map,
        fixes=options.fixes,
        tets=options.tets,
        distortion=options.distortion,
        settings=options.settings,
        init=options.init,
        anchors=options.anchors,
        equations=options.equations or (),
        pin_boundary=options.pin_boundary,
        allow_inversions=options.allow_inversions,
        seed=options.seed,
    )
