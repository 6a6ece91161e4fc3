"""Names for sides that are chosen by where they are."""

import time

import numpy as np
import pytest
import shapely
from reference.transforms import SIMILARITIES, TRANSFORMS

import adaptmesh as am
from adaptmesh.curves import Arc, Circle, Line

SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]
RING = [(0, 1), (1, 2), (2, 3), (3, 0)]
HOLE = [(0.4, 0.4), (0.6, 0.4), (0.6, 0.6), (0.4, 0.6)]


def left(transform):
    return lambda x: transform.inverse(x)[:, 0] < 1e-6


def choices(transform):
    """The same four sides in four ways; directions for maps that keep angles."""
    m = np.array(transform.matrix)
    middle = transform(np.array([(0.5, 0.0), (0.9, 0.6)]))
    return {
        "left": left(transform),
        "bottom": am.nearest(middle[0]),
        "right": am.nearest(middle[1]),
        "top": am.facing(m @ (0, 1)),
    }


def sides(domain, transform):
    """The middles of the segments of each name, in the old coordinates."""
    return {
        name: transform.inverse(domain.points[domain.segments[domain.segment_tags == tag]].mean(1))
        for name, tag in domain.names.items()
    }


@pytest.mark.parametrize("transform", SIMILARITIES, ids=str)
def test_each_way_to_choose_in_each_way_to_make_a_domain(transform):
    square, hole = transform(np.array(SQUARE, float)), transform(np.array(HOLE))
    points = np.concatenate([square, hole])
    segments = np.array([*RING, *((a + 4, b + 4) for a, b in RING)])
    names = choices(transform)
    lines = [Line(points[a], points[b]) for a, b in segments.tolist()]
    made = [
        am.Domain(points, segments, names=names),
        am.Domain(points, segments).with_names(names),
        am.Domain.polygon(square, [hole], names=names),
        am.Domain.polygon(shapely.Polygon(square, [hole]), names=names),
        am.Domain.from_curves(lines, names=names),
        am.Domain.from_curves(lines).with_names(names),
        am.repair(am.Outline(points, segments, names=names))[0],
        am.repair([square, hole])[0].with_names(names),
        am.generate(am.Domain(points, segments), transform.scale).to_domain().with_names(
            names
        ),
    ]  # fmt: skip
    for domain in made:
        found = sides(domain, transform)
        where = {"left": (0, 0.5), "bottom": (0.5, 0), "right": (1, 0.5)}
        for name, (x, y) in where.items():
            assert found[name] == pytest.approx(np.array([(x, y)]), abs=1e-6), name
        # the lower side of the hole faces up, too: out of the domain
        assert sorted(found["top"][:, 1].round(6).tolist()) == [0.4, 1.0]
        assert list(domain.names) == list(names)


@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
def test_a_repaired_cell_becomes_periodic(transform):
    """Its left side has a point in the middle, which the right one gets, too."""
    ring = np.array([(0, 0), (1, 0), (1, 0.5), (1, 1), (0, 1), (0, 0.5), (0, 0.5)])
    cell, repairs = am.repair(transform(ring))
    assert repairs
    inverse = transform.inverse
    cell = cell.with_names(
        {"left": left(transform), "right": lambda x: inverse(x)[:, 0] > 1 - 1e-6}
    )
    cell = cell.with_periodic("left", "right", tolerance=1e-6 * transform.scale)
    mesh = am.generate(cell, 0.2 * transform.scale)
    assert mesh.validate().ok, str(mesh.validate())
    pairs = mesh.periodic_vertices()["left", "right"]
    assert len(pairs) >= 3
    shift = np.diff(inverse(mesh.points[pairs]), axis=1)[:, 0]
    assert shift == pytest.approx(np.tile([1.0, 0.0], (len(pairs), 1)), abs=1e-6)
    with pytest.raises(am.DomainError, match="'left' is periodic"):
        cell.with_names({"other": left(transform)})


@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
@pytest.mark.parametrize("domain", [True, False])
def test_meshes(transform, domain):
    square = am.Domain.polygon(transform(np.array(SQUARE, float)), names={"old": [0, 3]})
    mesh = am.generate(square, 0.2 * transform.scale)
    if not domain:
        mesh = am.Mesh(mesh.points, mesh.triangles)
    named = mesh.with_names({"left": left(transform)})
    edges = named.edges_named("left")
    assert len(edges) >= (1 if "stretched" in str(transform) else 3)
    assert np.abs(transform.inverse(named.points[edges])[..., 0]).max() < 1e-6
    assert named.validate().ok, str(named.validate())
    assert list(named.names) == (["old", "left"] if domain else ["left"])
    again = am.adapt(named, 0.3 * transform.scale)
    assert len(again.edges_named("left")) >= (1 if "stretched" in str(transform) else 2)
    if domain:
        with pytest.raises(am.DomainError, match=r"numbers.*mesh\.domain\.with_names"):
            mesh.with_names({"a": [0]})
    else:
        assert len(mesh.with_names({"a": [0]}).edges_named("a")) == 1


