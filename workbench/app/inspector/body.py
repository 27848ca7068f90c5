"""What is in the inspector: a page for the formula and its properties, and one for each plot."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QSizePolicy, QTabWidget, QVBoxLayout, QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.document.document import Document
from workbench.app.inspector.curves_page import CurvesPage
from workbench.app.inspector.formula_page import FormulaPage
from workbench.app.inspector.mirror_page import MirrorPage
from workbench.app.inspector.page import Page
from workbench.app.inspector.plane_page import PlanePage
from workbench.app.inspector.star_page import StarPage
from workbench.app.inspector.subject import Subject
from workbench.app.panels.distortion_box import title_of
from workbench.app.simplex_brush import SimplexBrush


class Heading(Page):
    """Name of the distortion, and the dimension it is looked at in."""

    def __init__(self, subject: Subject, parent: QWidget | None = None) -> None:
        super().__init__(subject, parent)
        self.name = QLabel(self)
        self.name.setTextFormat(Qt.TextFormat.PlainText)
        self.name.setWordWrap(True)
        self.name.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Minimum)
        font = self.name.font()
        font.setBold(True)
        self.name.setFont(font)
        self.dimension = QComboBox(self)
        for n in (2, 3):
            self.dimension.addItem(f"n = {n}", n)
        self.dimension.setToolTip("Triangles or tetrahedra: how many singular values there are.")
        self.dimension.activated.connect(self._choose_dimension)
        self.error = QLabel(self)
        self.error.setObjectName("form-error")
        self.error.setWordWrap(True)
        row = QHBoxLayout()
        row.addWidget(self.name, 1)
        row.addWidget(self.dimension)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 4, 8, 4)
        layout.setSpacing(3)
        layout.addLayout(row)
        layout.addWidget(self.error)

    def refresh(self) -> None:
        item = self.subject.distortion
        self.error.setText(self.subject.sentence)
        self.error.setVisible(bool(self.subject.sentence))
        self.dimension.setCurrentIndex(self.dimension.findData(self.subject.dimension))
        if item is None:
            self.name.setText("")
            return
        self.name.setText("Typed formula" if item.id == item.formula else title_of(item))
        self.name.setToolTip(item.formula)

    def _choose_dimension(self) -> None:
        self.subject.dimension = self.dimension.currentData()


class InspectorBody(QWidget):
    """A heading, and the pages below it as tabs."""

    def __init__(self, subject: Subject, document: Document, brush: SimplexBrush, parent: QWidget) -> None:
        super().__init__(parent)
        self.heading = Heading(subject, self)
        self.formula = FormulaPage(subject, self)
        self.plane = PlanePage(subject, document, brush, self)
        self.curves = CurvesPage(subject, self)
        self.star = StarPage(subject, self)
        self.mirror = MirrorPage(subject, self)
        self.tabs = QTabWidget(self)
        self.tabs.setDocumentMode(True)
        self.tabs.setUsesScrollButtons(True)
        for page, name, tip in (
            (self.formula, "Formula", "The formula and its properties"),
            (self.plane, "Plane", "D over two singular values, with the simplices of the map"),
            (self.curves, "Curves", "D along (s, …, s) and (s, 1/s), beside others"),
            (self.star, "Fig. 12", "A vertex is pulled across its star"),
            (self.mirror, "Fig. 19", "A simplex on its way to its mirror image"),
        ):
            self.tabs.addTab(page, name)
            self.tabs.setTabToolTip(self.tabs.count() - 1, tip)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addWidget(self.heading)
        layout.addWidget(self.tabs, 1)

    @property
    def pages(self) -> tuple[Page, ...]:
        found = (self.tabs.widget(row) for row in range(self.tabs.count()))
        return (self.heading, *(page for page in found if isinstance(page, Page)))

    def set_theme(self, theme: Theme) -> None:
        for page in self.pages:
            page.set_theme(theme)

    def wait(self) -> None:
        """Let threads end before the window does."""
        for page in self.pages:
            page.wait()
