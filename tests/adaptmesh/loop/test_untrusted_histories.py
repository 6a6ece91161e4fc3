"""Histories that were damaged, or made to do harm: `FormatError`, within little memory and time."""

import io
import json
import struct
import time
import zipfile

import numpy as np
import pytest
from reference.damage import little_memory, little_time

import adaptmesh as am
from adaptmesh.files.npz import read_npz

SECONDS = 5


def read_history(folder):
    history = am.History.load(folder)
    for iteration in history:
        _ = iteration.mesh, iteration.fields, iteration.metric
    str(history)
    return history


def read_history_in_time(folder):
    history = am.TransientHistory.load(folder)
    str(history)
    return history


def refused(read, folder, match=None):
    began = time.process_time()
    with little_memory(), little_time(), pytest.raises(am.FormatError, match=match) as caught:
        read(folder)
    assert folder.name in str(caught.value)
    assert caught.value.__cause__ is None, f"unforeseen: {caught.value.__cause__!r}"
    assert time.process_time() - began < SECONDS


@pytest.fixture(scope="module")
def whole():
    mesh = am.generate(am.Domain.rectangle(0, 0, 1, 1), 0.4)
    return am.adapt_loop(lambda m: m.points[:, 0] ** 2, mesh, target_vertices=30, max_iterations=1)


@pytest.fixture
def folder(whole, tmp_path):
    whole.save(tmp_path / "run")
    return tmp_path / "run"


# ------------------------------------------------------------------------------------ the archives


def archive(folder):
    return min(folder.glob("*.npz"))


def each_entry(change):
    """Change the bytes of each entry in the directory of an archive."""

    def edit(folder):
        data = bytearray(archive(folder).read_bytes())
        at = data.find(b"PK\x01\x02")
        while at >= 0:
            change(data, at)
            at = data.find(b"PK\x01\x02", at + 4)
        archive(folder).write_bytes(bytes(data))

    return edit


def set_byte(offset, value):
    return each_entry(lambda data, at: data.__setitem__(at + offset, value))


def entry(name, raw, method=zipfile.ZIP_STORED):
    """Put other bytes in the place of an array."""

    def edit(folder):
        with zipfile.ZipFile(archive(folder)) as file:
            items = {n: file.read(n) for n in file.namelist()}
        items[f"{name}.npy"] = raw
        with zipfile.ZipFile(archive(folder), "w", method) as file:
            for n, content in items.items():
                file.writestr(n, content)

    return edit


def without(name):
    def edit(folder):
        arrays = read_npz(archive(folder).read_bytes())
        del arrays[name]
        np.savez(archive(folder), **arrays)

    return edit


def npy(header, content=b""):
    head = header.encode() + b"\n"
    return b"\x93NUMPY\x01\0" + struct.pack("<H", len(head)) + head + content


def array(values, **options):
    out = io.BytesIO()
    np.save(out, np.array(values, **options))
    return out.getvalue()


def header(shape, descr="'<f8'", order="False"):
    return f"{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}"


@pytest.mark.parametrize(
    "edit",
    [
        set_byte(8, 1),  # encrypted
        set_byte(10, 97),  # an unknown compression
        set_byte(10, 12),  # bzip2, which it is not
        set_byte(6, 99),  # a version of zip there is not
        set_byte(24, 255),  # another length
        set_byte(16, 255),  # another checksum
        set_byte(42, 7),  # another place
        entry("points", npy(header("(1099511627776, 2)"))),
        entry("points", npy(header("(99999999999999999999999999, 2)"))),
        entry("points", npy(header("(" + "9, " * 300 + ")"))),
        entry("points", npy(header("(-3, 2)"), bytes(48))),
        entry("points", npy(header("(3, 2)", "'|O'"), bytes(48))),
        entry("points", npy(header("(3, 2)", "[('x', '<f8')]"), bytes(48))),
        entry("points", npy(header("(3, 2)", "__import__('os').abort()"), bytes(48))),
        entry("points", npy(header("(3, 2)", "'<f3'"), bytes(18))),
        entry("points", npy("{'descr': '<f8', 'shape': (3, 2), ")),
        entry("points", npy("(" * 60_000)),
        entry("points", npy("-" * 60_000 + "1")),
        entry("points", npy(header("(3, 2)"), bytes(47))),
        entry("points", b"\x93NUMPY\x01\0"),
        entry("points", b"\x93NUMPY\x02\0" + b"\xff" * 4),
        entry("points", array(np.zeros((10_000_000, 2))), zipfile.ZIP_DEFLATED),
        entry("points", array(np.full((30, 2), np.nan))),
        entry("points", array([[0.0, 0], [1, 0], [0, 1]])),
        entry("triangles", array([[0, 1, 2**40]])),
        entry("triangles", array([[0, 1, -1]])),
        entry("triangles", array([[0.0, 1.0, 2.0]])),
        entry("edges", array([0, 1])),
        entry("edges", array([[0, 10**6]])),
        entry("regions", array([0])),
        entry("field_0", b"hello"),
        entry("field_0", array("hello")),
        entry("field_0", array(1.0)),
        entry("field_0", array([1.0, 2.0, 3.0])),
        entry("metric", array([[1.0, 0, 1]])),
        entry("metric", array([[1, 0, 1]])),
        entry("notes", array("[" * 100_000)),
        entry("notes", array("{}")),
        entry("notes", array("[]")),
        entry("notes", array(5)),
        entry("notes", array('{"names": {"a": "b"}}')),
        entry("notes", array('{"names": {"a": %s}}' % ("1" * 5000))),
        without("notes"),
        without("edges"),
        without("metric"),
        without("field_0"),
        lambda folder: archive(folder).write_bytes(b""),
        lambda folder: archive(folder).write_bytes(archive(folder).read_bytes()[:-30]),
    ],
)
def test_archives(edit, folder):
    edit(folder)
    refused(read_history, folder, r"iteration_0000\.npz")


