"""Asking for the name of a file that is to be written."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog, QWidget

from workbench.app.files.file_choice import remember_folder
from workbench.io.opening import SAMPLE


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
    dialog.filterSelected.connect(lambda chosen: dialog.setDefaultSuffix(ending_of(chosen) or suffix))
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    dialog.fileSelected.connect(lambda path: remember_folder(parent, path))
    dialog.fileSelected.connect(take)
    dialog.open()


def ending_of(name_filter: str) -> str:
    """First ending that a name filter of a dialog stands for; empty where it stands for all."""
    found = re.search(r"\*\.(\w+)", name_filter)
    return found.group(1) if found else ""


def endings_of(filters: str) -> frozenset[str]:
    """Endings, in small letters with their dots, of the first of some name filters: those that are meant."""
    return frozenset(f".{ending.lower()}" for ending in re.findall(r"\*\.(\w+)", filters.split(";;")[0]))


def stem_of(source: str) -> str:
    """What files that are made of a source are called: its own name without the ending, or the sample's."""
    return Path(source.replace(SAMPLE, "")).stem
