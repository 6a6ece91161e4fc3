"""The values of rasters: from files and arrays of xarray, checked."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from metrics.checks import as_numbers
from metrics.errors import MetricError
from metrics.types import Floats

_X_NAMES = ("x", "lon", "longitude", "easting")
_Y_NAMES = ("y", "lat", "latitude", "northing")
# Attributes in which arrays from files say what marks cells without a value.
_MARKERS = ("_FillValue", "missing_value", "nodata")
# Formats of GDAL that hold their values themselves. Others, such as VRT, name files and servers.
_DRIVERS = (
    "GTiff", "AAIGrid", "GSAG", "GSBG", "GS7BG", "netCDF", "XYZ", "USGSDEM", "DTED", "SRTMHGT",
    "BT", "GTX", "PNG", "JP2OpenJPEG", "EHdr", "ENVI",
)  # fmt: skip
_UNPACKED = 2**28  # bytes that any raster may take
_UNPACKED_PER_BYTE = 100
# Sizes above this times the extent of the raster are fill values: 1e20, 9.97e36, 1e38, 1.8e308.
_MAX_EXTENTS = 1000.0


def read_file(path: Path, band: int) -> tuple[Any, Any, Any]:
    """The values of a band, masked; the affine transform of its cells; its no-data marker."""
    _refuse_indirect(path)
    try:
        import rasterio
    except ImportError as error:
        raise MetricError(
            f"{path} cannot be read without rasterio: python -m pip install rasterio"
        ) from error
    try:
        with rasterio.open(path) as file:
            if file.driver not in _DRIVERS:
                raise MetricError(f"{path}: {file.driver}: expected one of {', '.join(_DRIVERS)}")
            _refuse_bomb(path, file.width * file.height * np.dtype(file.dtypes[0]).itemsize)
            return file.read(band, masked=True), file.transform, file.nodata
    except (rasterio.errors.RasterioError, IndexError) as error:
        raise MetricError(f"{path} cannot be read: {error}") from error


def _refuse_indirect(path: Path) -> None:
    """Raise MetricError for what is no file, such as a URL, and for lists of other files."""
    if not path.is_file():
        raise MetricError(f"{path} cannot be read: there is no such file")
    with path.open("rb") as file:
        start = file.read(256).lstrip(b"\xef\xbb\xbf \t\r\n")[:1]
    if start in (b"<", b"{"):
        raise MetricError(f"{path} cannot be read: it is text that names other files or servers")


def _refuse_bomb(path: Path, n_bytes: int) -> None:
    """Raise MetricError if a raster would take much more memory than its file has bytes."""
    bound = max(_UNPACKED, _UNPACKED_PER_BYTE * path.stat().st_size)
    if n_bytes > bound:
        raise MetricError(
            f"{path}: expected at most {bound:,} bytes of values for a file of its size, got a "
            f"raster of {n_bytes:,}; write it without compression if it is meant so"
        )


def read_data_array(data: Any) -> tuple[Any, Any, Any, list[float]]:
    """Values with y along the rows, coordinates, and the no-data markers of an xarray.DataArray."""
    dims = [str(dim) for dim in data.dims]
    x_dims = [dim for dim in dims if dim.lower() in _X_NAMES]
    y_dims = [dim for dim in dims if dim.lower() in _Y_NAMES]
    if len(dims) != 2 or len(x_dims) != 1 or len(y_dims) != 1:
        raise MetricError(
            f"the DataArray has the dimensions {tuple(dims)}: expected two, one of "
            f"{', '.join(_X_NAMES)} and one of {', '.join(_Y_NAMES)}; select or rename them"
        )
    values = np.asarray(data.values)
    if dims[0] == x_dims[0]:
        values = values.T
    attributes = getattr(data, "attrs", {})
    markers = [m for name in _MARKERS for m in _markers(attributes.get(name))]
    for dim in dims:
        if dim not in data.coords:
            raise MetricError(f"the DataArray has no coordinates along {dim!r}")
    x, y = (np.asarray(data.coords[dim[0]].values) for dim in (x_dims, y_dims))
    return values, x, y, markers


def as_sizes(values: Any, no_data: float | Sequence[float] | None) -> Floats:
    """Sizes (rows, columns), NaN where there is none."""
    raw = as_numbers(np.ma.getdata(values), "the raster")
    sizes = raw.astype(np.float64)
    if sizes.ndim != 2 or sizes.size == 0:
        raise MetricError(f"the raster must have the shape (rows, columns), not {sizes.shape}")
    for mark in _markers(no_data):
        with np.errstate(over="ignore"):  # as the array holds it: -3.4e38 is another in float32
            is_float = raw.dtype.kind == "f"
            marker = raw.dtype.type(mark) if is_float else np.float64(mark)
        sizes[raw == marker] = np.nan
    sizes[np.ma.getmaskarray(values)] = np.nan
    wrong = ~(np.isnan(sizes) | ((sizes > 0) & np.isfinite(sizes)))
    if wrong.any():
        row, column = (int(i) for i in np.unravel_index(wrong.argmax(), sizes.shape))
        raise MetricError(
            f"the raster at row {row}, column {column} is not a size: {float(sizes[row, column])}; "
            "a size is positive and finite, no_data=... names what marks cells without one"
        )
    if np.isnan(sizes).all():
        raise MetricError("no cell of the raster has data")
    return sizes


def _markers(no_data: float | Sequence[float] | None) -> list[float]:
    if no_data is None:
        return []
    try:
        return [float(mark) for mark in np.asarray(no_data, dtype=np.float64).ravel()]
    except (TypeError, ValueError):
        raise MetricError(
            f"no_data: expected a number or several numbers, got {no_data!r}"
        ) from None


def refuse_fill_values(sizes: Floats, side: float) -> None:
    """Refuse numbers so large that they cannot be meant as sizes on a raster of this extent."""
    large = sizes > _MAX_EXTENTS * side
    if large.any():
        row, column = (int(i) for i in np.unravel_index(large.argmax(), sizes.shape))
        value = float(sizes[row, column])
        raise MetricError(
            f"the raster at row {row}, column {column} is {value!r} ({int(large.sum())} cells are "
            f"like that), more than {_MAX_EXTENTS:g} times its longer side, {side:g}: a fill "
            f"value and no size; name it, no_data={value!r}, or give the largest size that is meant"
        )
