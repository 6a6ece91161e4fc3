"""The text of a file, in whatever encoding programs write it.

=============================  ==================================================================
a byte-order mark in front     UTF-8, UTF-16 or UTF-32, as the mark says
valid UTF-8                    UTF-8
anything else                  Windows-1252, which is Latin-1 with quotes and dashes; what has no
                               meaning there is Latin-1
=============================  ==================================================================

So any bytes are a text in some encoding; those with a zero byte are taken for binary data.
"""

from __future__ import annotations

import codecs
import contextlib

_MARKS = (  # that of UTF-32 starts with that of UTF-16
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF32_LE, "utf-32-le"),
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)
_HEAD = 1000  # bytes in which a text has the end of a line


def text_of(data: bytes) -> str:
    """Return the text that bytes hold; its lines end in ``\\n``, however the file ends them.

    Raises
    ------
    ValueError
        If it is no text: a zero byte, or bytes that are not what the mark in front says.
    """
    text = _decoded(data)
    zero = text.find("\0")
    if zero >= 0:
        raise ValueError(
            f"is not a text file: character {zero} is a zero byte (if it is UTF-16 without a "
            "byte-order mark, save it as UTF-8)"
        )
    return text.replace("\r\n", "\n").replace("\r", "\n") if "\r" in text else text


def without_mark(data: bytes) -> bytes:
    r"""Return the bytes of a file that may be text or binary.

    A text with a mark, or with lines that end in ``\r`` alone, is returned as plain UTF-8.
    """
    marked = any(data.startswith(mark) for mark, _ in _MARKS)
    head = data[:_HEAD]
    return text_of(data).encode() if marked or (b"\r" in head and b"\n" not in head) else data


def _decoded(data: bytes) -> str:
    for mark, encoding in _MARKS:
        if data.startswith(mark):
            try:
                return data[len(mark) :].decode(encoding)
            except UnicodeDecodeError as error:
                raise ValueError(
                    f"is not a text file: it starts with the mark of {encoding.upper()}, but "
                    f"{error.reason} at byte {len(mark) + error.start}"
                ) from None
    with contextlib.suppress(UnicodeDecodeError):
        return data.decode("utf-8")
    with contextlib.suppress(UnicodeDecodeError):
        return data.decode("cp1252")
    return data.decode("latin-1")
