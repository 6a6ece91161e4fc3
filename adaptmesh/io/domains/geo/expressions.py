"""Numbers and lists in .geo scripts: tokens, and expressions of them. Parsed, never executed.

In order of precedence, weakest first::

    list        item, item, ...        an item is an expression, a range a:b or a:b:step,
                                       {list}, name[], -{list}
    expression  a ? b : c   ||  &&  == !=  < > <= >=  + -  * / %  - !  ^  number, name, name[i],
                                       #name[], function(...), (expression)
"""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass

from adaptmesh.errors import FormatError

_TOKEN = re.compile(
    r"""
    (?P<skip>\s+ | //[^\n]* | /\*.*?\*/)
  | (?P<unclosed>/\*)
  | (?P<number>(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?)
  | (?P<string>"[^"\n]*" | '[^'\n]*')
  | (?P<name>[A-Za-z_]\w*(?:\.[A-Za-z]\w*)*)
  | (?P<sign>\+= | -= | \*= | /= | == | != | <= | >= | && | \|\| | [-+*/%^!?:;,=<>(){}\[\]\#~.])
    """,
    re.VERBOSE | re.DOTALL,
)

MOST_ITEMS = 500_000
"""Numbers that a script may put into lists beyond those that stand in it, in all its loops."""
MOST_TOKENS = 1_000_000
"""Tokens that a script may have read again, in all its loops."""


class NotReadError(FormatError):
    """A statement or expression that is not known here; Gmsh may know it."""


FUNCTIONS: dict[str, Callable[..., float]] = {
    "Acos": math.acos, "ArcCos": math.acos, "Asin": math.asin, "ArcSin": math.asin,
    "Atan": math.atan, "ArcTan": math.atan, "Atan2": math.atan2, "ArcTan2": math.atan2,
    "Ceil": math.ceil, "Cos": math.cos, "Cosh": math.cosh, "Exp": math.exp, "Fabs": math.fabs,
    "Abs": math.fabs, "Floor": math.floor, "Fmod": math.fmod, "Modulo": math.fmod,
    "Hypot": math.hypot, "Log": math.log, "Log10": math.log10, "Max": max, "Min": min,
    "Round": round, "Sin": math.sin, "Sinh": math.sinh, "Sqrt": math.sqrt, "Tan": math.tan,
    "Tanh": math.tanh,
}  # fmt: skip

_BINARY: dict[str, tuple[int, Callable[[float, float], float]]] = {  # level: 0 binds weakest
    "||": (0, lambda a, b: float(bool(a or b))),
    "&&": (1, lambda a, b: float(bool(a and b))),
    "==": (2, operator.eq), "!=": (2, operator.ne),
    "<": (3, operator.lt), ">": (3, operator.gt), "<=": (3, operator.le), ">=": (3, operator.ge),
    "+": (4, operator.add), "-": (4, operator.sub),
    "*": (5, operator.mul), "/": (5, operator.truediv), "%": (5, math.fmod),
}  # fmt: skip

_ENTITIES = ("Curve", "Curve Loop", "Surface", "Physical")
_NEW = {
    "newp": ("Point",),
    **dict.fromkeys(("newl", "newc", "newll", "newcl", "news", "newreg"), _ENTITIES),
}
"""What the number next to the largest is that of; Gmsh counts all but points together, unless its
option Geometry.OldNewReg is 0."""


@dataclass(frozen=True)
class Token:
    kind: str  # number, string, name, sign, or end
    text: str
    line: int


def tokens_of(text: str) -> list[Token]:
    """All tokens of a script, and one of kind "end"."""
    out, at, line = [], 0, 1
    while at < len(text):
        match = _TOKEN.match(text, at)
        if match is None:
            raise NotReadError(f"line {line}: {text[at : at + 20].split()[0]!r} cannot be read")
        kind, found = str(match.lastgroup), match.group()
        if kind == "unclosed":
            raise FormatError(f"line {line}: the comment that begins here has no */")
        if kind != "skip":
            out.append(Token(kind, found, line))
        line += found.count("\n")
        at = match.end()
    out.append(Token("end", "the end of the file", line))
    return out


class Variables:
    """Numbers and lists by name, and the largest number used of each kind of entity."""

    def __init__(self) -> None:
        self.values: dict[str, list[float]] = {"Pi": [math.pi]}
        self.largest: dict[str, int] = {}

    def used(self, kind: str, number: int) -> None:
        self.largest[kind] = max(number, self.largest.get(kind, 0))

    def new(self, name: str) -> float:
        return 1.0 + max(self.largest.get(kind, 0) for kind in _NEW[name])


