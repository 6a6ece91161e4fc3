"""What is inside: one default for segments and curves, and nothing asked for is left out."""

import itertools

import numpy as np
import pytest
import shapely
from reference.transforms import SIMILARITIES, TRANSFORMS

import adaptmesh as am
from adaptmesh.curves import Line

OUTER = [(0, 0), (3, 0), (3, 3), (0, 3)]
INNER = [(1, 1), (2, 1), (2, 2), (1, 2)]


def closed(*rings):
    """Points and segments of rings."""
    starts = np.cumsum([0, *map(len, rings)])
    segments = [
        (n + i, n + (i + 1) % len(ring))
        for n, ring in zip(starts.tolist(), rings, strict=False)
        for i in range(len(ring))
    ]
    return np.concatenate(rings), segments


def as_curves(points, segments, **options):
    return am.Domain.from_curves([Line(points[a], points[b]) for a, b in segments], **options)


def random_rings(rng, depth=4):
    """Star polygons in and beside each other, none of which cross."""
    out, places = [], [((0.0, 0.0), 1.0)]
    for _ in range(depth):
        inner = []
        for (x, y), r in places:
            n = int(rng.integers(3, 9))
            angle = np.sort(rng.uniform(0, 2 * np.pi, n))
            gaps = np.diff(np.append(angle, angle[0] + 2 * np.pi))
            if gaps.max() > 2.5 or gaps.min() < 0.05:
                angle = np.linspace(0, 2 * np.pi, n, endpoint=False)
            ring = np.stack([x + r * np.cos(angle), y + r * np.sin(angle)], axis=1)
            out.append(ring[:: rng.choice([-1, 1])])
            reach = shapely.Polygon(ring).exterior.distance(shapely.Point(x, y))
            if rng.random() < 0.5:
                inner.append(((x, y), 0.8 * reach))
            else:
                inner += [((x + s * reach / 2, y), 0.4 * reach) for s in (-1, 1)]
        places = inner
    return out[: int(rng.integers(2, len(out)))]


def even_odd_area(rings):
    """By shapely, which knows nothing of ours."""
    area = shapely.Polygon()
    for ring in rings:
        area = area.symmetric_difference(shapely.Polygon(ring))
    return area.area


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
def test_rings_alternate_as_segments_as_curves_and_as_a_polygon(transform):
    for seed in range(8):
        rings = [transform(ring) for ring in random_rings(np.random.default_rng(seed))]
        points, segments = closed(*rings)
        expected = even_odd_area([ring - rings[0][0] for ring in rings])
        made = [am.Domain(points, segments), am.Domain(points, segments, holes="nesting")]
        made += [am.Outline(points, segments).domain(), am.repair(am.Outline(points, segments))[0]]
        made += [as_curves(points, segments)]
        rounding = 1e-15 * np.abs(points).max() * np.ptp(points, axis=0).max() / expected
        for domain in made:
            assert domain.area == pytest.approx(expected, rel=1e-12 + rounding)
        whole = am.Domain(points, segments, holes=[])
        assert whole.area == pytest.approx(
            shapely.Polygon(rings[0] - rings[0][0]).area, rel=1e-12 + rounding
        )


@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
@pytest.mark.parametrize("make", [am.Domain, as_curves])
def test_a_part_with_the_point_of_a_region_is_no_hole(make, transform):
    """A fibre in a matrix, and a tube: its wall is a region, what it holds a hole."""
    core = [(1.4, 1.4), (1.6, 1.4), (1.5, 1.6)]
    points, segments = closed(OUTER, INNER, core)
    seeds = transform(np.array([(0.5, 0.5), (1.2, 1.2)]))
    regions = {"matrix": seeds[0], "wall": seeds[1]}
    tube = make(transform(points), segments, regions=regions)
    assert tube.area == pytest.approx((9 - 0.02) * abs(transform.determinant), rel=1e-8)
    full = make(
        transform(points),
        segments,
        regions={**regions, "core": transform(np.array([(1.5, 1.5)]))[0]},
    )
    assert full.area == pytest.approx(9 * abs(transform.determinant), rel=1e-8)
    assert set(np.unique(full.triangle_regions)) == {1, 2, 3}


@pytest.mark.parametrize("make", [am.Domain, as_curves])
def test_what_may_be_a_hole_or_not_is_asked_for(make):
    nine = [(i, j) for i in range(4) for j in range(4)]
    cells = [(4 * i + j, 4 * i + j + 1) for i in range(4) for j in range(3)]
    cells += [(4 * i + j, 4 * i + 4 + j) for i in range(3) for j in range(4)]
    with pytest.raises(am.DomainError, match=r"holes=\[\] if it is not, holes='nesting' if it is"):
        make(nine, cells)
    assert make(nine, cells, holes=[]).area == 9
    assert make(nine, cells, holes="nesting").area == 8


LINES = {
    "dangles": [(1.0, 1.0), (1.5, 1.4)],
    "is alone": [(1.2, 1.2), (1.5, 1.4)],
    "divides it": [(1.0, 1.0), (1.5, 1.4), (2.0, 2.0)],
    "is a ring at its corner": [(1.0, 1.0), (1.5, 1.4), (1.4, 1.5), (1.0, 1.0)],
    "is a side shared": [(2.0, 1.0), (1.5, 1.5), (1.0, 2.0)],
}


