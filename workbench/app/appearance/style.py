"""The little that the palette cannot say."""

from __future__ import annotations

from PySide6.QtWidgets import QApplication

from workbench.app.appearance.theme import Theme

SMALL = 0.92
"""Size of citations and the like, beside that of other words."""


def _sliders_in_the_dark(theme: Theme) -> str:
    """Sliders that are told from a dark window: the style draws groove and handle darker still."""
    knob = "width: 11px; height: 11px; margin: -5px 0; border-radius: 6px;"
    return f"""
    QSlider {{ min-height: 18px; }}
    QSlider::groove:horizontal {{ height: 4px; border-radius: 2px; background: {theme.border}; }}
    QSlider::sub-page:horizontal {{ height: 4px; border-radius: 2px; background: {theme.accent}; }}
    QSlider::sub-page:horizontal:disabled {{ background: {theme.border}; }}
    QSlider::handle:horizontal {{ {knob} background: {theme.text}; border: 1px solid {theme.window}; }}
    QSlider::handle:horizontal:disabled {{ {knob} background: {theme.faint}; }}
    """


def style_sheet(theme: Theme) -> str:
    small = SMALL * QApplication.font().pointSizeF()
    return f"""
    QDockWidget {{ color: {theme.text}; }}
    QDockWidget::title {{ background: {theme.window}; padding: 4px 8px; border-bottom: 1px solid {theme.border}; }}
    QWidget#dock-title {{ background: {theme.window}; border-bottom: 1px solid {theme.border}; }}
    QMainWindow::separator {{ background: {theme.border}; width: 4px; height: 4px; }}
    QSplitter::handle {{ background: {theme.border}; width: 3px; }}
    QLabel#citation {{ color: {theme.faint}; font-size: {small:.1f}pt; }}
    QLabel#form-error {{ color: {"#ff8a80" if theme.is_dark else "#b3261e"}; }}
    QGroupBox {{ border: 1px solid {theme.border}; border-radius: 5px; margin-top: 9px; padding-top: 6px; }}
    QGroupBox::title {{ subcontrol-origin: margin; left: 8px; padding: 0 4px; color: {theme.text}; font-weight: 600; }}
    QCheckBox::indicator:unchecked, QListView::indicator:unchecked, QTableView::indicator:unchecked {{
        border: 1px solid {theme.faint}; border-radius: 2px; background: {theme.base}; width: 12px; height: 12px; }}
    QToolButton#switch:checked {{ background: {theme.accent}; color: #ffffff; border: 1px solid {theme.accent};
        border-radius: 3px; padding: 3px 5px; }}
    QToolButton#switch:checked:disabled {{ background: {theme.border}; color: {theme.faint}; border-color: {theme.border}; }}
    QFrame#palette {{ background: {theme.window}; border: 1px solid {theme.faint}; border-radius: 6px; }}
    QFrame#palette QListView {{ background: {theme.window}; }}
    QFrame#progress-line {{ background: {theme.window}; border: 1px solid {theme.border}; border-radius: 5px; }}
    QStatusBar {{ border-top: 1px solid {theme.border}; }}
    QStatusBar::item {{ border: 0; }}
    QToolBar {{ border: 0; border-bottom: 1px solid {theme.border}; spacing: 3px; padding: 2px; }}
    QToolTip {{ background: {theme.base}; color: {theme.text}; border: 1px solid {theme.border}; padding: 3px; }}
    """ + (_sliders_in_the_dark(theme) if theme.is_dark else "")
