"""Dirty outlines: refused by place without repair, repaired with a report."""

import json

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from reference.winding import area_within

import adaptmesh as am
from adaptmesh.convert import to_shapely

SQUARE = [(0, 0), (4, 0), (4, 4), (0, 4)]
RING = [(0, 1), (1, 2), (2, 3), (3, 0)]
STAR = [(0, 0), (4, 0), (0.5, 3), (2, -2), (3.5, 3)]


def box(x0, y0, x1, y1):
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]


def polygon(*rings):
    return {"type": "Polygon", "coordinates": [[list(p) for p in [*r, r[0]]] for r in rings]}


def region_areas(domain):
    return {name: area.area for name, area in to_shapely(domain).items()}


# -- polygons: what is wrong, the kind of repair, its place, and the area that is left -------------

POLYGONS = {
    "bow tie": (polygon([(0, 0), (4, 4), (4, 0), (0, 4)]), "crossing", (2, 2), 8),
    "wound twice": (
        polygon([(0, 0), (4, 0), (4, 4), (0, 4), (0, 0), (2, 0), (2, 2), (0, 2)]),
        "self-overlap",
        None,
        16,
    ),
    "spike outwards": (
        polygon([(0, 0), (4, 0), (4, 2), (9, 2), (4, 2), (4, 4), (0, 4)]),
        "spike",
        (9, 2),
        16,
    ),
    "spike inwards": (
        polygon([(0, 0), (4, 0), (4, 2), (1, 2), (4, 2), (4, 4), (0, 4)]),
        "spike",
        (1, 2),
        16,
    ),
    "bent spike": (
        polygon([(0, 0), (4, 0), (4, 2), (5, 2), (5, 3), (5, 2), (4, 2), (4, 4), (0, 4)]),
        "spike",
        (5, 3),
        16,
    ),
    "same point twice": (
        polygon([*SQUARE[:2], SQUARE[1], *SQUARE[2:]]),
        "duplicate points",
        (4, 0),
        16,
    ),
    "nearly the same point": (
        polygon([*SQUARE[:2], (4, 1e-9), *SQUARE[2:]]),
        "nearly the same point",
        (4, 0),
        16,
    ),
    "not closed": (
        {"type": "Polygon", "coordinates": [[list(p) for p in SQUARE]]},
        "ring not closed",
        (0, 4),
        16,
    ),
    "hole outside": (polygon(SQUARE, box(6, 0, 7, 1)), "hole outside", None, 16),
    "hole that leaves": (polygon(SQUARE, box(3, 1, 5, 2)), "crossing", (4, 1), 15),
    "same hole twice": (polygon(SQUARE, box(1, 1, 2, 2), box(1, 1, 2, 2)), None, None, 15),
    "holes overlap": (
        polygon(SQUARE, box(1, 1, 3, 2), box(2, 1.5, 3.5, 3)),
        "crossing",
        None,
        12.25,
    ),
    "hole in a hole": (
        polygon(SQUARE, box(1, 1, 3, 3), box(1.5, 1.5, 2, 2)),
        "hole in a hole",
        None,
        12.25,
    ),
    "flat hole": (
        polygon(SQUARE, [(1, 1), (2, 2), (3, 3)]),
        "ring that bounds nothing",
        (1, 1),
        16,
    ),
    "parts overlap": (
        {
            "type": "MultiPolygon",
            "coordinates": [
                polygon(box(0, 0, 2, 2))["coordinates"],
                polygon(box(1, 0, 3, 2))["coordinates"],
            ],
        },
        "overlapping parts",
        None,
        6,
    ),
    "sliver": (
        polygon([(0, 0), (4, 0), (4, 4), (2, 4), (2, 9), (2 + 1e-9, 4), (0, 4)]),
        "spike",
        (2, 9),
        16,
    ),
}


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("name", POLYGONS)
def test_polygons(name, scale):
    geometry, kind, place, area = POLYGONS[name]
    scaled = scaled_geometry(geometry, scale)
    domain, repairs = am.repair(scaled)
    assert domain.area == pytest.approx(area * scale**2, rel=1e-9)
    assert am.generate(domain, scale).validate().ok
    if kind is None:
        assert not repairs
        return
    records = [record for record in repairs if record.kind == kind]
    assert records, str(repairs)
    if place is not None:
        assert any(np.allclose(np.divide(r.place, scale), place, atol=1e-6) for r in records)


