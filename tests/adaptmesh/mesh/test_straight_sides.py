"""Straight borders of meshes whose coordinates were rounded: in files, in float32, far away.

The right corners are those that the mesh was made with. The oracle for what may be left out is
exact: every vertex is within the tolerance said of the border of the domain, in fractions.
"""

from fractions import Fraction

import numpy as np
import pytest
from reference.transforms import TRANSFORMS, Transform

import adaptmesh as am
from adaptmesh.mesh.coordinate_digits import digits_of

RING = np.array([(0, 0), (1, 0.2), (0.8, 0.9), (0.1, 0.7)])
HOLE = np.array([(0.4, 0.3), (0.6, 0.35), (0.5, 0.55)])


def significant(digits):
    return lambda p: np.array([[float(f"{v:.{digits}g}") for v in row] for row in p])


def decimals(places):
    return lambda p: np.array([[float(f"{v:.{places}f}") for v in row] for row in p])


def single(p):
    return p.astype(np.float32).astype(float)


ROUNDED = {
    "as it is": lambda p: p,
    "12 digits": significant(12),
    "9 digits": significant(9),
    "6 digits": significant(6),
    "float32": single,
}


def digits_left(transform, rounded):
    """How many digits rounding leaves of the extent of the figure."""
    places = {"9 digits": 9, "6 digits": 6, "float32": 7.2}.get(rounded, 12)
    return places - np.log10(1 + np.abs(transform.offset).max() / transform.scale)


def bare(mesh, points):
    """The mesh as read from a file, with other coordinates."""
    return am.Mesh(points, mesh.triangles, edges=mesh.edges, edge_tags=mesh.edge_tags)


def farthest(points, domain):
    """How far a point of these is from the segments of a domain, computed exactly till the root."""
    worst = Fraction(0)
    segments = [[tuple(map(Fraction, p)) for p in s] for s in domain.points[domain.segments]]
    for p in points.tolist():
        x, y = map(Fraction, p)
        squares = []
        for (x0, y0), (x1, y1) in segments:
            dx, dy = x1 - x0, y1 - y0
            t = min(max(((x - x0) * dx + (y - y0) * dy) / (dx * dx + dy * dy), 0), 1)
            squares.append((x - x0 - t * dx) ** 2 + (y - y0 - t * dy) ** 2)
        worst = max(worst, min(squares))
    return float(worst) ** 0.5


@pytest.mark.fast_cases(6)
@pytest.mark.parametrize("rounded", ROUNDED)
@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
def test_rounded_straight_sides_have_no_corners(transform, rounded):
    domain = am.Domain.polygon(transform(RING), [transform(HOLE)])

    def size(h):
        def tensors(x):
            return transform.metric(np.tile([h**-2, 0, h**-2], (len(x), 1)))

        return tensors

    fine = am.generate(domain, size(0.05))
    points = ROUNDED[rounded](fine.points)
    if digits_left(transform, rounded) < 3:
        pytest.skip("edges are no longer than what rounding does to them")
    mesh = bare(fine, points)
    coarse = am.adapt(mesh, size(0.5))
    found = coarse.domain.corners_found
    assert found.corners == 7
    assert found.vertices == len(np.unique(fine.edges))
    border = points[np.unique(fine.edges)]
    assert farthest(border, mesh.to_domain()) <= found.tolerance * (1 + 1e-6)
    assert am.validate(coarse), am.validate(coarse)
    assert f"7 corners of {found.vertices} vertices" in str(am.measure(coarse, size(0.5)))


@pytest.mark.fast_cases(5)
@pytest.mark.parametrize("rounded", ["as it is", "9 digits", "float32"])
@pytest.mark.parametrize("offset", [(0.0, 0.0), (5e5, 5.2e6)], ids=["near", "UTM"])
def test_true_corners_of_tiny_angles_stay(rounded, offset):
    """A side bent by a few times what rounding can do, and one that is bent by less."""
    for times, corners in ((4, 5), (0.2, 4)):
        ring = 1e3 * np.array([(0, 0), (0.5, 0), (1, 0.1), (1, 1), (0, 0.8)]) + offset
        ring[1] = ring[[0, 2]].mean(axis=0)
        straight = am.generate(am.Domain.polygon(ring), 40.0)
        points = ROUNDED[rounded](straight.points)
        said = bare(straight, points).to_domain().corners_found
        ring[1] += times * said.tolerance * np.array([0.1, -1]) / np.hypot(0.1, 1)
        bent = am.generate(am.Domain.polygon(ring), 40.0)
        found = bare(bent, ROUNDED[rounded](bent.points)).to_domain().corners_found
        assert found.corners == corners
        assert found.tolerance == pytest.approx(said.tolerance, rel=0.01)


def test_the_tolerance_is_an_argument():
    ring = [(0, 0), (1, 1e-4), (2, 0), (2, 1), (0, 1)]
    mesh = am.generate(am.Domain.polygon(ring), 0.1)
    mesh = bare(mesh, mesh.points)
    assert len(mesh.to_domain().points) == 5
    loose = mesh.to_domain(straight_tolerance=2e-4)
    assert len(loose.points) == 4
    assert "straight_tolerance" in str(loose.corners_found)
    coarse = am.adapt(mesh, 1.0, straight_tolerance=2e-4)
    assert len(coarse.domain.points) == 4
    with pytest.raises(ValueError, match="leave it out"):
        am.adapt(coarse, 1.0, straight_tolerance=1e-4)
    for bad in (-1.0, np.nan, np.inf, "small"):
        with pytest.raises(am.DomainError, match="straight_tolerance: expected a distance"):
            mesh.to_domain(straight_tolerance=bad)


