"""The grammar of SVG, as far as it says where lines go.

A browser draws a path up to the first error in it, and leaves out a circle whose radius it cannot
read; so does svgelements, without a word. A domain with such a gap would be a wrong one: here what
does not follow the grammar is refused, with the element and the text.

Source: Scalable Vector Graphics (SVG) 1.1, 8.3.9 "The grammar for path data", and 7.6 for
transformations.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from adaptmesh.errors import FormatError
from adaptmesh.files.bounded import MOST_NESTED

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

_BLANK = " \t\r\n\f,"
_GAP = r"[\s,]*"
_NUMBER = r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"
_UNIT = "(?:[a-zA-Z]{1,4}|%)?"
_COORDINATE = re.compile(_NUMBER + _GAP)
_FLAG = re.compile("[01]" + _GAP)
_ANGLE_OR_LENGTH = re.compile(_NUMBER + _UNIT + _GAP)
_LENGTH = re.compile(rf"{_NUMBER}(?:\s*(?:[a-zA-Z]{{1,4}}|%))?|auto")
_FUNCTION = re.compile(r"(?:matrix|translate[XY]?|scale[XY]?|rotate|skew[XY]?)\s*\(([^()]*)\)")
_COMMAND = re.compile(r"([MLHVCSQTAZ])([^MLHVCSQTAZ]*)", re.IGNORECASE)
_ARGUMENTS = {
    **{
        letter: (_COORDINATE,) * count
        for letter, count in {
            "M": 2,
            "L": 2,
            "T": 2,
            "H": 1,
            "V": 1,
            "C": 6,
            "S": 4,
            "Q": 4,
        }.items()
    },
    "A": (_COORDINATE,) * 3 + (_FLAG,) * 2 + (_COORDINATE,) * 2,
    "Z": (),
}

_LENGTHS = ("x", "y", "x1", "y1", "x2", "y2", "cx", "cy", "r", "rx", "ry", "width", "height")
_SHAPES = {"circle", "ellipse", "line", "rect"}
_NAMESPACE = "{http://www.w3.org/2000/svg}"
_HREFS = ("href", "{http://www.w3.org/1999/xlink}href")

_COLOURS = ("fill", "stroke", "color")
_COLOUR = re.compile(r"\b(?:fill|stroke|color)\s*:([^;}]*)")
_LONGEST_COLOUR = 200
_LONGEST_SELECTOR = 1000
MOST_COPIES = 100_000
"""Elements, and numbers in their paths, that `<use>` may draw beyond those of the file itself."""


def check_syntax(root: Element) -> None:
    """Raise for the first element that would not be drawn as its author meant."""
    ids = {f"#{element.get('id')}": element for element in root.iter()}
    _refuse_many_copies(root, ids)
    for element in root.iter():
        tag = str(element.tag).removeprefix(_NAMESPACE)
        if tag == "path":
            _check(element, "d", _is_path)
        elif tag in ("polyline", "polygon"):
            _check(element, "points", lambda text: _are(text, (_COORDINATE,) * 2))
        elif tag in _SHAPES:
            for name in _LENGTHS:
                _check(element, name, lambda text: bool(_LENGTH.fullmatch(text.strip())))
        elif tag == "use":
            for name in _HREFS:
                _check(element, name, ids.__contains__)
        elif tag == "style" and not is_stylesheet(element.text or ""):
            raise FormatError("<style> is not a list of rules, selector { property: value; }")
        _check(element, "transform", _is_transform)
        _check(element, "style", _are_colours_short)
        for name in _COLOURS:
            _check(element, name, lambda text: len(text) <= _LONGEST_COLOUR)


def _refuse_many_copies(root: Element, ids: Mapping[str, Element]) -> None:
    """Raise if uses of groups of uses, ... draw far more than the file holds."""
    weights: dict[Element, int] = {}

    def own(element: Element) -> int:
        return 1 + (len(element.get("d", "")) + len(element.get("points", ""))) // 8

    def weight(element: Element, depth: int) -> int:
        if depth > MOST_NESTED:
            raise FormatError(f"uses are nested more than {MOST_NESTED} deep, or in themselves")
        if element not in weights:
            parts = list(element)
            if str(element.tag).removeprefix(_NAMESPACE) == "use":
                parts += [ids[h] for h in map(element.get, _HREFS) if h is not None and h in ids]
            total = own(element)
            for part in parts:
                total += weight(part, depth + 1)
            weights[element] = total
        return weights[element]

    if weight(root, 0) > MOST_COPIES + sum(map(own, root.iter())):
        raise FormatError(
            f"its uses draw more than {MOST_COPIES} copies of what it holds: it is made to fill "
            "the memory, or should be split"
        )


def is_stylesheet(text: str) -> bool:
    """Whether it is rules, comments closed: svgelements' patterns take quadratic time else."""
    at = text.find("/*")
    while at >= 0:
        end = text.find("*/", at + 2)
        if end < 0:
            return False
        at = text.find("/*", end + 2)
    *rules, rest = text.split("}")
    selectors = [rule.partition("{")[0] for rule in rules]
    return (
        "{" not in rest
        and all(len(selector) <= _LONGEST_SELECTOR for selector in (*selectors, rest))
        and _are_colours_short(text)
    )


def _are_colours_short(text: str) -> bool:
    return all(len(match[1]) <= _LONGEST_COLOUR for match in _COLOUR.finditer(text))


def _check(element: Element, name: str, is_good: Callable[[str], bool]) -> None:
    value = element.get(name)
    if value is None or is_good(value):
        return
    tag, attribute = (str(full).rpartition("}")[2] for full in (element.tag, name))
    which = f" {element.get('id')!r}" if element.get("id") else ""
    shown = value if len(value) <= 60 else f"{value[:60]}..."
    raise FormatError(f"<{tag}>{which}: {attribute}={shown!r} cannot be drawn: mend or remove it")


def _is_path(text: str) -> bool:
    """Whether it is nothing, or commands with as many numbers as they take, the first a move."""
    text = text.strip()
    if text in ("", "none"):
        return True
    return text[0] in "mM" and all(
        _are(arguments, kinds) and bool(arguments.strip(_BLANK)) == bool(kinds)
        for letter, arguments in _COMMAND.findall(text)
        for kinds in [_ARGUMENTS[letter.upper()]]
    )


def _is_transform(text: str) -> bool:
    """Whether it is functions of numbers, one after another."""
    return not _FUNCTION.sub("", text).strip(_BLANK) and all(
        _are(arguments, (_ANGLE_OR_LENGTH,)) for arguments in _FUNCTION.findall(text)
    )


def _are(text: str, kinds: tuple[re.Pattern[str], ...]) -> bool:
    """Whether it is arguments of these kinds, in turn, any number of times.

    One after another: a pattern for all of them would try every way to cut a row of digits.
    """
    at = len(text) - len(text.lstrip(_BLANK))
    count = 0
    while at < len(text):
        found = kinds[count % len(kinds)].match(text, at) if kinds else None
        if found is None:
            return False
        at = found.end()
        count += 1
    return not kinds or count % len(kinds) == 0