@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
@pytest.mark.parametrize("how", LINES)
@pytest.mark.parametrize("holes", ["nesting", "points", None])
def test_lines_in_holes_are_refused_by_name_and_left_out_by_repair(how, holes, transform):
    points, segments = closed(OUTER, INNER)
    line = [tuple(p) for p in LINES[how]]
    all_points = [*map(tuple, points.tolist())]
    numbers = []
    for p in line:
        if p not in all_points:
            all_points.append(p)
        numbers.append(all_points.index(p))
    wall = list(itertools.pairwise(numbers))
    names = {"wall": list(range(len(segments), len(segments) + len(wall)))}
    if holes == "points":  # one in each part that the line may divide the hole into
        holes = [(1.8, 1.15), (1.15, 1.8), (1.8, 1.85), (1.3, 1.3)]
        holes = transform(np.array(holes[: 4 if "ring" in how else 3]))
    placed = transform(np.array(all_points, float))
    if holes is None and "ring" in how:
        return  # a ring in a hole is an island
    if isinstance(holes, str) and "ring" in how:
        return
    with pytest.raises(am.DomainError, match=r"segment \d+ .*named 'wall', is in a hole"):
        am.Domain(placed, [*segments, *wall], holes, names=names)
    outline = am.Outline(placed, [*segments, *wall], holes, names=names)
    domain, repairs = am.repair(outline, 0.0)
    assert repairs.counts == {"line in a hole": len(wall), "name lost": 1}
    assert domain.area == pytest.approx(8 * abs(transform.determinant), rel=1e-8)
    mesh = am.generate(domain, 0.7 * transform.scale)
    assert mesh.validate().ok, str(mesh.validate())


@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
def test_points_in_holes_and_outside(transform):
    points, segments = closed(OUTER, INNER)
    for lone in ([(1.5, 1.5)], [(4.0, 1.0)]):
        placed = transform(np.concatenate([points, lone]))
        with pytest.raises(am.DomainError, match=r"point 8 at .* outside the domain, or in a hole"):
            am.Domain(placed, segments)
        domain, repairs = am.repair(am.Outline(placed, segments))
        assert repairs.counts == {"point outside": 1} and len(domain.points) == 8
    inside = transform(np.concatenate([points, [(0.5, 0.5)]]))
    domain, repairs = am.repair(am.Outline(inside, segments))
    assert not repairs and len(domain.points) == 9


@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
def test_holes_of_polygons_lie_in_their_shell(transform):
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
    rings = {
        "beside": [[(2, 2), (3, 2), (3, 3)]],
        "around": [[(-1, -1), (2, -1), (2, 2), (-1, 2)]],
        "at a corner": [[(1, 1), (2, 1), (2, 2)]],
        "one of two": [[(0.2, 0.2), (0.3, 0.2), (0.3, 0.3)], [(2, 2), (3, 2), (3, 3)]],
    }
    for holes in rings.values():
        placed = [transform(np.array(hole, float)) for hole in holes]
        with pytest.raises(am.DomainError, match=r"hole \d of polygon 0 is not within its shell"):
            am.Domain.polygon(transform(square), placed)
        with pytest.raises(am.DomainError, match=r"hole \d of polygon 0 is not within its shell"):
            am.Domain.polygon(shapely.Polygon(transform(square), placed))
    touching = [[(0, 0), (0.5, 0.2), (0.2, 0.5)], [(0.5, 0.2), (0.8, 0.2), (0.8, 0.4)]]
    placed = [transform(np.array(hole)) for hole in touching]
    domain = am.Domain.polygon(transform(square), placed)
    assert domain.area == pytest.approx((1 - 0.105 - 0.03) * abs(transform.determinant), rel=1e-8)


def test_parts_of_polygons_that_overlap_or_are_nested_are_refused():
    nested = shapely.MultiPolygon([shapely.box(0, 0, 3, 3), shapely.box(1, 1, 2, 2)])
    with pytest.raises(am.DomainError, match=r"parts of polygon 0 overlap.*adaptmesh\.repair"):
        am.Domain.polygon(nested)
    assert am.repair(nested)[0].area == 9
    in_hole = shapely.Polygon(OUTER, [INNER, [(1.4, 1.4), (1.6, 1.4), (1.5, 1.6)]])
    with pytest.raises(am.DomainError, match="hole 1 of polygon 0 lies in another hole"):
        am.Domain.polygon(in_hole)


def lattice(n, transform):
    """Points and segments of n x n cells."""
    points = [(i, j) for i in range(n + 1) for j in range(n + 1)]
    number = {p: k for k, p in enumerate(points)}
    steps = [(p, (p[0] + dx, p[1] + dy)) for p in points for dx, dy in ((1, 0), (0, 1))]
    segments = [(number[p], number[q]) for p, q in steps if q in number]
    return transform(points), segments


