"""The files of histories: a mesh with arrays and notes in one .npz, bit for bit; lists in JSON.

folder/
  iteration_0000.npz            of a `History`: mesh, fields and metric of each iteration
  history.json                  its list, replaced last, so that what it lists is whole

  sweep_00_interval_0000.npz    of a `TransientHistory`: mesh, fields and Hessians of each interval
  transient.json                its list
"""

from __future__ import annotations

import io
import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from adaptmesh.domain.domain import Domain
from adaptmesh.errors import AdaptmeshError, FormatError
from adaptmesh.files.bounded import read_json
from adaptmesh.files.notes import Notes
from adaptmesh.files.npz import read_npz
from adaptmesh.files.whole import read_bytes, replace_files
from adaptmesh.mesh.incoming import Content, mesh_of
from adaptmesh.mesh.mesh import Mesh
from adaptmesh.transfer.spaces import sizes
from adaptmesh.types import Array, Floats
from adaptmesh.value import FrozenMapping
from metrics import tensor

from .records import Fields, Interval, Seconds, Snapshot
from .solution import UNNAMED, Solution

VERSION = 1
MESH_ARRAYS = ("points", "triangles", "regions", "edges", "edge_tags")
INTERVAL_FIELDS = ("first", "last", "hessians")
_COLUMNS = {"points": 2, "triangles": 3, "edges": 2}


@dataclass(frozen=True)
class OnDisk:
    """A snapshot that is read from a file whenever it is asked for."""

    path: Path
    domain: Domain | None

    def read(self) -> Snapshot:
        return read_snapshot(self.path, self.domain)


# The lists ---------------------------------------------------------------------------------------


