"""What of a .geo script is handed to Gmsh: it and what it includes, and nothing that reaches out.

A script can run programs and read and write files. Before Gmsh sees it,

- ``Include`` and ``Merge`` of another script include a copy of that file, made safe in the same
  way, if it is in the folder of the script or below;
- statements that show, print, save, mesh or cut meshes are left out: they say nothing about the
  domain;
- what else reads or writes files, runs programs or makes statements of texts is refused.

The words are found as Gmsh's own scanner finds them. Comments are left out and lines stay what they
were, so that the line of an error in the script is right; and because Gmsh remembers macros and
loops by their lines: what follows on the same line is lost when they are called.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from adaptmesh.errors import FormatError
from adaptmesh.files.whole import read_text

LARGEST_SCRIPT = 2_000_000
"""Characters of a script with all that it includes."""

DEEPEST_INCLUDE = 16
"""Files that include one another."""

MOST_INCLUDES = 200
"""Files that are put in, each as often as it is."""

_LONGEST_STRING = 1000  # at 1023 Gmsh stops, and takes what is left for statements

_TOKENS = re.compile(
    r"""(?P<blank>\s+)
    | (?P<comment>//[^\n]*|/\*.*?\*/)
    | (?P<open>/\*)
    | (?P<string>"[^"]*"|'[^']*')
    | (?P<name>[A-Za-z_][A-Za-z_0-9]*)
    | (?P<sign>.)""",
    re.VERBOSE | re.DOTALL,
)

_LEFT_OUT_WORDS = """
Printf Print Save Sleep Plugin View Draw Background General Solver PostProcessing OptimizeMesh
RefineMesh RecombineMesh SetOrder Warning Levelset
"""
_LEFT_OUT = frozenset(_LEFT_OUT_WORDS.split())
_REFUSED_WORDS = """
SystemCall System NonBlockingSystemCall OnelabRun OnelabAction Open MergeFile MergeWithBoundingBox
ShapeFromFile ListFromFile FileExists GetEnv CreateDir StringToName S2N Parse Exit Abort AdaptMesh
Levelset ExternalProcess
"""
_REFUSED = frozenset(_REFUSED_WORDS.split())
_ONLY_COMMANDS = frozenset(["Merge", "Printf", "Print", "Save", "Plugin"])
"""Words that read or write files, and have to begin a statement to be seen."""
MENTIONED = frozenset(["Merge", "Print", "Save", "Plugin", "View", "Mesh", "Levelset"])
"""Of what is left out: that of which somebody may want to know."""

_BEFORE_STATEMENTS = frozenset([";", "}", ")", "EndIf", "EndFor", "Else", "Return"])
_SCRIPTS, _VIEWS = (".geo", ".inc", ".txt", ".par"), (".pos",)


class _Token(NamedTuple):
    kind: str
    text: str
    line: int


@dataclass
class SafeScript:
    """A script that may be handed to Gmsh.

    Attributes
    ----------
    text : str
    included : list of (Path, str)
        The files that it includes, as often as they are, and their texts; the first is to be named
        as `included_name` says, and so on.
    left_out : dict of str to int
        First words of statements that are not in it, and the line of the first of each.
    """

    text: str = ""
    included: list[tuple[Path, str]] = field(default_factory=list)
    left_out: dict[str, int] = field(default_factory=dict)


def included_name(number: int) -> str:
    """The name by which a script includes its file of this number, counted from 0."""
    return f"included{number}.geo"


def safe_script(path: Path) -> SafeScript:
    """Read a script and what it includes; a `FormatError` names what may not be in it."""
    out = SafeScript()
    expander = _Expander(path.resolve().parent, out)
    out.text = expander.text_of(path, 0)
    return out


class _Expander:
    """Takes in included files, and looks at each word."""

    def __init__(self, folder: Path, out: SafeScript) -> None:
        self._folder, self._out = folder, out
        self._size = self._files = 0

    def text_of(self, path: Path, depth: int) -> str:
        """A file as it is handed to Gmsh."""
        return "".join(self._pieces(path, depth)) + "\n"  # a last line without an end is dropped

    def _pieces(self, path: Path, depth: int) -> Iterator[str]:
        tokens = self._tokens_of(path, depth)
        at, before = 0, ";"
        while at < len(tokens):
            token = tokens[at]
            starts = token.kind == "name" and before in _BEFORE_STATEMENTS
            if _includes(token, starts):
                end = _end_of_statement(path, tokens, at)
                yield from self._included(path, tokens[at : end + 1], depth)
            elif starts and _is_left_out(tokens, at):
                end = _end_of_statement(path, tokens, at)
                self._out.left_out.setdefault(token.text, token.line)
                yield _newlines(tokens[at : end + 1])
            else:
                _check_word(path, tokens, at, starts)
                yield token.text
                if token.kind != "blank":
                    before = ";" if before in ("Macro", "Function") else token.text
                at += 1
                continue
            before, at = ";", end + 1

    def _tokens_of(self, path: Path, depth: int) -> list[_Token]:
        if depth > DEEPEST_INCLUDE:
            raise FormatError(f"{path}: more than {DEEPEST_INCLUDE} files include one another")
        text = read_text(path)
        self._size += len(text)
        self._files += 1
        if self._size > LARGEST_SCRIPT or self._files > MOST_INCLUDES:
            raise FormatError(
                f"{path}: the script and what it includes have over {LARGEST_SCRIPT:,} characters, "
                f"or over {MOST_INCLUDES} files"
            )
        return list(_tokens(path, text))

    def _included(self, path: Path, statement: list[_Token], depth: int) -> Iterator[str]:
        """The statement that includes a copy; nothing of a view, which only says sizes."""
        word, line = statement[0].text, statement[0].line
        file = self._named_file(path, statement)
        if word == "Merge" and file.suffix.lower() in _VIEWS:
            self._out.left_out.setdefault(word, line)
        else:
            text = self.text_of(file, depth + 1)
            yield f'Include "{included_name(len(self._out.included))}";'
            self._out.included.append((file, text))
        yield _newlines(statement)

    def _named_file(self, path: Path, statement: list[_Token]) -> Path:
        """The file that ``Include "name";`` or ``Merge "name";`` names."""
        word, line = statement[0].text, statement[0].line
        kinds = [t for t in statement[1:] if t.kind != "blank" and t.text != ";"]
        if len(kinds) != 1 or kinds[0].kind != "string":
            raise FormatError(
                f'{path}, line {line}: {word} of a computed name is refused; write {word} "name"'
            )
        name = kinds[0].text[1:-1]
        file = (path.resolve().parent / name).resolve()
        if not file.is_relative_to(self._folder):
            raise FormatError(
                f"{path}, line {line}: {word} of {name!r} is refused: it is not in the folder of "
                "the script; put a copy beside it"
            )
        if word == "Merge" and file.suffix.lower() not in (*_SCRIPTS, *_VIEWS):
            raise FormatError(
                f"{path}, line {line}: {word} of {name!r} cannot be read: only scripts can be "
                "merged; mesh the geometry with Gmsh and read the .msh"
            )
        return file


def _includes(token: _Token, starts: bool) -> bool:
    is_include = token.kind == "name" and token.text == "Include"
    return is_include or (starts and token.text == "Merge")


def _is_left_out(tokens: list[_Token], at: int) -> bool:
    """Whether a statement is only for the eye, prints, saves, or meshes (``Mesh 2;``)."""
    word, after = tokens[at].text, _next(tokens, at)
    if word in ("Show", "Hide"):  # with a text; those of entities have no ; at their end
        return after.kind == "string"
    return word in _LEFT_OUT or (word == "Mesh" and after.text.isdigit())


def _check_word(path: Path, tokens: list[_Token], at: int, starts: bool) -> None:
    kind, word, line = tokens[at]
    hidden = word in _ONLY_COMMANDS and _next(tokens, at).text != "."
    if kind == "name" and (word in _REFUSED or hidden):
        raise FormatError(
            f"{path}, line {line}: {word} is refused: a script may not run programs, read or write "
            "other files, or make statements of texts; remove it"
        )
    if starts and _next(tokens, at).kind == "string":
        raise FormatError(
            f"{path}, line {line}: the command {word} with a text is not known: remove it"
        )


def _tokens(path: Path, text: str) -> Iterator[_Token]:
    line = 1
    for match in _TOKENS.finditer(text):
        kind, word = str(match.lastgroup), match[0]
        if kind == "open" or (kind == "sign" and word in "\"'"):
            raise FormatError(f"{path}, line {line}: a comment or text is not closed")
        if kind == "string" and len(word.encode()) > _LONGEST_STRING:
            raise FormatError(f"{path}, line {line}: a text of {len(word)} letters is too long")
        if kind == "comment":
            kind, word = "blank", "\n" * word.count("\n") or " "
        yield _Token(kind, word, line)
        line += word.count("\n")


def _next(tokens: list[_Token], at: int) -> _Token:
    return next((t for t in tokens[at + 1 :] if t.kind != "blank"), _Token("end", "", 0))


def _end_of_statement(path: Path, tokens: list[_Token], at: int) -> int:
    """The place of the ``;`` that ends a statement."""
    depth = 0
    for k in range(at, len(tokens)):
        text = tokens[k].text
        if tokens[k].kind == "sign":
            depth += (text in "{([") - (text in "})]")
            if text == ";" and depth <= 0:
                return k
    raise FormatError(f"{path}, line {tokens[at].line}: {tokens[at].text} is not closed by ;")


def _newlines(tokens: list[_Token]) -> str:
    return "\n" * sum(t.text.count("\n") for t in tokens) or " "
