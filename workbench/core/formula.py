"""The formula language: one line of text in the singular values, checked, compiled, never executed as code.

The text is parsed with Python's `ast` and then read by a closed list of node types; it reaches neither `eval` nor `exec`.
Derivatives are taken on the expression graph (`workbench.core.expression`).
"""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, reduce
from typing import TYPE_CHECKING

import numpy as np

from workbench.core.errors import FormulaError
from workbench.core.exponentials import logarithm
from workbench.core.expression import Graph, Op

if TYPE_CHECKING:
    from workbench.core.tape import Tape

MAXIMUM_LENGTH = 2000
MAXIMUM_DEPTH = 64
MAXIMUM_TOTAL_DEPTH = 160
MAXIMUM_LITERAL = 1e6
MAXIMUM_REFERENCES = 64
TEST_POINTS = ((1.0, 1.0, 1.0), (2.0, 1.5, 0.5), (1.2, 0.9, 0.8))

FUNCTIONS = ("max", "min", "sum", "prod", "exp", "log", "sqrt", "abs", "largest")
_OPERATORS = {ast.Add: Op.ADD, ast.Sub: Op.SUBTRACT, ast.Mult: Op.MULTIPLY, ast.Div: Op.DIVIDE, ast.Pow: Op.POWER}

Vector = list[int]
Value = int | Vector
"""A node of the graph (a scalar), or a list of nodes (a vector as long as sigma, or of `largest`)."""


@dataclass(frozen=True, eq=False)
class CompiledFormula:
    """A formula in one dimension n with its parameters bound.

    `value` gives D; `gradient` D and D_i; `hessian` D, D_i and D_ij (i <= j, row by row), each a `Tape` in |sigma|.
    `majoriser` is as `hessian`, with the curvature at switches that a Newton step wants (see `workbench.core.expression`).
    `graph` and `root` are the expression itself, parameters bound, for symbolic analysis.
    `looks_at_start` : whether the tapes take one input more, 1 where a simplex had a positive orientation at the start.
    """

    text: str
    dimension: int
    graph: Graph
    root: int
    value: Tape
    gradient: Tape
    hessian: Tape
    majoriser: Tape
    looks_at_start: bool = False

    @cached_property
    def has_logarithm(self) -> bool:
        """Whether the formula is made of exponentials, so that its logarithm can be computed where they overflow."""
        return logarithm(self.graph, self.root) is not None

    @cached_property
    def is_kinked_at_ties(self) -> bool:
        """Whether D_i and D_j differ where sigma_i = sigma_j: then D is not smooth in the map there (max(sigma), say)."""
        n = self.dimension
        points = np.array([[a] * n for a in (0.6, 1.0, 1.7)] + [[1.7] * (n - 1) + [0.6], [1.7] + [0.6] * (n - 1)])
        data = np.ones((len(points), self.gradient.variable_count - n))
        first = self.gradient.evaluate(np.hstack([points, data]))[:, 1 : n + 1]
        ties = np.isclose(points[:, :-1], points[:, 1:], rtol=0.0, atol=0.0)
        gaps = np.abs(np.diff(first, axis=1))
        scale = np.abs(first).max(axis=1, keepdims=True) + np.finfo(float).tiny
        with np.errstate(invalid="ignore"):
            return bool((ties & (gaps > 1e-9 * scale)).any())


