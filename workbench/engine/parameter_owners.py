"""Parameters by name: which method each of them belongs to."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from workbench.core.distortion import Distortion, looks_like_id
from workbench.core.errors import WorkbenchError
from workbench.core.formula_names import check_names, undeclared_names
from workbench.core.method import Method
from workbench.core.registry import registry


def distortion_parameters(distortion: str | Distortion) -> tuple[str, ...]:
    """Names that can be set for a distortion: its declared parameters; for a typed formula also its free names."""
    known = registry().distortions
    if isinstance(distortion, str) and distortion in known:
        distortion = known[distortion]
    if isinstance(distortion, Distortion):
        return tuple(item.name for item in distortion.parameters)
    if looks_like_id(distortion):
        return ()  # it is none; resolving it says so
    free = [item.name for item in undeclared_names(distortion)]
    return (*(item.name for item in Distortion.from_formula(distortion).parameters), *free)


def assign(
    settings: Iterable[tuple[str, Any]], distortion: str | Distortion, methods: Sequence[Sequence[type[Method]]] = ()
) -> tuple[dict[str, Any], ...]:
    """Settings of the distortion, then of each group of `methods`: a name goes to the first group in which a method has it.

    Raises `WorkbenchError` for a name that none of them has, naming those that there are, and `FormulaError` for a name
    in a typed formula that is not set.
    """
    names = (tuple(item.name for method in group for item in method.parameters()) for group in methods)
    forms = [distortion_parameters(distortion), *names]
    chosen: tuple[dict[str, Any], ...] = tuple({} for _ in forms)
    for name, value in settings:
        owner = next((i for i, form in enumerate(forms) if name in form), None)
        if owner is None:
            known = ", ".join(dict.fromkeys(item for form in forms for item in form)) or "none"
            raise WorkbenchError(f"There is no parameter {name!r} to set; there are: {known}.")
        chosen[owner][name] = value
    if isinstance(distortion, str) and distortion not in registry().distortions and not looks_like_id(distortion):
        check_names(distortion, chosen[0])
    return chosen
