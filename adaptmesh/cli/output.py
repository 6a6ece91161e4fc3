"""Output of the commands: text, one JSON object, or nothing; errors and warnings."""

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


class Reporter:
    """Prints the results of a command to standard output.

    Parameters
    ----------
    quiet : bool
        Print nothing.
    as_json : bool
        Instead of text, print one JSON object when the command is done.
    """

    def __init__(self, quiet: bool = False, as_json: bool = False) -> None:
        if quiet and as_json:
            raise typer.BadParameter("give one of --quiet and --json")
        self.is_silent = quiet or as_json
        self.as_json = as_json
        self.facts: dict[str, Any] = {}

    def print(self, text: object) -> None:
        """Print text, unless quiet or as JSON."""
        if not self.is_silent:
            write(str(text))

    def record(self, **facts: Any) -> None:
        """Add facts to the JSON object."""
        self.facts.update(facts)

    def finish(self) -> None:
        """Print the JSON object, if requested."""
        if self.as_json:
            write(json.dumps(self.facts, indent=1, allow_nan=False))


def write(text: str) -> None:
    """Print to standard output; ignore a closed pipe, as of ``| head``."""
    try:
        typer.echo(text)
    except BrokenPipeError:
        devnull = os.open(os.devnull, os.O_WRONLY)
        os.dup2(devnull, sys.stdout.fileno())  # also for the rest of the buffer
        os.close(devnull)


@contextmanager
def report_errors() -> Iterator[None]:
    """Turn errors of the input into a message and an exit code; let bugs raise tracebacks."""
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
def report_as_usage_error() -> Iterator[None]:
    """Report a `ValueError` of the library about an argument as wrong usage."""
    try:
        yield
    except AdaptmeshError:
        raise
    except ValueError as error:
        raise typer.BadParameter(str(error)) from None


def _fail(message: str) -> NoReturn:
    typer.echo(typer.style("error: ", fg=typer.colors.RED, bold=True) + message, err=True)
    raise typer.Exit(EXIT_BAD) from None


def shorten_warnings() -> None:
    """Print warnings to standard error as one line, without the line of code."""

    def show(message: Warning | str, *_: object, **__: object) -> None:
        heading = typer.style("warning: ", fg=typer.colors.YELLOW, bold=True)
        typer.echo(heading + str(message), err=True)

    warnings.showwarning = show
