"""Domains: what they accept, and how they refuse the rest."""

import re

import numpy as np
import pytest

from adaptmesh import Domain, DomainError, Outline, generate, repair
from adaptmesh.curves import Circle

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
RING = [(0, 1), (1, 2), (2, 3), (3, 0)]


def square_ring(x0, y0, size):
    return [(x0, y0), (x0 + size, y0), (x0 + size, y0 + size), (x0, y0 + size)]


def test_square_has_its_area_and_names():
    domain = Domain(SQUARE, RING, names={"inlet": [3], "walls": [0, 2]})
    assert domain.area == 1.0
    assert dict(domain.names) == {"inlet": 1, "walls": 2}
    assert domain.segment_tags.tolist() == [2, 0, 2, 1]


def test_hole_by_seed():
    points = SQUARE + square_ring(0.25, 0.25, 0.5)
    segments = RING + [(a + 4, b + 4) for a, b in RING]
    assert Domain(points, segments, holes=[]).area == pytest.approx(1.0)
    assert Domain(points, segments, holes=[(0.5, 0.5)]).area == pytest.approx(0.75)


def test_nested_rings_alternate_between_hole_and_island():
    rings = [square_ring(k, k, 10 - 2 * k) for k in range(4)]
    domain = Domain.polygon(rings[0], rings[1:])
    assert domain.area == pytest.approx(100 - 64 + 36 - 16)


def test_polygon_takes_shapely():
    shapely = pytest.importorskip("shapely")
    disc = shapely.Point(0, 0).buffer(1.0).difference(shapely.Point(0, 0).buffer(0.5))
    assert Domain.polygon(disc).area == pytest.approx(disc.area)
    two = shapely.MultiPolygon([shapely.box(0, 0, 1, 1), shapely.box(2, 0, 3, 1)])
    assert Domain.polygon(two).area == pytest.approx(2.0)


def test_polygons_that_touch_in_a_point_share_it():
    domain = Domain.polygon([(0, 0), (2, 0), (2, 2), (0, 2)], [[(0, 0), (1, 0.5), (0.5, 1)]])
    assert len(domain.points) == 6


def test_regions_are_numbered_in_the_order_given():
    points = [(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1)]
    segments = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (1, 4)]
    domain = Domain(points, segments, regions={"right": (1.5, 0.5), "left": (0.5, 0.5)})
    centres = domain.points[domain.triangles].mean(axis=1)
    assert np.array_equal(domain.triangle_regions, np.where(centres[:, 0] > 1, 1, 2))


def test_one_region_may_have_several_parts():
    points = [*SQUARE, (0.3, 0), (0.3, 1), (0.7, 0), (0.7, 1)]
    segments = [(0, 4), (4, 6), (6, 1), (1, 2), (2, 7), (7, 5), (5, 3), (3, 0), (4, 5), (6, 7)]
    domain = Domain(points, segments, regions={"steel": [(0.1, 0.5), (0.9, 0.5)]})
    p = domain.points[domain.triangles].mean(axis=1)
    assert np.array_equal(domain.triangle_regions, (abs(p[:, 0] - 0.5) > 0.2).astype(int))


def test_point_on_a_segment_divides_it():
    domain = Domain([*SQUARE, (0.5, 0.0)], RING)
    assert domain.area == 1.0
    assert 4 in domain.triangles


def test_it_never_changes():
    domain = Domain(SQUARE, RING)
    for array in (domain.points, domain.segments, domain.segment_tags, domain.triangles):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([(0, 0), (1, 0), (np.nan, 1)], [(0, 1), (1, 2), (2, 0)]), r"point 2 is \(nan, 1"),
        (([(0, 0), (1, np.inf), (1, 1)], [(0, 1), (1, 2), (2, 0)]), "point 1 .* must be finite"),
        (([(0, 0), (1, 0)], [(0, 1)]), "2 points: at least 3"),
        (([(0, 0), (1e80, 0), (0, 1)], [(0, 1), (1, 2), (2, 0)]), "point 1 .* another unit"),
        (([(0, 0, 0), (1, 0, 0.5), (1, 1, 0)], RING), r"point 1 is at height 0.5, .* \[:, :2\]"),
        (([(0, 0, 0, 0)] * 3, RING), r"shape \(3, 4\)"),
        (("abc", RING), "array of numbers"),
        ((np.array(SQUARE) * 1j, RING), "they are complex"),
        ((SQUARE, [(0, 1), (1, 2), (2, 4)]), "segment 2 joins points 2 and 4"),
        ((SQUARE, [(0, 1), (1, -2)]), "segment 1 joins points 1 and -2"),
        ((SQUARE, [(0.0, 1.0)]), "must be integers"),
        ((SQUARE, []), "no segments"),
        ((SQUARE, [0, 1, 2]), r"\(k, 2\) array"),
        ((SQUARE, [*RING, (2, 2)]), "segment 4 has no length"),
        (([*SQUARE, (1, 0)], RING), r"points 1 and 4 are the same, \(1, 0\)"),
        (([(0, 0), (1, 0), (2, 0)], [(0, 1), (1, 2)]), "on one line"),
        (([(0, 0), (1, 1), (1, 0), (0, 1)], RING), r"cross at \(0.5, 0.5\)"),
        (([*SQUARE, (0.5, 0), (2, 0)], [*RING, (4, 5)]), "overlap"),
        ((SQUARE, RING[:3]), "not closed"),
        ((SQUARE, RING, [(2, 2)]), r"hole 0 at \(2, 2\) is not inside"),
        ((SQUARE, RING, [(0.5, 0)]), "lies on a segment"),
        ((SQUARE, RING, [(0.5, 0.5)]), "nothing is left"),
        ((SQUARE, RING, "nested"), "or 'nesting'"),
        ((SQUARE, RING, (), {"steel": (5, 5)}), "region 'steel' at .* is not inside"),
        ((SQUARE, RING, (), {"a": (0.2, 0.2), "b": (0.7, 0.2)}), "'a' and .* 'b'"),
        ((SQUARE, RING, (), None, {"in": [4]}), "name 'in' is given to segment 4"),
        ((SQUARE, RING, (), None, {"in": [1], "out": [1]}), "both 'in' and 'out'"),
        (([*SQUARE, (3, 3)], RING), r"point 4 at \(3, 3\)"),
    ],
)
def test_bad_input_is_named(arguments, message):
    with pytest.raises(DomainError, match=message):
        Domain(*arguments)