def scaled_geometry(geometry, scale):
    def scaled(item):
        return [scaled(x) for x in item] if isinstance(item, list) else item * scale

    return {**geometry, "coordinates": scaled(geometry["coordinates"])}


@pytest.mark.parametrize(
    "name", [name for name in POLYGONS if POLYGONS[name][1] and name != "same point twice"]
)
def test_polygons_without_repair_are_refused_by_place(name, tmp_path):
    path = tmp_path / "dirty.geojson"
    path.write_text(json.dumps(POLYGONS[name][0]))
    with pytest.raises(am.DomainError, match=r"at \(.*polygon 0.*adaptmesh\.repair"):
        am.read_domain(path)


@pytest.mark.parametrize("name", POLYGONS)
def test_direction_and_start_of_rings_do_not_matter(name):
    geometry, _, _, area = POLYGONS[name]
    if geometry["type"] == "Polygon" and name != "not closed":
        for turn in (lambda r: r[::-1], lambda r: [*r[2:], *r[1:3]]):
            turned = {**geometry, "coordinates": [turn(r) for r in geometry["coordinates"]]}
            assert am.repair(turned)[0].area == pytest.approx(area, rel=1e-9)


def test_what_needs_no_repair_stays_bit_for_bit():
    rng = np.random.default_rng(0)
    ring = shapely.get_coordinates(shapely.Point(0, 0).buffer(1.0))[:-1] * rng.uniform(0.9, 1)
    domain, repairs = am.repair(ring)
    assert not repairs
    assert len(repairs) == 0
    assert repairs.displacement == 0
    assert {*map(tuple, domain.points)} == {*map(tuple, ring)}


# -- neighbours ------------------------------------------------------------------------------------


@pytest.mark.parametrize("gap", [1e-3, -1e-3])
def test_gaps_and_overlaps_within_the_tolerance_vanish(gap):
    left = [(0, 0), (1, 0), (1, 0.3), (1, 0.7), (1, 1), (0, 1)]
    right = [(1 + gap, 0), (2, 0), (2, 1), (1 + gap, 1), (1 + gap / 2, 0.4)]
    domain, repairs = am.repair({"left": left, "right": right}, tolerance=2e-3)
    areas = region_areas(domain)
    assert areas["left"] == 1.0  # the first one stays
    assert areas["right"] == pytest.approx(1.0)
    assert "left|right" in domain.names
    assert repairs.counts["point near a segment"] > 0
    assert 0 < repairs.displacement <= 2e-3
    mesh = am.generate(domain, 0.2)
    shared = mesh.points[mesh.edges_named("left|right")]
    assert np.hypot(*(shared[:, 1] - shared[:, 0]).T).sum() == pytest.approx(1.0)
    assert (shared[..., 0] == 1.0).all()


def test_the_first_keeps_an_overlap():
    a, b = box(0, 0, 2, 1), box(1, 0, 3, 1)
    domain, repairs = am.repair({"a": a, "b": b})
    assert region_areas(domain) == {"a": 2.0, "b": 1.0}
    (overlap,) = (record for record in repairs if record.kind == "overlap")
    assert "polygon 0 ('a'), which keeps it, and polygon 1 ('b')" in overlap.what
    assert "an area of 1" in overlap.what
    assert region_areas(am.repair({"b": b, "a": a})[0]) == {"b": 2.0, "a": 1.0}


def test_a_polygon_of_which_nothing_is_left_is_reported():
    domain, repairs = am.repair({"a": box(0, 0, 4, 4), "b": box(1, 1, 2, 2)})
    assert list(domain.region_names) == ["a"]
    assert repairs.counts["polygon lost"] == 1


def test_names_kinds_of_input():
    square = shapely.box(0, 0, 1, 1)
    feature = {"type": "Feature", "properties": {"name": "a"}, "geometry": square.__geo_interface__}
    for dirty in (
        square,
        [square],
        {"a": square},
        {"a": square.__geo_interface__},
        feature,
        [feature],
        {"type": "FeatureCollection", "features": [feature]},
        box(0, 0, 1, 1),
        [box(0, 0, 1, 1)],
        np.array(box(0, 0, 1, 1)),
        am.Domain.rectangle(0, 0, 1, 1),
        am.Outline(box(0, 0, 1, 1), RING),
    ):
        domain, repairs = am.repair(dirty)
        assert domain.area == 1.0
        assert not repairs
        assert str(repairs).startswith("nothing to repair")


