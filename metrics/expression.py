"""A control space from a formula in x and y.

The text is parsed with `ast`, and only what is listed here is understood; it is never run as
Python. What comes of it is a tree of closures over numpy arrays of floats, so that no formula can
compute more than one array for each of its operations.
"""

from __future__ import annotations

import ast
from collections.abc import Callable
from functools import reduce
from typing import NoReturn

import numpy as np
from numpy.typing import ArrayLike

from .control import ControlSpace
from .errors import MetricError
from .types import Array, Floats

__all__ = ["Expression"]

Evaluator = Callable[[Floats, Floats], Array]

_MAX_LENGTH = 10_000  # characters
_MAX_DEPTH = 200  # operations within operations; Python's own stack holds about a thousand

_VARIABLES: dict[str, Evaluator] = {"x": lambda x, y: x, "y": lambda x, y: y}
_CONSTANTS = {"pi": np.pi, "e": np.e}
_UNARY: dict[type[ast.unaryop], Callable[..., Array]] = {
    ast.UAdd: np.positive,
    ast.USub: np.negative,
    ast.Not: np.logical_not,
}
_BINARY: dict[type[ast.operator], Callable[..., Array]] = {
    ast.Add: np.add,
    ast.Sub: np.subtract,
    ast.Mult: np.multiply,
    ast.Div: np.divide,
    ast.Pow: np.power,
}
_COMPARISONS: dict[type[ast.cmpop], Callable[..., Array]] = {
    ast.Lt: np.less,
    ast.LtE: np.less_equal,
    ast.Gt: np.greater,
    ast.GtE: np.greater_equal,
    ast.Eq: np.equal,
    ast.NotEq: np.not_equal,
}


def _where(condition: Array, a: Array, b: Array) -> Array:
    return np.where(condition != 0, a, b)


def _min(*arrays: Array) -> Array:
    return reduce(np.minimum, arrays)


def _max(*arrays: Array) -> Array:
    return reduce(np.maximum, arrays)


# Each function with the minimum and the maximum of its arguments.
_FUNCTIONS: dict[str, tuple[Callable[..., Array], int, int]] = {
    **{
        name: (getattr(np, name), 1, 1)
        for name in (
            *("sqrt", "exp", "log", "log10", "abs", "sign", "floor", "ceil"),
            *("sin", "cos", "tan", "sinh", "cosh", "tanh"),
        )
    },
    "asin": (np.arcsin, 1, 1),
    "acos": (np.arccos, 1, 1),
    "atan": (np.arctan, 1, 1),
    "atan2": (np.arctan2, 2, 2),
    "hypot": (np.hypot, 2, 2),
    "where": (_where, 3, 3),
    "min": (_min, 2, 50),
    "max": (_max, 2, 50),
}


class Expression(ControlSpace):
    """A size, or a metric, as a formula in x and y.

    Parameters
    ----------
    *formulas : str
        One formula for the size h; or three, for m11, m12 and m22, as three strings or in one
        string with commas between them.

    Raises
    ------
    MetricError
        For what is not understood, naming it and its column. A formula whose value is not a metric
        somewhere raises when it is evaluated there.

    Notes
    -----
    Numbers, ``x``, ``y``, ``pi``, ``e``, ``+ - * / **``, comparisons (1 where true, else 0) with
    ``and``, ``or``, ``not``, ``where(condition, a, b)``, ``min``, ``max``, ``hypot``, ``atan2``,
    and ``abs sqrt exp log log10 sin cos tan asin acos atan sinh cosh tanh sign floor ceil``.

    Examples
    --------
    >>> from metrics import Expression
    >>> Expression("where(hypot(x, y) < 1, 0.01, 0.1)")([[0.0, 0.0]])
    array([[10000.,     0., 10000.]])
    """

    def __init__(self, *formulas: str) -> None:
        if not all(isinstance(formula, str) for formula in formulas):
            raise MetricError("a formula is a string, such as '0.01 + 0.1*hypot(x, y)'")
        parts = [part for formula in formulas for part in _parse(formula)]
        if len(parts) not in (1, 3):
            raise MetricError(
                f"one formula (the size h) or three (m11, m12, m22) are needed, not {len(parts)}"
            )
        self.formulas = formulas
        self._evaluators = parts

    def values(self, points: Floats) -> ArrayLike:
        x, y = points.T
        out = np.empty((len(points), len(self._evaluators)))
        with np.errstate(all="ignore"):  # what is not finite in the end is refused
            for k, evaluate in enumerate(self._evaluators):
                out[:, k] = evaluate(x, y)
        return out if out.shape[1] == 3 else out[:, 0]

    def __repr__(self) -> str:
        return f"Expression({', '.join(map(repr, self.formulas))})"

    def __reduce__(self) -> tuple[type[Expression], tuple[str, ...]]:
        return Expression, self.formulas


