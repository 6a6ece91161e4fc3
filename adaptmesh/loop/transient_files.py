"""Histories in time in folders: a file for each interval, and one that says which there are.

folder/
  sweep_00_interval_0000.npz    mesh, fields and Hessians, bit for bit
  sweep_00_interval_0001.npz
  transient.json                the list of all; replaced last, so what it lists is whole
"""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.files.whole import replace_files
from adaptmesh.value import FrozenMapping

from .archive import check_fields, damage_named, decoded, encoded, refuse_left_over, take
from .history import Seconds
from .history_files import make, read_list
from .transient_history import Fields, Interval, TransientHistory

if TYPE_CHECKING:
    from adaptmesh.domain.domain import Domain

LIST = "transient.json"
VERSION = 1

MAPPINGS = ("first", "last", "hessians")


def save(history: TransientHistory, folder: Path) -> None:
    """Write every interval, then the list of them; an older list is removed first."""
    make(folder)
    (folder / LIST).unlink(missing_ok=True)
    for k, sweep in enumerate(history.sweeps):
        for number, interval in enumerate(sweep):
            replace_files({folder / _name(k, number): _encoded(interval)})
    _write_list(history, folder)


def append(history: TransientHistory, folder: Path) -> None:
    """Write the last interval, then the list."""
    name = _name(len(history.sweeps) - 1, len(history.intervals) - 1)
    replace_files({folder / name: _encoded(history.intervals[-1])})
    _write_list(history, folder)


def load(folder: Path, domain: Domain | None) -> TransientHistory:
    """Read the list and all that it lists."""
    path = folder / LIST
    if not path.exists():
        raise FormatError(f"{folder}: there is no history in time here ({LIST} is missing)")
    with damage_named(path):
        content = read_list(path, VERSION)
        counts = content.counts("intervals")
        if 0 in counts:
            raise FormatError(f"sweep {counts.index(0)} has no intervals")
        options = content.texts("options") if "options" in content else {}
    names = [_names(path, sweep, count) for sweep, count in enumerate(counts)]
    sweeps = tuple(tuple(_interval(folder / name, domain) for name in sweep) for sweep in names)
    return TransientHistory(sweeps, options)


def _names(path: Path, sweep: int, count: int) -> list[str]:
    """The files of a sweep, of which the first that is missing is named."""
    out: list[str] = []
    while len(out) < count:
        out.append(_name(sweep, len(out)))
        if not (path.parent / out[-1]).exists():
            raise FormatError(f"{path}: {out[-1]} is missing")
    return out


def _write_list(history: TransientHistory, folder: Path) -> None:
    content = {
        "version": VERSION,
        "options": dict(history.options),
        "intervals": [len(sweep) for sweep in history.sweeps],
    }
    replace_files({folder / LIST: json.dumps(content, indent=1).encode()})


def _name(sweep: int, number: int) -> str:
    return f"sweep_{sweep:02d}_interval_{number:04d}.npz"


def _encoded(interval: Interval) -> bytes:
    mappings: dict[str, Fields] = {name: getattr(interval, name) for name in MAPPINGS}
    arrays = {
        f"{name}_{k}": values
        for name, fields in mappings.items()
        for k, values in enumerate(fields.values())
    }
    arrays["times"] = interval.times
    notes = {
        "start": interval.start,
        "end": interval.end,
        "is_bare": interval.is_bare,
        "seconds": asdict(interval.seconds),
        **{name: list(fields) for name, fields in mappings.items()},
    }
    return encoded(interval.mesh, arrays, notes)


def _interval(path: Path, domain: Domain | None) -> Interval:
    mesh, arrays, notes = decoded(path, domain)
    with damage_named(path):
        mappings = {
            name: FrozenMapping(
                {n: take(arrays, f"{name}_{k}") for k, n in enumerate(notes.names(name))}
            )
            for name in MAPPINGS
        }
        for fields in mappings.values():
            check_fields(fields, mesh)
        times = take(arrays, "times")
        if times.ndim != 1 or times.dtype != np.float64:
            raise FormatError(f"the times are {times.dtype} of shape {times.shape}")
        refuse_left_over(arrays)
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
