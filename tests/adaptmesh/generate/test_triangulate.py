"""Delaunay triangulations of points: always a triangulation, always Delaunay, exactly."""

from __future__ import annotations

import signal
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from reference.delaunay import border_of, delaunay_triangles, edges_of, loops_of
from scipy.spatial import Delaunay

from adaptmesh import _core
from adaptmesh.errors import DomainError
from adaptmesh.generate.delaunay import delaunay


def canonical(triangles):
    """Each row with its lowest number first, rows sorted."""
    first = np.argmin(triangles, axis=1)
    turned = np.take_along_axis(triangles, (first[:, None] + np.arange(3)) % 3, axis=1)
    return turned[np.lexsort(turned.T[::-1])]


def check_delaunay(points, triangles, duplicate_of):
    """All that makes `triangles` the Delaunay triangulation of `points`, with exact signs."""
    p = np.ascontiguousarray(points, dtype=float)
    t = triangles
    _, first = np.unique(p, axis=0, return_index=True)
    assert np.array_equal(np.unique(t), np.sort(first)), "vertices are not the distinct points"
    assert np.array_equal(p[duplicate_of], p)
    assert np.isin(duplicate_of, first).all()

    assert (_core.orient2d(p[t[:, 0]], p[t[:, 1]], p[t[:, 2]]) == 1).all()

    opposite = edges_of(t.tolist())
    inner = [(u, v, w, opposite[v, u]) for (u, v), w in opposite.items() if (v, u) in opposite]
    if inner:
        a, b, c, d = (p[list(column)] for column in zip(*inner, strict=True))
        assert (_core.incircle(a, b, c, d) <= 0).all(), "an edge is not Delaunay"

    (hull,) = loops_of(border_of(opposite))
    corners = p[hull]
    before, after = np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0)
    assert (_core.orient2d(before, corners, after) >= 0).all(), "the hull is not convex"
    # Once around: the loop has one lowest point (by y, then x).
    keys = [tuple(q[::-1]) for q in corners.tolist()]
    lowest = [k for k in range(len(keys)) if keys[k] < min(keys[k - 1], keys[(k + 1) % len(keys)])]
    assert len(lowest) == 1
    assert len(t) == 2 * len(first) - 2 - len(hull), "Euler"


def grid(nx, ny, step=1.0):
    x, y = np.meshgrid(np.arange(nx) * step, np.arange(ny) * step)
    return np.stack([x, y], axis=-1).reshape(-1, 2)


def circle(n, radius=1.0):
    angle = 2 * np.pi * np.arange(n) / n
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def lattice_circle():
    """All 36 integer points on the circle of radius 65: exactly cocircular."""
    x, y = np.meshgrid(np.arange(-65.0, 66), np.arange(-65.0, 66))
    on = x * x + y * y == 65 * 65
    return np.stack([x[on], y[on]], axis=1)


def zoo():
    rng = np.random.default_rng(7)
    random = rng.random((200, 2))
    line = np.stack([np.arange(50.0), np.zeros(50)], axis=1)
    slope = np.stack([np.arange(50.0), 3 * np.arange(50.0)], axis=1)
    clusters = rng.integers(0, 4, (150, 2)) + 1e-12 * rng.normal(size=(150, 2))
    parabola = np.stack([np.arange(-40.0, 41), np.arange(-40.0, 41) ** 2], axis=1)
    return {
        "triangle": np.array([[0.0, 0], [1, 0], [0, 1]]),
        "square": grid(2, 2),
        "random": random,
        "grid": grid(12, 9),
        "grid of 0.1": grid(12, 9, 0.1),
        "shuffled grid": rng.permutation(grid(12, 12)),
        "line and a point": np.vstack([line, [[20.3, 4.0]]]),
        "line and a point below": np.vstack([[[20.3, -1e-3]], line]),
        "sloping line and a point": np.vstack([slope, [[20.0, 61.0]]]),
        "two lines": np.vstack([line, line + np.array([0.5, 1.0])]),
        "cross": np.vstack([line - [25, 0], line[:, ::-1] - [0, 25.5]]),
        "circle": circle(100),
        "circle and centre": np.vstack([circle(64), [[0.0, 0.0]]]),
        "exact circle": lattice_circle(),
        "concentric circles": np.vstack([circle(40, r) for r in (1.0, 2.0, 3.0)]),
        "duplicates": np.vstack([random[:40], random[30:60], random[:5], random[:5]]),
        "each point four times": np.repeat(grid(4, 4), 4, axis=0),
        "clusters": clusters,
        "parabola": parabola,
        "needle": random * [1.0, 1e-14],
        "geometric": np.vstack([2.0 ** -np.arange(60)[:, None] * [1, 0], [[0, 0], [0, 1]]]),
    }


ZOO = zoo()


