"""What each view and panel shows, kept from one use of the window to the next."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from workbench.app.view_states.range_state import range_state, take_range_state
from workbench.app.view_states.words import quantity_meant, words_of

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

Plain = dict[str, Any]
"""Texts, numbers, yes and no, and tables of them: what a settings file can hold."""


class ViewMemory:
    """Quantities of views and panels, scales of colours, choices of histogram, curves and inspector, how solids are cut.

    Ends that were set by hand, and where a plane stood, belong to a mesh and are not kept. What can no longer be shown, as a
    formula of one's own that was deleted, leaves the view as it begins.
    """

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        self._begins = {name: self._shown(name) for name in self._names}
        self._waiting: Plain = {}
        self._scales: Plain = {}
        window.quantities.listed.connect(self._go_on)

    @property
    def _names(self) -> tuple[str, ...]:
        return ("source", "target", *(dock.objectName() for dock in self._panels))

    @property
    def _panels(self) -> list[Any]:
        return [*self._window.maps, self._window.histogram]

    def _shown(self, name: str) -> str:
        """Name of a pattern, or id of a quantity."""
        window = self._window
        if name in ("source", "target"):
            return window.colouring.style_of(getattr(window, name))
        return next(str(dock.quantity) for dock in self._panels if dock.objectName() == name)

    def _show(self, name: str, id: str) -> None:
        window = self._window
        if name in ("source", "target"):
            window.colouring.set_style(getattr(window, name), id)
        else:
            next(dock for dock in self._panels if dock.objectName() == name).show_quantity(id)

    # ------------------------------------------------------------------------------------------ keeping

    def state(self) -> Plain:
        """Everything that is kept, as plain values."""
        window, book = self._window, self._window.quantities
        shown = {name: self._shown(name) for name in self._names}
        # what still waits for its formula to be found is kept as it was
        views = {name: words_of(book[id]) if id in book else id for name, id in shown.items()} | self._waiting
        states = {r.quantity.id: range_state(r, with_ends=False) for r in book.ranges()}
        scales = {id: state for id, state in states.items() if state}
        return {
            "views": views,
            "scales": self._scales | scales,
            "histogram": {
                "weighted": window.histogram.is_weighted,
                "logarithmic": window.histogram.has_logarithmic_counts,
            },
            "convergence": {
                "abscissa": window.convergence.abscissa.currentIndex(),
                "logarithmic": window.convergence.logarithmic.isChecked(),
            },
            "inspector": {"page": window.inspector.page},
            "solid": window.volume.kept(),
            "splits": window.view_states.state(of_mesh=False),
            "pattern": window.texturing.kept(),
            "glyphs": window.glyphs.kept(),
        }

    # ------------------------------------------------------------------------------------------ taking up

    def restore(self, state: Plain) -> None:
        """Show what was kept; what needs the methods is shown when they are listed. Values of another kind are passed over."""
        window = self._window
        histogram, curves = _table(state, "histogram"), _table(state, "convergence")
        window.histogram.set_weighted(histogram.get("weighted") is True)
        window.histogram.set_logarithmic_counts(histogram.get("logarithmic") is True)
        window.convergence.logarithmic.setChecked(curves.get("logarithmic") is not False)
        _choose(window.convergence.abscissa, curves.get("abscissa"))
        page = _table(state, "inspector").get("page")
        window.inspector.page = page if isinstance(page, int) else 0
        window.volume.take_kept(_table(state, "solid"))
        window.texturing.take_kept(_table(state, "pattern"))
        window.glyphs.take_kept(_table(state, "glyphs"))
        window.view_states.restore(_table(state, "splits"))
        self._waiting = {name: words for name, words in _table(state, "views").items() if name in self._begins}
        self._scales = _table(state, "scales")
        self._go_on()

    def _go_on(self) -> None:
        """Show what can be shown by now, but where the user has chosen something else meanwhile."""
        book = self._window.quantities
        for name, words in list(self._waiting.items()):
            id = self._id_of(name, words)
            if id is not None or book.is_listed:
                self._waiting.pop(name, None)
            if id is not None and self._shown(name) == self._begins[name] != id:
                self._show(name, id)
        for id in [id for id in self._scales if id in book]:
            take_range_state(book.range_of(id), self._scales.pop(id))
        if book.is_listed:
            self._scales = {}

    def _id_of(self, name: str, words: object) -> str | None:
        """The pattern or quantity that is meant; None where there is none, or not yet."""
        book = self._window.quantities
        if isinstance(words, str):
            is_pattern = name in ("source", "target") and getattr(self._window, name).offers(words)
            return words if is_pattern or words in book else None
        return quantity_meant(words, book)


def _table(state: Plain, name: str) -> Plain:
    found = state.get(name)
    return dict(found) if isinstance(found, dict) else {}


def _choose(widget: Any, index: object) -> None:
    """Choose a row or a tab by its number, where there is one."""
    if isinstance(index, int) and 0 <= index < widget.count():
        widget.setCurrentIndex(index)
