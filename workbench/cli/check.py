"""`workbench check`: whether a text is a formula, and what it says at a similarity."""

from __future__ import annotations

import argparse

from workbench.cli.output import json_text, number
from workbench.cli.settings import add_set_option, assign


def add_parser(name: str, commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = commands.add_parser(name, help="read a distortion's formula: accepted with its values, or refused with the reason")
    parser.add_argument("distortion", metavar="ID|FORMULA", help="a registered distortion, or a formula in sigma")
    add_set_option(parser, "the formula")
    parser.add_argument("--dim", type=int, choices=(2, 3), default=2, help="dimension of the simplices (default: 2)")
    parser.add_argument("--json", action="store_true", help="one JSON object")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print what the formula is; `FormulaError` says why not."""
    import numpy as np

    from workbench.core.distortion import Distortion

    (values,) = assign(options.settings, options.distortion)
    distortion = Distortion.resolve(options.distortion, values)
    distortion.compiled(options.dim)
    identity = np.ones((1, options.dim))
    facts = {
        "id": distortion.id,
        "label": distortion.label,
        "formula": distortion.formula,
        "parameters": distortion.parameter_values,
        "dim": options.dim,
        "accepted": True,
        "value_at_ones": float(distortion.value(identity)[0]),
        "gradient_at_ones": distortion.gradient(identity)[0],
        "barrier": distortion.has_barrier(options.dim),
    }
    if options.json:
        print(json_text(facts), end="")
        return 0
    parameters = ", ".join(f"{key} = {number(value)}" for key, value in facts["parameters"].items())
    print(f"{facts['label']}: {facts['formula']}" + (f" with {parameters}" if parameters else ""))
    ones = ", ".join(["1"] * options.dim)
    print(f"value at ({ones}): {number(facts['value_at_ones'], 12)}")
    print("counts as infinite on inverted simplices" if facts["barrier"] else "finite on inverted simplices: no barrier")
    return 0
