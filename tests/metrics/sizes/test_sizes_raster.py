"""Rasters: which way up they are, what is between cells and beyond them, and cells without data."""

import sys
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy.interpolate import RegularGridInterpolator

from metrics import MetricError, Raster, tensor

#: Rows from the top, as on paper.
TABLE = np.array([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]])
BOUNDS = (10, 0, 13, 2)


def sizes(field, points):
    return tensor.sizes(field(points))[:, 0]


def test_row_0_is_where_it_is_said_to_be():
    corners = [[10.5, 1.5], [12.5, 1.5], [10.5, 0.5], [12.5, 0.5]]
    upper = Raster(TABLE, bounds=BOUNDS, origin="upper")
    lower = Raster(TABLE[::-1], bounds=BOUNDS, origin="lower")
    falling = Raster(TABLE, x=[10.5, 11.5, 12.5], y=[1.5, 0.5])
    rising = Raster(TABLE[::-1], x=[10.5, 11.5, 12.5], y=[0.5, 1.5])
    mirrored = Raster(TABLE[:, ::-1], x=[12.5, 11.5, 10.5], y=[1.5, 0.5])
    for field in (upper, lower, falling, rising, mirrored):
        np.testing.assert_allclose(sizes(field, corners), [1, 3, 4, 6])


def test_linear_and_nearest():
    points = [[11.0, 1.5], [11.5, 1.0], [11.4, 0.9], [10.0, 2.0], [12.9, 0.1]]
    linear = Raster(TABLE, bounds=BOUNDS, origin="upper")
    np.testing.assert_allclose(sizes(linear, points), [1.5, 3.5, 3.7, 1, 6])
    nearest = Raster(TABLE, bounds=BOUNDS, origin="upper", interpolation="nearest")
    np.testing.assert_allclose(sizes(nearest, points[2:]), [5, 1, 6])


@given(
    hnp.arrays(float, st.tuples(st.integers(2, 6), st.integers(2, 6)), elements=st.floats(0.1, 9)),
    st.integers(0, 2**32 - 1),
)
@settings(max_examples=40, deadline=None)
def test_bilinear_as_by_scipy(values, seed):
    rng = np.random.default_rng(seed)
    rows, columns = values.shape
    y, x = np.cumsum(rng.uniform(0.1, 2, rows)), np.cumsum(rng.uniform(0.1, 2, columns))
    points = rng.uniform([x[0], y[0]], [x[-1], y[-1]], (50, 2))
    wanted = RegularGridInterpolator((y, x), values)(points[:, ::-1])
    np.testing.assert_allclose(sizes(Raster(values, x=x, y=y), points), wanted, rtol=1e-9)


def test_outside():
    field = Raster(TABLE, bounds=BOUNDS, origin="upper")
    np.testing.assert_allclose(sizes(field, [[-5.0, 9.0], [99.0, 0.5]]), [1, 6])
    strict = Raster(TABLE, bounds=BOUNDS, origin="upper", outside="error")
    np.testing.assert_allclose(sizes(strict, [[10.0, 0.0], [13 + 1e-12, 2.0]]), [4, 3])
    with pytest.raises(MetricError, match=r"point 1 \(13.1, 1.0\) is outside .*\[10, 13\] x \[0,"):
        strict([[11.0, 1.0], [13.1, 1.0]])


def test_no_data():
    table = TABLE.copy()
    table[0, 0] = -9999
    here = [[10.6, 1.5]]
    field = Raster(table, bounds=BOUNDS, origin="upper", no_data=-9999)
    with pytest.raises(MetricError, match=r'no data at point 0 \(10.6, 1.5\).*fill="nearest"'):
        field(here)
    np.testing.assert_allclose(sizes(field, [[11.5, 1.5], [10.5, 0.5]]), [2, 4])  # not needed there
    nearest = Raster(table, bounds=BOUNDS, origin="upper", no_data=-9999, fill="nearest")
    assert sizes(nearest, here)[0] in (pytest.approx(2), pytest.approx(4 * 0.9 + 0.2))
    number = Raster(table, bounds=BOUNDS, origin="upper", no_data=-9999, fill=0.5)
    np.testing.assert_allclose(sizes(number, here), 0.9 * 0.5 + 0.1 * 2)


