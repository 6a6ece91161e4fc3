"""A control space from files: a mesh and the sizes or metrics at its vertices.

Medit text (``.mesh`` with ``.sol``, as written by Mmg) and BAMG (``.mesh`` with ``.mtr``) are read
here; ``.vtu`` and ``.msh`` by `adaptmesh`, if it is installed too. What `adaptmesh.write` writes
with ``metric=`` is read back.
"""

from __future__ import annotations

import os
from importlib.metadata import entry_points
from pathlib import Path
from typing import Any, Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from .background import Background
from .checks import as_points, as_triangles
from .errors import AdaptmeshError, MetricError
from .text import text_of
from .types import Floats, Ints

__all__ = ["read"]

PathLike: TypeAlias = "str | os.PathLike[str]"

MESHES = "metrics.meshes"
"""Entry points by suffix: functions of a path that give points, triangles, and fields by name."""

_SOLUTIONS = (".sol", ".mtr")
_LARGEST_COUNT = 1 << 48  # far more than any file can hold


def read(
    path: PathLike, field: PathLike | None = None, outside: Literal["clamp", "error"] = "clamp"
) -> Background:
    """The control space in a file.

    Parameters
    ----------
    path : str or path-like
        ======================  ====================================================================
        ``.mesh``               Medit text in two dimensions, as from Mmg or BAMG; the values are in
                                ``name.sol`` or ``name.mtr`` beside it
        ``.sol``, ``.mtr``      the values; the mesh is ``name.mesh`` beside it
        ``.vtu``, ``.msh``      the values are point data of the mesh
        ======================  ====================================================================
    field : str or path-like, optional
        For ``.mesh`` the file with the values; for ``.vtu`` and ``.msh`` the name of the point
        data, if not given ``metric``, or the only one there is. Values are sizes h (n,), packed
        metrics (m11, m12, m22) (n, 3), or tensors (n, 2, 2) or (n, 3, 3) in rows of 4 or 9.
    outside : {"clamp", "error"}, optional
        As in `Background`.

    Returns
    -------
    Background
        Triangles that are clockwise in the file are turned around.

    Raises
    ------
    MetricError
        A file that is missing or damaged, without triangles, not in the plane z = 0, or whose
        values do not fit the mesh or are not sizes or metrics; with the name of the file.
    """
    path = Path(path)
    mesh_path, solution = path, None if field is None else Path(field)
    suffix = path.suffix.lower()
    if suffix in _SOLUTIONS:
        if field is not None:
            raise MetricError(f"{path} has the values itself: give the mesh, or leave out field")
        mesh_path, solution, suffix = path.with_suffix(".mesh"), path, ".mesh"
    if suffix == ".mesh":
        solution = solution or _beside(mesh_path)
        mesh, values, origin = _medit_mesh(mesh_path), _solution(solution), solution
    elif suffix in (".vtu", ".msh"):
        mesh, values = _by_plugin(path, None if field is None else os.fspath(field))
        origin = path
    else:
        raise MetricError(
            f"{path}: the extension must be .mesh, .sol, .mtr, .vtu or .msh, not {path.suffix!r}"
            + (
                "; for binary Medit use adaptmesh.read and adaptmesh.read_sol"
                * (suffix[-1:] == "b")
            )
        )
    if len(values) != len(mesh.points):
        raise MetricError(
            f"{origin} has {len(values)} values, the mesh {mesh_path} has {len(mesh.points)} "
            "vertices: they do not belong together"
        )
    try:
        return Background(mesh.points, _upright(mesh), values, outside)
    except MetricError as error:
        raise MetricError(f"{origin}: {error}") from error


class _Mesh(NamedTuple):
    points: Floats
    triangles: Ints


def _upright(mesh: _Mesh) -> Ints:
    """Triangles, all counter-clockwise."""
    p = mesh.points[mesh.triangles]
    u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    clockwise = u[:, 0] * v[:, 1] < u[:, 1] * v[:, 0]
    return np.where(clockwise[:, None], mesh.triangles[:, ::-1], mesh.triangles)