def _parse(formula: str) -> list[Evaluator]:
    """The formulas in a string, compiled: one, or several with commas between them."""
    text = formula.replace("\n", " ").strip()
    if not text:
        raise MetricError("the formula is empty")
    if len(text) > _MAX_LENGTH:
        raise MetricError(f"the formula has {len(text)} characters, more than {_MAX_LENGTH}")
    try:
        body: ast.expr | None = ast.parse(text, mode="eval").body
    except SyntaxError as error:
        column = f" at column {error.offset}" if error.offset else ""
        raise MetricError(f"the formula {_quote(text)} is not valid{column}: {error.msg}") from None
    except ValueError as error:
        raise MetricError(f"the formula {_quote(text)} cannot be parsed: {error}") from None
    except (MemoryError, RecursionError):
        body = None
    if body is None or _depth(body) > _MAX_DEPTH:
        raise MetricError(
            f"the formula {_quote(text)} is nested deeper than {_MAX_DEPTH} operations; "
            "a Python function can be given instead"
        )
    compiler = _Compiler(text)
    parts = body.elts if isinstance(body, ast.Tuple) else [body]
    return [compiler.compile(part) for part in parts]


def _quote(text: str) -> str:
    return repr(text if len(text) <= 80 else text[:77] + "...")


def _depth(tree: ast.AST) -> int:
    """How many nodes there are one in another; without recursion."""
    depth, level = 0, [tree]
    while level:
        depth += 1
        level = [child for node in level for child in ast.iter_child_nodes(node)]
    return depth


class _Compiler:
    """Turns the syntax tree of one text into closures of (x, y)."""

    def __init__(self, text: str) -> None:
        self.text = text

    def compile(self, node: ast.expr) -> Evaluator:
        if isinstance(node, ast.Constant):
            return self.constant(node)
        if isinstance(node, ast.Name):
            return self.name(node)
        if isinstance(node, ast.UnaryOp) and type(node.op) in _UNARY:
            return self.operation(node, _UNARY[type(node.op)], [node.operand])
        if isinstance(node, ast.BinOp):
            if type(node.op) in _BINARY:
                return self.operation(node, _BINARY[type(node.op)], [node.left, node.right])
            self.refuse(node, "the operators are + - * / and ** for powers")
        if isinstance(node, ast.Compare):
            return self.comparison(node)
        if isinstance(node, ast.BoolOp):
            join = np.logical_and if isinstance(node.op, ast.And) else np.logical_or
            return self.operation(node, lambda *a: reduce(join, a), node.values)
        if isinstance(node, ast.Call):
            return self.call(node)
        if isinstance(node, ast.IfExp):
            self.refuse(node, "write conditions as where(condition, a, b)")
        self.refuse(node, "a formula is made of numbers, operators, and words: " + _known_words())

    def constant(self, node: ast.Constant) -> Evaluator:
        if isinstance(node.value, bool) or not isinstance(node.value, (int, float)):
            self.refuse(node, "only real numbers are constants")
        try:
            value = np.float64(node.value)
        except OverflowError:
            self.refuse(node, "the number is too large")
        return lambda x, y: value

    def name(self, node: ast.Name) -> Evaluator:
        if node.id in _VARIABLES:
            return _VARIABLES[node.id]
        if node.id in _CONSTANTS:
            value = np.float64(_CONSTANTS[node.id])
            return lambda x, y: value
        if node.id in _FUNCTIONS:
            self.refuse(node, f"it is a function, write {node.id}(...)")
        self.refuse(node, _known_words())

    def comparison(self, node: ast.Compare) -> Evaluator:
        if not all(type(op) in _COMPARISONS for op in node.ops):
            self.refuse(node, "the comparisons are < <= > >= == !=")
        tests = [_COMPARISONS[type(op)] for op in node.ops]

        def compare(*values: Array) -> Array:
            links = [test(*values[k : k + 2]) for k, test in enumerate(tests)]
            return reduce(np.logical_and, links)

        return self.operation(node, compare, [node.left, *node.comparators])

    def call(self, node: ast.Call) -> Evaluator:
        if not isinstance(node.func, ast.Name) or node.func.id not in _FUNCTIONS:
            self.refuse(node.func, _known_words())
        if node.keywords:
            self.refuse(node, "functions take no keywords")
        function, minimum, maximum = _FUNCTIONS[node.func.id]
        if not minimum <= len(node.args) <= maximum:
            counts = str(minimum) if minimum == maximum else f"{minimum} to {maximum}"
            arguments = "argument" if maximum == 1 else "arguments"
            self.refuse(node, f"{node.func.id} takes {counts} {arguments}, got {len(node.args)}")
        return self.operation(node, function, node.args)

    def operation(
        self, node: ast.expr, function: Callable[..., Array], operands: list[ast.expr]
    ) -> Evaluator:
        inner = [self.compile(operand) for operand in operands]
        # Truth values become numbers at once: -(x > 0) and (x > 0) * 0.1 are arithmetic.
        return lambda x, y: np.asarray(function(*(f(x, y) for f in inner)), np.float64)

    def refuse(self, node: ast.expr, remedy: str) -> NoReturn:
        column = len(self.text.encode()[: node.col_offset].decode()) + 1
        word = ast.get_source_segment(self.text, node) or ""
        raise MetricError(
            f"{_quote(word)} at column {column} of the formula {_quote(self.text)} is not "
            f"understood: {remedy}"
        )


def _known_words() -> str:
    return (
        f"the variables are {', '.join(_VARIABLES)}, the constants {', '.join(_CONSTANTS)}, "
        f"the functions {', '.join(sorted(_FUNCTIONS))}"
    )
