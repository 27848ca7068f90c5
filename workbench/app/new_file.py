"""Asking for the name of a file that is not there yet."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog, QWidget


def ask_new_file(
    parent: QWidget,
    title: str,
    place: str,
    filters: str,
    suffix: str,
    take: Callable[[str], object],
    *,
    overwrites: bool = False,
) -> None:
    """Open a file dialog at `place` without stopping the event loop; `take` gets the path, whose ending is that of the filter.

    A file that is there may be named: whoever takes the path refuses it in words of its own, or, where it `overwrites`, the
    dialog has asked whether it may.
    """
    dialog = QFileDialog(parent, title, place, filters)
    dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
    dialog.setOption(QFileDialog.Option.DontConfirmOverwrite, not overwrites)
    dialog.setDefaultSuffix(suffix)
    dialog.filterSelected.connect(lambda chosen: dialog.setDefaultSuffix(chosen.partition("*.")[2].rstrip(")")))
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    dialog.fileSelected.connect(take)
    dialog.open()