def test_nan_masked_and_single_precision_are_no_data_too():
    marker = -3.4028234663852886e38
    for table, options in (
        (np.where(TABLE == 1, np.nan, TABLE), {}),
        (np.ma.masked_equal(TABLE, 1), {}),
        (np.where(TABLE == 1, marker, TABLE).astype(np.float32), {"no_data": marker}),
        (np.where(TABLE == 1, 255, TABLE).astype(np.uint8), {"no_data": 255.0}),
        (TABLE.astype(np.uint8), {"no_data": 1}),
    ):
        field = Raster(table, bounds=BOUNDS, origin="upper", fill=7, **options)
        np.testing.assert_allclose(sizes(field, [[10.5, 1.5], [11.5, 1.5]]), [7, 2])


def test_one_row_one_column_one_cell():
    np.testing.assert_allclose(
        sizes(Raster([[1.0, 3.0]], bounds=(0, 0, 2, 1), origin="upper"), [[1, 0.2]]), 2
    )
    np.testing.assert_allclose(
        sizes(Raster([[1.0], [3.0]], bounds=(0, 0, 1, 2), origin="lower"), [[0.3, 1]]), 2
    )
    np.testing.assert_allclose(
        sizes(Raster([[5]], bounds=(0, 0, 1, 1), origin="lower"), [[9, 9]]), 5
    )


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"origin": None}, 'give origin="upper" if row 0'),
        ({"origin": "top"}, "origin must be one of 'upper', 'lower', not 'top'"),
        ({"bounds": None, "origin": None}, r"bounds=\(x0, y0, x1, y1\), or x and y"),
        ({"bounds": (0, 1, 2)}, "bounds must be"),
        ({"bounds": (0, 5, 1, 2)}, "y0 < y1"),
        ({"bounds": (0, 2, 1, np.nan)}, "bounds must be finite"),
        ({"x": [1, 2, 3], "y": [1, 2]}, "not both"),
        ({"bounds": None, "x": [1, 2, 3], "y": [1, 2]}, "origin goes with bounds"),
        ({"bounds": None, "origin": None, "x": [1, 2], "y": [1, 2]}, r"x must have the shape \(3,"),
        (
            {"bounds": None, "origin": None, "x": [1, 3, 2], "y": [1, 2]},
            r"x\[2\] = 2.0 follows 3.0",
        ),
        ({"interpolation": "cubic"}, "interpolation must be"),
        ({"outside": "nan"}, "outside must be"),
        ({"fill": "zero"}, "fill must be"),
        ({"fill": -1}, "fill must be positive"),
        ({"values": TABLE - 2}, "row 0, column 0 is not a size: -1.0; .*no_data"),
        ({"values": np.where(TABLE == 6, np.inf, TABLE)}, "row 1, column 2 is not a size: inf"),
        ({"values": np.full((2, 2), np.nan)}, "no cell of the raster has data"),
        ({"values": np.ones(3)}, r"\(rows, columns\), not \(3,\)"),
        ({"values": [["a"]]}, "real numbers"),
    ],
)
def test_refused(arguments, message):
    good = {"values": TABLE, "bounds": BOUNDS, "origin": "upper"}
    with pytest.raises(MetricError, match=message):
        Raster(**(good | arguments))


# --- xarray and rasterio, by what they look like ------------------------------------------------


def data_array(values, dims, **coords):
    coordinates = {name: SimpleNamespace(values=np.asarray(c)) for name, c in coords.items()}
    return SimpleNamespace(values=values, dims=dims, coords=coordinates, attrs={"_FillValue": 5})


def test_a_data_array_brings_its_coordinates_in_either_order():
    x, y = [10.5, 11.5, 12.5], [1.5, 0.5]
    for data in (
        data_array(TABLE, ("y", "x"), x=x, y=y),
        data_array(TABLE.T, ("lon", "lat"), lon=x, lat=y),
    ):
        field = Raster(data, fill=50)
        np.testing.assert_allclose(sizes(field, [[10.5, 1.5], [11.5, 0.5]]), [1, 50])
    with pytest.raises(MetricError, match=r"dimensions \('band', 'x'\).*longitude"):
        Raster(data_array(TABLE, ("band", "x"), x=x))
    with pytest.raises(MetricError, match="neither bounds"):
        Raster(data, bounds=BOUNDS)


