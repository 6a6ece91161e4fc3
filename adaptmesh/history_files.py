"""Histories in folders: a file for each iteration, and one that says which belong together.

folder/
  iteration_0000.npz    mesh, fields and metric, bit for bit
  iteration_0001.npz
  history.json          numbers of all iterations; replaced last, so what it lists is whole
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .errors import FormatError
from .history import History, Iteration, OnDisk, Seconds, Snapshot
from .io.files import read_bytes, replace_files
from .solved import Solved
from .stored import damage_named, decoded, encoded
from .value import FrozenMapping

if TYPE_CHECKING:
    from .domain import Domain

LIST = "history.json"
VERSION = 1


def save(history: History, folder: Path) -> None:
    """Write every iteration, then the list of them; an older list is removed first."""
    make(folder)
    (folder / LIST).unlink(missing_ok=True)
    for iteration in history:
        path = _path(folder, iteration)
        if not (isinstance(iteration.kept, OnDisk) and iteration.kept.path == path):
            replace_files({path: _encoded(iteration.snapshot)})
    write_list(history, folder)


def append(history: History, folder: Path) -> None:
    """Write the last iteration, then the list."""
    iteration = history[-1]
    replace_files({_path(folder, iteration): _encoded(iteration.snapshot)})
    write_list(history, folder)


def left_on_disk(history: History, folder: Path, most: int, domain: Domain | None) -> History:
    """The same history, with no more than so many of the last snapshots in memory."""
    older = len(history) - most
    iterations = tuple(
        replace(it, kept=OnDisk(_path(folder, it), domain))
        if k < older and isinstance(it.kept, Snapshot)
        else it
        for k, it in enumerate(history)
    )
    return replace(history, iterations=iterations)


def write_list(history: History, folder: Path) -> None:
    """Write the numbers of all iterations, and why the loop has ended."""
    content = {
        "version": VERSION,
        "options": dict(history.options),
        "options_since": history.options_since,
        "reason": history.reason,
        "converged": history.converged,
        "iterations": [_numbers(iteration) for iteration in history],
    }
    replace_files({folder / LIST: json.dumps(content, indent=1).encode()})


def make(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FormatError(f"{folder}: cannot be made a folder: {error.strerror}") from None


def refuse_history(folder: Path, name: str = LIST) -> None:
    """Nobody's history is written over by a new one."""
    if (folder / name).exists():
        raise FormatError(
            f"{folder}: there is a history in this folder; give it as `resume` too to go on with "
            "it, or choose another folder"
        )


def load(folder: Path, domain: Domain | None) -> History:
    """Read the list; the arrays stay on disk."""
    path = folder / LIST
    if not path.exists():
        raise FormatError(f"{folder}: there is no history here ({LIST} is missing)")
    with damage_named(path):
        content = json.loads(read_bytes(path))
        if content["version"] != VERSION:
            raise FormatError(f"{path}: version {content['version']}; this reads {VERSION}")
        iterations = tuple(_iteration(n, folder, domain) for n in content["iterations"])
        history = History(
            iterations,
            content["reason"],
            bool(content["converged"]),
            content["options"],
            int(content.get("options_since", 0)),
        )
    for k, iteration in enumerate(history):
        file = _path(folder, iteration)
        if iteration.number != k or not file.exists():
            raise FormatError(f"{path}: iteration {k} is missing ({file.name})")
    return history


def read_snapshot(path: Path, domain: Domain | None) -> Snapshot:
    """The arrays of one iteration."""
    mesh, arrays, notes = decoded(path, domain)
    with damage_named(path):
        fields = {name: arrays[f"field_{k}"] for k, name in enumerate(notes["fields"])}
        given = arrays["given"] if notes["metric_was_given"] else None
        solved = Solved(FrozenMapping(fields), notes["is_bare"], given, notes["errors"])
        return Snapshot(mesh, solved, arrays["metric"])


def _encoded(snapshot: Snapshot) -> bytes:
    solved = snapshot.solved
    arrays = {f"field_{k}": values for k, values in enumerate(solved.fields.values())}
    arrays["metric"] = snapshot.metric
    if solved.metric is not None:
        arrays["given"] = solved.metric
    notes = {
        "fields": list(solved.fields),
        "is_bare": solved.is_bare,
        "metric_was_given": solved.metric is not None,
        "errors": dict(solved.errors),
    }
    return encoded(snapshot.mesh, arrays, notes)


def _numbers(iteration: Iteration) -> dict[str, Any]:
    return {
        "number": iteration.number,
        "n_points": iteration.n_points,
        "n_triangles": iteration.n_triangles,
        "errors": dict(iteration.errors),
        "unit_fraction": None if np.isnan(iteration.unit_fraction) else iteration.unit_fraction,
        "seconds": asdict(iteration.seconds),
    }


def _iteration(numbers: Mapping[str, Any], folder: Path, domain: Domain | None) -> Iteration:
    number = int(numbers["number"])
    unit = numbers["unit_fraction"]
    return Iteration(
        number=number,
        n_points=int(numbers["n_points"]),
        n_triangles=int(numbers["n_triangles"]),
        errors=FrozenMapping({str(k): float(v) for k, v in numbers["errors"].items()}),
        unit_fraction=np.nan if unit is None else float(unit),
        seconds=Seconds(**numbers["seconds"]),
        kept=OnDisk(folder / _name(number), domain),
    )


def _path(folder: Path, iteration: Iteration) -> Path:
    return folder / _name(iteration.number)


def _name(number: int) -> str:
    return f"iteration_{number:04d}.npz"
