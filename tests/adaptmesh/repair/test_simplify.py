"""Detail left out: how far boundaries move, and what is kept."""

from pathlib import Path

import numpy as np
import pytest
import shapely
from reference.decimate import decimate as slowly
from reference.dirty import star

import adaptmesh as am
from adaptmesh.convert import to_shapely
from adaptmesh.repair.decimate import decimate

ICELAND = Path(__file__).parents[3] / "examples" / "data" / "iceland.geojson"


def rough(points, rng, amplitude=0.01, n=40):
    """A ring with n points on each side, off the line by about the amplitude."""
    points = np.asarray(points, float)
    t = np.arange(n) / n
    sides = [a + t[:, None] * (b - a) for a, b in zip(points, np.roll(points, -1, 0), strict=True)]
    for side in sides:
        side[1:] += amplitude * rng.uniform(-1, 1, (n - 1, 2))
    return np.concatenate(sides)


def outline(domain):
    return shapely.union_all([area.boundary for area in to_shapely(domain).values()])


def test_displacement_is_bounded_and_corners_stay():
    ring = rough([(0, 0), (1, 0), (1, 1), (0, 1)], np.random.default_rng(0))
    domain = am.Domain.polygon(ring)
    simple, dropped = am.simplify(domain, 0.2)
    assert len(simple.points) < len(domain.points) / 5
    assert {(0, 0), (1, 0), (1, 1), (0, 1)} <= {*map(tuple, simple.points)}
    assert {*map(tuple, simple.points)} <= {*map(tuple, domain.points)}
    between = shapely.hausdorff_distance(outline(domain), outline(simple), densify=0.01)
    assert 0 < between <= dropped.displacement * (1 + 1e-9) <= 0.1 * 0.2
    assert simple.area == pytest.approx(domain.area, rel=0.05)
    gone = sum(int(record.what.split()[0]) for record in dropped)
    assert gone == len(domain.points) - len(simple.points)


def test_the_size_may_vary_and_have_a_direction():
    ring = rough([(0, 0), (10, 0), (10, 1), (0, 1)], np.random.default_rng(1), 0.003, 200)
    domain = am.Domain.polygon(ring)
    simple, _ = am.simplify(domain, lambda x: 0.02 + 0.05 * x[:, 0])
    fine = np.histogram(simple.points[:, 0], [0, 2, 4, 6, 8, 10.1])[0]
    assert fine[0] > 2 * fine[2] > 0
    # Along y the size asked for is tiny, so that nothing may move across the long sides.
    tensor = np.array([1.0, 0.0, 1e8])
    simple, dropped = am.simplify(domain, lambda x: np.broadcast_to(tensor, (len(x), 3)))
    assert all(abs(record.displacement) < 0.1 for record in dropped)
    long_sides = (simple.points[:, 0] > 0.1) & (simple.points[:, 0] < 9.9)
    assert long_sides.sum() > 370  # of about 394, off the line by chance less than that


def test_what_is_coarser_than_the_size_stays_and_nothing_is_built_anew():
    domain = am.Domain.polygon([(0, 0), (1, 0), (2, 0), (2, 2), (0, 2)])
    simple, dropped = am.simplify(domain, 0.5)
    assert simple is domain
    assert not dropped
    assert str(dropped).startswith("nothing removed")


def test_names_regions_interfaces_and_lone_points_are_kept():
    rng = np.random.default_rng(2)
    border = np.stack([1 + 0.004 * rng.uniform(-1, 1, 50), np.linspace(0, 1, 50)], axis=1)
    border[[0, -1], 0] = 1.0
    left = np.concatenate([border, [(0, 1), (0, 0)]])
    right = np.concatenate([border[::-1], [(2, 0), (2, 1)]])
    domain, _ = am.repair({"left": left, "right": right})
    simple, _ = am.simplify(domain, 0.2)
    assert list(simple.region_names) == ["left", "right"]
    assert dict(simple.names) == dict(domain.names)
    assert len(simple.segments) < 20
    for name in domain.region_names:
        a, b = (to_shapely(d)[name].area for d in (domain, simple))
        assert a == pytest.approx(b, abs=0.02)
    mesh = am.generate(simple, 0.2)
    assert mesh.validate().ok
    assert len(mesh.edges_named("left|right")) < 10

    points = [*domain.points, (0.5, 0.5)]
    with_point = am.Domain(points, domain.segments, regions={"left": (0.1, 0.1)})
    assert (0.5, 0.5) in {*map(tuple, am.simplify(with_point, 0.2)[0].points)}


def test_points_where_names_change_stay():
    ring = rough([(0, 0), (1, 0), (1, 1), (0, 1)], np.random.default_rng(3))
    names = {"a": range(100), "b": range(100, 130)}
    domain = am.Domain.polygon(ring, names=names)
    simple, _ = am.simplify(domain, 0.3)
    for corner in (ring[0], ring[100], ring[130]):
        assert tuple(corner) in {*map(tuple, simple.points)}
    assert dict(simple.names) == dict(domain.names)


