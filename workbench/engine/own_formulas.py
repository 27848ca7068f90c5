"""Formulas of the user's own in what is given to others: the formula goes along, not the name that only its owner knows."""

from __future__ import annotations

import re
from dataclasses import replace

from workbench.core.distortion import Distortion
from workbench.core.registry import registry
from workbench.session.session import Session

_ID = re.compile(r"[a-z0-9-]+")


def self_contained(choices: Session) -> Session:
    """The choices with a formula of the user's own as the formula that it is, and all its values.

    One that uses another of them stays a name.
    """
    own = registry().own_formulas
    if choices.distortion not in own:
        return choices
    formula = own[choices.distortion].formula
    if _uses_own(formula):
        return choices
    values = Distortion.resolve(choices.distortion, choices.distortion_parameters).parameter_values
    return replace(choices, distortion=formula, distortion_parameters=dict(values))


def with_own_names(choices: Session) -> Session:
    """The choices with a formula that is one of the user's own by its name again."""
    if _ID.fullmatch(choices.distortion):
        return choices
    for id, item in registry().own_formulas.items():
        if item.formula == choices.distortion and not _uses_own(item.formula):
            names = Distortion.resolve(id, {}).parameter_values
            if set(choices.distortion_parameters) <= set(names):
                return replace(choices, distortion=id)
    return choices


def _uses_own(formula: str) -> bool:
    return any(re.search(rf"\b{id.replace('-', '_')}\b", formula) for id in registry().own_formulas)