class Reader:
    """Takes tokens from the front, and evaluates expressions on the way."""

    def __init__(self, tokens: list[Token], variables: Variables) -> None:
        self.tokens, self.variables = tokens, variables
        self.at = 0
        self._items_left = MOST_ITEMS + len(tokens)
        self._tokens_left = MOST_TOKENS + 2 * len(tokens)

    # -- tokens

    @property
    def token(self) -> Token:
        return self.tokens[self.at]

    def next(self) -> Token:
        token = self.token
        self.at = min(self.at + 1, len(self.tokens) - 1)
        self._tokens_left -= 1
        if self._tokens_left < 0:
            raise self.error(f"the loops of this script take more than {MOST_TOKENS:,} steps")
        return token

    def has(self, *texts: str) -> bool:
        return self.token.kind != "string" and self.token.text in texts

    def accept(self, *texts: str) -> Token | None:
        return self.next() if self.has(*texts) else None

    def expect(self, *texts: str) -> Token:
        if not self.has(*texts):
            known = " or ".join(map(repr, texts))
            raise self.error(f"expected {known}, got {self.token.text!r}", NotReadError)
        return self.next()

    def error(self, message: str, kind: type[FormatError] = FormatError) -> FormatError:
        return kind(f"line {self.token.line}: {message}")

    # -- lists

    def braced(self) -> list[float]:
        """{ list }"""
        opening = self.expect("{", "[", "(").text
        closing = {"{": "}", "[": "]", "(": ")"}[opening]
        out = [] if self.has(closing) else self.listed()
        self.expect(closing)
        return out

    def listed(self) -> list[float]:
        out = list(self._counted(self._item()))
        while self.accept(","):
            out += self._counted(self._item())
        return out

    def _counted(self, items: Iterator[float]) -> Iterator[float]:
        for item in items:
            self._items_left -= 1
            if self._items_left < 0:
                raise self.error(f"the lists of this script have more than {MOST_ITEMS:,} numbers")
            yield item

    def _item(self) -> Iterator[float]:
        negative = self.has("-") and self.tokens[self.at + 1].text == "{"
        if negative:
            self.next()
        if self.has("{"):
            yield from (-x if negative else x for x in self.braced())
            return
        if self._is_whole_list():
            name = self.next().text
            self.at += 2
            yield from self.look_up(name)
            return
        first = self.number()
        if not self.accept(":"):
            yield first
            return
        last = self.number()
        step = self.number() if self.accept(":") else math.copysign(1.0, last - first)
        yield from self._range(first, last, step)

    def _is_whole_list(self) -> bool:
        texts = [t.text for t in self.tokens[self.at + 1 : self.at + 3]]
        return self.token.kind == "name" and texts in (["[", "]"], ["(", ")"], ["{", "}"])

    def _range(self, first: float, last: float, step: float) -> Iterator[float]:
        if step == 0 or not math.isfinite((last - first) / step):
            raise self.error(f"the range {first:g}:{last:g}:{step:g} has no end")
        count = math.floor((last - first) / step + 1e-9) + 1
        if count > MOST_ITEMS:  # before the first of them is made
            raise self.error(f"the range {first:g}:{last:g}:{step:g} has {count:.3g} numbers")
        for k in range(count):
            yield first + k * step

    # -- numbers

    def number(self) -> float:
        """An expression with one value."""
        line = self.token.line
        try:
            value = float(self._ternary())
        except (ArithmeticError, ValueError) as error:
            raise FormatError(f"line {line}: {error}") from None
        if not math.isfinite(value):
            raise FormatError(f"line {line}: {value} is not a number to go on with")
        return value

    def whole(self, what: str) -> int:
        value = self.number()
        if value != int(value):
            raise self.error(f"{what} is {value:g}, not a whole number")
        return int(value)

    def _ternary(self) -> float:
        condition = self._binary(0)
        if not self.accept("?"):
            return condition
        first = self._ternary()
        self.expect(":")
        second = self._ternary()
        return first if condition else second

    def _binary(self, weakest: int) -> float:
        """An expression of signs that bind at least as strongly as those of a level."""
        left = self._unary()
        while self.has(*_BINARY) and _BINARY[self.token.text][0] >= weakest:
            level, operation = _BINARY[self.next().text]
            left = float(operation(left, self._binary(level + 1)))
        return left

    def _unary(self) -> float:
        signs = []
        while sign := self.accept("-", "+", "!"):
            signs.append(sign.text)
        value = self._atom()
        if self.accept("^"):
            value = self._power(value, self._unary())
        for text in reversed(signs):
            value = {"-": -value, "+": value, "!": float(not value)}[text]
        return value

    def _power(self, base: float, exponent: float) -> float:
        power = base**exponent
        if isinstance(power, complex):
            raise self.error(f"({base:g})^{exponent:g} is not a real number")
        return float(power)

    def _atom(self) -> float:
        if self.accept("("):
            value = self.number()
            self.expect(")")
            return value
        if self.accept("#"):
            name = self.next().text
            self.expect("[", "(")
            self.expect("]", ")")
            return float(len(self.look_up(name)))
        token = self.next()
        if token.kind == "number":
            return float(token.text.lower().replace("d", "e"))
        if token.kind != "name":
            self.at -= 1
            raise self.error(f"expected a number, got {token.text!r}", NotReadError)
        if token.text in _NEW:
            return self.variables.new(token.text)
        if token.text in FUNCTIONS and self.has("(", "["):
            return self._applied(token.text, self.braced())
        values = self.look_up(token.text)
        if self.has("[", "("):
            (index,) = self.braced() or [0.0]
            if not 0 <= index < len(values) or index != int(index):
                raise self.error(f"{token.text} has no element {index:g}, only {len(values)}")
            return values[int(index)]
        if len(values) != 1:
            message = f"expected a number, got {token.text}, a list of {len(values)}"
            raise self.error(message, NotReadError)
        return values[0]

    def _applied(self, name: str, values: list[float]) -> float:
        try:
            return float(FUNCTIONS[name](*values))
        except TypeError:
            raise self.error(f"{name} is not a function of {len(values)} numbers") from None

    def look_up(self, name: str) -> list[float]:
        values = self.variables.values.get(name)
        if values is None:
            message = f"{name!r} is neither a variable nor a function that can be read"
            raise self.error(message, NotReadError)
        return values