def compile_formula(
    text: str,
    dimension: int,
    parameters: Mapping[str, float] | None = None,
    resolve: Callable[[str], tuple[str, Mapping[str, float]] | None] | None = None,
    *,
    text_on_inverted: str = "",
    power: float = 1.0,
    softening: float = 0.0,
    fence: float = 0.0,
) -> CompiledFormula:
    """Check and compile a formula.

    Parameters
    ----------
    text : str           the formula
    dimension : int      n, 2 or 3
    parameters : dict    declared names and their values
    resolve : callable   name with underscores -> (formula, its parameters) of another distortion, or None
    text_on_inverted : str   a second formula for simplices that are inverted at the start
    softening : float    sqrt(sigma_i^2 + softening^2) stands for each sigma_i
    fence : float        fence/det is added
    power : float        compile D^power instead, or log D where it is 0, of a formula made of exponentials

    Raises `FormulaError` with a sentence and the place for everything that is not allowed.
    """
    graph = Graph(dimension)
    if softening:
        square = graph.constant(softening**2)
        graph.singular_values = [graph.sqrt(graph.add(graph.multiply(v, v), square)) for v in graph.variables]
    bound = dict(parameters or {})
    root = _read_number(graph, bound, resolve, text)
    exponent = logarithm(graph, root) if power != 1.0 else None
    if exponent is not None:
        root = graph.exp(graph.multiply(graph.constant(power), exponent)) if power else exponent
    if fence:
        root = graph.add(root, graph.divide(graph.constant(fence), reduce(graph.multiply, graph.variables)))
    if text_on_inverted:
        other = _read_number(graph, bound, resolve, text_on_inverted)
        root = graph.select(graph.datum(), graph.one, root, other)
    first = [graph.derivative(root, i) for i in range(dimension)]
    pairs = [(i, j) for i in range(dimension) for j in range(i, dimension)]
    from workbench.core.tape import compile_tape  # late: the window reads formulas, and compiles them when it has been seen

    hessian = compile_tape(graph, [root, *first, *(graph.derivative(first[i], j) for i, j in pairs)])
    majoriser = hessian
    if graph.has_switches:
        second = [graph.derivative(first[i], j, majorise=True) for i, j in pairs]
        majoriser = compile_tape(graph, [root, *first, *second])
    return CompiledFormula(
        text=text,
        dimension=dimension,
        graph=graph,
        root=root,
        value=compile_tape(graph, [root]),
        gradient=compile_tape(graph, [root, *first]),
        hessian=hessian,
        majoriser=majoriser,
        looks_at_start=bool(text_on_inverted),
    )


def _read_number(
    graph: Graph,
    parameters: dict[str, float],
    resolve: Callable[[str], tuple[str, Mapping[str, float]] | None] | None,
    text: str,
) -> int:
    """The node of a formula that is one finite number a simplex and not a constant."""
    root = _Reader(graph, parameters, resolve).read(text)
    if isinstance(root, list):
        raise FormulaError("The result is a vector; it must be one number a simplex: wrap it in sum, max, min or prod.")
    if not any(graph.nodes[n][0] is Op.VARIABLE for n in graph.reachable([root])):
        raise FormulaError("The formula is a constant; it must depend on the singular values (sigma, sigma1, ..., det).")
    _check_values(graph, root, graph.variable_count)
    return root


def names_in_formula(text: str) -> tuple[str, ...]:
    """Names that a formula uses beside functions and singular values, in order of appearance (for parameter forms)."""
    tree = parse(text)
    known = {"sigma", "n", "det", *FUNCTIONS}
    names = [
        node.id
        for node in ast.walk(tree)
        if isinstance(node, ast.Name) and node.id not in known and not re.fullmatch(r"sigma\d*|sigman", node.id)
    ]
    return tuple(dict.fromkeys(names))


def _check_values(graph: Graph, root: int, dimension: int) -> None:
    from workbench.core.tape import compile_tape

    tape = compile_tape(graph, [root])
    points = np.array([[*p[:dimension], *[1.0] * (tape.variable_count - dimension)] for p in TEST_POINTS])
    values = tape.evaluate(points)[:, 0]
    for point, value in zip(points, values, strict=True):
        if not math.isfinite(value):
            where = ", ".join(f"{s:g}" for s in point)
            raise FormulaError(f"The formula is {value} at sigma = ({where}); it must be finite at ordinary singular values.")


def parse(text: str) -> ast.expr:
    """The syntax tree of a formula, of its characters, length and depth checked; its nodes are not. Raises `FormulaError`."""
    if len(text) > MAXIMUM_LENGTH:
        raise FormulaError(f"The formula has {len(text)} characters; {MAXIMUM_LENGTH} are allowed.", position=MAXIMUM_LENGTH)
    if not text.strip():
        raise FormulaError("The formula is empty; type one such as sum(sigma^2 + 1/sigma^2).")
    for position, character in enumerate(text):
        if not (character.isascii() and (character.isalnum() or character in "_ \t+-*/^().,")):
            raise FormulaError(f"The character {character!r} has no meaning in a formula.", position=position)
    depth = 0
    for position, character in enumerate(text):
        depth += (character == "(") - (character == ")")
        if depth > MAXIMUM_DEPTH:
            raise FormulaError(f"The formula is nested more than {MAXIMUM_DEPTH} deep.", position=position)
    try:
        return ast.parse(text.strip(" \t").replace("^", "**"), mode="eval").body
    except SyntaxError as error:
        lead, end = len(text) - len(text.lstrip(" \t")), len(text.rstrip(" \t"))
        position = lead + _column_in_text(text.strip(" \t"), error.offset - 1) if error.offset else end
        if position >= end:
            raise FormulaError("The formula breaks off: something has to follow its end.", position=end) from None
        raise FormulaError(f"This is not a formula: {error.msg}.", position=position) from None
    except (RecursionError, MemoryError, ValueError):
        raise FormulaError(f"The formula is nested more than {MAXIMUM_DEPTH} deep.") from None


