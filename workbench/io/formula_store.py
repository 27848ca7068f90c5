"""The user's named formulas: saved, renamed and deleted, each time the whole file at once."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.named_formulas import (
    NamedFormula,
    add_formulas,
    check_formula,
    formulas_file,
    id_of_name,
    read_formulas,
    text_of_formulas,
)
from workbench.core.registry import registry
from workbench.io.atomic import write_text


class NameTakenError(WorkbenchError):
    """There is a formula of that name, which saving would replace."""


def save_formula(item: NamedFormula, *, replaces: bool = False) -> str:
    """Keep a formula; its id.

    Raises `NameTakenError` where there is one and not `replaces`, `WorkbenchError` where it cannot be used.
    """

    def change(items: list[NamedFormula]) -> list[NamedFormula]:
        place = next((i for i, other in enumerate(items) if other.id == item.id), None)
        if place is not None and not replaces:
            raise NameTakenError(f"There is a formula {items[place].name!r} already; choose another name, or replace it.")
        others = [other for other in items if other.id != item.id]
        check_formula(item, _known(others))
        others.insert(len(others) if place is None else place, item)
        _check_dependents(others)
        return others

    _change(change)
    return item.id


def rename_formula(id: str, name: str) -> str:
    """Another name for a formula; its new id. Raises `WorkbenchError` where it cannot have it."""

    def change(items: list[NamedFormula]) -> list[NamedFormula]:
        renamed = replace(_named(items, id), name=name)
        if renamed.id != id and any(other.id == renamed.id for other in items):
            raise WorkbenchError(f"There is a formula {name!r} already; choose another name.")
        check_formula(renamed, _known([other for other in items if other.id != id]))
        changed = [renamed if other.id == id else other for other in items]
        _check_dependents(changed)
        return changed

    _change(change)
    return id_of_name(name)


def delete_formula(id: str) -> None:
    """Forget a formula. Raises `WorkbenchError` where there is none, or another one refers to it."""

    def change(items: list[NamedFormula]) -> list[NamedFormula]:
        _named(items, id)
        left = [other for other in items if other.id != id]
        _check_dependents(left)
        return left

    _change(change)


def _named(items: Sequence[NamedFormula], id: str) -> NamedFormula:
    found = next((item for item in items if item.id == id), None)
    if found is None:
        known = ", ".join(item.id for item in items) or "none"
        raise WorkbenchError(f"There is no own formula {id!r}; there are: {known}.")
    return found


def _change(change: Callable[[list[NamedFormula]], list[NamedFormula]]) -> None:
    path = formulas_file()
    items, faults = read_formulas(path)
    changed = text_of_formulas(change(items))
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        if faults:
            shutil.copyfile(path, _free_name(path))  # what could not be read may still be mended by hand
    except OSError as error:
        raise WorkbenchError(f"{path} cannot be written: {error.strerror or error}.") from None
    write_text(path, changed)


def _free_name(path: Path) -> Path:
    number = 1
    while (place := path.with_name(f"{path.stem}-damaged-{number}{path.suffix}")).exists():
        number += 1
    return place


def _known(others: Sequence[NamedFormula]) -> dict[str, Distortion]:
    """Distortions of plugins, and those own formulas that can be used."""
    found = registry()
    known = {id: item for id, item in found.distortions.items() if id not in found.own_formulas}
    add_formulas(others, known)
    return known


def _check_dependents(items: Sequence[NamedFormula]) -> None:
    """Raises `WorkbenchError` where a formula that can be used now could not after the change."""
    after = _known(items)
    for item in items:
        if item.id not in after and item.id in registry().distortions:
            raise WorkbenchError(f"The formula {item.name!r} refers to it; change that one first.")
