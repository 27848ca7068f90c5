"""What a view shows, in words that find it again: the id of a pattern or of a quantity, or a typed formula."""

from __future__ import annotations

from workbench.app.quantities.quantities import Quantity
from workbench.app.quantities.quantity_book import QuantityBook
from workbench.core.errors import WorkbenchError


def words_of(quantity: Quantity) -> object:
    """Its id, or the formula that was typed for it."""
    if quantity.group != "typed":
        return quantity.id
    return {"formula": quantity.text, "parameters": dict(quantity.parameters)}


def quantity_meant(words: object, book: QuantityBook) -> str | None:
    """Id of the quantity that is meant; None where there is none, or not yet. A formula is offered from then on."""
    if isinstance(words, str):
        return words if words in book else None
    if not isinstance(words, dict) or not book.is_listed:
        return None
    given = words.get("parameters")
    parameters = dict(given) if isinstance(given, dict) else {}
    if not all(isinstance(value, int | float) for value in parameters.values()):
        return None
    try:
        return book.add_formula(str(words.get("formula", "")), parameters).id
    except WorkbenchError:
        return None
