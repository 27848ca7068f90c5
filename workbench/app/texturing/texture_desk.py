"""The window's part of patterns: their menu and dialog, pictures that are chosen or dropped."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, QPoint
from PySide6.QtWidgets import QMenu

from workbench.app.document.first_start import has_own_map
from workbench.app.files.file_choice import ask_file
from workbench.app.texturing.pattern_dialog import PatternDialog
from workbench.app.views.pane import ViewPane
from workbench.app.views.textures import PATTERN_LABELS
from workbench.core.errors import WorkbenchError
from workbench.io.picture import is_picture

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

FILTERS = "Pictures (*.png *.jpg *.jpeg)"


class TextureDesk(QObject):
    """One dialog at a time; a picture goes to the view that it was dropped on, or to the source."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self.dialog: PatternDialog | None = None
        window.actions_by_name["picture"].triggered.connect(lambda _=False: self.ask_picture(window.source))
        window.actions_by_name["pattern"].triggered.connect(lambda _=False: self.ask())
        for pane in (window.source, window.target):
            pane.style_chosen.connect(partial(self._picture_chosen, pane))

    def fill_menu(self, menu: QMenu) -> None:
        """Patterns for the source, a picture, and how they lie."""
        for id, label in PATTERN_LABELS.items():
            if id != "picture":
                action = menu.addAction(label)
                action.setToolTip(f"Source: {label.lower()}")
                action.triggered.connect(lambda _=False, style=id: self._window.set_source_style(style))
        menu.addSeparator()
        for name in ("picture", "pattern"):
            menu.addAction(self._window.actions_by_name[name])

    def ask(self) -> None:
        """Size, turn and place of the pattern, in a window of their own."""
        if self.dialog is None:
            self.dialog = PatternDialog(self._window.texturing, self._window)
            self.dialog.picture_wanted.connect(lambda: self.ask_picture(self._window.source))
            self.dialog.destroyed.connect(self._closed)
            self.dialog.show()
        self.dialog.raise_()

    def _closed(self, _: Any = None) -> None:
        self.dialog = None

    # ------------------------------------------------------------------------------------------ pictures

    @staticmethod
    def takes(path: str) -> bool:
        """Whether a file is a picture by its ending."""
        return is_picture(path)

    def pane_at(self, place: QPoint) -> ViewPane:
        """The large view at a place of the window; the source where there is none."""
        target = self._window.target
        return target if target.rect().contains(target.mapFrom(self._window, place)) else self._window.source

    def ask_picture(self, pane: ViewPane) -> None:
        """Choose a file; a view shows it."""
        window = self._window
        folder = str(Path(window.texturing.layout.picture).parent) if window.texturing.has_picture else ""
        ask_file(window, "A picture on the mesh", FILTERS, lambda path: self.show_picture(path, pane), place=folder)

    def show_picture(self, path: str, pane: ViewPane | None = None) -> None:
        """Lay the picture of a file over a view, or say why not."""
        window = self._window
        try:
            window.texturing.take_picture(str(Path(path).expanduser().resolve()))
        except WorkbenchError as error:
            window.error_bar.show_message(error.sentence)
            return
        is_by_uvs = has_own_map(window.document.session)
        window.texturing.choose(of_unit=is_by_uvs)
        pane = pane or window.source
        window.colouring.set_style(pane, "picture")
        name = "target" if pane is window.target else "source"
        how = " by u and v from 0 to 1" if is_by_uvs and not window.texturing.layout.of_source else ""
        window.status.say(f"{Path(path).name} lies on the {name}{how}; View > Pattern > Size and turn… fits it.")

    def _picture_chosen(self, pane: ViewPane, style: str) -> None:
        if style == "picture" and not self._window.texturing.has_picture:
            self.ask_picture(pane)
