"""Sizes from a raster: an image, a grid of numbers, a GeoTIFF."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from metrics.checks import as_numbers, number, one_of, positive
from metrics.control import ControlSpace
from metrics.errors import MetricError
from metrics.types import Floats

from .raster_input import as_sizes, read_data_array, read_file, refuse_fill_values

__all__ = ["Raster"]

# A point this far beyond the border, relative to the size of the raster, is on it by rounding.
_BORDER = 1e-9


class Raster(ControlSpace):
    """Sizes h at the centres of the cells (pixels) of a rectangular grid.

    ::

        origin="upper": row 0 is at the top          origin="lower": row 0 is at the bottom

          y1 +-------+-------+                         y1 +-------+-------+
             | [0,0] | [0,1] |                            | [1,0] | [1,1] |
             +-------+-------+                            +-------+-------+
             | [1,0] | [1,1] |                            | [0,0] | [0,1] |
          y0 +-------+-------+                         y0 +-------+-------+
            x0              x1                           x0              x1

    Parameters
    ----------
    values : (rows, columns) array_like, or xarray.DataArray
        Sizes, with y along the rows and x along the columns. A DataArray brings its coordinates;
        its dimensions are called x and y, lon and lat, longitude and latitude, or easting and
        northing, in either order.
    bounds : (x0, y0, x1, y1), optional
        The outer borders of the outer cells, left, bottom, right and top, as everywhere here.
    x, y : (columns,) and (rows,) array_like, optional
        Instead of `bounds`, the centres of the cells, rising or falling, evenly spaced or not.
        Falling y have row 0 at the top.
    origin : {"upper", "lower"}, optional
        With `bounds`, and only then, needed: whether row 0 is at the top, as in images and most
        GeoTIFFs, or at the bottom.
    no_data : float or sequence of float, optional
        The numbers that mark cells without a value. NaN and masked cells are always without; a
        DataArray brings the numbers in its attributes `_FillValue`, `missing_value` and `nodata`.
        Nothing else is guessed: what is no size is an error, and so is a number above 1000 times
        the longer side of the raster, as fill values of files and libraries are (1e20, 1e38). To
        say that a cell has no limit, give it a size as large as the raster.
    fill : {"error", "nearest"} or float, optional
        What cells without a value get: nothing, so that a point that needs one is an error; the
        value of the nearest cell that has one; or this size.
    interpolation : {"linear", "nearest"}, optional
        Bilinear in h between the centres, and constant from the outermost centres to the border;
        or the value of the cell that the point is in.
    outside : {"clamp", "error"}, optional
        For a point beyond the borders: the value at the nearest point of the border, or a
        `MetricError` that names the point.

    Raises
    ------
    MetricError
        Names the argument, or the cell (row, column) whose value is not a size.

    Examples
    --------
    >>> from metrics import Raster, tensor
    >>> field = Raster([[1.0, 2.0], [3.0, 4.0]], bounds=(0, 0, 2, 2), origin="upper")
    >>> tensor.sizes(field([[0.5, 1.5], [1.0, 1.0]]))[:, 0]
    array([1. , 2.5])
    """

    def __init__(
        self,
        values: ArrayLike | Any,
        *,
        bounds: tuple[float, float, float, float] | None = None,
        x: ArrayLike | None = None,
        y: ArrayLike | None = None,
        origin: Literal["upper", "lower"] | None = None,
        no_data: float | Sequence[float] | None = None,
        fill: Literal["error", "nearest"] | float = "error",
        interpolation: Literal["linear", "nearest"] = "linear",
        outside: Literal["clamp", "error"] = "clamp",
    ) -> None:
        self.interpolation = one_of("interpolation", interpolation, ("linear", "nearest"))
        self.outside = one_of("outside", outside, ("clamp", "error"))
        if hasattr(values, "dims") and hasattr(values, "coords"):
            if bounds is not None or x is not None or y is not None:
                raise MetricError("a DataArray has coordinates: give neither bounds nor x and y")
            values, x, y, markers = read_data_array(values)
            no_data = markers if no_data is None else no_data
        given = sizes = as_sizes(values, no_data)
        columns, rows = _centres(sizes, bounds, x, y, origin)
        if columns[0] > columns[-1]:
            columns, sizes = columns[::-1], sizes[:, ::-1]
        if rows[0] > rows[-1]:
            rows, sizes = rows[::-1], sizes[::-1]
        #: Centres, rising, and the sizes there with row 0 at the bottom; NaN where there is none.
        self.x, self.y = np.ascontiguousarray(columns), np.ascontiguousarray(rows)
        self._x_edges = _edges(self.x, None if bounds is None else bounds[::2])
        self._y_edges = _edges(self.y, None if bounds is None else bounds[1::2])
        refuse_fill_values(given, max(np.ptp(self._x_edges), np.ptp(self._y_edges)))
        self.sizes = _fill(np.ascontiguousarray(sizes), self.x, self.y, fill)

    @classmethod
    def read(cls, path: str | os.PathLike[str], band: int = 1, **options: Any) -> Raster:
        """A raster from a file that rasterio reads, such as a GeoTIFF.

        Parameters
        ----------
        path : str or path-like
        band : int, optional
            Which band has the sizes, from 1.
        **options
            `no_data` (that of the file if not given), `fill`, `interpolation`, `outside`.

        Raises
        ------
        MetricError
            If rasterio is not installed, the file cannot be read, or the raster is rotated. Of the
            formats of GDAL those are read that hold their values themselves, not in other files or
            on servers; and no raster is unpacked to more than 100 times its file and 256 MiB.
        """
        path = Path(path)
        values, affine, marker = read_file(path, band)
        if affine.b != 0 or affine.d != 0:
            raise MetricError(f"{path} is rotated or sheared: warp it to be north-up")
        rows, columns = values.shape
        options.setdefault("no_data", marker)
        x = affine.c + affine.a * (np.arange(columns) + 0.5)
        y = affine.f + affine.e * (np.arange(rows) + 0.5)
        if rows > 1 and columns > 1:
            return cls(values, x=x, y=y, **options)
        ends_x = sorted([affine.c, affine.c + affine.a * columns])
        ends_y = sorted([affine.f, affine.f + affine.e * rows])
        upright = values[:, ::-1] if affine.a < 0 else values
        origin: Literal["upper", "lower"] = "upper" if affine.e < 0 else "lower"
        return cls(
            upright, bounds=(ends_x[0], ends_y[0], ends_x[1], ends_y[1]), origin=origin, **options
        )

    def values(self, points: Floats) -> Floats:
        if self.outside == "error":
            self._refuse_outside(points)
        if self.interpolation == "nearest":
            sizes = self.sizes[
                _cell(self._y_edges, points[:, 1]), _cell(self._x_edges, points[:, 0])
            ]
        else:
            sizes = self._bilinear(points)
        missing = np.isnan(sizes)
        if missing.any():
            i = int(missing.argmax())
            px, py = points[i].tolist()
            raise MetricError(
                f"the raster has no data at point {i} ({px!r}, {py!r}): choose what is there with "
                'fill="nearest" or fill=size'
            )
        return sizes

    def _bilinear(self, points: Floats) -> Floats:
        left, right, tx = _between(self.x, points[:, 0])
        below, above, ty = _between(self.y, points[:, 1])
        total = np.zeros(len(points))
        for row, weight_y in ((below, 1 - ty), (above, ty)):
            for column, weight_x in ((left, 1 - tx), (right, tx)):
                weight = weight_x * weight_y
                # A cell of no weight is not needed, whether it has data or not.
                total += np.where(weight > 0, weight * self.sizes[row, column], 0)
        return total

    def _refuse_outside(self, points: Floats) -> None:
        edges = np.array([self._x_edges[[0, -1]], self._y_edges[[0, -1]]])
        margin = _BORDER * np.ptp(edges, axis=1).max()
        beyond = ((points < edges[:, 0] - margin) | (points > edges[:, 1] + margin)).any(axis=1)
        if beyond.any():
            i = int(beyond.argmax())
            px, py = points[i].tolist()
            (x0, x1), (y0, y1) = edges.tolist()
            raise MetricError(
                f"point {i} ({px!r}, {py!r}) is outside of the raster [{x0:g}, {x1:g}] x "
                f'[{y0:g}, {y1:g}]; outside="clamp" takes the nearest value'
            )

    def __repr__(self) -> str:
        rows, columns = self.sizes.shape
        (x0, x1), (y0, y1) = self._x_edges[[0, -1]].tolist(), self._y_edges[[0, -1]].tolist()
        return f"<Raster: {rows} x {columns} on [{x0:g}, {x1:g}] x [{y0:g}, {y1:g}]>"


def _centres(
    sizes: Floats, bounds: Any, x: Any, y: Any, origin: str | None
) -> tuple[Floats, Floats]:
    """The centres of columns and rows, in the order of the array."""
    rows, columns = sizes.shape
    if bounds is not None:
        if x is not None or y is not None:
            raise MetricError("give either bounds or x and y, not both")
        if origin is None:
            raise MetricError(
                'give origin="upper" if row 0 of the raster is at the top, as in images, or '
                'origin="lower" if it is at the bottom'
            )
        one_of("origin", origin, ("upper", "lower"))
        if len(bounds) != 4:
            raise MetricError(f"bounds must be (x0, y0, x1, y1), not {bounds!r}")
        x0, y0, x1, y1 = (number("bounds", value) for value in bounds)
        if not (x0 < x1 and y0 < y1):
            raise MetricError(f"bounds must be (x0, y0, x1, y1) with x0 < x1 and y0 < y1: {bounds}")
        across = x0 + (x1 - x0) * (np.arange(columns) + 0.5) / columns
        upwards = y0 + (y1 - y0) * (np.arange(rows) + 0.5) / rows
        return across, upwards[::-1] if origin == "upper" else upwards
    if x is None or y is None:
        raise MetricError("give the place of the raster: bounds=(x0, y0, x1, y1), or x and y")
    if origin is not None:
        raise MetricError("origin goes with bounds; with x and y, their order tells it")
    return _coordinates("x", x, columns, "columns"), _coordinates("y", y, rows, "rows")


def _coordinates(name: str, values: Any, count: int, of: str) -> Floats:
    out = as_numbers(values, name).astype(np.float64)
    if out.shape != (count,):
        raise MetricError(
            f"{name} must have the shape ({count},), one for each of the {of}, not {out.shape}"
        )
    if count < 2:
        raise MetricError(f"a single {name} has no width: give bounds instead")
    steps = np.diff(out)
    if not np.isfinite(out).all() or not ((steps > 0).all() or (steps < 0).all()):
        i = int(np.argmin(steps * np.sign(steps[0]) > 0)) + 1
        raise MetricError(
            f"{name} must rise or fall all along, but {name}[{i}] = {float(out[i])} "
            f"follows {float(out[i - 1])}"
        )
    return out


def _edges(centres: Floats, ends: Any) -> Floats:
    """Borders between cells: half way between centres, and as far beyond the outermost ones."""
    middle = 0.5 * (centres[:-1] + centres[1:])
    if ends is None:
        ends = 2 * centres[0] - middle[0], 2 * centres[-1] - middle[-1]
    return np.concatenate([[float(ends[0])], middle, [float(ends[1])]])


def _fill(sizes: Floats, x: Floats, y: Floats, fill: Any) -> Floats:
    missing = np.isnan(sizes)
    if isinstance(fill, str):
        one_of("fill", fill, ("error", "nearest"))
        if fill == "error" or not missing.any():
            return sizes
        from scipy.spatial import cKDTree

        centres = np.stack(np.meshgrid(x, y), axis=-1)
        _, nearest = cKDTree(centres[~missing]).query(centres[missing])
        values = sizes[~missing][nearest]
    else:
        values = positive("fill", fill)
    out: Floats = sizes.copy()
    out[missing] = values
    return out


def _cell(edges: Floats, where: Floats) -> NDArray[np.intp]:
    """The cells that coordinates are in; beyond the borders, the outermost."""
    return np.clip(np.searchsorted(edges, where, side="right") - 1, 0, len(edges) - 2)


def _between(centres: Floats, where: Floats) -> tuple[Any, Any, Floats]:
    """The centres before and after, and the share of the way from one to the other."""
    last = len(centres) - 1
    before = np.clip(np.searchsorted(centres, where, side="right") - 1, 0, max(last - 1, 0))
    after = np.minimum(before + 1, last)
    gap = np.where(after > before, centres[after] - centres[before], 1)
    return before, after, np.clip((where - centres[before]) / gap, 0, 1)
