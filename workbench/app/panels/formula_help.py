"""The grammar of formulas in a small window, with examples to take over."""

from __future__ import annotations

from PySide6.QtCore import Qt, QUrl, Signal
from PySide6.QtWidgets import QDialog, QTextBrowser, QVBoxLayout, QWidget

EXAMPLES = (
    ("sum(sigma^2 + 1/sigma^2)", "symmetric Dirichlet (32)"),
    ("max(sigma)/min(sigma)", "condition number (29)"),
    ("lam*symmetric_dirichlet + (1 - lam)*condition_number", "a blend (38); lam gets a slider"),
    ("exp(alpha*(lam*mips + (1 - lam)*(det + 1/det)/2))", "exponential of a blend"),
    ("sum(abs(sigma - 1)^p)^(1/p)", "distance from rigid in an lp norm"),
    ("sum(largest(2)) + 1/det", "the largest singular values, with a barrier"),
)
NAMES = (
    ("sigma", "all singular values, largest first; what is done to it is done to each"),
    ("sigma1, sigma2, sigma3, sigman", "the first, second, third, last one"),
    ("n", "the dimension: 2 for triangles, 3 for tetrahedra"),
    ("det", "the product of all singular values"),
    ("max, min, sum, prod", "one number out of sigma; max(a, b) and min(a, b) compare"),
    ("exp, log, sqrt, abs", "as usual"),
    ("largest(k)", "the k largest singular values"),
    ("symmetric_dirichlet, mips, …", "any distortion of the list, own ones too, with _ for -"),
    ("lam, p, weight, …", "any other name becomes a parameter with a slider"),
)


def help_text() -> str:
    """As HTML; examples are links `example:NUMBER`."""
    names = "".join(f"<tr><td><code>{name}</code></td><td>{text}</td></tr>" for name, text in NAMES)
    examples = "".join(
        f'<tr><td><a href="example:{number}"><code>{formula}</code></a></td><td>{text}</td></tr>'
        for number, (formula, text) in enumerate(EXAMPLES)
    )
    return f"""
    <p>A formula gives one number for the singular values of the Jacobian of a simplex. It needs no derivatives: these
    are found from the text.</p>
    <h4>Operators</h4>
    <p><code>+ &nbsp; - &nbsp; * &nbsp; / &nbsp; ^ &nbsp; ( )</code>; <code>^</code> binds strongest, and
    <code>**</code> is the same.</p>
    <h4>Names</h4><table cellspacing="4">{names}</table>
    <h4>Examples</h4><p>A click puts one into the editor.</p><table cellspacing="4">{examples}</table>
    <h4>Keys</h4>
    <p><b>Enter</b> applies the formula, <b>Esc</b> brings back the one in force, <b>Tab</b> takes the name that is
    offered, <b>Ctrl+Space</b> offers all names.</p>
    """


class FormulaHelp(QDialog):
    """Stays open beside the work; `example_wanted` carries a formula."""

    example_wanted = Signal(str)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("Formulas")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.browser = QTextBrowser(self)
        self.browser.setOpenLinks(False)
        self.browser.setHtml(help_text())
        self.browser.anchorClicked.connect(self._take)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.browser)
        self.resize(640, 620)

    def _take(self, link: QUrl) -> None:
        number = link.path()
        if link.scheme() == "example" and number.isdigit() and int(number) < len(EXAMPLES):
            self.example_wanted.emit(EXAMPLES[int(number)][0])
