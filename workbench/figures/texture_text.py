"""How a texture lies on a panel, as JSON: every value within bounds."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from workbench.figures.recipe import PLACES, TextureLook
from workbench.session import schema

STEEPEST = 1e80
"""Of numbers in the matrix: coordinates of meshes are not smaller than its inverse."""


def texture_of(what: str, value: Any) -> TextureLook:
    """The look that a JSON object stands for. Raises `WorkbenchError` naming what is wrong."""
    look = TextureLook(**schema.checked_object(value, TEXTURE, what))
    if len(look.matrix) != len(look.offset):
        raise schema.refuse(f"{what}.offset", look.offset, f"{len(look.matrix)} numbers, one for each row of the matrix")
    return look


def _numbers(what: str, value: Any) -> tuple[float, ...]:
    found = tuple(schema.number(what, entry, -STEEPEST, STEEPEST) for entry in schema.rows(what, value, 3))
    if len(found) < 2:
        raise schema.refuse(what, value, "two or three numbers")
    return found


def _matrix(what: str, value: Any) -> tuple[tuple[float, ...], ...]:
    lines = tuple(_numbers(what, row) for row in schema.rows(what, value, 3))
    if len(lines) < 2 or len({len(line) for line in lines}) > 1:
        raise schema.refuse(what, value, "two or three rows of as many numbers")
    return lines


TEXTURE: dict[str, schema.Check] = {
    "of": schema.one_of(PLACES),
    "matrix": _matrix,
    "offset": _numbers,
    "picture": schema.path,
}
assert set(TEXTURE) == {field.name for field in fields(TextureLook)}
