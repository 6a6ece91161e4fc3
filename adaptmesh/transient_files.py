"""Histories in time in folders: a file for each interval, and one that says which there are.

folder/
  sweep_00_interval_0000.npz    mesh, fields and Hessians, bit for bit
  sweep_00_interval_0001.npz
  transient.json                the list of all; replaced last, so what it lists is whole
"""

from __future__ import annotations

import itertools
import json
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

from .errors import FormatError
from .history import Seconds
from .history_files import make
from .io.files import read_bytes, replace_files
from .stored import damage_named, decoded, encoded
from .transient_history import Fields, Interval, TransientHistory
from .value import FrozenMapping

if TYPE_CHECKING:
    from .domain import Domain

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
        content = json.loads(read_bytes(path))
        if content["version"] != VERSION:
            raise FormatError(f"{path}: version {content['version']}; this reads {VERSION}")
        counts = [int(n) for n in content["intervals"]]
        options = {str(k): str(v) for k, v in content.get("options", {}).items()}
    names = [[_name(k, number) for number in range(n)] for k, n in enumerate(counts)]
    for name in itertools.chain(*names):
        if not (folder / name).exists():
            raise FormatError(f"{path}: {name} is missing")
    sweeps = tuple(tuple(_interval(folder / name, domain) for name in sweep) for sweep in names)
    return TransientHistory(sweeps, options)


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
            name: FrozenMapping({n: arrays[f"{name}_{k}"] for k, n in enumerate(notes[name])})
            for name in MAPPINGS
        }
        return Interval(
            start=float(notes["start"]),
            end=float(notes["end"]),
            mesh=mesh,
            times=arrays["times"],
            seconds=Seconds(**notes["seconds"]),
            is_bare=bool(notes["is_bare"]),
            **mappings,
        )
