"""Histories in folders: a file for each iteration, and one that says which belong together.

folder/
  iteration_0000.npz    mesh, fields and metric, bit for bit
  iteration_0001.npz
  history.json          numbers of all iterations; replaced last, so what it lists is whole
"""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from adaptmesh.errors import FormatError
from adaptmesh.files.bounded import read_json
from adaptmesh.files.notes import Notes
from adaptmesh.files.whole import read_bytes, replace_files
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.value import FrozenMapping
from metrics import tensor

from .archive import check_fields, damage_named, decoded, encoded, refuse_left_over, take
from .history import History, Iteration, OnDisk, Seconds, Snapshot
from .solution import UNNAMED, Solved

if TYPE_CHECKING:
    from adaptmesh.domain.domain import Domain

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
        content = read_list(path, VERSION)
        iterations = tuple(
            _iteration(Notes(n), folder, domain) for n in content.items("iterations")
        )
        history = History(
            iterations,
            content.text("reason"),
            content.flag("converged"),
            content.texts("options"),
            content.count("options_since") if "options_since" in content else 0,
        )
    for k, iteration in enumerate(history):
        file = _path(folder, iteration)
        if iteration.number != k or not file.exists():
            raise FormatError(f"{path}: iteration {k} is missing ({file.name})")
    return history


def read_list(path: Path, version: int) -> Notes:
    """What the list of a history says, if it is of that version."""
    content = Notes(read_json(read_bytes(path)))
    if content.count("version") != version:
        raise FormatError(f"it is of version {content.count('version')}; this reads {version}")
    return content


def read_snapshot(path: Path, domain: Domain | None) -> Snapshot:
    """The arrays of one iteration."""
    mesh, arrays, notes = decoded(path, domain)
    with damage_named(path):
        fields = {n: take(arrays, f"field_{k}") for k, n in enumerate(notes.names("fields"))}
        check_fields(fields, mesh)
        is_bare = notes.flag("is_bare")
        if is_bare and list(fields) != [UNNAMED]:
            raise FormatError(f"the fields {list(fields)} are not one without a name")
        given = _metric(arrays, "given", mesh) if notes.flag("metric_was_given") else None
        solved = Solved(FrozenMapping(fields), is_bare, given, notes.reals("errors"))
        metric = _metric(arrays, "metric", mesh)
        refuse_left_over(arrays)
        return Snapshot(mesh, solved, metric)


def _metric(arrays: dict[str, NDArray[Any]], name: str, mesh: Mesh) -> NDArray[np.float64]:
    metric = take(arrays, name)
    if metric.shape != (len(mesh.points), 3) or metric.dtype != np.float64:
        raise FormatError(f"a metric is {metric.dtype} of shape {metric.shape}")
    tensor.pack(metric, points=mesh.points)  # a check
    return metric


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


def _iteration(numbers: Notes, folder: Path, domain: Domain | None) -> Iteration:
    number = numbers.count("number")
    return Iteration(
        number=number,
        n_points=numbers.count("n_points"),
        n_triangles=numbers.count("n_triangles"),
        errors=FrozenMapping(numbers.reals("errors")),
        unit_fraction=np.nan if numbers.is_null("unit_fraction") else numbers.real("unit_fraction"),
        seconds=numbers.record("seconds", Seconds),
        kept=OnDisk(folder / _name(number), domain),
    )


def _path(folder: Path, iteration: Iteration) -> Path:
    return folder / _name(iteration.number)


def _name(number: int) -> str:
    return f"iteration_{number:04d}.npz"