def test_numbers_that_someone_chose_are_exact():
    """Grids and corners with few digits, near and far: nothing of them is rounding."""
    x, y = np.meshgrid(np.arange(6) * 0.25, np.arange(5) * 0.2)
    grid = np.stack([x.ravel(), y.ravel()], axis=1)
    for points in (grid, grid * 1000 + [500000, 5200000], np.round(grid / 0.05) * 0.05):
        assert digits_of(points, 0.2).why == "double precision"
    typed = np.array([(500000, 5200000), (500100, 5200001), (500200, 5200000), (500100, 5200090)])
    mesh = am.Mesh(typed.astype(float), [[0, 1, 3], [1, 2, 3]])
    assert len(mesh.to_domain().points) == 4


@pytest.mark.parametrize(
    ("written", "why", "error"),
    [
        (lambda p: p, "double precision", 2e-15),
        (significant(12), "12 significant digits", 0.5e-12),
        (decimals(6), "6 decimal places", 0.5e-6),
        (lambda p: decimals(3)(100 * p + [5e5, 5.2e6]), "3 decimal places", 0.5e-3),
        (lambda p: decimals(3)(100 * p + [5e5, 5.2e6]) - [5e5, 5.2e6], "3 decimal", 0.5e-3),
        (lambda p: (100 * p + [5e5, 5.2e6]) - [5e5, 5.2e6], "multiples of 9.31e-10", 0.47e-9),
        (single, "float32", 2**-25),
        (lambda p: 1e300 * p, "double precision", 2e285),
        (lambda p: 1e-300 * p, "double precision", 2e-315),
    ],
)
def test_what_is_found_in_digits(written, why, error):
    points = written(np.random.default_rng(1).random((200, 2)))
    found = digits_of(points, 0.05 * np.ptp(points))
    assert found.why.startswith(why)
    assert error / 2 <= found.error <= 2 * error


def test_edges_are_kept_though_they_are_off_the_line_by_rounding():
    fine = am.generate(am.Domain.polygon(100 * RING), 4.0)
    mesh = bare(fine, single(fine.points))
    edited = am.adapt(mesh, 4.0, keep=True)
    assert np.mean(edited.kept >= 0) > 0.99
    assert am.validate(edited), am.validate(edited)


def test_what_is_nearer_than_the_tolerance_is_not_swallowed():
    """A slit and a hole that are narrower than the rounding: the mesh is taken as it is."""
    for gap in (1e-5, 1e-7):
        ring = [(0, 0), (1, 0), (1, 1), (0.5 + gap, 1), (0.5, 0.3), (0.5 - gap, 1), (0, 1)]
        mesh = am.generate(am.Domain.polygon(ring), 0.2)
        mesh = bare(mesh, mesh.points)
        domain = mesh.to_domain(straight_tolerance=1e-12)
        assert len(domain.points) == 7
        assert mesh.to_domain().area == pytest.approx(domain.area, abs=1e-12)
    hole = 1e-6 * HOLE + 0.5
    mesh = am.generate(am.Domain.polygon(RING, [hole]), 0.2)
    assert len(bare(mesh, significant(9)(mesh.points)).to_domain().points) == 7


def test_smooth_borders_of_rounded_coordinates_stay_smooth():
    """Edges of a fine circle are in line with their neighbours, to five digits."""
    disc = am.Domain.from_curves([am.curves.Circle((0, 0), 100.0)])
    fine = am.generate(disc, lambda x: 0.4 + 0.4 * np.abs(100 - np.hypot(*x.T)))
    mesh = bare(fine, significant(5)(fine.points))
    polygon = mesh.to_domain()
    assert polygon.corners_found.corners < 0.6 * polygon.corners_found.vertices
    smooth = mesh.to_domain(corner_angle=40)
    coarse = am.generate(smooth, 20.0)
    assert len(coarse.edges) < 40
    np.testing.assert_allclose(np.hypot(*coarse.points[coarse.edges[:, 0]].T), 100, atol=1e-2)


@pytest.mark.parametrize(
    "transform",
    [t for t in TRANSFORMS if t.name in ("as it is", "reflected", "UTM: metres, offset")],
    ids=str,
)
def test_straight_sides_between_arcs_stay_straight(transform: Transform):
    a = [transform((1, -0.5)), transform((1, 0.5)), transform((-1, 0.5)), transform((-1, -0.5))]
    curves = [
        am.curves.Spline([a[0], transform((1.5, 0)), a[1]]),
        am.curves.Line(a[1], a[2]),
        am.curves.Spline([a[2], transform((-1.5, 0)), a[3]]),
        am.curves.Line(a[3], a[0]),
    ]
    fine = am.generate(am.Domain.from_curves(curves), 0.05 * transform.scale)
    for points in (fine.points, significant(12)(fine.points)):
        domain = bare(fine, points).to_domain(corner_angle=40)
        straight = domain.points[domain.segments[domain.curved.segment_paths < 0]]
        assert len(straight) == 2
        lengths = np.hypot(*np.diff(straight, axis=1)[:, 0].T)
        np.testing.assert_allclose(lengths, 2 * transform.scale, rtol=0.05)  # but an edge
