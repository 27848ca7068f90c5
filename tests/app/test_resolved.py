"""Formulas are read once, and anew when what they name has changed."""

from __future__ import annotations

from dataclasses import replace

import pytest

from workbench.app.document import resolved as module
from workbench.app.document.resolved import KEPT, resolved
from workbench.core.errors import WorkbenchError
from workbench.core.registry import registry


def test_the_same_choice_is_read_once_and_another_one_is_not_mixed_up_with_it() -> None:
    item = resolved("t*mips", {"t": 2.0})
    assert resolved("t*mips", {"t": 2.0}) is item
    assert resolved("t*mips", {"t": 3.0}).parameter_values == {"t": 3.0}
    assert resolved("mips") is resolved("mips", {})
    for _ in range(2):
        with pytest.raises(WorkbenchError):
            resolved("no_such(sigma)")


def test_few_are_kept() -> None:
    first = resolved("1.5*det")
    for factor in range(2, KEPT + 2):
        resolved(f"{factor}*det")
    assert resolved("1.5*det") is not first


def test_what_a_name_stands_for_may_change(monkeypatch: pytest.MonkeyPatch) -> None:
    before = resolved("2*mips")
    other = replace(registry(), distortions=dict(registry().distortions))
    monkeypatch.setattr(module, "registry", lambda: other)
    assert resolved("2*mips") is not before
