"""A program of its own that reads or writes one file with meshio.

It is started by `adaptmesh.io.meshes.meshio_process`, so that endless loops, memory and `sys.exit`
of meshio, and crashes of the libraries that it uses, stay outside of the caller. It imports nothing
of adaptmesh. Started in a folder of its own with ::

    read|write   name of the format   name of the file   seconds of processor time   bytes of memory

it reads the file into ``arrays.npz``, or writes ``arrays.npz`` to the file; in ``arrays.npz``,
"meta" is a JSON text of all that is no array. It prints, as JSON, an error or null, and what meshio
has said. Files outside of the folder can't be opened, whatever the file names.
"""

from __future__ import annotations

import contextlib
import io
import json
import os
import sys
import warnings
from pathlib import Path
from typing import Any

import numpy as np

ARRAYS = "arrays.npz"
_LIBRARIES = {"med": "h5py", "h5m": "h5py", "hmf": "h5py", "exodus": "netCDF4"}


def main(task: str, kind: str, file: str, seconds: str, memory: str) -> None:
    """Read or write the file, and print what came of it."""
    said = io.StringIO()
    error = None
    with contextlib.redirect_stderr(said), contextlib.redirect_stdout(said):
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                _work(task, kind, file, int(seconds), int(memory))
        except ModuleNotFoundError as missing:
            error = f"needs {missing.name}: pip install {missing.name}"
        except BaseException as fault:  # sys.exit, too
            error = f"{type(fault).__name__}: {fault}"[:500]
    print(json.dumps({"error": error, "said": said.getvalue()[:1000]}))


def _work(task: str, kind: str, file: str, seconds: int, memory: int) -> None:
    import meshio
    from meshio._helpers import _writer_map, reader_map

    __import__(_LIBRARIES.get(kind, "meshio"))
    _limit(seconds, memory)
    with contextlib.suppress(TypeError, ValueError):  # older numpy has no other way to print
        np.set_printoptions(legacy="1.25")  # writers of meshio take repr(x) for the digits of x
    sys.addaudithook(_only_here(str(Path.cwd())))
    if task == "read":
        _pack(reader_map[kind](file))
        return
    _writer_map[kind](file, _unpacked(meshio, kind))


def _limit(seconds: int, memory: int) -> None:
    """Bound time and memory, where the system can: memory on Linux only."""
    try:
        import resource
    except ImportError:  # Windows
        return
    bounds = {resource.RLIMIT_CPU: seconds, resource.RLIMIT_CORE: 0}
    in_use = Path("/proc/self/statm")
    if in_use.exists():
        used = int(in_use.read_text().split()[0]) * resource.getpagesize()
        bounds |= {resource.RLIMIT_AS: used + memory, resource.RLIMIT_FSIZE: memory}
    for what, bound in bounds.items():
        hard = resource.getrlimit(what)[1]
        bound = bound if hard == resource.RLIM_INFINITY else min(bound, hard)
        resource.setrlimit(what, (bound, hard))


def _only_here(folder: str) -> Any:
    """An audit hook that refuses other files than modules and those of the folder."""
    inside = os.path.join(os.path.realpath(folder), "")  # noqa: PTH118
    modules = (".py", ".pyc", ".so", ".pyd")

    def hook(event: str, arguments: tuple[Any, ...]) -> None:
        if event != "open" or not isinstance(arguments[0], (str, bytes)):
            return
        path = os.path.realpath(os.fsdecode(arguments[0]))
        if not path.startswith(inside) and not path.endswith(modules):
            raise PermissionError("names another file, which is not opened: put it into this one")

    return hook


# ----------------------------------------------------------------------------------------- arrays


def _pack(mesh: Any) -> None:
    """Write all of a mesh that has a meaning for a plane mesh of triangles."""
    blocks = range(len(mesh.cells))
    arrays = {"points": np.asarray(mesh.points)}
    meta: dict[str, Any] = {
        "kinds": [block.type for block in mesh.cells],
        "point_data": list(mesh.point_data),
        "cell_data": list(mesh.cell_data),
        "cell_sets": list(mesh.cell_sets),
        "point_sets": [str(name) for name in mesh.point_sets],
        "field_data": {str(k): np.ravel(v).tolist() for k, v in mesh.field_data.items()},
        "families": {str(k): list(v) for k, v in getattr(mesh, "cell_tags", {}).items()},
    }
    for i, block in enumerate(mesh.cells):
        arrays[f"cells {i}"] = np.asarray(block.data)
    for j, values in enumerate(mesh.point_data.values()):
        arrays[f"point_data {j}"] = np.asarray(values)
    for what, of in (("cell_data", mesh.cell_data), ("cell_sets", mesh.cell_sets)):
        for j, parts in enumerate(of.values()):
            for i in blocks:
                part = parts[i] if i < len(parts) else None
                if part is not None:
                    arrays[f"{what} {j} {i}"] = np.asarray(part)
    arrays = {key: a for key, a in arrays.items() if a.dtype.kind in "fiub"}
    np.savez(ARRAYS, meta=np.array(json.dumps(meta)), **arrays)  # type: ignore[arg-type]


def _unpacked(meshio: Any, kind: str) -> Any:
    class Block(meshio.CellBlock):  # type: ignore[misc]
        """Cells that are a pair of kind and numbers, too: some writers still take them for one."""

        def __iter__(self) -> Any:
            return iter((self.type, self.data))

        def __getitem__(self, i: int) -> Any:
            return (self.type, self.data)[i]

    with np.load(ARRAYS, allow_pickle=False) as given:
        meta = json.loads(str(given["meta"]))
        blocks = range(len(meta["kinds"]))

        def parts(what: str) -> dict[str, Any]:
            return {
                name: [given[f"{what} {j} {i}"] for i in blocks]
                for j, name in enumerate(meta[what])
            }

        mesh = meshio.Mesh(
            given["points"],
            [Block(of, given[f"cells {i}"]) for i, of in enumerate(meta["kinds"])],
            point_data={
                name: given[f"point_data {j}"] for j, name in enumerate(meta["point_data"])
            },
            cell_data=parts("cell_data"),
            cell_sets=parts("cell_sets"),
            field_data={name: np.array(v) for name, v in meta["field_data"].items()},
        )
    mesh.cells = [Block(block.type, block.data) for block in mesh.cells]
    if meta["families"]:
        mesh.cell_tags = {int(k): v for k, v in meta["families"].items()}
    if kind == "ugrid":  # which takes the numbers of its one block for those of all
        mesh.cell_data = {name: np.concatenate(v) for name, v in mesh.cell_data.items()}
    return mesh


if __name__ == "__main__":
    main(*sys.argv[1:])