def test_a_line_is_not_moved_over_a_point_or_an_island():
    """A bay with an island in it: the shore may not be straightened across the island."""
    shore = [(0, 0), (4, 0), (4, 3), (2.2, 3), (2.1, 2.9), (1.9, 2.9), (1.8, 3), (0, 3)]
    island = [(1.98, 2.95), (2.02, 2.95), (2, 2.97)]
    domain, repairs = am.repair([shapely.Polygon(shore), shapely.Polygon(island)])
    assert not repairs
    simple, _ = am.simplify(domain, 3.0)
    a, b = (shapely.union_all([*to_shapely(d).values()]) for d in (domain, simple))
    assert len(shapely.get_parts(b)) == len(shapely.get_parts(a)) == 2
    free, _ = am.simplify(am.Domain.polygon(shore), 3.0)
    assert len(free.points) == 4


def test_loops_below_a_size_are_left_out_on_request_only():
    holes = [[(0.2, 0.2), (0.21, 0.2), (0.2, 0.21)], [(0.6, 0.6), (0.9, 0.6), (0.6, 0.9)]]
    square = [(0, 0), (1, 0), (1, 1), (0, 1)]
    domain = am.Domain.polygon(square, holes)
    assert am.simplify(domain, 0.1)[0].area == pytest.approx(domain.area)
    simple, dropped = am.simplify(domain, 0.1, loops_below=0.5)
    assert simple.area == pytest.approx(1 - 0.045)
    assert [record.kind for record in dropped] == ["loop"]


def test_what_lies_in_a_loop_goes_with_it_but_never_the_last_of_a_region():
    lake, island = [(4, 4), (5, 4), (5, 5), (4, 5)], [(4.4, 4.4), (4.6, 4.4), (4.5, 4.6)]
    square = [(0, 0), (9, 0), (9, 9), (0, 9)]
    domain = am.Domain.polygon(square, [lake, island])
    simple, dropped = am.simplify(domain, 1.0, loops_below=2.0)
    assert (len(simple.points), simple.area, len(dropped)) == (4, 81.0, 1)
    named, _ = am.repair({"land": shapely.Polygon(square, [lake]), "rock": island})
    simple, dropped = am.simplify(named, 1.0, loops_below=2.0)
    assert simple is named
    assert not dropped


def test_iceland():
    domain, _ = am.repair(ICELAND)
    simple, dropped = am.simplify(domain, 10.0)
    assert 800 < len(simple.points) < 1000
    assert dropped.displacement <= 1.0
    assert len(shapely.get_parts(to_shapely(simple)["Iceland"])) == len(
        shapely.get_parts(to_shapely(domain)["Iceland"])
    )
    assert am.generate(simple, 10.0).validate().ok


@pytest.mark.parametrize("seed", range(30))
def test_random_neighbours(seed):
    rng = np.random.default_rng(seed)
    polygons = {str(k): star(rng, n=200, radius=0.3, wild=0.1) for k in range(3)}
    domain, _ = am.repair(polygons)
    simple, dropped = am.simplify(domain, rng.uniform(0.02, 0.5), loops_below=rng.choice([0, 0.3]))
    assert set(simple.region_names) == set(domain.region_names)
    assert am.generate(simple, 0.1).validate().ok
    if "loop" not in dropped.counts:
        between = shapely.hausdorff_distance(outline(domain), outline(simple))
        assert between <= dropped.displacement * (1 + 1e-9)


@pytest.mark.parametrize("seed", range(12))
def test_the_same_points_go_as_by_the_slow_way(seed):
    """Rings on a few levels of coordinates, so that some points are collinear and some offs tie."""
    rng = np.random.default_rng(seed)
    polygons = {str(k): np.round(star(rng, n=120, wild=0.1), rng.integers(2, 4)) for k in range(2)}
    domain, _ = am.repair(polygons)
    edges = domain.pieces.astype(np.int64)
    tensors = np.broadcast_to(
        [rng.uniform(4, 400), 0.0, rng.uniform(4, 400)], (len(domain.points), 3)
    )
    kind = domain.segment_tags[domain.piece_segments]
    fast = decimate(domain.points, tensors, edges, kind, 0.3)
    removed = np.split(fast.removed, fast.starts[1:-1])
    assert [
        (*ends, e, sorted(p.tolist()))
        for ends, e, p in zip(fast.edges.tolist(), fast.source.tolist(), removed, strict=True)
    ] == slowly(domain.points, tensors, edges, kind, 0.3)
    assert 10 < len(fast.removed) < len(domain.points)


def test_a_straight_line_of_many_points():
    n = 50_000
    bottom = np.stack([np.linspace(0, 1, n), np.zeros(n)], axis=1)
    domain = am.Domain.polygon(np.concatenate([bottom, [(1, 1), (0, 1)]]))
    simple, dropped = am.simplify(domain, 2.0)
    assert len(simple.points) == 4
    assert dropped.displacement < 1e-15


def test_bad_arguments():
    domain = am.Domain.rectangle(0, 0, 1, 1)
    with pytest.raises(ValueError, match=r"share: .* got -1"):
        am.simplify(domain, 1.0, share=-1)
    with pytest.raises(ValueError, match=r"loops_below: .* got nan"):
        am.simplify(domain, 1.0, loops_below=np.nan)
    with pytest.raises(am.DomainError, match=r"got list.*repair"):
        am.simplify([(0, 0), (1, 0), (1, 1)], 1.0)
    with pytest.raises(am.MetricError):
        am.simplify(domain, lambda x: np.full(len(x), np.nan))