@pytest.mark.parametrize("name", ZOO)
@pytest.mark.parametrize("offset", [0.0, 1e6])
@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_zoo(name, scale, offset):
    points = ZOO[name] * scale + offset
    try:
        triangles, duplicate_of = _core.delaunay(points)
    except _core.InputError as fault:
        # Beside an offset of 1e6 rounding can put everything in a few places.
        assert fault.args[0].name == "all_collinear" and offset > 0
        distinct = np.unique(points, axis=0)
        a, b = distinct[[0] * len(distinct)], distinct[[-1] * len(distinct)]
        assert (_core.orient2d(a, b, distinct) == 0).all()
    else:
        check_delaunay(points, triangles, duplicate_of)


def test_same_triangles_as_qhull():
    points = np.random.default_rng(1).random((100_000, 2))
    assert np.array_equal(
        np.unique(np.sort(delaunay(points), axis=1), axis=0),
        np.unique(np.sort(Delaunay(points).simplices, axis=1), axis=0),
    )


coordinates = st.integers(0, 6).map(float)


@pytest.mark.slow
@settings(max_examples=150, deadline=None)
@given(st.lists(st.tuples(coordinates, coordinates), min_size=3, max_size=14))
def test_every_triangle_has_an_empty_circle(points):
    array = np.array(points)
    try:
        triangles, duplicate_of = _core.delaunay(array)
    except _core.InputError as fault:
        assert fault.args[0].name == "all_collinear"
        assert not delaunay_triangles(sorted(set(points)))
        return
    check_delaunay(array, triangles, duplicate_of)
    distinct = sorted(set(points))
    number = [distinct.index(p) for p in points]
    mine = {tuple(t) for t in canonical(np.array(number)[triangles]).tolist()}
    assert mine <= delaunay_triangles(distinct)


@settings(max_examples=100, deadline=None)
@given(st.lists(st.tuples(st.floats(-1e300, 1e300), st.floats(-1e300, 1e300)), max_size=30))
def test_any_finite_coordinates(points):
    array = np.array(points).reshape(-1, 2)
    try:
        triangles, duplicate_of = _core.delaunay(array)
    except _core.InputError as fault:
        assert fault.args[0].name in ("all_collinear", "too_few_points")
    else:
        check_delaunay(array, triangles, duplicate_of)


def test_duplicates_map_to_the_lowest_number():
    points = np.random.default_rng(3).integers(0, 5, (400, 2)).astype(float)
    _, duplicate_of = _core.delaunay(points)
    distinct, first, inverse = np.unique(points, axis=0, return_index=True, return_inverse=True)
    assert np.array_equal(duplicate_of, first[inverse.ravel()])
    assert len(distinct) == 25


def test_the_same_points_give_the_same_bits():
    points = np.random.default_rng(4).random((5000, 2))
    assert np.array_equal(delaunay(points), delaunay(points.copy()))


@pytest.mark.parametrize(
    "move", [lambda p: p * 1024.0, lambda p: p[:, ::-1] * [1, -1], lambda p: -p]
)
def test_moved_points_give_the_same_triangles(move):
    points = np.random.default_rng(5).random((2000, 2))
    assert np.array_equal(canonical(delaunay(points)), canonical(delaunay(move(points))))


def test_input_is_not_changed():
    points = np.random.default_rng(6).random((100, 2))
    kept = points.copy()
    delaunay(points)
    assert np.array_equal(points, kept)
    points.flags.writeable = False
    delaunay(points[::2])


@pytest.mark.parametrize(
    ("points", "message"),
    [
        (np.zeros((4, 3)), r"shape \(n, 2\).*\(4, 3\)"),
        (np.zeros(6), r"shape \(n, 2\)"),
        ([[0, 0], [1, 1]], "at least 3 points, got 2"),
        (np.empty((0, 2)), "got 0"),
        ([[0, 0], [1, np.nan], [np.inf, 1]], r"point 1 at \(1.0, nan\) \(and 1 more\)"),
        ([["a", "b"]], "real numbers"),
        (np.full((3, 2), 1j), "real numbers"),
        ([[0, 0], [1, 2], [2, 4], [3, 6]], r"all 4 points.*one line.*\(0, 0\) and \(3, 6\)"),
        ([[1, 2]] * 5, "all 5 points.*one line"),
    ],
)
def test_bad_points_are_named(points, message):
    with pytest.raises(DomainError, match=message):
        delaunay(points)


def test_the_core_refuses_what_is_not_finite():
    with pytest.raises(_core.InputError) as caught:
        _core.delaunay(np.array([[0.0, 0], [1, 0], [np.inf, 1]]))
    assert caught.value.args[:2] == (_core.InputFault.not_finite, 2)


@pytest.mark.skipif(sys.platform == "win32", reason="no interval timer")
def test_interrupted():
    points = np.random.default_rng(8).random((1_000_000, 2))
    previous = signal.signal(signal.SIGALRM, signal.default_int_handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.01)
        with pytest.raises(KeyboardInterrupt):
            _core.delaunay(points)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, previous)