def _column_in_text(text: str, column: int) -> int:
    """Column in the typed text of a column in the text where each ^ became **."""
    shifted = 0
    for position, character in enumerate(text):
        if shifted >= column:
            return position
        shifted += 2 if character == "^" else 1
    return len(text)


class _Reader:
    """From checked syntax to nodes of a graph."""

    def __init__(
        self,
        graph: Graph,
        parameters: dict[str, float],
        resolve: Callable[[str], tuple[str, Mapping[str, float]] | None] | None,
    ) -> None:
        self.graph = graph
        self.parameters = parameters
        self.resolve = resolve
        self.open: list[str] = []  # names of distortions being read, to catch circles
        self.references = 0
        self.depth = 0  # of the place that refers to the formula being read
        self.text = ""

    def read(self, text: str) -> Value:
        outer, self.text = self.text, text
        try:
            return self.visit(parse(text), 1)
        finally:
            self.text = outer

    def fail(self, node: ast.AST, sentence: str) -> FormulaError:
        lead = len(self.text) - len(self.text.lstrip(" \t"))
        column = lead + _column_in_text(self.text.strip(" \t"), getattr(node, "col_offset", 0))
        return FormulaError(sentence, position=column)

    def visit(self, node: ast.expr, depth: int) -> Value:
        if depth > MAXIMUM_DEPTH:
            raise self.fail(node, f"The formula is nested more than {MAXIMUM_DEPTH} deep.")
        if isinstance(node, ast.Constant):
            return self.number(node)
        if isinstance(node, ast.Name):
            return self.name(node, depth)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.UAdd | ast.USub):
            operand = self.visit(node.operand, depth + 1)
            if isinstance(node.op, ast.UAdd):
                return operand
            return _each(operand, lambda a: self.graph.subtract(self.graph.zero, a))
        if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
            return self.binary(node, depth)
        if isinstance(node, ast.Call):
            return self.call(node, depth)
        raise self.fail(node, "Only numbers, names, + - * / ^ and the functions " + ", ".join(FUNCTIONS) + " are allowed.")

    def number(self, node: ast.Constant) -> int:
        if isinstance(node.value, bool) or not isinstance(node.value, int | float):
            raise self.fail(node, f"{node.value!r} is not a real number.")
        if abs(node.value) > MAXIMUM_LITERAL:
            raise self.fail(node, f"A number is beyond {MAXIMUM_LITERAL:g}.")
        return self.graph.constant(float(node.value))

    def name(self, node: ast.Name, depth: int) -> Value:
        graph, n = self.graph, self.graph.variable_count
        if node.id in self.parameters:
            return graph.constant(float(self.parameters[node.id]))
        if node.id == "sigma":
            return list(graph.singular_values)
        if node.id == "n":
            return graph.constant(float(n))
        if node.id == "det":
            return self.fold(list(graph.singular_values), graph.multiply)
        if node.id == "sigman":
            return graph.singular_values[-1]
        match = re.fullmatch(r"sigma([1-9]\d{0,3})", node.id)
        if match:
            index = int(match.group(1))
            if index > n:
                raise self.fail(node, f"{node.id} does not exist in dimension {n}; the last one is sigma{n} (or sigman).")
            return graph.singular_values[index - 1]
        if node.id in FUNCTIONS:
            raise self.fail(node, f"{node.id} is a function; write {node.id}(...).")
        return self.other_distortion(node, depth)

    def other_distortion(self, node: ast.Name, depth: int) -> Value:
        other = self.resolve(node.id) if self.resolve else None
        if other is None:
            known = "".join(f", {p}" for p in self.parameters)
            raise self.fail(
                node,
                f"The name {node.id!r} is not known; there are sigma, sigma1 ... sigman, n, det{known} and the distortions.",
            )
        self.references += 1
        if node.id in self.open:
            raise self.fail(node, f"The distortion {node.id} refers to itself.")
        if self.references > MAXIMUM_REFERENCES:
            raise self.fail(node, f"The formula refers to more than {MAXIMUM_REFERENCES} other distortions.")
        text, defaults = other
        inner = _Reader(self.graph, {**defaults, **{k: v for k, v in self.parameters.items() if k in defaults}}, self.resolve)
        inner.open = [*self.open, node.id]
        inner.references = self.references
        inner.depth = self.depth + depth
        if inner.depth > MAXIMUM_TOTAL_DEPTH:
            raise self.fail(
                node, f"With the distortions that it refers to, the formula is nested more than {MAXIMUM_TOTAL_DEPTH} deep."
            )
        value = inner.read(text)
        self.references = inner.references
        return value

    def binary(self, node: ast.BinOp, depth: int) -> Value:
        left, right = self.visit(node.left, depth + 1), self.visit(node.right, depth + 1)
        op = _OPERATORS[type(node.op)]
        graph = self.graph
        operation = {
            Op.ADD: graph.add,
            Op.SUBTRACT: graph.subtract,
            Op.MULTIPLY: graph.multiply,
            Op.DIVIDE: graph.divide,
            Op.POWER: graph.power,
        }[op]
        if op is Op.POWER:
            for exponent in right if isinstance(right, list) else [right]:
                value = graph.constant_value(exponent)
                if value is not None and not abs(value) <= MAXIMUM_LITERAL:
                    raise self.fail(node.right, f"An exponent is beyond {MAXIMUM_LITERAL:g}.")
        result = self.broadcast(node, operation, left, right)
        self.check_constants(node, result)
        return result

    def call(self, node: ast.Call, depth: int) -> Value:
        if not isinstance(node.func, ast.Name) or node.func.id not in FUNCTIONS:
            raise self.fail(node, "Only the functions " + ", ".join(FUNCTIONS) + " can be called.")
        name = node.func.id
        if node.keywords or any(isinstance(a, ast.Starred) for a in node.args) or not node.args:
            raise self.fail(node, f"{name} takes plain arguments in brackets.")
        arguments = [self.visit(a, depth + 1) for a in node.args]
        graph = self.graph
        if name in ("max", "min"):
            operation = graph.maximum if name == "max" else graph.minimum
            if len(arguments) == 1:
                return self.extreme(arguments[0], name, operation)
            result = arguments[0]
            for argument in arguments[1:]:
                result = self.broadcast(node, operation, result, argument)
            return result
        if len(arguments) != 1:
            raise self.fail(node, f"{name} takes one argument.")
        argument = arguments[0]
        if name == "sum":
            return self.fold(argument, graph.add)
        if name == "prod":
            return self.fold(argument, graph.multiply)
        if name == "largest":
            return self.largest(node, argument)
        function = {"exp": graph.exp, "log": graph.log, "sqrt": graph.sqrt, "abs": graph.abs}[name]
        result = _each(argument, function)
        self.check_constants(node, result)
        return result

    def extreme(self, argument: Value, name: str, operation: Callable[[int, int], int]) -> int:
        # Singular values come sorted, so the extremes of sigma itself are its first and its last one.
        if argument == self.graph.singular_values:
            return self.graph.singular_values[0 if name == "max" else -1]
        return self.fold(argument, operation)

    def largest(self, node: ast.Call, argument: Value) -> Vector:
        count = None if isinstance(argument, list) else self.graph.constant_value(argument)
        n = self.graph.variable_count
        if count is None or count != int(count) or not 1 <= count <= n:
            raise self.fail(node, f"largest(k) takes a whole number from 1 to {n}.")
        return list(self.graph.singular_values[: int(count)])

    def fold(self, argument: Value, operation: Callable[[int, int], int]) -> int:
        if not isinstance(argument, list):
            return argument
        result = argument[0]
        for item in argument[1:]:
            result = operation(result, item)
        return result

    def broadcast(self, node: ast.AST, operation: Callable[[int, int], int], left: Value, right: Value) -> Value:
        if not isinstance(left, list) and not isinstance(right, list):
            return operation(left, right)
        length = len(left) if isinstance(left, list) else len(right) if isinstance(right, list) else 1
        lefts = left if isinstance(left, list) else [left] * length
        rights = right if isinstance(right, list) else [right] * length
        if len(lefts) != len(rights):
            raise self.fail(node, f"Vectors of {len(lefts)} and {len(rights)} entries cannot be combined.")
        return [operation(a, b) for a, b in zip(lefts, rights, strict=True)]

    def check_constants(self, node: ast.AST, value: Value) -> None:
        for item in value if isinstance(value, list) else [value]:
            constant = self.graph.constant_value(item)
            if constant is not None and not math.isfinite(constant):
                raise self.fail(node, "A part of the formula without singular values is not a finite number.")


def _each(value: Value, function: Callable[[int], int]) -> Value:
    return [function(v) for v in value] if isinstance(value, list) else function(value)
