"""Whole files in, whole files out."""

from __future__ import annotations

import codecs
import contextlib
import os
import secrets
import shutil
from collections.abc import Mapping
from pathlib import Path

from adaptmesh.errors import FormatError

from . import encodings
from .located import located


def read_bytes(path: Path) -> bytes:
    """Everything that a file holds; pipes and devices, which may have no end, are refused."""
    try:
        if path.exists() and not path.is_file():
            raise FormatError(f"{path}: cannot be read: it is no regular file")
        return path.read_bytes()
    except FormatError:
        raise
    except FileNotFoundError:
        raise FormatError(f"{path}: there is no such file") from None
    except OSError as error:
        raise FormatError(f"{path}: cannot be read: {error.strerror or error}") from None


def read_text(path: Path) -> str:
    """Everything that a text file holds, in any encoding that `encodings` knows."""
    data = read_bytes(path)
    with located(path):
        return text_of(data)


def text_of(data: bytes) -> str:
    """The text that bytes hold, see `encodings`; a `FormatError` if they are no text."""
    try:
        return encodings.text_of(data)
    except ValueError as error:
        raise FormatError(str(error)) from None


def without_mark(data: bytes) -> bytes:
    """The bytes of a file, text or binary; of a text with a byte-order mark as plain UTF-8."""
    try:
        return encodings.without_mark(data)
    except ValueError as error:
        raise FormatError(str(error)) from None


def readable_xml(data: bytes) -> bytes:
    """XML that names no encoding and is not the UTF-8 it should be, as UTF-8; else as it is."""
    head = data[: data.find(b"?>")] if data.lstrip().startswith(b"<?xml") else b""
    try:
        data.decode()
    except UnicodeDecodeError:
        named = b"encoding" in head or data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
        return data if named else text_of(data).encode()
    return data


def replace_files(contents: Mapping[Path, bytes]) -> None:
    """Write each file whole or not at all.

    Everything is first written under temporary names in the same folders, then renamed: until the
    last byte is on disk the old files stay as they were, and after any error or interrupt the
    temporary ones are removed.
    """
    written: dict[Path, Path] = {}
    path = Path()
    try:
        for path, data in contents.items():
            target = Path(os.path.realpath(path))  # a link keeps pointing where it points
            if target.is_dir():
                raise FormatError(f"{path}: is a folder; give the name of a file")
            temporary = target.with_name(f".{secrets.token_hex(8)}.tmp")
            written[temporary] = target
            _write_synced(temporary, data)
            if target.exists():
                shutil.copymode(target, temporary)
        for temporary, target in written.items():
            temporary.replace(target)
    except FormatError:
        raise
    except FileNotFoundError:
        raise FormatError(
            f"{path}: there is no folder {str(path.parent)!r}; create it first"
        ) from None
    except OSError as error:
        raise FormatError(f"{path}: cannot be written: {error.strerror or error}") from None
    finally:
        for temporary in written:
            with contextlib.suppress(OSError):
                temporary.unlink(missing_ok=True)


def _write_synced(path: Path, data: bytes) -> None:
    with path.open("xb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())
