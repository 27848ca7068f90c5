"""A formula as mathematics: LaTeX with indices, sums, fractions and roots, from the checked syntax tree.

The text is parsed by `workbench.core.formula`, whose closed list of node types is repeated by `_Typesetter`: what it does
not know it refuses. Only what the mathtext of matplotlib understands is written.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

from workbench.core.errors import FormulaError
from workbench.core.formula import FUNCTIONS, MAXIMUM_DEPTH, parse

SUM, BIG, PRODUCT, POWER, ATOM = range(5)
"""How tightly the outermost operation of a piece binds; BIG is a sum or product sign, open to its right."""

INDICES = "ijkl"
SHORT = 22
"""Characters of LaTeX up to which an exponential is written as a power of e."""
GREEK = re.findall(
    r"\w+", "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi pi rho tau upsilon phi chi psi omega"
)
SPELT_OTHERWISE = {"lam": r"\lambda", "eps": r"\epsilon"}


@dataclass(frozen=True)
class Piece:
    """Part of a formula.

    `latex` is what it looks like, `binding` one of SUM ... ATOM; `count` is the number of entries of a vector (LaTeX),
    whose entry with the present index `latex` shows, and empty for a number.
    """

    latex: str
    binding: int
    count: str = ""


def latex_of_formula(text: str, titles: Mapping[str, str] | None = None) -> str:
    """LaTeX of a formula, without dollar signs.

    Parameters
    ----------
    text : str        a formula (see `workbench.core.formula`)
    titles : dict     names of other distortions in the formula -> their short names

    Raises `FormulaError` for what is not a formula.
    """
    return " ".join(latex_terms(text, titles))


def latex_terms(text: str, titles: Mapping[str, str] | None = None) -> tuple[str, ...]:
    """The terms of the outermost sum, each from the second on with its sign in front: where a long formula may be broken."""
    terms: list[tuple[str, ast.expr]] = []
    node, typesetter = parse(text), _Typesetter(titles or {})
    while isinstance(node, ast.BinOp) and isinstance(node.op, ast.Add | ast.Sub) and len(terms) < MAXIMUM_DEPTH:
        terms.append(("+" if isinstance(node.op, ast.Add) else "-", node.right))
        node = node.left
    lines = [typesetter.visit(node, 1).latex]
    for sign, term in reversed(terms):
        lines.append(f"{sign} {typesetter.bound(typesetter.visit(term, 1), BIG)}")
    return tuple(lines)


def latex_of_name(name: str) -> str:
    r"""LaTeX of a parameter's name: greek letters by their names, a number at the end as an index."""
    if name in SPELT_OTHERWISE:
        return SPELT_OTHERWISE[name]
    if name in GREEK:
        return "\\" + name
    match = re.fullmatch(r"([A-Za-z]+)_?(\d+)", name)
    if match:
        return f"{latex_of_name(match.group(1))}_{{{match.group(2)}}}"
    return name if len(name) == 1 else upright(name)


def upright(text: str) -> str:
    r"""Words in upright letters; whatever might mean something to LaTeX is left out."""
    words = re.findall(r"[A-Za-z0-9.()-]+", text)
    return r"\mathrm{" + r"\ ".join(words) + "}"


def latex_of_number(value: float) -> Piece:
    """A number, its power of ten written out where it is far from 1."""
    mantissa, _, exponent = f"{value:.6g}".partition("e")
    if not exponent:
        return Piece(mantissa, ATOM)
    power = f"10^{{{int(exponent)}}}"
    return Piece(power, POWER) if mantissa == "1" else Piece(rf"{mantissa} \cdot {power}", PRODUCT)


