"""A view with its title line: what is shown, and how it is coloured."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QVBoxLayout, QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.colouring.colour_legend import ColourLegend
from workbench.app.colouring.colour_range import ColourRange
from workbench.app.quantities.quantity_book import QuantityBook
from workbench.app.quantities.quantity_chooser import QuantityChooser
from workbench.app.status.status_line import ElidedLabel
from workbench.app.views.mesh_view import MeshView


class ViewPane(QWidget):
    """Title, choice of colouring, the view, and a colour bar below it while it is coloured by a quantity."""

    style_chosen = Signal(str)

    def __init__(
        self,
        title: str,
        styles: dict[str, str],
        book: QuantityBook,
        theme: Theme,
        parent: QWidget | None = None,
    ) -> None:
        """`styles` are the patterns that are offered beside the quantities of the book: id -> label."""
        super().__init__(parent)
        self.styles = dict(styles)
        self._layout = QVBoxLayout(self)
        self._layout.setContentsMargins(0, 0, 0, 0)
        self._layout.setSpacing(0)
        self.header = QWidget(self)
        header = QHBoxLayout(self.header)
        header.setContentsMargins(10, 4, 6, 4)
        header.setSpacing(6)
        self.title = title
        self.name = QLabel(f"<b>{title}</b>", self)
        self.caption = ElidedLabel("", self)
        self.caption.setObjectName("citation")
        self.caption.setMinimumWidth(10)
        self.chooser = QuantityChooser(book, next(iter(styles)), styles, self)
        self.chooser.chosen.connect(self.style_chosen)
        self.chooser.setMinimumContentsLength(21)
        self.chooser.setMinimumWidth(70)  # in a small window it gives way
        header.addWidget(self.name)
        header.addWidget(self.caption, 1)
        header.addWidget(self.chooser)
        self._layout.addWidget(self.header)
        self.view = MeshView(theme, self)
        self._layout.addWidget(self.view, 1)
        self.legend = ColourLegend(book.range_of(book.quantities[0].id), self)
        self.legend.hide()
        self._layout.addWidget(self.legend)

    def add_to_header(self, widget: QWidget) -> None:
        """Put a widget at the end of the title line."""
        layout = self.header.layout()
        assert layout is not None
        layout.addWidget(widget)

    def add_tools(self, tools: QWidget) -> None:
        """Put a row of controls between the title and the view."""
        self._layout.insertWidget(1, tools)

    def add_below(self, widget: QWidget) -> None:
        """Put a widget below the view and its colour bar."""
        self._layout.addWidget(widget)

    def offers(self, style: str) -> bool:
        """Whether a pattern is one of this view's."""
        return style in self.styles

    def set_style(self, id: str) -> None:
        self.chooser.show_choice(id)

    def set_theme(self, theme: Theme) -> None:
        self.view.set_theme(theme)
        self.legend.set_theme(theme)

    def show_colours(self, colour_range: ColourRange | None) -> None:
        """Draw in the colours of a range, its bar below; None hides the bar."""
        self.legend.setVisible(colour_range is not None)
        if colour_range is None:
            return
        self.legend.show_range(colour_range)
        if self.view.surface is not None:
            self.view.surface.show_range(colour_range)