def test_curves_are_chosen_whole():
    def outer(x):
        return np.hypot(*x.T) > 1.5

    rings = [Circle((0, 0), 2), Circle((0, 0), 1)]
    for ring in (
        am.Domain.from_curves(rings, names={"outer": outer, "inner": am.nearest((0.1, 0))}),
        am.Domain.from_curves(rings).with_names({"outer": outer, "inner": am.nearest((0.1, 0))}),
        am.generate(am.Domain.from_curves(rings), 0.5)
        .with_names({"outer": outer, "inner": am.nearest((0.1, 0))})
        .domain,
    ):
        for name, radius in (("outer", 2), ("inner", 1)):
            on = ring.points[ring.segments[ring.segment_tags == ring.names[name]]]
            assert np.hypot(*on.reshape(-1, 2).T) == pytest.approx(radius)
        assert ring.area == pytest.approx(3 * np.pi)
    quarter = [Arc((0, 0), 1, k * np.pi / 2, (k + 1) * np.pi / 2) for k in range(4)]
    disc = am.Domain.from_curves(quarter, names={"east": am.facing((1, 1), within=45)})
    assert (disc.segment_tags == 1).sum() == (disc.curved.segment_curves == 0).sum()
    assert disc.outline(1e-3, names=["east"]).min() > -1e-9
    assert len(disc.outline(1e-3, names=["east"])) < len(disc.outline(1e-3))
    mesh = am.generate(am.Domain.from_curves(quarter), 0.3)
    with pytest.raises(am.DomainError, match="no vertex where the name changes"):
        mesh.with_names({"east": am.facing((1, 1), within=45)})


def test_a_side_gets_a_new_name_for_its_old_one():
    square = am.Domain.polygon(SQUARE, names={"walls": [0, 1, 2], "inlet": [3]})
    named = square.with_names({"lid": am.facing((0, 1)), "outlet": [1]})
    assert named.segment_tags.tolist() == [1, 4, 3, 2]
    assert "inlet" not in square.with_names({"in": [3]}).names
    assert square.segment_tags.tolist() == [1, 1, 1, 2]
    assert named == square.with_names({"lid": am.nearest((0.5, 2)), "outlet": [1]})


@pytest.mark.parametrize(
    ("chosen", "message"),
    [
        (lambda x: x[:, 0] < -1, r"'a' is given to nothing: .* between \(0, 0\) and \(1, 1\)"),
        (
            lambda x: x[:, 0] < 0.5,
            r"a part of segment 0 .*, at \(0\.0555\d*, 0\) but not at \(0\.5",
        ),
        (lambda x: x[:, 0], "type float64; expected bool"),
        (lambda x: x < 0.5, r"shape \(36, 2\)"),
        (lambda x: True, r"shape \(\)"),
        (lambda x: [True], r"shape \(1,\)"),
        (lambda x: None, r"shape \(\)"),
        (am.nearest((0, 0)), "are equally near"),
        (am.facing((1, 1), within=10), "given to nothing"),
        ([True, False, False, False], "given to segment True"),
        (3, "given to 3: expected a sequence of numbers"),
        (None, "given to None"),
        ([7], "given to segment 7"),
    ],
)
def test_choices_that_choose_nothing_or_something_else(chosen, message):
    for make in (
        lambda: am.Domain(SQUARE, RING, names={"a": chosen}),
        lambda: am.Domain(SQUARE, RING).with_names({"a": chosen}),
    ):
        with pytest.raises(am.DomainError, match=message):
            make()


def test_two_names_for_one_side():
    low = {"low": lambda x: x[:, 1] < 1e-9, "down": am.facing((0, -1))}
    for names in (low, {"low": low["low"], "down": [0]}):
        with pytest.raises(am.DomainError, match=r"named both 'low' and 'down'|'down' and 'low'"):
            am.Domain(SQUARE, RING, names=names)


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: am.nearest(),
        lambda: am.nearest((np.nan, 0)),
        lambda: am.facing((0, 0)),
        lambda: am.facing((1, np.inf)),
        lambda: am.facing((1, 0), within=180),
        lambda: am.facing(3),
    ],
)
def test_choices_that_say_nothing(wrong):
    with pytest.raises(am.DomainError):
        wrong()


def test_a_condition_is_not_asked_at_ends_and_may_not_change_what_it_is_given():
    def condition(x):
        x[:] = 7.0
        return np.ones(len(x), bool)

    assert am.Domain(SQUARE, RING, names={"all": condition}).segment_tags.tolist() == [1] * 4
    with_line = am.Domain(
        [*SQUARE, (0.5, 0.5)], [*RING, (4, 0)], names={"line": am.nearest((0.25, 0.26))}
    )
    assert with_line.segment_tags.tolist() == [0, 0, 0, 0, 1]
    with pytest.raises(am.DomainError, match="given to nothing"):
        with_line.with_names({"inner": am.facing((1, -1), within=5)})


def test_thousands_of_nearest_sides_take_time_in_proportion():
    seconds = {}
    for n in (500, 2000):
        angle = np.linspace(0, 2 * np.pi, n, endpoint=False)
        ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        middles = 0.5 * (ring + np.roll(ring, -1, axis=0))
        names = {f"side {k}": am.nearest(place) for k, place in enumerate(middles)}
        start = time.process_time()
        domain = am.Domain.polygon(ring, names=names)
        seconds[n] = time.process_time() - start
        assert domain.segment_tags.tolist() == list(range(1, n + 1))
    assert seconds[2000] < 10 * max(seconds[500], 0.1)  # in n squared, 16 times
