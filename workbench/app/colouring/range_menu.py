"""What can be done to a colour range: one menu and one dialog, wherever a range is shown."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QFormLayout, QLabel, QLineEdit, QMenu, QWidget

from workbench.app.colouring.colour_range import ColourRange


def fill_range_menu(menu: QMenu, colour_range: ColourRange, parent: QWidget) -> None:
    """Hold, fit, edit, scale, colours; `parent` owns the dialog."""
    hold = menu.addAction("Hold this range")
    hold.setCheckable(True)
    hold.setChecked(colour_range.is_locked)
    hold.toggled.connect(colour_range.hold)
    menu.addAction("Edit its ends…").triggered.connect(lambda: ask_ends(colour_range, parent))
    menu.addSeparator()
    for text, whole in (("Fit, leaving out the last 1 %", False), ("Fit to all values", True)):
        fit = menu.addAction(text)
        fit.setCheckable(True)
        fit.setChecked(not colour_range.is_locked and colour_range.is_whole is whole)
        fit.triggered.connect(lambda _=False, w=whole: colour_range.fit(whole=w))
    menu.addSeparator()
    scale = menu.addAction("Logarithmic")
    scale.setCheckable(True)
    scale.setChecked(colour_range.is_logarithmic)
    scale.toggled.connect(colour_range.set_logarithmic)
    reverse = menu.addAction("Reverse the colours")
    reverse.setCheckable(True)
    reverse.setChecked(colour_range.is_reversed)
    reverse.toggled.connect(colour_range.set_reversed)
    clip = menu.addAction("Mark what lies beyond the ends")
    clip.setCheckable(True)
    clip.setChecked(colour_range.is_clipped)
    clip.toggled.connect(colour_range.set_clipped)


class EndsDialog(QDialog):
    """The two ends of a range as text; a range that is none is not taken, and the dialog says why."""

    def __init__(self, colour_range: ColourRange, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle(f"Colours of {colour_range.quantity.title}")
        self._range = colour_range
        self.low = QLineEdit(f"{colour_range.low:.6g}", self)
        self.high = QLineEdit(f"{colour_range.high:.6g}", self)
        self.error = QLabel("", self)
        self.error.setObjectName("form-error")
        self.error.setWordWrap(True)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Ok | QDialogButtonBox.StandardButton.Cancel, self)
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        layout = QFormLayout(self)
        layout.addRow("Lower end", self.low)
        layout.addRow("Upper end", self.high)
        layout.addRow(self.error)
        layout.addRow(buttons)
        self.low.selectAll()

    def accept(self) -> None:
        try:
            self._range.set_ends(_number(self.low.text()), _number(self.high.text()))
        except ValueError as error:
            self.error.setText(str(error))
            return
        super().accept()


def _number(text: str) -> float:
    try:
        return float(text.strip().replace(",", "."))
    except ValueError:
        raise ValueError(f"{text.strip() or 'An empty field'} is not a number.") from None


def ask_ends(colour_range: ColourRange, parent: QWidget) -> None:
    """Let the user type the ends."""
    dialog = EndsDialog(colour_range, parent)
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    dialog.open()
