"""What a command says: text on its way, one JSON object at its end, or nothing; and errors."""

from __future__ import annotations

import json
import os
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NoReturn

import typer

from adaptmesh.errors import AdaptmeshError

EXIT_BAD = 1
EXIT_INTERRUPTED = 130


class Speaker:
    """Reports of a command on standard output.

    Parameters
    ----------
    quiet : bool
        Say nothing.
    as_json : bool
        Instead of text, print one JSON object when the command is done.
    """

    def __init__(self, quiet: bool = False, as_json: bool = False) -> None:
        if quiet and as_json:
            raise typer.BadParameter("--quiet prints nothing and --json an object: give one")
        self.is_silent = quiet or as_json
        self.as_json = as_json
        self.facts: dict[str, Any] = {}

    def say(self, text: object) -> None:
        """Print text now, for people."""
        if not self.is_silent:
            write(str(text))

    def note(self, **facts: Any) -> None:
        """Keep facts for the JSON object."""
        self.facts.update(facts)

    def finish(self) -> None:
        """Print the JSON object, if one was asked for."""
        if self.as_json:
            write(json.dumps(self.facts, indent=1, allow_nan=False))


def write(text: str) -> None:
    """Print to standard output; if its reader has left, as in ``| head``, go on without."""
    try:
        typer.echo(text)
    except BrokenPipeError:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())  # what is still in the buffer goes there, too
        os.close(nowhere)


@contextmanager
def neat_errors() -> Iterator[None]:
    """Turn what the user can mend into a message and an exit code; let our own mistakes show."""
    try:
        yield
    except AdaptmeshError as error:
        _fail(str(error))
    except OSError as error:
        _fail(f"{error.filename or 'a file'}: {error.strerror or error}")
    except KeyboardInterrupt:
        typer.echo("interrupted", err=True)
        raise typer.Exit(EXIT_INTERRUPTED) from None


@contextmanager
def refused_as_usage() -> Iterator[None]:
    """Take arguments that the library refuses, once it has seen the data, for wrong usage."""
    try:
        yield
    except AdaptmeshError:
        raise
    except ValueError as error:
        raise typer.BadParameter(str(error)) from None


def _fail(message: str) -> NoReturn:
    typer.echo(typer.style("error: ", fg=typer.colors.RED, bold=True) + message, err=True)
    raise typer.Exit(EXIT_BAD) from None


def show_warnings_neatly() -> None:
    """Print warnings as one line on standard error, without the line of code."""

    def show(message: Warning | str, *_: object, **__: object) -> None:
        heading = typer.style("warning: ", fg=typer.colors.YELLOW, bold=True)
        typer.echo(heading + str(message), err=True)

    warnings.showwarning = show
