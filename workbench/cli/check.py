"""`workbench check`: whether a text is a formula, what it says at a similarity, and what it is good for."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any

from workbench.cli.settings import add_set_option
from workbench.io.json_text import json_text
from workbench.io.tables import number, table

if TYPE_CHECKING:
    from workbench.core.analysis import Analysis, Property
    from workbench.core.distortion import Distortion


def add_parser(name: str, commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = commands.add_parser(name, help="read a distortion's formula: refused with the reason, or its properties")
    parser.add_argument("distortion", metavar="ID|FORMULA", help="a registered distortion, or a formula in sigma")
    add_set_option(parser, "the formula")
    parser.add_argument("--dim", type=int, choices=(2, 3), default=2, help="dimension of the simplices (default: 2)")
    parser.add_argument("--json", action="store_true", help="one JSON object")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print what the formula is and which properties it has; `FormulaError` says why it is none."""
    from workbench.core.analysis import analyse
    from workbench.core.distortion import Distortion
    from workbench.engine.parameter_owners import assign

    (values,) = assign(options.settings, options.distortion)
    distortion = Distortion.resolve(options.distortion, values)
    analysis = analyse(distortion, options.dim)
    if options.json:
        print(json_text({**_facts(distortion, options.dim), **_properties(analysis)}), end="")
    else:
        _print(_facts(distortion, options.dim), analysis)
    return 0


def _facts(distortion: Distortion, dimension: int) -> dict[str, Any]:
    """What the formula is, without any search."""
    import numpy as np

    identity = np.ones((1, dimension))
    return {
        "id": distortion.id,
        "label": distortion.label,
        "formula": distortion.formula,
        "parameters": distortion.parameter_values,
        "dim": dimension,
        "accepted": True,
        "value_at_ones": float(distortion.value(identity)[0]),
        "gradient_at_ones": distortion.gradient(identity)[0],
        "barrier": distortion.has_barrier(dimension),
    }


def _properties(analysis: Analysis) -> dict[str, dict[str, Any]]:
    return {
        name: {"holds": p.holds, "method": p.method, "sentence": p.sentence, "witness": p.witness, "value": p.value}
        for name, p in analysis.items()
    }


def _print(facts: dict[str, Any], analysis: Analysis) -> None:
    parameters = ", ".join(f"{key} = {number(value)}" for key, value in facts["parameters"].items())
    print(f"{facts['label']}: {facts['formula']}" + (f" with {parameters}" if parameters else ""))
    ones = ", ".join(["1"] * facts["dim"])
    print(f"value at ({ones}): {number(facts['value_at_ones'], 12)}")
    print("counts as infinite on inverted simplices" if facts["barrier"] else "finite on inverted simplices: no barrier")
    print()
    print(table([_row(name, p) for name, p in analysis.items()]))


def _row(name: str, found: Property) -> tuple[str, str, str]:
    answer = {True: "yes", False: "no", None: "open"}[found.holds]
    return name.replace("_", " "), answer, found.sentence
