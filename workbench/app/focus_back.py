"""Where keys go when the part of the window that had them is put away."""

from __future__ import annotations

from PySide6.QtWidgets import QWidget


def give_focus_back(part: QWidget) -> None:
    """To be called before `part` is hidden: Qt would choose the next field, and Space would be typed instead of run."""
    focused = part.window().focusWidget()
    if focused is not None and (part is focused or part.isAncestorOf(focused)):
        part.window().setFocus()
