"""Numbers with their nouns, in sentences."""

from __future__ import annotations


def count_of(count: int, noun: str) -> str:
    """`3 triangles`, `1 vertex`."""
    return f"{count} {noun if count == 1 else plural(noun)}"


def plural(noun: str) -> str:
    """Plural of the few nouns that meshes need."""
    irregular = {"vertex": "vertices", "tetrahedron": "tetrahedra"}
    return irregular.get(noun, noun + "s")
