"""meshio, <https://github.com/nschloe/meshio>, in a process of its own, see `meshio_program`.

It believes every count, and some damaged files keep it busy for ever: so it may take so much
processor time and memory, and opens no other file.
"""

from __future__ import annotations

import io
import json
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from adaptmesh.errors import FormatError
from adaptmesh.files.own_process import ask_program
from adaptmesh.mesh.meshio_parts import Parts
from adaptmesh.types import Array

SECONDS, SECONDS_PER_MEGABYTE = 10, 10
"""Of processor time that a file may take."""
MEMORY, MEMORY_TIMES = 1 << 30, 200
"""Bytes that it may take, and times its size: meshio has lists of numbers, of 32 bytes each."""


def read(data: bytes, kind: str, name: str) -> Parts:
    """What meshio finds in a file of that content and name, in its format of that kind."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / name
        file.write_bytes(data)
        said = _run("read", kind, file, len(data))
        try:
            found = (Path(folder) / "arrays.npz").read_bytes()
            return _unpacked(found, said)
        except (OSError, ValueError, KeyError) as error:
            raise FormatError(f"meshio has read nothing that can be used: {error}") from None


def write(parts: Parts, kind: str, name: str) -> bytes:
    """The content of a file of that name that meshio writes."""
    arrays = _packed(parts)
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "arrays.npz").write_bytes(arrays)
        file = Path(folder) / name
        _run("write", kind, file, len(arrays))
        try:
            return file.read_bytes()
        except OSError as error:
            raise FormatError(f"meshio has written nothing: {error}") from None


def _run(task: str, kind: str, file: Path, size: int) -> str:
    """Let the program work; what meshio has said."""
    seconds = SECONDS + SECONDS_PER_MEGABYTE * (size >> 20)
    memory = max(MEMORY, MEMORY_TIMES * size)
    answer = ask_program(
        Path(__file__).with_name("meshio_program.py"),
        [task, kind, file.name, seconds, memory],
        file.parent,
        4 * seconds,
        who="meshio",
        late="done it",
        no_answer=f"the file is damaged, or would take more than {seconds} s or {memory >> 20} MiB",
        environment=dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"), "1"),
    )
    if answer["error"]:
        raise FormatError(
            f"meshio, which reads and writes {kind}, refuses it: {answer['error']}".replace(
                str(file.parent), ""
            )
        )
    return " ".join(str(answer["said"]).split())


def _unpacked(data: bytes, said: str) -> Parts:
    with np.load(io.BytesIO(data), allow_pickle=False) as given:
        meta = json.loads(str(given["meta"]))
        blocks = range(len(meta["kinds"]))

        def parts(what: str) -> dict[str, list[Array | None]]:
            return {
                name: [given.get(f"{what} {j} {i}") for i in blocks]
                for j, name in enumerate(meta[what])
            }

        return Parts(
            given["points"],
            [(kind, given[f"cells {i}"]) for i, kind in enumerate(meta["kinds"])],
            {
                name: given[f"point_data {j}"]
                for j, name in enumerate(meta["point_data"])
                if f"point_data {j}" in given
            },
            parts("cell_data"),
            parts("cell_sets"),
            {name: np.array(values) for name, values in meta["field_data"].items()},
            {int(number): names for number, names in meta["families"].items()},
            meta["point_sets"],
            said,
        )


def _packed(parts: Parts) -> bytes:
    arrays = {"points": parts.points}
    meta = {
        "kinds": [kind for kind, _ in parts.cells],
        "point_data": list(parts.point_data),
        "cell_data": list(parts.cell_data),
        "cell_sets": list(parts.cell_sets),
        "field_data": {name: np.ravel(v).tolist() for name, v in parts.field_data.items()},
        "families": parts.families,
    }
    for i, (_, cells) in enumerate(parts.cells):
        arrays[f"cells {i}"] = cells
    for j, values in enumerate(parts.point_data.values()):
        arrays[f"point_data {j}"] = values
    of_cells: Mapping[str, Mapping[str, Sequence[Array | None]]]
    of_cells = {"cell_data": parts.cell_data, "cell_sets": parts.cell_sets}
    for what, of in of_cells.items():
        for j, blocks in enumerate(of.values()):
            for i, block in enumerate(blocks):
                if block is not None:
                    arrays[f"{what} {j} {i}"] = block
    buffer = io.BytesIO()
    np.savez(buffer, meta=np.array(json.dumps(meta)), **arrays)  # type: ignore[arg-type]
    return buffer.getvalue()