def _checked(path: Path, points: Any, triangles: Any) -> _Mesh:
    array = np.asarray(points, np.float64)
    if array.ndim == 2 and array.shape[1] == 3:
        if array[:, 2].any():
            i = int(array[:, 2].astype(bool).argmax())
            raise MetricError(f"{path}: vertex {i} is not in the plane z = 0: {array[i].tolist()}")
        array = array[:, :2]
    try:
        checked = as_points(array)
        return _Mesh(checked, as_triangles(triangles, len(checked)))
    except MetricError as error:
        raise MetricError(f"{path}: {error}") from error


# -------------------------------------------------------------------------------- Medit and BAMG


def _beside(mesh_path: Path) -> Path:
    for suffix in _SOLUTIONS:
        if (solution := mesh_path.with_suffix(suffix)).exists():
            return solution
    raise MetricError(
        f"there is neither {mesh_path.with_suffix('.sol').name} nor "
        f"{mesh_path.with_suffix('.mtr').name} beside {mesh_path}: name the file with field=..."
    )


class _Words:
    """The words of a text file, taken one after the other; comments from # to the end of line."""

    def __init__(self, path: Path) -> None:
        try:
            if path.exists() and not path.is_file():
                raise MetricError(f"{path} cannot be read: it is no regular file")
            text = text_of(path.read_bytes())
        except MetricError:
            raise
        except (OSError, ValueError) as error:
            raise MetricError(f"{path} cannot be read: {error}") from None
        lines = (line.split("#", 1)[0] for line in text.splitlines())
        self.words = " ".join(lines).split()
        self.path, self.place = path, 0

    def keyword(self) -> str:
        """The next word; "End" where there is none."""
        if self.place == len(self.words):
            return "End"
        word = self.words[self.place]
        if not word[0].isalpha():
            raise MetricError(
                f"{self.path}: a keyword was expected, not {word[:24]!r}: a count may be wrong"
            )
        self.place += 1
        return word

    def skip(self) -> None:
        """Pass over the numbers of a keyword that does not matter."""
        while self.place < len(self.words) and not self.words[self.place][0].isalpha():
            self.place += 1

    def numbers(self, count: int, what: str) -> Floats:
        words = self.words[self.place : self.place + count]
        self.place += count
        if len(words) < count:
            raise MetricError(
                f"{self.path} ends within {what}: {count} numbers are wanted, {len(words)} left"
            )
        try:
            return np.array(words, np.float64)
        except ValueError as error:
            raise MetricError(f"{self.path}: {what}: {error}") from None

    def integer(self, what: str) -> int:
        value = float(self.numbers(1, what)[0])
        if value != np.floor(value) or not 0 <= value <= _LARGEST_COUNT:
            raise MetricError(f"{self.path}: {what} must be a whole number, not {value:g}")
        return int(value)

    def rows(self, columns: int, what: str) -> Floats:
        """A count and that many rows."""
        count = self.integer(f"the number of {what}")
        return self.numbers(count * columns, what).reshape(count, columns)

    def dimension(self) -> int:
        dim = self.integer("Dimension")
        if dim not in (2, 3):
            raise MetricError(f"{self.path}: the dimension is 2 or 3, not {dim}")
        return dim


def _medit_mesh(path: Path) -> _Mesh:
    words, dim = _Words(path), 2
    points = triangles = None
    while (keyword := words.keyword()) != "End":
        if keyword == "Dimension":
            dim = words.dimension()
        elif keyword == "Vertices":
            points = words.rows(dim + 1, "Vertices")[:, :dim]  # and a reference
        elif keyword == "Triangles":
            triangles = _vertices(words.rows(4, "Triangles")[:, :3], path)
        else:
            words.skip()
    if points is None or triangles is None:
        raise MetricError(f"{path} has no {'Vertices' if points is None else 'Triangles'}")
    return _checked(path, points, triangles)