@pytest.mark.parametrize(
    "dirty", [None, 3, "absent.geojson", [], {}, [[]], [3], {"a": None}, [None]]
)
def test_nonsense(dirty):
    with pytest.raises((am.AdaptmeshError, TypeError), match=r"\w"):
        am.repair(dirty)


@pytest.mark.parametrize("tolerance", [-1.0, np.nan, np.inf])
def test_tolerances_that_make_no_sense(tolerance):
    with pytest.raises(ValueError, match="expected a finite length"):
        am.repair(box(0, 0, 1, 1), tolerance)


# -- segments --------------------------------------------------------------------------------------

OUTLINES = {
    "crossing": (
        am.Outline([(0, 0), (4, 4), (4, 0), (0, 4)], RING),
        r"cross at \(2, 2\)",
        8.0,
    ),
    "overlapping segments": (
        am.Outline([*SQUARE, (1, 0), (3, 0)], [*RING, (4, 5)]),
        r"overlap near \(\d, 0\)",
        16.0,
    ),
    "duplicate points": (
        am.Outline([*SQUARE, (4, 0)], [(0, 1), (4, 2), (2, 3), (3, 0)]),
        r"points 1 and 4 are the same, \(4, 0\)",
        16.0,
    ),
    "nearly the same point": (
        am.Outline([*SQUARE, (4, 1e-9)], [(0, 1), (4, 2), (2, 3), (3, 0)]),
        r"not closed.*\(4, ",
        16.0,
    ),
    "point near a segment": (
        am.Outline(
            [*SQUARE, (1, 1e-9), (1, 4)], [*RING, (4, 5)], regions={"a": (0.5, 1), "b": (2, 1)}
        ),
        r"'a'.*'b'.*same part",
        16.0,
    ),
    "segment without length": (
        am.Outline([*SQUARE, (4, 4)], [*RING, (2, 4)]),
        r"no length: its ends are both \(4, 4\)",
        16.0,
    ),
    "spike": (
        am.Outline(
            [*SQUARE, (4, 2), (9, 2)], [(0, 1), (1, 4), (4, 2), (2, 3), (3, 0), (4, 5), (5, 4)]
        ),
        r"overlap near \(\d, 2\)",
        16.0,
    ),
}


@pytest.mark.parametrize("kind", OUTLINES)
def test_segments(kind):
    outline, refusal, area = OUTLINES[kind]
    with pytest.raises(am.DomainError, match=refusal):
        outline.domain()
    domain, repairs = am.repair(outline)
    assert kind in repairs.counts
    assert domain.area == pytest.approx(area)
    assert am.generate(domain, 1.0).validate().ok


def test_names_stay_on_the_parts_of_what_is_divided():
    outline = am.Outline(
        [*SQUARE, (2, -1), (2, 5)], [*RING, (4, 5)], names={"floor": [0], "cut": [4]}
    )
    with pytest.raises(am.DomainError, match=r"not closed.*point 4 \(2, -1\)"):
        am.repair(outline)  # it sticks out of the domain, and is not a spike: drawn once only
    inside = am.Outline([*SQUARE, (2, 0), (2, 4)], [*RING, (4, 5)], names=outline.names)
    domain, repairs = am.repair(inside)
    assert not repairs
    assert (domain.piece_segments.size, len(domain.pieces)) == (7, 7)
    crossed = am.Outline(
        [*SQUARE, (1, 2), (3, 2), (2, 1), (2, 3)],
        [*RING, (4, 5), (6, 7)],
        names={"floor": [0], "across": [4], "up": [5]},
    )
    domain, repairs = am.repair(crossed)
    assert repairs.counts == {"crossing": 1}
    assert (domain.segment_tags == domain.names["across"]).sum() == 2
    assert (domain.segment_tags == domain.names["up"]).sum() == 2
    assert (domain.segment_tags == domain.names["floor"]).sum() == 1


def test_of_two_names_on_one_line_the_first_is_kept_and_both_are_reported():
    outline = am.Outline(SQUARE, [*RING, (1, 0)], names={"inlet": [0], "wall": [4]})
    domain, repairs = am.repair(outline)
    assert (domain.segment_tags == domain.names["inlet"]).sum() == 1
    assert "with the name 'inlet' instead of 'wall'" in repairs[0].what
    assert repairs.counts["name lost"] == 1