def write_svg(path, points, segments):
    lines = [
        f'<line x1="{points[a][0]!r}" y1="{points[a][1]!r}" x2="{points[b][0]!r}" '
        f'y2="{points[b][1]!r}"/>'
        for a, b in segments
    ]
    path.write_text(f'<svg xmlns="http://www.w3.org/2000/svg">{"".join(lines)}</svg>')


def write_dxf(path, points, segments):
    out = ["0", "SECTION", "2", "ENTITIES"]
    for a, b in segments:
        out += ["0", "LINE", "8", "0", "10", repr(points[a][0]), "20", repr(points[a][1])]
        out += ["11", repr(points[b][0]), "21", repr(points[b][1])]
    path.write_text("\n".join([*out, "0", "ENDSEC", "0", "EOF", ""]))


def write_geo(path, points, segments):
    out = [f"Point({i + 1}) = {{{x!r}, {y!r}, 0}};" for i, (x, y) in enumerate(points)]
    out += [f"Line({i + 1}) = {{{a + 1}, {b + 1}}};" for i, (a, b) in enumerate(segments)]
    path.write_text("\n".join(out))


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize("transform", SIMILARITIES[:4] + TRANSFORMS[-2:], ids=str)
@pytest.mark.parametrize("write", [write_svg, write_dxf, write_geo])
def test_files_of_lines_say_what_domain_says_of_their_holes(write, transform, tmp_path):
    """The middle cell of nine was a hole in scripts, and in what `repair` made of drawings."""
    path = tmp_path / f"cells.{write.__name__[6:]}"
    for n in (2, 3, 4):
        points, segments = lattice(n, transform)
        write(path, points.tolist(), segments)
        if n == 2:
            assert am.read_domain(path).area == pytest.approx(4 * abs(transform.determinant))
            continue
        for make in (am.read_domain, am.repair):
            with pytest.raises(am.DomainError, match=r"uncertain: say holes=\[\]"):
                make(path)
        cells = am.read_domain(path, holes=[])
        assert cells.area == pytest.approx(n * n * abs(transform.determinant), rel=1e-9)
    points, segments = closed(OUTER, INNER)
    write(path, transform(points).tolist(), segments)
    place = transform((1.5, 1.5)) * (1, -1 if write is write_svg else 1)  # y is turned over
    for holes, area in ((None, 8), ("nesting", 8), ([place], 8), ([], 9)):
        for found in (am.read_domain(path, holes=holes), am.repair(path, holes=holes)[0]):
            assert found.area == pytest.approx(area * abs(transform.determinant), rel=1e-9)


def test_holes_of_files_that_say_what_is_inside(tmp_path):
    am.write(tmp_path / "a.vtu", am.generate(am.Domain.rectangle(0, 0, 1, 1), 0.5))
    (tmp_path / "a.wkt").write_text("POLYGON ((0 0, 1 0, 1 1, 0 0))")
    (tmp_path / "a.geo").write_text(
        "Point(1) = {0,0,0}; Point(2) = {1,0,0}; Point(3) = {0,1,0}; Line(1) = {1,2};"
        "Line(2) = {2,3}; Line(3) = {3,1}; Line Loop(1) = {1,2,3}; Plane Surface(1) = {1};"
    )
    for name in ("a.vtu", "a.wkt", "a.geo"):
        assert am.read_domain(tmp_path / name).area > 0
        for read in (am.read_domain, am.repair):
            with pytest.raises(am.DomainError, match=r"holes=\[\]: there are .* leave holes out"):
                read(tmp_path / name, holes=[])


def test_repair_takes_holes_of_what_does_not_say_them():
    outline = am.Outline(*closed(OUTER, INNER))
    for holes, area in ((None, 8), ([], 9), ([(1.5, 1.5)], 8)):
        assert am.repair(outline, holes=holes)[0].area == pytest.approx(area)
    given = am.Outline(*closed(OUTER, INNER), holes=[])
    for dirty in (given, given.domain(), OUTER):
        assert am.repair(dirty)[0].area == 9
        with pytest.raises(am.DomainError, match="leave holes out"):
            am.repair(dirty, holes=[(1.5, 1.5)])


def test_two_parts_between_holes_get_the_remedy():
    """Two wires between electrodes: what they enclose may be a hole or not, points say it."""
    points, segments = closed(OUTER, [(0.5, 1), (1, 1), (1, 2), (0.5, 2)])
    points = np.concatenate([points, [(2, 1), (2.5, 1), (2.5, 2), (2, 2)]])
    segments += [(8, 9), (9, 10), (10, 11), (11, 8), (5, 8), (6, 11)]
    with pytest.raises(am.DomainError, match=r"holes=\[\] if there are no holes, or give a point"):
        am.Domain(points, segments)
    assert am.Domain(points, segments, holes=[]).area == 9
    assert am.Domain(points, segments, holes=[(0.7, 1.5), (2.2, 1.5)]).area == 8


@pytest.mark.parametrize("holes", [5, "nesting", "none"])
def test_holes_of_a_polygon_are_rings(holes):
    with pytest.raises(am.DomainError, match="expected a sequence of rings"):
        am.Domain.polygon(OUTER, holes=holes)