def noted(name, to):
    """Put another value into the notes of the archive."""

    def edit(folder):
        with np.load(archive(folder)) as arrays:
            notes = json.loads(str(arrays["notes"]))
        entry("notes", array(json.dumps(notes | {name: to})))(folder)

    return edit


@pytest.mark.parametrize("names", [[], [None], [1], [[]], ["solution", "solution"], "solution"])
def test_names_of_fields_are_texts_and_leave_none_out(names, folder):
    for is_bare in (True, False):
        noted("fields", names)(folder)
        noted("is_bare", is_bare)(folder)
        refused(read_history, folder, r"iteration_0000\.npz")


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_field_with_a_value_that_no_loop_takes_is_refused(value, folder, whole):
    values = np.array(whole[0].fields["solution"])
    values[3] = value
    entry("field_0", array(values))(folder)
    refused(read_history, folder, "not finite")


@pytest.mark.parametrize("dtype", ["<f8", ">f8", "<f4", "<c16", "<i4", "|b1", "|u1"])
@pytest.mark.parametrize("shape", [(0,), (7,), (3, 4), (2, 3, 4)])
@pytest.mark.parametrize("order", ["C", "F"])
def test_arrays_come_back_as_they_were(dtype, shape, order):
    values = np.asarray(np.arange(np.prod(shape)).reshape(shape), dtype, order=order)
    for write in (np.savez, np.savez_compressed):
        out = io.BytesIO()
        write(out, a=values, text=np.array("größer"))
        arrays = read_npz(out.getvalue())
        assert arrays["a"].dtype == values.dtype
        assert arrays["a"].tobytes() == values.tobytes()
        assert arrays["a"].shape == shape
        assert str(arrays["text"]) == "größer"


# -------------------------------------------------------------------------------------- the lists


def changed(*keys, to):
    """Put another value into the list."""

    def edit(folder):
        path = folder / "history.json"
        content = json.loads(path.read_text())
        at = content
        for key in keys[:-1]:
            at = at[key]
        at[keys[-1]] = to
        path.write_text(json.dumps(content))

    return edit


NUMBERS = ("iterations", 0)


@pytest.mark.parametrize(
    "edit",
    [
        lambda folder: (folder / "history.json").write_text("[" * 100_000),
        lambda folder: (folder / "history.json").write_text("[]"),
        lambda folder: (folder / "history.json").write_text("1" * 5000),
        lambda folder: (folder / "history.json").write_bytes(b"\xff\xfe{}"),
        changed("version", to="1"),
        changed("version", to=2),
        changed("iterations", to={}),
        changed("iterations", to=[1]),
        changed("iterations", 0, to=None),
        changed("reason", to=5),
        changed("converged", to="no"),
        changed("options", to=[]),
        changed("options", to={"a": 1}),
        changed(*NUMBERS, "n_points", to=float("inf")),
        changed(*NUMBERS, "n_points", to=-1),
        changed(*NUMBERS, "n_points", to=7.5),
        changed(*NUMBERS, "n_points", to=123456),
        changed(*NUMBERS, "n_triangles", to=1),
        changed(*NUMBERS, "number", to=10**17),
        changed(*NUMBERS, "number", to="../../0"),
        changed(*NUMBERS, "errors", to={"u": "x"}),
        changed(*NUMBERS, "errors", to=5),
        changed(*NUMBERS, "unit_fraction", to="x"),
        changed(*NUMBERS, "seconds", to={"adapt": "x"}),
        changed(*NUMBERS, "seconds", to={}),
        changed(*NUMBERS, "seconds", to=[]),
    ],
)
def test_lists(edit, folder):
    edit(folder)
    refused(read_history, folder, r"\.json|iteration_0000\.npz: is damaged, or of another history")


def test_names_are_no_markup(folder):
    changed(*NUMBERS, "errors", to={"[/u]": 1.0, "[red]v": 2.0})(folder)
    assert "[/u]" in str(read_history(folder))
    assert "[red]v" in str(read_history(folder))


def test_lists_of_histories_in_time(tmp_path):
    for intervals in ([10**17], [10**30], ["x"], [[]], [1], {}, None, [-1], [0]):
        content = {"version": 1, "intervals": intervals}
        (tmp_path / "transient.json").write_text(json.dumps(content))
        refused(read_history_in_time, tmp_path, "transient.json")
