"""A sign over a view: what is seen there is an earlier map."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtWidgets import QLabel, QWidget

from workbench.app.appearance.theme import Theme

GAP = 8
NAME = "past-badge"


class PastBadge(QLabel):
    """Words at the upper edge of a view, in the middle or, `in_corner`, at the left; the mouse does not see it."""

    def __init__(self, view: QWidget, in_corner: bool = False) -> None:
        super().__init__(view)
        self.setObjectName(NAME)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.hide()
        self._view, self._in_corner = view, in_corner
        view.installEventFilter(self)

    def set_theme(self, theme: Theme) -> None:
        self.setStyleSheet(
            f"#past-badge {{ background: {theme.curves[1]}; color: {'#1c2127' if theme.is_dark else '#ffffff'};"
            " border-radius: 9px; padding: 2px 10px; font-weight: 600; }"
        )

    def say(self, text: str) -> None:
        """Show these words; empty ones hide the badge."""
        self.setText(text)
        self.setVisible(bool(text))
        self._place()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Resize and self.isVisible():
            self._place()
        return False

    def _place(self) -> None:
        self.adjustSize()
        self.setFixedWidth(min(self.sizeHint().width(), max(self._view.width() - 2 * GAP, 1)))
        self.move(GAP if self._in_corner else (self._view.width() - self.width()) // 2, GAP)
        self.raise_()


def badge_of(view: QWidget, theme: Theme, *, in_corner: bool) -> PastBadge:
    """The badge of a view; it is made when it is asked for first, and goes with the view."""
    found = view.findChild(PastBadge, NAME)
    if isinstance(found, PastBadge):
        return found
    badge = PastBadge(view, in_corner)
    badge.set_theme(theme)
    return badge
