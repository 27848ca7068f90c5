"""How views are is read back as it was written, and nothing else is taken."""

from __future__ import annotations

import copy
from typing import Any

import pytest

from workbench.core.errors import WorkbenchError
from workbench.session.record import SessionRecord
from workbench.session.session import Session
from workbench.session.text import parsed, plain_of, readable, record_of
from workbench.session.view_schema import DEEPEST, views

EYE = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
VIEWS: dict[str, Any] = {
    "layout": {
        "centre": {
            "split": "right",
            "sizes": [300, 200],
            "parts": ["source", {"split": "below", "sizes": [1, 2], "parts": ["target", "pane-1"]}],
        }
    },
    "panes": {
        "pane-1": {
            "side": "target",
            "shows": {"formula": "t*sigma1", "parameters": {"t": 2.0}},
            "camera": {"focal": [0.5, -1.0], "half_height": 2.5, "axes": EYE},
            "linked": False,
            "draws": {"edges": None, "wireframe": True},
            "range": {"low": 1.0, "high": 4.0, "clipped": True},
        },
        "target": {"shows": "mips", "closed": True},
    },
    "ranges": {"mips": {"reversed": True, "low": 2.0, "high": 3.0}},
    "draws": {"scale_bar": True},
    "readings": True,
    "pattern": {"size": 2.0, "degrees": -30.0, "of_source": True, "picture": "/home/me/me.png"},
    "glyphs": {"kind": "ellipses", "number": 0.5, "size": 2.0, "places": ["target"]},
}


def test_views_come_back_as_they_were() -> None:
    plain, arrays = plain_of(SessionRecord(Session(source="sample:bar"), views=VIEWS))
    again = record_of(parsed(readable(plain)), arrays)
    assert again.views == VIEWS


def test_views_that_were_read_are_written_once_more() -> None:
    read = views("views", VIEWS)
    assert views("views", read) == read == VIEWS, "scripts and copies are made of what was read"


def test_a_session_without_views_says_nothing_of_them() -> None:
    plain, arrays = plain_of(SessionRecord(Session(source="sample:bar")))
    assert "views" not in plain and record_of(plain, arrays).views is None
    plain, arrays = plain_of(SessionRecord(Session(source="sample:bar"), views={}))
    assert record_of(plain, arrays).views == {}, "those of a fresh window are something else than none"


def nested(depth: int) -> dict[str, Any]:
    tree: dict[str, Any] = {"split": "right", "sizes": [1], "parts": ["source"]}
    for _ in range(depth):
        tree = {"split": "right", "sizes": [1], "parts": [tree]}
    return tree


HOSTILE: list[tuple[tuple[str, ...], Any]] = [
    (("pattern",), [1]),
    (("pattern", "size"), 0.0),
    (("pattern", "picture"), "a\nb"),
    (("glyphs", "kind"), "hedgehogs"),
    (("glyphs", "number"), 1e9),
    (("glyphs", "places"), ["source", "target", "source"]),
    (("glyphs", "places"), ["carried"]),
    (("layout",), []),
    (("layout", "centre"), "source"),
    (("layout", "centre", "split"), "aside"),
    (("layout", "centre", "sizes"), [1]),
    (("layout", "centre", "sizes"), [1, -1]),
    (("layout", "centre", "sizes"), [1, 10**9]),
    (("layout", "centre", "sizes"), [True, 2]),
    (("layout", "centre", "parts"), ["source", "source"]),
    (("layout", "centre", "parts"), ["source", "pane-7"]),
    (("layout", "centre", "parts"), ["source", 5]),
    (("layout", "centre"), nested(DEEPEST)),
    (("layout", "centre"), nested(500)),
    (("panes",), {f"pane-{i}": {} for i in range(100)}),
    (("panes", "pane-1", "side"), "outside"),
    (("panes", "pane-1", "shows"), 5),
    (("panes", "pane-1", "shows"), {"formula": "x" * 30_000}),
    (("panes", "pane-1", "shows"), {"formula": "sigma1", "parameters": {"t": "1"}}),
    (("panes", "pane-1", "shows"), {"code": "import os"}),
    (("panes", "pane-1", "camera", "axes"), [[1, 0, 0], [1, 0, 0], [0, 0, 1]]),
    (("panes", "pane-1", "camera", "axes"), [[1, 0], [0, 1]]),
    (("panes", "pane-1", "camera", "half_height"), 0.0),
    (("panes", "pane-1", "camera", "half_height"), 1e300),
    (("panes", "pane-1", "camera", "focal"), [1.0]),
    (("panes", "pane-1", "camera"), {"axes": EYE, "focal": [1.0, 2.0]}),
    (("panes", "pane-1", "linked"), 1),
    (("panes", "pane-1", "draws", "edges"), "yes"),
    (("panes", "pane-1", "draws"), {"fire": True}),
    (("panes", "pane-1", "range"), {"low": 1.0}),
    (("panes", "pane-1", "window"), {}),
    (("ranges", "mips", "high"), 1e200),
    (("ranges",), {"a" * 600: {}}),
    (("readings",), "no"),
    (("theme",), "dark"),
]


@pytest.mark.parametrize(("place", "value"), HOSTILE, ids=[f"{'.'.join(p)}-{i}" for i, (p, _) in enumerate(HOSTILE)])
def test_what_is_no_view_is_refused(place: tuple[str, ...], value: Any) -> None:
    changed = copy.deepcopy(VIEWS)
    part = changed
    for name in place[:-1]:
        part = part[name]
    part[place[-1]] = value
    with pytest.raises(WorkbenchError):
        views("views", changed)
    plain, arrays = plain_of(SessionRecord(Session(source="sample:bar")))
    with pytest.raises(WorkbenchError):
        record_of(plain | {"views": changed}, arrays)
