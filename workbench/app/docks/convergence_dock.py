"""Live convergence curves: energy, gradient norm, inverted count, over iterations or seconds; marks of switches."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtWidgets import QCheckBox, QComboBox, QDockWidget, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.docks.dock_title import DockTitle
from workbench.app.docks.plot_place import PlotPlace
from workbench.app.document.history import History
from workbench.app.document.switches import Switches

if TYPE_CHECKING:
    from workbench.app.docks.convergence_plots import ConvergencePlots

CURVES = (("energy", "Energy"), ("gradient_norm", "Gradient"), ("inverted", "Inverted"))


class ConvergenceDock(QDockWidget):
    """Three plots side by side with one abscissa; each is one standing curve, with a mark where something was switched."""

    def __init__(self, history: History, switches: Switches, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__("Convergence", parent)
        self.setObjectName("convergence")
        self.setTitleBarWidget(DockTitle(self, QLabel(self.windowTitle(), self)))
        self._history = history
        self._switches = switches
        body = QWidget(self)
        layout = QVBoxLayout(body)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        bar = QHBoxLayout()
        bar.setContentsMargins(8, 3, 8, 3)
        self.abscissa = QComboBox(body)
        self.abscissa.addItem("iterations", "iteration")
        self.abscissa.addItem("seconds", "seconds")
        self.abscissa.currentIndexChanged.connect(lambda _: self.refresh())
        self.logarithmic = QCheckBox("logarithmic", body)
        self.logarithmic.setChecked(True)
        self.logarithmic.toggled.connect(self._set_logarithmic)
        bar.setSpacing(6)
        bar.addWidget(QLabel("over ", body))
        bar.addWidget(self.abscissa)
        bar.addWidget(self.logarithmic)
        bar.addStretch(1)
        layout.addLayout(bar)
        self.place = PlotPlace(self._make_plots, (290, 110), body)
        layout.addWidget(self.place, 1)
        self.setWidget(body)
        self.set_theme(theme)

    def _make_plots(self, parent: QWidget) -> ConvergencePlots:
        from workbench.app.docks.convergence_plots import ConvergencePlots

        plots = ConvergencePlots([title for _, title in CURVES], parent)
        plots.set_logarithmic(self.logarithmic.isChecked())
        return plots

    @property
    def plots(self) -> ConvergencePlots:
        """The three plots, made when they are first asked for."""
        plots: ConvergencePlots = self.place.plot
        return plots

    def set_theme(self, theme: Theme) -> None:
        self.place.set_theme(theme)

    def _set_logarithmic(self, wanted: bool) -> None:
        if self.place.is_made:
            self.plots.set_logarithmic(wanted)
            self.refresh()

    def refresh(self) -> None:
        """Draw what the history holds now, where the plots are made."""
        if not self.place.is_made:
            return
        over = self.abscissa.currentData()
        columns = [self._history.column(name) for name, _ in CURVES]
        self.plots.show_columns(self._history.column(over), columns, self._switches, over)