def test_a_gap_is_closed_within_the_tolerance_only():
    points = [*SQUARE, (0.01, 0)]
    outline = am.Outline(points, [(4, 1), (1, 2), (2, 3), (3, 0)])
    with pytest.raises(am.DomainError, match=r"not closed.*\(0(\.01)?, 0\).*adaptmesh\.repair"):
        am.repair(outline)
    domain, repairs = am.repair(outline, tolerance=0.02)
    assert domain.area == pytest.approx(16.0)
    assert repairs[0].displacement == pytest.approx(0.01)


def test_a_seed_that_a_segment_may_have_moved_over_is_refused():
    sliver = [*SQUARE, (0, 2), (4, 2), (0, 2.0005), (4, 2.0005)]
    segments = [(0, 1), (1, 5), (5, 7), (7, 2), (2, 3), (3, 6), (6, 4), (4, 0), (4, 5), (6, 7)]
    outline = am.Outline(sliver, segments, regions={"thin": (2, 2.0002)})
    assert outline.domain().area == 16.0
    with pytest.raises(am.DomainError, match=r"region 'thin' at \(2, 2\.0002\) is within"):
        am.repair(outline, tolerance=1e-3)


def test_a_clean_domain_keeps_everything(plate):
    domain, repairs = am.repair(plate)
    assert not repairs
    assert np.array_equal(domain.points, plate.points)
    assert domain.area == plate.area
    assert dict(domain.names) == dict(plate.names)
    assert dict(domain.region_names) == dict(plate.region_names)


def test_lone_points_divide_what_they_are_near():
    domain, repairs = am.repair(am.Outline([*SQUARE, (2, 1e-9), (1, 1)], RING))
    assert repairs.counts == {"point near a segment": 1}
    assert len(domain.points) == 6
    assert len(domain.segments) == 5


def test_drawings_of_straight_lines(tmp_path):
    pytest.importorskip("svgelements")
    path = tmp_path / "dirty.svg"
    path.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg"><path id="frame" d="M0 0 H4 V-4 H0 Z"/>'
        '<path id="a" d="M0 -2 H4"/><path id="b" d="M2 0 V-4"/></svg>'
    )
    with pytest.raises(am.DomainError, match="cross"):
        am.read_domain(path)
    domain, repairs = am.repair(path)
    assert repairs.counts == {"crossing": 1}
    assert domain.area == 16.0
    tags = {name: int((domain.segment_tags == tag).sum()) for name, tag in domain.names.items()}
    assert tags == {"frame": 8, "a": 2, "b": 2}


def test_curves_are_left_alone():
    curved = am.Domain.from_curves([am.curves.Circle((0, 0), 1)])
    domain, repairs = am.repair(curved)
    assert domain is curved
    assert not repairs
    with pytest.raises(
        am.DomainError, match=r"expected straight segments, got a curve through \(1, "
    ):
        am.simplify(curved, 0.1)


# -- limits ----------------------------------------------------------------------------------------


def test_too_many_crossings_are_refused_by_place():
    ring = np.random.default_rng(0).uniform(0, 1, (4000, 2))
    with pytest.raises(am.DomainError, match=r"more than 1,000,000 points, one of them \(0\.\d"):
        am.repair(ring)


def test_a_tolerance_larger_than_everything_is_refused():
    with pytest.raises(am.DomainError, match="tolerance"):
        am.repair(box(0, 0, 1, 1), tolerance=10.0)


def test_the_report_shows_a_few_of_each_kind():
    _, repairs = am.repair(np.random.default_rng(1).uniform(0, 1, (30, 2)))
    text = str(repairs)
    assert f"crossing: {repairs.counts['crossing']}" in text
    assert f"... and {repairs.counts['crossing'] - 5} more" in text
    assert text.count("cross; a point added there") == 5
    x, y = repairs[0].place
    assert f"at ({x:.10g}, {y:.10g})" in text
    assert len(repairs[:3]) == 3


# -- against winding numbers -----------------------------------------------------------------------


@given(
    arrays.arrays(
        np.float64, st.tuples(st.integers(3, 12), st.just(2)), elements=st.integers(0, 5).map(float)
    )
)
@settings(max_examples=60, deadline=None)
def test_a_lattice_ring_has_the_area_of_what_it_winds_around(ring):
    expected = area_within(ring)
    try:
        domain, _ = am.repair(ring)
    except am.DomainError as error:
        assert expected < 1e-12, str(error)  # a sum of rounded areas
        return
    assert domain.area == pytest.approx(expected, rel=1e-9)
    assert sum(region_areas(domain).values()) == pytest.approx(domain.area, rel=1e-12)
