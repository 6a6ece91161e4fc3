"""Damaged files of every format: a `FormatError` or a mesh, never anything else."""

import random
import warnings

import numpy as np
import pytest

from adaptmesh import io
from adaptmesh.errors import FormatError
from adaptmesh.mesh import Mesh

WAYS = {
    "vtu": ("a.vtu", {}),
    "msh41": ("a.msh", {}),
    "msh41 text": ("a.msh", {"binary": False}),
    "msh22": ("a.msh", {"version": "2.2"}),
    "msh22 text": ("a.msh", {"version": "2.2", "binary": False}),
    "mesh": ("a.mesh", {}),
    "meshb": ("a.meshb", {}),
    "xdmf": ("a.xdmf", {}),
    "ele": ("a.ele", {}),
    "sol": ("a.sol", {}),
    "solb": ("a.solb", {}),
}


@pytest.fixture(params=WAYS)
def path(request, tmp_path):
    """A whole file of every kind, with everything that it can hold."""
    name, options = WAYS[request.param]
    points = np.random.default_rng(0).random((7, 2))
    points[:6] = [[np.cos(a), np.sin(a)] for a in np.arange(6) * np.pi / 3]
    points[6] = 0
    ring = np.arange(6)
    border = np.stack([ring, (ring + 1) % 6], axis=1)
    triangles = np.column_stack([np.full(6, 6), border])
    mesh = Mesh(points, triangles, ring, border, ring % 3, {"in": 1, 'o"ut': 2}, {"steel": 4})
    path = tmp_path / name
    if ".sol" in name:
        io.write_sol(path, points)
    else:
        io.write(path, mesh, u=points[:, 0], v=points, q=ring, metric=0.1, **options)
    return path


def reads(path):
    """Whether the file can be read; `FormatError` is the only error allowed, and names it."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            if path.suffix.startswith(".sol"):
                io.read_sol(path)
            else:
                io.read_fields(path)
    except FormatError as error:
        assert str(path.with_suffix("")) in str(error)  # or a solution beside it
        return False
    return True


def test_cut_short(path, capfd):
    whole = path.read_bytes()
    # the last bytes may be blanks or the unused place after End
    for size in [*range(0, len(whole) - 8, max(1, len(whole) // 150))]:
        path.write_bytes(whole[:size])
        if reads(path):  # only whole sections may be missing
            assert path.suffix == ".msh"
            assert whole[:size].rstrip().endswith((b"Elements", b"Data"))
    assert capfd.readouterr() == ("", "")


def test_flipped_bytes(path, capfd):
    whole = path.read_bytes()
    chance = random.Random(0)
    for _ in range(200):
        damaged = bytearray(whole)
        for _ in range(chance.choice([1, 1, 3])):
            i = chance.randrange(len(damaged))
            damaged[i] = chance.choice([damaged[i] ^ 1 << chance.randrange(8), 0, 255, 45, 57])
        path.write_bytes(damaged)
        reads(path)
    assert capfd.readouterr() == ("", "")


def test_pieces_lost_or_repeated(path):
    whole = path.read_bytes()
    chance = random.Random(1)
    for _ in range(60):
        i, j = sorted(chance.randrange(len(whole)) for _ in range(2))
        for damaged in (whole[:i] + whole[j:], whole[:j] + whole[i:]):
            path.write_bytes(damaged)
            reads(path)


def test_counts_that_would_exhaust_memory(path):
    # every place where a number stands gets a huge one
    whole = path.read_bytes()
    for value in (b"\xff\xff\xff\x7f", b"\xff\xff\xff\xff\xff\xff\xff\x7f", b"9999999999999"):
        for at in range(0, min(len(whole), 600), 4):
            path.write_bytes(whole[:at] + value + whole[at + len(value) :])
            reads(path)


def test_other_bytes_altogether(path):
    for content in (b"", b"\0" * 100, bytes(range(256)) * 4, b"\x01\0\0\0" * 50, b"x" * 10_000):
        path.write_bytes(content)
        assert not reads(path)