def test_without_rasterio(monkeypatch, tmp_path):
    (tmp_path / "size.tif").write_bytes(b"II")
    monkeypatch.setitem(sys.modules, "rasterio", None)
    with pytest.raises(
        MetricError, match=r"size.tif cannot be read without rasterio: .*pip install"
    ):
        Raster.read(tmp_path / "size.tif")


class FakeFile:
    """What rasterio.open gives: row 0 at the top if e < 0."""

    nodata, driver, dtypes = 5.0, "GTiff", ("float64",)
    height, width = np.shape(TABLE)

    def __init__(self, a, b, c, d, e, f, table=TABLE):
        self.transform = SimpleNamespace(a=a, b=b, c=c, d=d, e=e, f=f)
        self.table = table

    def __enter__(self):
        return self

    def __exit__(self, *_):
        pass

    def read(self, band, masked=False):
        if band != 1:
            raise IndexError(f"band index {band} out of range")
        return self.table


@pytest.mark.parametrize(
    "file",
    [
        FakeFile(1, 0, 10, 0, -1, 2),
        FakeFile(1, 0, 10, 0, 1, 0, TABLE[::-1]),
        FakeFile(-1, 0, 13, 0, -1, 2, TABLE[:, ::-1]),
    ],
)
def test_read_any_way_up(monkeypatch, file, tmp_path):
    path = tmp_path / "size.tif"
    path.write_bytes(b"II")
    errors = SimpleNamespace(RasterioError=OSError)
    monkeypatch.setitem(
        sys.modules, "rasterio", SimpleNamespace(open=lambda _: file, errors=errors)
    )
    field = Raster.read(path, fill=50)
    points = [[10.5, 1.5], [12.5, 1.5], [10.5, 0.5], [11.5, 0.5]]
    np.testing.assert_allclose(sizes(field, points), [1, 3, 4, 50])
    with pytest.raises(MetricError, match="band index 2"):
        Raster.read(path, 2)
    file.transform.b = 0.1
    with pytest.raises(MetricError, match="rotated"):
        Raster.read(path)


def test_read_a_geotiff(tmp_path):
    rasterio = pytest.importorskip("rasterio")
    for name, transform, table in (
        ("up.tif", rasterio.Affine(1, 0, 10, 0, -1, 2), TABLE),
        ("row.tif", rasterio.Affine(1, 0, 10, 0, -2, 2), TABLE[:1]),
    ):
        options = {"driver": "GTiff", "count": 1, "dtype": "float32", "nodata": -1}
        rows, columns = table.shape
        path = tmp_path / name
        with rasterio.open(
            path, "w", height=rows, width=columns, transform=transform, **options
        ) as file:
            file.write(table.astype(np.float32), 1)
        field = Raster.read(path)
        np.testing.assert_allclose(sizes(field, [[10.5, 1.5], [12.5, 1.5]]), [1, 3])
    with pytest.raises(MetricError, match=r"none.tif cannot be read"):
        Raster.read(tmp_path / "none.tif")


def test_a_raster_reads_no_other_file_and_no_bomb(tmp_path):
    rasterio = pytest.importorskip("rasterio")
    options = {"driver": "GTiff", "count": 1, "dtype": "float32"}
    options["transform"] = rasterio.Affine(1, 0, 10, 0, -1, 2)
    secret, bomb = tmp_path / "other" / "secret.tif", tmp_path / "bomb.tif"
    secret.parent.mkdir()
    with rasterio.open(secret, "w", height=2, width=2, **options) as file:
        file.write(np.ones((2, 2), np.float32), 1)
    source = f"<SimpleSource><SourceFilename>{secret}</SourceFilename></SimpleSource>"
    band = f'<VRTRasterBand dataType="Float32" band="1">{source}</VRTRasterBand>'
    (tmp_path / "a.vrt").write_text(
        f'<VRTDataset rasterXSize="2" rasterYSize="2">{band}</VRTDataset>'
    )
    (tmp_path / "a.tif").write_text((tmp_path / "a.vrt").read_text())
    for name in ("a.vrt", "a.tif", f"/vsizip/{tmp_path}/a.zip", "https://localhost/a.tif"):
        with pytest.raises(MetricError, match="cannot be read"):
            Raster.read(tmp_path / name)
    sparse = {"sparse_ok": True, "tiled": True, "compress": "deflate"}
    with rasterio.open(bomb, "w", height=100_000, width=100_000, **options, **sparse):
        pass
    assert bomb.stat().st_size < 10_000_000
    with pytest.raises(MetricError, match=r"expected at most .* bytes of values"):
        Raster.read(bomb)


