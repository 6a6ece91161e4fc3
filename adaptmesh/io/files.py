"""Whole files in, whole files out."""

from __future__ import annotations

import contextlib
import os
import secrets
import shutil
from collections.abc import Mapping
from pathlib import Path

from ..errors import FormatError


def read_bytes(path: Path) -> bytes:
    """Everything that a file holds."""
    try:
        return path.read_bytes()
    except FileNotFoundError:
        raise FormatError(f"{path}: there is no such file") from None
    except OSError as error:
        raise FormatError(f"{path}: cannot be read: {error.strerror or error}") from None


def read_text(path: Path) -> str:
    """Everything that a text file holds; UTF-8, with or without a mark in front."""
    try:
        return read_bytes(path).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise FormatError(f"{path}: is not a text file: {error}") from None


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
