"""Tool tips of methods: what they are, their formula as mathematics, where they come from."""

from __future__ import annotations

import html
import re
from base64 import b64encode

from PySide6.QtCore import QBuffer, QIODevice
from PySide6.QtGui import QColor

from workbench.app.inspector.formula_picture import Drawing, inked
from workbench.app.panels.distortion_box import title_of
from workbench.core.bibliography import bibliography, keys_of
from workbench.core.distortion import Distortion
from workbench.core.method import Method

WIDTH = 360
"""Pixels of a tip, and of the formula in it."""
_TITLE = re.compile(r"^\s*title\s*=\s*\{(.*)\},?\s*$", re.MULTILINE)


def tip_of_distortion(item: Distortion, picture: str = "") -> str:
    """Rich text about a distortion; `picture` is its formula, which stands there as text where there is none."""
    formula = picture or f"<p><code>{html.escape(item.formula)}</code></p>"
    return _tip(title_of(item), formula, item.description, item.citation)


def tip_of_method(method: type[Method]) -> str:
    """Rich text about a solver or an initializer."""
    words = " ".join((method.__doc__ or "").split("\n\n")[0].split())
    return _tip(method.label, "", words, method.citation)


def _tip(title: str, formula: str, words: str, citation: str) -> str:
    parts = [f"<b>{html.escape(title)}</b>", formula]
    if words:
        parts.append(f"<p>{_with_code(html.escape(words))}</p>")
    if citation:
        titles = "".join(f"<br><i>{html.escape(title)}</i>" for title in titles_of(citation))
        parts.append(f"<p><small>{html.escape(citation)}{titles}</small></p>")
    return f'<table width="{WIDTH}"><tr><td>{"".join(parts)}</td></tr></table>'


def _with_code(words: str) -> str:
    return re.sub(r"`([^`]*)`", r"<code>\1</code>", words)


def titles_of(citation: str) -> list[str]:
    """Titles of the works whose keys a citation names, as far as they are known."""
    titles = []
    for key in keys_of(citation):
        found = _TITLE.search(bibliography().get(key, ""))
        if found:
            titles.append(re.sub(r"[{}]|\\(?=\W)", "", found[1]))
    return titles


def picture_of(drawing: Drawing, colour: str) -> str:
    """A drawn formula as an image within rich text."""
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    inked(drawing.ink, QColor(colour)).save(buffer, "PNG")  # type: ignore[call-overload]
    shown = min(round(drawing.ink.shape[1] / drawing.ratio), WIDTH)
    data = b64encode(buffer.data().data()).decode()
    return f'<p><img src="data:image/png;base64,{data}" width="{shown}"></p>'