def test_rings_with_too_few_points():
    with pytest.raises(DomainError, match="ring 1 has 2 different points"):
        Domain.polygon(SQUARE, [[(0.1, 0.1), (0.2, 0.2), (0.1, 0.1)]])


def test_polygon_of_the_wrong_kind():
    shapely = pytest.importorskip("shapely")
    with pytest.raises(DomainError, match="is a LineString"):
        Domain.polygon(shapely.LineString([(0, 0), (1, 1)]))


def test_rectangle():
    assert Domain.rectangle(-1, 2, 3, 4).area == 8.0
    with pytest.raises(DomainError, match="x0 < x1"):
        Domain.rectangle(1, 0, 0, 1)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"names": ["inlet"]}, "names must be a mapping of names, not list"),
        ({"names": {"inlet": [1.5]}}, "name 'inlet' is given to segment 1.5"),
        ({"names": {"inlet": "3"}}, "name 'inlet' is given to segment '3'"),
        ({"names": {"": [1]}}, "the name '': expected a text"),
        ({"names": {None: [1]}}, "the name None: expected a text"),
        ({"regions": [(0.5, 0.5)]}, "regions must be a mapping of names, not list"),
    ],
)
def test_names_that_are_none_are_refused(arguments, message):
    with pytest.raises(DomainError, match=re.escape(message)):
        Domain(SQUARE, RING, **arguments)


NO_NUMBERS = [None, "1", float("nan"), [1.0]]


@pytest.mark.parametrize("wrong", NO_NUMBERS)
@pytest.mark.parametrize(
    "use",
    [
        lambda x: Domain.rectangle(x, 0, 1, 1),
        lambda x: Domain.rectangle(0, 0, 1, 1).with_periodic(
            "left", "right", rotation="" if x is None else x
        ),
        lambda x: Domain.from_curves([Circle((0, 0), 1)], corner_angle=x),
        lambda x: Domain(SQUARE, RING).outline(x),
        lambda x: Domain.rectangle(0, 0, 1, 1).with_periodic(
            "left", "right", translation="" if x is None else x
        ),
        lambda x: Domain.rectangle(0, 0, 1, 1).with_periodic(
            "left", "right", tolerance="" if x is None else x
        ),
        lambda x: repair(SQUARE, tolerance="" if x is None else x),
    ],
)
def test_what_is_no_number_is_refused(use, wrong):
    with pytest.raises(DomainError):
        use(wrong)


def test_none_is_as_if_not_given():
    nothing = dict.fromkeys(("holes", "regions", "names", "tags", "region_tags"))
    assert Domain(SQUARE, RING, **nothing) == Domain(SQUARE, RING)
    assert repair(Outline(SQUARE, RING, **nothing))[0] == repair(Outline(SQUARE, RING))[0]
    circle = [Circle((0, 0), 1)]
    more = {**nothing, "points": None, "join_tolerance": None}
    assert Domain.from_curves(circle, **more) == Domain.from_curves(circle)
    assert Domain.polygon(SQUARE, None, names=None) == Domain.polygon(SQUARE)
    assert Domain(SQUARE, RING).with_names({}) == Domain(SQUARE, RING)
    assert Domain(SQUARE, RING).with_frozen(segments=None) == Domain(SQUARE, RING)
    for curves in (None, [], [None], Circle((0, 0), 1)):
        with pytest.raises(DomainError, match="curve"):
            Domain.from_curves(curves)


def test_the_old_name_of_to_domain_still_works(plate):
    mesh = generate(plate, 0.5)
    with pytest.warns(DeprecationWarning, match="to_domain"):
        assert Domain.of_mesh(mesh, straight_tolerance=1e-9) == mesh.to_domain(
            straight_tolerance=1e-9
        )
