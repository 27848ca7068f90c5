"""`--set NAME=VALUE`: which method each parameter belongs to."""

from __future__ import annotations

import argparse
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from workbench.core.errors import WorkbenchError

if TYPE_CHECKING:
    from workbench.core.method import Method


def add_set_option(parser: argparse.ArgumentParser, owners: str) -> None:
    parser.add_argument(
        "--set", dest="settings", metavar="NAME=VALUE", type=name_and_value, action="append", default=[],
        help=f"a parameter of {owners}; may be given many times",
    )  # fmt: skip


def name_and_value(text: str) -> tuple[str, str]:
    """`NAME=VALUE` taken apart; argparse's own error otherwise."""
    name, equals, value = text.partition("=")
    if not equals or not name.strip() or not value.strip():
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form NAME=VALUE")
    return name.strip(), value.strip()


def distortion_parameters(text: str) -> tuple[str, ...]:
    """Names that can be set for a distortion: its declared parameters; for a typed formula also its free names."""
    from workbench.core.distortion import Distortion, looks_like_id
    from workbench.core.formula_names import undeclared_names
    from workbench.core.registry import registry

    known = registry().distortions
    if text in known:
        return tuple(item.name for item in known[text].parameters)
    if looks_like_id(text):
        return ()  # it is none; resolving it says so
    free = [item.name for item in undeclared_names(text)]
    return (*(item.name for item in Distortion.from_formula(text).parameters), *free)


def assign(
    settings: Iterable[tuple[str, str]], distortion: str, methods: Sequence[Sequence[type[Method]]] = ()
) -> tuple[dict[str, str], ...]:
    """Settings of the distortion, then of each group of `methods`: a name goes to the first group in which a method has it.

    Raises `WorkbenchError` for a name that none of them has, naming those that there are, and `FormulaError` for a name
    in a typed formula that is not set.
    """
    from workbench.core.distortion import looks_like_id
    from workbench.core.formula_names import check_names
    from workbench.core.registry import registry

    names = (tuple(item.name for method in group for item in method.parameters()) for group in methods)
    forms = [distortion_parameters(distortion), *names]
    chosen: tuple[dict[str, str], ...] = tuple({} for _ in forms)
    for name, value in settings:
        owner = next((i for i, form in enumerate(forms) if name in form), None)
        if owner is None:
            known = ", ".join(dict.fromkeys(item for form in forms for item in form)) or "none"
            raise WorkbenchError(f"There is no parameter {name!r} to set; there are: {known}.")
        chosen[owner][name] = value
    if distortion not in registry().distortions and not looks_like_id(distortion):
        check_names(distortion, chosen[0])
    return chosen