def _vertices(numbers: Floats, path: Path) -> NDArray[np.int64]:
    """Numbers from 1 as numbers from 0."""
    wrong = ~((np.abs(numbers) <= _LARGEST_COUNT) & (numbers == np.rint(numbers))).all(axis=1)
    if wrong.any():
        i = int(wrong.argmax())
        raise MetricError(f"{path}: triangle {i} has the vertices {numbers[i].tolist()}")
    return numbers.astype(np.int64) - 1


def _solution(path: Path) -> Floats:
    """Sizes (n,) or packed metrics (n, 3)."""
    if path.suffix.lower() not in _SOLUTIONS:
        raise MetricError(f"{path}: values at the vertices of .mesh are in .sol or .mtr")
    return _bamg_metric(path) if path.suffix.lower() == ".mtr" else _medit_solution(path)


def _bamg_metric(path: Path) -> Floats:
    """How many, 1 or 3, and the values: h, or m11 m12 m22."""
    words = _Words(path)
    count, columns = words.integer("the number of values"), words.integer("the number of columns")
    if columns not in (1, 3):
        raise MetricError(f"{path}: rows of 1 size or 3 metric entries are wanted, not {columns}")
    values = words.numbers(count * columns, "the values").reshape(count, columns)
    if words.place < len(words.words):
        raise MetricError(f"{path} has more than {count} rows of {columns} values")
    return values[:, 0] if columns == 1 else values


def _medit_solution(path: Path) -> Floats:
    """The count, how many fields, their types (1 scalar, 2 vector, 3 tensor), and the rows."""
    words, dim = _Words(path), 2
    while (keyword := words.keyword()) != "SolAtVertices":
        if keyword == "Dimension":
            dim = words.dimension()
        elif keyword == "End":
            raise MetricError(f"{path} has no SolAtVertices: there are no values to read")
        else:
            words.skip()
    count = words.integer("the number of values")
    types = words.numbers(words.integer("the number of fields"), "the types").tolist()
    if types == [1]:
        values = words.numbers(count, "SolAtVertices")
        words.keyword()
        return values
    if types != [3]:
        listed = ", ".join(f"{t:g}" for t in types)
        raise MetricError(
            f"{path} has fields of the types {listed}: one is wanted, of type 1 (sizes) or 3 "
            "(metrics)"
        )
    columns = 3 if dim == 2 else 6
    # In space the order is m11 m12 m22 m13 m23 m33.
    values = words.numbers(count * columns, "SolAtVertices").reshape(count, columns)[:, :3]
    words.keyword()
    return values


# ---------------------------------------------------------------------------------- by adaptmesh


def _by_plugin(path: Path, field: str | None) -> tuple[_Mesh, Floats]:
    """The mesh and values that the reader of the suffix finds, see `MESHES`."""
    reader = next(
        (r for r in entry_points(group=MESHES) if r.name == path.suffix.lower()[1:]), None
    )
    if reader is None:
        raise MetricError(f"{path}: {path.suffix} is read by way of adaptmesh, which is not there")
    try:
        points, triangles, fields = reader.load()(path)
    except AdaptmeshError as error:
        raise MetricError(str(error)) from None
    values = np.asarray(fields[_field_name(path, fields, field)])
    if values.ndim == 2 and values.shape[1] in (4, 9):
        values = values.reshape(len(values), *(2 * [int(values.shape[1] ** 0.5)]))
    if values.shape[1:] == (3, 3):
        values = values[:, :2, :2]
    return _checked(path, points, triangles), values


def _field_name(path: Path, point_data: dict[str, Any], field: str | None) -> str:
    names = list(point_data)
    if field is None and "metric" in names:
        return "metric"
    if field is None and len(names) == 1:
        return names[0]
    if field in names:
        return str(field)
    listed = ", ".join(map(repr, sorted(names))) or "none"
    if field is None:
        raise MetricError(f"{path}: choose one of its point data with field=...: {listed}")
    raise MetricError(f"{path} has no point data {field!r}; it has {listed}")