FILLS = [1e20, 1e38, 9.969209968386869e36, 3.4028235e38, 1.7976931348623157e308, 2.0e9]


@pytest.mark.parametrize("value", FILLS)
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e4])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_fill_values_are_no_sizes(value, scale, dtype):
    """What numpy, netCDF and GDAL write where there is nothing, in rasters of any extent."""
    if value > float(np.finfo(dtype).max):
        pytest.skip("no number of this type")
    table = (np.array(TABLE, dtype=float) * scale).astype(dtype)
    table[1, 2] = value
    bounds = tuple(scale * v for v in BOUNDS)
    with pytest.raises(MetricError, match=r"row 1, column 2 is .*: a fill value.*no_data="):
        Raster(table, bounds=bounds, origin="upper", fill="nearest")
    field = Raster(table, bounds=bounds, origin="upper", no_data=value, fill="nearest")
    assert field.sizes.max() <= np.max(TABLE) * scale * (1 + 1e-6)
    both = Raster(table, bounds=bounds, origin="upper", no_data=[-1.0, value], fill=0.5 * scale)
    assert np.count_nonzero(both.sizes == 0.5 * scale) >= 1
    masked = np.ma.masked_values(table, value)
    assert Raster(masked, bounds=bounds, origin="upper", fill="nearest").sizes.max() < value


def test_a_masked_array_that_was_filled_is_refused():
    masked = np.ma.array(TABLE, dtype=float, mask=np.eye(len(TABLE), len(TABLE[0])))
    with pytest.raises(MetricError, match="a fill value and no size"):
        Raster(masked.filled(), bounds=BOUNDS, origin="upper")


def test_a_size_as_large_as_the_raster_is_one():
    Raster([[1e3]], bounds=(0, 0, 1, 1), origin="lower")
    with pytest.raises(MetricError, match="a fill value"):
        Raster([[1.1e3]], bounds=(0, 0, 1, 1), origin="lower")


@pytest.mark.parametrize("name", ["_FillValue", "missing_value", "nodata"])
def test_markers_in_attributes(name):
    table = np.array(TABLE, dtype=float)
    table[0, 0] = 777.0
    x, y = [10.5, 11.5, 12.5], [1.5, 0.5]
    data = data_array(table, ("y", "x"), x=x, y=y)
    data.attrs = {name: 777.0}
    assert Raster(data, fill=50).sizes.max() == 50


@pytest.mark.parametrize("bad", ["none", [[1], [2, 3]], {}])
def test_what_is_no_marker(bad):
    with pytest.raises(MetricError, match="no_data: expected a number"):
        Raster(TABLE, bounds=BOUNDS, origin="upper", no_data=bad)


@pytest.mark.parametrize("interpolation", ["linear", "nearest"])
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_a_raster_is_the_same_reflected_transposed_scaled_and_offset(scale, interpolation):
    rng = np.random.default_rng(7)
    values = rng.uniform(0.1, 1, (5, 7))
    x, y = np.sort(rng.uniform(0, 1, 7)), np.sort(rng.uniform(0, 1, 5))
    at = rng.uniform(-0.1, 1.1, (200, 2))
    wanted = tensor.sizes(Raster(values, x=x, y=y, interpolation=interpolation)(at))

    def same(values, x, y, at):
        k, shift = scale, 100 * scale * np.array([1, -1])
        x, y, at = k * x + shift[0], k * y + shift[1], k * at + shift
        field = Raster(k * values, x=x, y=y, interpolation=interpolation)
        np.testing.assert_allclose(tensor.sizes(field(at)) / k, wanted, rtol=1e-10)

    same(values, x, y, at)
    same(values[:, ::-1], x[::-1], y, at)
    same(values, -x, y, at * (-1, 1))
    same(values[::-1], x, -y[::-1], at * (1, -1))
    same(values.T, y, x, at[:, ::-1])