def make_folder(folder: Path) -> None:
    """Make a folder, if there is none."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FormatError(f"{folder}: cannot be made a folder: {error.strerror}") from None


def write_list(path: Path, content: Mapping[str, Any]) -> None:
    """Write the list of a history."""
    replace_files({path: json.dumps({"version": VERSION, **content}, indent=1).encode()})


def read_list(path: Path) -> Notes:
    """Read the list of a history, if it is of this version."""
    with name_damage(path):
        content = Notes(read_json(read_bytes(path)))
        if content.count("version") != VERSION:
            raise FormatError(f"it is of version {content.count('version')}; this reads {VERSION}")
    return content


@contextmanager
def name_damage(path: Path) -> Iterator[None]:
    """Errors of what a file holds, with its name."""
    try:
        yield
    except Warning:
        raise
    except AdaptmeshError as error:
        raise FormatError(f"{path}: is damaged: {error}") from None
    except Exception as error:  # unforeseen
        raise FormatError(f"{path}: is damaged: {type(error).__name__} {error}") from error


# Snapshots and intervals -------------------------------------------------------------------------


def write_snapshot(path: Path, snapshot: Snapshot) -> None:
    """Write the file of an iteration."""
    solution = snapshot.solution
    arrays = _number_fields("field", solution.fields)
    arrays["metric"] = snapshot.metric
    if solution.metric is not None:
        arrays["given"] = solution.metric
    notes = {
        "fields": list(solution.fields),
        "is_bare": solution.is_bare,
        "metric_was_given": solution.metric is not None,
        "errors": dict(solution.errors),
    }
    replace_files({path: _encode(snapshot.mesh, arrays, notes)})


def read_snapshot(path: Path, domain: Domain | None) -> Snapshot:
    """Read the file of an iteration; its mesh gets this domain."""
    mesh, arrays, notes = _decode(path, domain)
    with name_damage(path):
        fields = _take_fields(arrays, "field", notes.names("fields"), mesh)
        is_bare = notes.flag("is_bare")
        if is_bare and list(fields) != [UNNAMED]:
            raise FormatError(f"the fields {list(fields)} are not one without a name")
        given = _take_metric(arrays, "given", mesh) if notes.flag("metric_was_given") else None
        errors = FrozenMapping(notes.reals("errors"))
        metric = _take_metric(arrays, "metric", mesh)
        _refuse_left_over(arrays)
        return Snapshot(mesh, Solution(fields, given, errors, is_bare), metric)


def write_interval(path: Path, interval: Interval) -> None:
    """Write the file of an interval."""
    mappings: dict[str, Fields] = {name: getattr(interval, name) for name in INTERVAL_FIELDS}
    arrays = {"times": interval.times}
    for name, fields in mappings.items():
        arrays |= _number_fields(name, fields)
    notes = {
        "start": interval.start,
        "end": interval.end,
        "is_bare": interval.is_bare,
        "seconds": asdict(interval.seconds),
        **{name: list(fields) for name, fields in mappings.items()},
    }
    replace_files({path: _encode(interval.mesh, arrays, notes)})


def read_interval(path: Path, domain: Domain | None) -> Interval:
    """Read the file of an interval; its mesh gets this domain."""
    mesh, arrays, notes = _decode(path, domain)
    with name_damage(path):
        mappings = {
            name: _take_fields(arrays, name, notes.names(name), mesh) for name in INTERVAL_FIELDS
        }
        times = _take(arrays, "times")
        if times.ndim != 1 or times.dtype != np.float64:
            raise FormatError(f"the times are {times.dtype} of shape {times.shape}")
        _refuse_left_over(arrays)
        start, end = notes.real("start"), notes.real("end")
        if not -np.inf < start < end < np.inf:
            raise FormatError(f"an interval from {start:g} to {end:g}")
        return Interval(
            start=start,
            end=end,
            mesh=mesh,
            times=times,
            seconds=notes.record("seconds", Seconds),
            is_bare=notes.flag("is_bare"),
            **mappings,
        )


def _number_fields(prefix: str, fields: Fields) -> dict[str, Array]:
    """Fields as arrays with a number: names of fields need not do for names of arrays."""
    return {f"{prefix}_{k}": values for k, values in enumerate(fields.values())}


def _take_fields(
    arrays: dict[str, Array], prefix: str, names: list[str], mesh: Mesh
) -> FrozenMapping[str, Array]:
    """Take fields on a mesh out, by name, or raise for one that cannot be."""
    fields = {name: _take(arrays, f"{prefix}_{k}") for k, name in enumerate(names)}
    lengths = sizes(mesh).values()
    for name, array in fields.items():
        if array.dtype.kind not in "iufc" or not array.ndim or len(array) not in lengths:
            raise FormatError(f"field {name!r} is {array.dtype} of shape {array.shape}")
        if not np.isfinite(array).all():
            raise FormatError(f"field {name!r} has values that are not finite")
    return FrozenMapping(fields)


def _take_metric(arrays: dict[str, Array], name: str, mesh: Mesh) -> Floats:
    metric = _take(arrays, name)
    if metric.shape != (len(mesh.points), 3) or metric.dtype != np.float64:
        raise FormatError(f"a metric is {metric.dtype} of shape {metric.shape}")
    tensor.pack(metric, points=mesh.points)  # a check
    return metric


# A mesh with arrays and notes --------------------------------------------------------------------


class Decoded(NamedTuple):
    """What a file holds; the arrays are read-only."""

    mesh: Mesh
    arrays: dict[str, Array]
    notes: Notes


def _encode(mesh: Mesh, arrays: Mapping[str, Array], notes: Mapping[str, Any]) -> bytes:
    """The content of a file. Notes are what JSON can hold."""
    content = {name: getattr(mesh, name) for name in MESH_ARRAYS} | dict(arrays)
    notes = {"names": dict(mesh.names), "region_names": dict(mesh.region_names), **notes}
    out = io.BytesIO()
    np.savez(out, notes=np.array(json.dumps(notes)), **content)
    return out.getvalue()


def _decode(path: Path, domain: Domain | None) -> Decoded:
    """Read a file; its mesh gets this domain."""
    data = read_bytes(path)
    with name_damage(path):
        arrays = read_npz(data)
        for array in arrays.values():
            array.flags.writeable = False
        notes = Notes(read_json(str(_take(arrays, "notes"))))
        mesh = replace(_take_mesh(arrays, notes), domain=domain)
    return Decoded(mesh, arrays, notes)


def _take(arrays: dict[str, Array], name: str) -> Array:
    """Take the array of that name out."""
    if name not in arrays:
        raise FormatError(f"the array {name!r} is missing")
    return arrays.pop(name)


def _refuse_left_over(arrays: Mapping[str, Array]) -> None:
    """Raise for an array that no note names: the note that did is lost."""
    if arrays:
        raise FormatError(f"nothing in the notes says what the array {next(iter(arrays))!r} is")


def _take_mesh(arrays: dict[str, Array], notes: Notes) -> Mesh:
    points, triangles, regions, edges, tags = (
        _take_mesh_array(arrays, name) for name in MESH_ARRAYS
    )
    if len(regions) != len(triangles) or len(tags) != len(edges):
        raise FormatError("the numbers of triangles and regions, or of edges and tags, differ")
    names, region_names = notes.numbers("names"), notes.numbers("region_names")
    return mesh_of(Content(points, triangles, regions, edges, tags, names, region_names))


def _take_mesh_array(arrays: dict[str, Array], name: str) -> Array:
    values = _take(arrays, name)
    kinds, columns = "f" if name == "points" else "iu", _COLUMNS.get(name)
    shape = values.shape[:1] if columns is None else (*values.shape[:1], columns)
    if values.dtype.kind not in kinds or values.shape != shape:
        raise FormatError(f"the array {name} is {values.dtype} of shape {values.shape}")
    return values
