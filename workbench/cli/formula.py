"""`workbench formula`: formulas under names of the user's own."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from workbench.cli.settings import add_set_option, name_and_value
from workbench.core.errors import WorkbenchError

if TYPE_CHECKING:
    from workbench.core.method import Parameter


def add_parser(name: str, commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = commands.add_parser(name, help="keep a formula under a name, rename or delete it; `list distortions` shows them")
    deeds = parser.add_subparsers(title="what to do", metavar="save|rename|delete", required=True)
    save = deeds.add_parser("save", help="keep a formula; its parameters keep their values")
    save.add_argument("name", metavar="NAME", help="a few words; they give the id")
    save.add_argument("formula", metavar="FORMULA")
    add_set_option(save, "the formula")
    save.add_argument(
        "--range", dest="ranges", metavar="NAME=LOW:HIGH", type=name_and_value, action="append", default=[],
        help="between what a parameter may lie; may be given many times",
    )  # fmt: skip
    save.add_argument("--note", default="", metavar="TEXT", help="what it is good for")
    save.add_argument("--replace", action="store_true", help="take the place of the formula of that name")
    save.set_defaults(run=run_save)
    rename = deeds.add_parser("rename", help="give a formula another name")
    rename.add_argument("id", metavar="ID")
    rename.add_argument("name", metavar="NAME")
    rename.set_defaults(run=run_rename)
    delete = deeds.add_parser("delete", help="forget a formula")
    delete.add_argument("id", metavar="ID")
    delete.set_defaults(run=run_delete)


def run_save(options: argparse.Namespace) -> int:
    """Keep a formula and say its id."""
    from workbench.core.distortion import Distortion
    from workbench.core.named_formulas import NamedFormula
    from workbench.engine.parameter_owners import assign
    from workbench.io.formula_store import NameTakenError, save_formula

    (values,) = assign(options.settings, options.formula)
    item = Distortion.resolve(options.formula, values)
    ranges = dict(options.ranges)
    foreign = ranges.keys() - item.parameter_values.keys()
    if foreign:
        known = ", ".join(item.parameter_values) or "none; name it in the formula and give it a value with --set"
        raise WorkbenchError(f"The formula has no parameter {min(foreign)!r} for --range; there are: {known}.")
    parameters = tuple(_as_saved(p, item.parameter_values[p.name], ranges.get(p.name)) for p in item.parameters)
    formula = NamedFormula(options.name, item.formula, parameters, options.note)
    try:
        print(save_formula(formula, replaces=options.replace))
    except NameTakenError:
        raise WorkbenchError(f"There is a formula {options.name!r} already; add --replace, or choose another name.") from None
    return 0


def _as_saved(parameter: Parameter, value: float, span: str | None) -> Parameter:
    from dataclasses import replace

    if span is None:
        return replace(parameter, default=parameter.type(value))
    low, _, high = span.partition(":")
    try:
        return replace(parameter, default=parameter.type(value), minimum=float(low), maximum=float(high))
    except ValueError:
        raise WorkbenchError(f"--range {parameter.name}={span} is not of the form NAME=LOW:HIGH, two numbers.") from None


def run_rename(options: argparse.Namespace) -> int:
    """Give a formula another name and say its id."""
    from workbench.io.formula_store import rename_formula

    print(rename_formula(options.id, options.name))
    return 0


def run_delete(options: argparse.Namespace) -> int:
    """Forget a formula."""
    from workbench.io.formula_store import delete_formula

    delete_formula(options.id)
    return 0
