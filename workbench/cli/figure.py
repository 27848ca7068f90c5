"""`workbench figure`: figures fit to print, from a preset or a recipe, as PNG, PDF and SVG."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from workbench.cli.options import add_source_options, label_and_file, positive_count
from workbench.cli.output import teller
from workbench.cli.threads import limit_threads
from workbench.core.errors import WorkbenchError
from workbench.engine.interrupt import InterruptFlag

if TYPE_CHECKING:
    from workbench.figures.recipe import Recipe

ALL = "all"
ENDINGS = (".png", ".pdf", ".svg")
PAGE_OPTIONS = ("width", "dpi", "font_size", "background")

DESCRIPTION = """\
NAME is a preset (see `workbench list figures`), or `all` of them; RECIPE is a JSON file. Each becomes NAME.png, NAME.pdf and
NAME.svg in DIR, the same bytes each time. Flat maps are drawn triangle by triangle as vectors; what lies in space, or is
textured, is a picture inside the vector page."""


def add_parser(name: str, commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = commands.add_parser(
        name,
        help="figures fit to print, from presets or recipes",
        description=DESCRIPTION,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    add("figure", metavar="NAME|RECIPE|all", help="a preset, a recipe (.json), or all presets")
    add("--out", required=True, metavar="DIR", help="folder of the figures, made where it is missing")
    add("--mesh", metavar="FILE", help="preset: a mesh of yours, or sample:ID, with the anchors that it comes with")
    add(
        "--given", action="append", default=[], metavar="[LABEL=]FILE",
        help="preset: a map of that mesh, in place of solving for one; may be given many times",
    )  # fmt: skip
    add("--recipe", action="store_true", help="write NAME.json, too: the recipe, to be changed and used again")
    add("--width", type=float, metavar="MM", help="of the page (default: that of the recipe, else 180)")
    add("--dpi", type=int, metavar="N", help="of PNG, and of pictures inside PDF and SVG (default: 300)")
    add("--font-size", type=float, metavar="PT", help="of the text (default: that of the recipe, else 8)")
    add("--background", choices=("white", "transparent"), help="of the page (default: white)")
    add("--threads", type=positive_count, metavar="N", help="threads of the kernels and the linear algebra")
    add("--quiet", action="store_true", help="no progress; errors are still said")
    add_source_options(parser)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Make every figure that was asked for, then write them all."""
    limit_threads(options.threads)
    from workbench.figures.composer import compose
    from workbench.figures.figure_maps import make_maps
    from workbench.figures.recipe_text import write_recipe
    from workbench.figures.save import save_figure
    from workbench.io.atomic import check_folder, filling

    check_folder(options.out)
    tell = teller(options.quiet)
    recipes = {name: _with_page(recipe, options) for name, recipe in _recipes(options).items()}
    with InterruptFlag() as interrupt, filling(options.out) as folder:
        for name, recipe in recipes.items():
            composition = compose(recipe, make_maps(recipe.maps, interrupt=interrupt, tell=tell))
            for note in composition.notes:
                tell(f"{name}: {note}")
            for ending in ENDINGS:
                save_figure(composition.figure, folder / f"{name}{ending}", recipe.page.dpi)
            if options.recipe:
                write_recipe(folder / f"{name}.json", recipe)
    if not options.quiet:
        print(f"{', '.join(recipes)} in {options.out}")
    return 0


def _recipes(options: argparse.Namespace) -> dict[str, Recipe]:
    from workbench.figures.presets import PRESETS, Given, preset_recipe
    from workbench.figures.recipe_text import read_recipe

    name = options.figure
    if name == ALL or name in PRESETS:
        fixes = (*(("tets",) if options.tets else ()), *options.fixes)
        targets = tuple(label_and_file(text) for text in options.given)
        given = Given(options.mesh or "", options.map, fixes, targets)
        return {id: preset_recipe(id, given) for id in (PRESETS if name == ALL else (name,))}
    if options.mesh or options.given or options.fixes or options.tets or options.map != "auto":
        raise WorkbenchError("A recipe names its own meshes and maps; --mesh, --given, --map and --fix are for presets.")
    if not Path(name).suffix and not Path(name).exists():
        raise WorkbenchError(f"There is no figure {name!r}; there are: {', '.join(PRESETS)}, all, or a recipe (.json).")
    return {Path(name).stem: read_recipe(name)}


def _with_page(recipe: Recipe, options: argparse.Namespace) -> Recipe:
    """The recipe on the page that the options ask for. Raises `WorkbenchError` for one that cannot be."""
    from workbench.figures.recipe_text import checked_page

    wanted = {name: value for name in PAGE_OPTIONS if (value := getattr(options, name)) is not None}
    return replace(recipe, page=checked_page(recipe.page, wanted))
