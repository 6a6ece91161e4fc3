"""The statements of .geo scripts: what they define, in the order of the file.

Read are assignments, loops (For), conditions (If), and the definitions that describe a plane
domain. Statements that only say how Gmsh is to mesh or to show are passed over: sizes are the
business of the metric. All others (extrusion, booleans, ...) are refused, with their line.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from adaptmesh.errors import FormatError

from .expressions import NotReadError, Reader, Token, Variables, tokens_of

CURVES = ("Line", "Circle", "Ellipse", "Spline", "BSpline", "Bezier")
_RENAMED = {"Line Loop": "Curve Loop", "Physical Line": "Physical Curve", "Ellipsis": "Ellipse"}
_TWO_WORDS = {"Curve", "Line", "Plane", "Physical", "Surface", "Characteristic", "Transfinite"}

_MESHING = """
Mesh General Geometry Solver View PostProcessing Print Printf Characteristic MeshSize Field
Background BoundaryLayer Recombine Transfinite Smoother Show Hide Color Save Coherence Reverse
"""

PASSED_OVER = frozenset(_MESHING.split())
"""First words of statements that say nothing about the domain."""

_END_WITH_BRACE = ("Show", "Hide", "Color")

MOST_DEFINED = 100_000
"""Points, curves and groups that the loops of a script may define."""


@dataclass(frozen=True)
class Definition:
    """``Kind(number) = {values};`` or for physical groups ``Kind("name", number) = {values};``"""

    kind: str
    number: int
    values: tuple[float, ...]
    line: int
    name: str | None = None


@dataclass
class Script:
    """What a script defines.

    Attributes
    ----------
    definitions : list of Definition
    embedded : list of (kind, numbers)
        Points and curves that are In Surface: they lie inside.
    """

    definitions: list[Definition] = field(default_factory=list)
    embedded: list[tuple[str, tuple[int, ...]]] = field(default_factory=list)


def script_of(text: str) -> Script:
    """Read a script."""
    reader = _Statements(tokens_of(text), Variables())
    try:
        while reader.token.kind != "end":
            reader.statement()
    except RecursionError:
        raise reader.error("parentheses, loops or conditions are nested too deeply") from None
    return reader.script


class _Statements(Reader):
    def __init__(self, tokens: list[Token], variables: Variables) -> None:
        super().__init__(tokens, variables)
        self.script = Script()
        self._ends: dict[int, int] = {}  # of loops, by the place where their body begins
        self._parts: dict[int, tuple[int, str]] = {}  # of conditions, likewise

    def statement(self) -> None:
        if self.accept(";"):
            return
        token = self.token
        if token.kind != "name":
            raise self.error(f"expected a statement, got {token.text!r}", NotReadError)
        word = token.text
        if word == "For":
            self._for()
        elif word == "If":
            self._if()
        elif word == "SetFactory":
            self._set_factory()
        elif word == "DefineConstant":
            self._define_constant()
        elif self._is_assignment():
            self._assign()
        elif word == "Geometry.OldNewReg":
            message = "Geometry.OldNewReg, another way to count, cannot be read"
            raise self.error(message, NotReadError)
        elif word.split(".")[0] in PASSED_OVER:
            self._pass_over()
        else:
            self._entity()

    # -- variables

    def _is_assignment(self) -> bool:
        texts = [t.text for t in self.tokens[self.at + 1 : self.at + 4]]
        if texts[1:2] == ["]"] or texts[1:2] == [")"]:
            texts = texts[2:]
        return "." not in self.token.text and texts[:1] in (["="], ["+="], ["-="], ["*="], ["/="])

    def _assign(self) -> None:
        name = self.next().text
        is_list = bool(self.accept("[", "("))
        if is_list:
            self.expect("]", ")")
        sign = self.next().text
        if self.token.kind == "string":  # a text: of no use for a domain
            self._pass_over()
            return
        values = self.listed()
        self.expect(";")
        old = self.variables.values.get(name, [])
        if sign == "=":
            self.variables.values[name] = values
        elif is_list and sign == "+=":
            self.variables.values.setdefault(name, []).extend(values)
        elif len(old) == len(values) == 1:
            self.variables.values[name] = [self._changed(old[0], sign, values[0])]
        else:
            raise self.error(f"{sign} is for numbers, not for lists", NotReadError)

    def _changed(self, old: float, sign: str, new: float) -> float:
        if sign == "/=":
            if new == 0:
                raise self.error("division by zero")
            return old / new
        return {"+=": old + new, "-=": old - new, "*=": old * new}[sign]

    def _define_constant(self) -> None:
        """DefineConstant[ name = value, name = {value, options}, name ]; what is set stays."""
        self.next()
        self.expect("[", "(", "{")
        while not self.accept("]", ")", "}"):
            name = self.next().text
            if self.accept("="):
                values = self._constant()
                self.variables.values.setdefault(name, values)
            self.accept(",")
        self.expect(";")

    def _constant(self) -> list[float]:
        if not self.accept("{"):
            return [self.number()]
        value = [self.number()]
        depth = 1
        while depth:  # options of the graphical interface
            token = self.next()
            depth += (token.text == "{") - (token.text == "}")
            if token.kind == "end":
                raise self.error("DefineConstant is not closed")
        return value

    # -- control

    def _for(self) -> None:
        """For name In {a:b:c} ... EndFor, or For (a:b:c) ... EndFor"""
        opening = self.next()
        name = None
        if not self.has("("):
            name = self.next().text
            self.expect("In")
        before = self.at
        values = self.braced()
        has_step = [t.text for t in self.tokens[before : self.at]].count(":") == 2
        if values[:1] > values[-1:] and not has_step:  # a list would count down, but not a loop
            values = []
        body = self.at
        end = self._end_of("For", "EndFor", opening)
        for value in values:
            if name:
                self.variables.values[name] = [value]
            self.at = body
            while self.at < end:
                self.statement()
        self.at = end + 1

    def _if(self) -> None:
        """If (a) ... ElseIf (b) ... Else ... EndIf: the first part whose condition holds."""
        opening = self.next()
        done = False
        while True:
            holds = bool(self.number()) if not done else bool(self._skip_condition())
            end, closing = self._end_of_part(opening)
            if holds and not done:
                while self.at < end:
                    self.statement()
                done = True
            self.at = end + 1
            if closing == "EndIf":
                return
            if closing == "Else":
                end, _ = self._end_of_part(opening)
                while not done and self.at < end:
                    self.statement()
                self.at = end + 1
                return

    def _skip_condition(self) -> float:
        self.expect("(")
        depth = 1
        while depth:
            token = self.next()
            depth += (token.text == "(") - (token.text == ")")
            if token.kind == "end":
                raise self.error("a condition is not closed")
        return 0.0

    def _end_of(self, begin: str, end: str, opening: Token) -> int:
        if self.at in self._ends:
            return self._ends[self.at]
        depth = 1
        for k in range(self.at, len(self.tokens)):
            depth += (self.tokens[k].text == begin) - (self.tokens[k].text == end)
            if depth == 0:
                self._ends[self.at] = k
                return k
        raise FormatError(f"line {opening.line}: {begin} has no {end}")

    def _end_of_part(self, opening: Token) -> tuple[int, str]:
        if self.at in self._parts:
            return self._parts[self.at]
        depth = 0
        for k in range(self.at, len(self.tokens)):
            text = self.tokens[k].text
            if depth == 0 and text in ("ElseIf", "Else", "EndIf"):
                self._parts[self.at] = k, text
                return k, text
            depth += (text == "If") - (text == "EndIf")
        raise FormatError(f"line {opening.line}: If has no EndIf")

    def _set_factory(self) -> None:
        self.next()
        self.expect("(")
        name = self.next().text.strip("\"'")
        self.expect(")")
        self.expect(";")
        if name not in ("Built-in", "OpenCASCADE"):
            raise self.error(f"the geometry kernel {name!r} is not known")

    # -- entities

    def _entity(self) -> None:
        line, kind = self.token.line, self._kind()
        if self.has("{"):
            self._embed(kind)
            return
        if not self.has("("):
            raise NotReadError(f"line {line}: {kind!r} cannot be read; see docs/files for what can")
        self.next()
        name, number = self._tag(kind)
        self.expect(")")
        sign = self.expect("=", "+=").text
        values = tuple(self.braced())
        if self.accept("Using"):
            raise NotReadError(f"line {line}: {kind} Using cannot be read")
        self.expect(";")
        if sign == "+=" and not kind.startswith("Physical"):
            raise NotReadError(f"line {line}: only physical groups are added to")
        if len(self.script.definitions) > MOST_DEFINED + len(self.tokens):
            raise FormatError(f"line {line}: loops define more than {MOST_DEFINED:,} entities")
        self.script.definitions.append(Definition(kind, number, values, line, name))
        family = "Curve" if kind in CURVES else kind.split()[0]
        family = {"Plane": "Surface"}.get(family, kind if kind == "Curve Loop" else family)
        self.variables.used(family, number)

    def _kind(self) -> str:
        """One word, or two; plurals and old names become one."""
        words = [self.next().text]
        if words[0] in _TWO_WORDS and self.token.kind == "name":
            words.append(self.next().text)
        kind = " ".join(words)
        return _RENAMED.get(kind, kind)

    def _tag(self, kind: str) -> tuple[str | None, int]:
        if self.token.kind != "string":
            return None, self.whole(f"the number of a {kind}")
        name = self.next().text[1:-1]
        if self.accept(","):
            return name, self.whole(f"the number of {kind} {name!r}")
        groups = [d for d in self.script.definitions if d.kind.startswith("Physical")]
        like = (d.number for d in groups if (d.kind, d.name) == (kind, name))
        return name, next(like, 1 + max((d.number for d in groups), default=0))

    def _embed(self, kind: str) -> None:
        """Point{1, 2} In Surface{3}; the surface does not matter in a plane."""
        what = {"Line": "Curve"}.get(kind, kind)
        if what not in ("Point", "Curve"):
            raise self.error(f"{kind}{{...}} cannot be read", NotReadError)
        numbers = tuple(int(x) for x in self.braced())
        if not self.accept("In"):
            raise self.error(f"{kind}{{...}} cannot be read", NotReadError)
        self.expect("Surface")
        self.braced()
        self.expect(";")
        self.script.embedded.append((what, numbers))

    def _pass_over(self) -> None:
        """Go on to the end of a statement: a ``;``, or the ``}`` of ``Hide { Point{1}; }``."""
        ends_with_brace = self.token.text in _END_WITH_BRACE
        depth = 0
        while True:
            token = self.next()
            depth += (token.text in "{([") - (token.text in "})]") if token.kind == "sign" else 0
            if token.kind == "end":
                raise self.error("the last statement is not closed by ;")
            if depth <= 0 and (token.text == ";" or (ends_with_brace and token.text == "}")):
                return
