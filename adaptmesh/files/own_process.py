"""Libraries that may crash, hang or take all memory, run in a process of their own.

The program is a file that imports nothing of adaptmesh. It sets its bounds on time and memory
itself, and prints its answer as JSON in its last line, with an "error" that is empty if all went
well.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from adaptmesh.errors import FormatError


def ask_program(
    program: Path,
    arguments: Sequence[object],
    folder: Path,
    timeout: float,
    *,
    who: str,
    late: str,
    no_answer: str,
    environment: Mapping[str, str] | None = None,
) -> dict[str, Any]:
    """Run a program with this Python and return what it answers.

    Parameters
    ----------
    program : Path
    arguments : sequence
        As the program takes them; they become texts.
    folder : Path
        Where it works.
    timeout : float
        Seconds after which it is stopped.
    who : str
        What messages call it.
    late, no_answer : str
        What it has not done if it is stopped, and what the cause may be if it ends without answer.
    environment : mapping of str to str, optional
        Variables of the environment besides those of this process.

    Raises
    ------
    FormatError
        It cannot be started, is stopped, or ends without an answer.
    """
    paths = os.pathsep.join(filter(None, sys.path))
    try:
        done = subprocess.run(
            [sys.executable, "-c", program.read_text(encoding="utf-8"), *map(str, arguments)],
            cwd=folder,
            env={**os.environ, **(environment or {}), "PYTHONPATH": paths},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=timeout,
            check=False,
        )
    except subprocess.TimeoutExpired:
        raise FormatError(f"{who} has not {late} after {timeout} s") from None
    except OSError as error:
        raise FormatError(f"{who} cannot be started: {error}") from None
    try:
        answer: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    except (ValueError, IndexError):
        raise FormatError(
            f"{who} ended without a result (exit code {done.returncode}): {no_answer}"
        ) from None
    return answer