class _Typesetter:
    """Visits the tree; `level` counts the sums and products around a node, each with an index of its own."""

    def __init__(self, titles: Mapping[str, str]) -> None:
        self.titles = titles
        self.level = -1
        self.is_small = False  # inside an exponent fractions lie on one line

    def visit(self, node: ast.expr, depth: int) -> Piece:
        if depth > MAXIMUM_DEPTH:
            raise FormulaError(f"The formula is nested more than {MAXIMUM_DEPTH} deep.")
        if isinstance(node, ast.Constant) and isinstance(node.value, int | float):
            return latex_of_number(float(node.value))
        if isinstance(node, ast.Name):
            return self.name(node.id)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.UAdd | ast.USub):
            operand = self.visit(node.operand, depth + 1)
            if isinstance(node.op, ast.UAdd):
                return operand
            return replace(operand, latex=f"-{self.bound(operand, BIG)}", binding=SUM)
        if isinstance(node, ast.BinOp):
            return self.binary(node, depth)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in FUNCTIONS and node.args:
            return self.call(node.func.id, node.args, depth)
        raise FormulaError("This part of the formula cannot be typeset.", position=node.col_offset)

    def name(self, name: str) -> Piece:
        if name == "sigma":
            return Piece(rf"\sigma_{{{self.index}}}", ATOM, "n")
        if name == "det":
            return Piece(r"\det J", PRODUCT)
        match = re.fullmatch(r"sigma(\d+|n)", name)
        if match:
            return Piece(rf"\sigma_{{{match.group(1)}}}", ATOM)
        if name in self.titles:
            return Piece(f"D_{{{upright(self.titles[name])}}}", ATOM)
        return Piece(latex_of_name(name), ATOM)

    @property
    def index(self) -> str:
        level = max(self.level, 0)
        return INDICES[level] if level < len(INDICES) else f"i_{{{level}}}"

    @staticmethod
    def bound(piece: Piece, at_least: int) -> str:
        """LaTeX of a piece as part of an operation that binds so tightly: in brackets where need be."""
        return piece.latex if piece.binding >= at_least else rf"\left({piece.latex}\right)"

    # ------------------------------------------------------------------------------------ operators

    def binary(self, node: ast.BinOp, depth: int) -> Piece:
        if isinstance(node.op, ast.Pow):
            return self.power(node, depth)
        left, right = self.visit(node.left, depth + 1), self.visit(node.right, depth + 1)
        count = left.count or right.count
        if isinstance(node.op, ast.Add | ast.Sub):
            sign = "+" if isinstance(node.op, ast.Add) else "-"
            return Piece(f"{left.latex} {sign} {self.bound(right, BIG)}", SUM, count)
        if isinstance(node.op, ast.Mult):
            return Piece(self.product(left, right), min(right.binding, PRODUCT) if right.binding == BIG else PRODUCT, count)
        if isinstance(node.op, ast.Div):
            if self.is_small:
                return Piece(f"{self.bound(left, PRODUCT)}/{self.bound(right, POWER)}", PRODUCT, count)
            return Piece(rf"\frac{{{left.latex}}}{{{right.latex}}}", PRODUCT, count)
        raise FormulaError("This part of the formula cannot be typeset.", position=node.col_offset)

    def product(self, left: Piece, right: Piece) -> str:
        first, second = self.bound(left, PRODUCT), self.bound(right, BIG)
        if second[0].isdigit():
            return rf"{first} \cdot {second}"
        return f"{first} {second}" if second.startswith(r"\left(") else rf"{first}\, {second}"

    def power(self, node: ast.BinOp, depth: int) -> Piece:
        base = self.visit(node.left, depth + 1)
        was_small, self.is_small = self.is_small, True
        exponent = self.visit(node.right, depth + 1)
        self.is_small = was_small
        return Piece(f"{self.bound(base, ATOM)}^{{{exponent.latex}}}", POWER, base.count or exponent.count)

    # ------------------------------------------------------------------------------------ functions

    def call(self, name: str, nodes: list[ast.expr], depth: int) -> Piece:
        if name in ("sum", "prod") or (name in ("max", "min") and len(nodes) == 1):
            return self.fold(name, nodes[0], depth)
        if name == "largest":
            return Piece(rf"\sigma_{{{self.index}}}", ATOM, self.visit(nodes[0], depth + 1).latex)
        arguments = [self.visit(node, depth + 1) for node in nodes]
        count = next((a.count for a in arguments if a.count), "")
        inside = r",\ ".join(a.latex for a in arguments)
        if name in ("max", "min", "log"):
            return Piece(rf"\{name}\left({inside}\right)", POWER, count)
        if name == "sqrt":
            return Piece(rf"\sqrt{{{inside}}}", POWER, count)
        if name == "abs":
            return Piece(rf"\left|{inside}\right|", ATOM, count)
        if len(inside) <= SHORT and r"\frac" not in inside:
            return Piece(f"e^{{{inside}}}", POWER, count)
        return Piece(rf"\exp\left({inside}\right)", POWER, count)

    def fold(self, name: str, node: ast.expr, depth: int) -> Piece:
        """A sum, a product or an extreme over the entries of a vector; of a number it is the number."""
        if name in ("max", "min") and isinstance(node, ast.Name) and node.id == "sigma":
            return self.name("sigma1" if name == "max" else "sigman")  # they come sorted
        self.level += 1
        index = self.index
        inner = self.visit(node, depth + 1)
        self.level -= 1
        if not inner.count:
            return inner
        if name in ("sum", "prod"):
            body = self.bound(inner, BIG if name == "sum" else POWER)
            return Piece(rf"\{name}_{{{index}=1}}^{{{inner.count}}}\, {body}", BIG)
        return Piece(rf"\{name}_{{{index}}}\, {self.bound(inner, PRODUCT)}", BIG)
