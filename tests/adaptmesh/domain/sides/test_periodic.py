"""Periodic boundaries get vertices that correspond, in every mesh."""

import time

import numpy as np
import pytest
from reference.periodic import assert_periodic, by, sector, wave, wavy_channel
from reference.transforms import TRANSFORMS

import adaptmesh as am
from adaptmesh.curves import Line
from adaptmesh.errors import DomainError


def sizes(x):
    """Finer to the left, and not the same on both sides."""
    return 0.02 + 0.1 * x[:, 0] + 0.05 * x[:, 1] ** 2


def test_a_square_periodic_both_ways():
    square = am.Domain.rectangle(0, 0, 1, 1)
    domain = square.with_periodic("left", "right").with_periodic("bottom", "top")
    mesh = am.generate(domain, sizes)
    for _ in range(3):
        assert_periodic(mesh, "left", "right", by(1, 0))
        assert_periodic(mesh, "bottom", "top", by(0, 1))
        mesh = am.adapt(mesh, sizes(mesh.points))
    # fine enough for both sides: "left" asks for the smaller sizes
    alone = am.generate(square, sizes)
    assert len(mesh.edges_named("right")) >= len(alone.edges_named("left"))
    assert not square.periodic


def test_slanted_sides_in_pieces():
    """A parallelogram, a point on one of its sides; the other direction of each segment."""
    points = [(0, 0), (2, 0), (2.5, 1), (0.5, 1), (0.25, 0.5), (2.25, 0.5)]
    domain = am.Domain(
        points,
        [(0, 1), (2, 1), (2, 3), (0, 4), (3, 4)],
        names={"a": [3, 4], "b": [1]},
    )
    mesh = am.generate(domain.with_periodic("a", "b"), sizes)
    assert_periodic(mesh, "a", "b", by(2, 0))


def test_curved_sides():
    mesh = am.generate(wavy_channel().with_periodic("left", "right"), sizes)
    for _ in range(2):
        assert_periodic(mesh, "left", "right", by(1, 0))
        mesh = am.adapt(mesh, 0.5 * sizes(mesh.points))


def test_rotation():
    domain = sector().with_periodic("low", "high", rotation=60)
    a = np.radians(60)
    turn = np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
    mesh = am.generate(domain, lambda x: 0.02 + 0.05 * np.abs(x[:, 1]))
    assert_periodic(mesh, "low", "high", lambda x: x @ turn.T)


def test_a_side_that_needs_more_chords_takes_the_other_along():
    """An island close to one side only."""
    y = np.linspace(0.3, 0.7, 9)
    near = np.stack([0.012 + 0.1 * np.sin(2 * np.pi * y), y], axis=1)
    island = np.concatenate([near, [[0.4, 0.7], [0.4, 0.3]]])
    curves = [wave(0), Line((0, 0), (1, 0)), wave(1), Line((0, 1), (1, 1))]
    ring = np.roll(island, -1, axis=0)
    curves += [Line(a, b) for a, b in zip(island, ring, strict=True)]
    domain = am.Domain.from_curves(curves, names={"left": [0], "right": [2]})
    mesh = am.generate(domain.with_periodic("left", "right"), 0.4)
    assert_periodic(mesh, "left", "right", by(1, 0))


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_at_any_scale(scale):
    domain = am.Domain.rectangle(0, 0, scale, scale).with_periodic("left", "right")
    mesh = am.generate(domain, lambda x: scale * sizes(x / scale))
    assert_periodic(mesh, "left", "right", by(scale, 0), atol=1e-12 * scale)


def test_what_does_not_correspond_is_named():
    square = am.Domain.rectangle(0, 0, 1, 1)
    with pytest.raises(DomainError, match="no boundary is named 'lef'"):
        square.with_periodic("lef", "right")
    with pytest.raises(DomainError, match="with itself"):
        square.with_periodic("left", "left")
    with pytest.raises(DomainError, match="check the motion"):
        square.with_periodic("left", "bottom")
    with pytest.raises(DomainError, match=r"would be carried to \(2, "):
        square.with_periodic("left", "right", translation=(2, 0))
    with pytest.raises(DomainError, match="periodic already"):
        square.with_periodic("left", "right").with_periodic("right", "top")
    with pytest.raises(DomainError, match="not both"):
        square.with_periodic("left", "right", translation=(1, 0), rotation=90)
    with pytest.raises(DomainError, match="two finite numbers"):
        square.with_periodic("left", "right", translation=(np.nan, 0))
    with pytest.raises(DomainError, match="rotation=inf: expected a finite number"):
        square.with_periodic("left", "bottom", rotation=np.inf)
    quarter = square.with_periodic("left", "bottom", rotation=-90, centre=(0, 0), tolerance=1e-9)
    assert quarter.periodic[0].first == "left"
    bent = am.Domain.polygon(
        [(0, 0), (1, 0), (1.1, 0.5), (1, 1), (0, 1)], names={"left": [4], "right": [1, 2]}
    )
    with pytest.raises(DomainError, match=r"from \(0, 0\) to \(0, 1\) on 'left' would be"):
        bent.with_periodic("left", "right", translation=(1, 0))
    with pytest.raises(DomainError, match="no segment is named 'wall'"):
        bent_with_empty_name().with_periodic("wall", "right")


def bent_with_empty_name():
    return am.Domain.polygon([(0, 0), (1, 0), (1, 1)], names={"wall": [], "right": [1]})


@pytest.mark.parametrize("transform", TRANSFORMS, ids=str)
@pytest.mark.parametrize("frozen", [(), (5,)])
def test_corners_of_one_side_divide_the_other(transform, frozen):
    """As a repair leaves them: other corners on each side, and a crack that ends on one."""
    square = [(0, 0), (0.5, 0), (1, 0), (1, 0.3), (1, 0.8), (1, 1), (0, 1), (0, 0.25)]
    points = transform([*square, (0.4, 0.6)])
    segments = [(k, (k + 1) % 8) for k in range(8)] + [(4, 8)]
    names = {"bottom": [0, 1], "right": [2, 3, 4], "top": [5], "left": [6, 7]}
    domain = am.Domain(points, segments, names=names, tags={"left": 7})
    domain = domain.with_frozen(segments=[1]) if frozen else domain
    motion = {"translation": transform([1, 0]) - transform([0, 0])} if frozen else {}
    both = domain.with_periodic("left", "right", **motion).with_periodic("top", "bottom")
    assert len(both.points) == 9 + 3 + 1 and both.names == domain.names
    assert both.area == pytest.approx(domain.area, rel=1e-9)
    assert (both.segment_tags[:9] == domain.segment_tags).all()
    assert both.segment_is_frozen.sum() == len(frozen)
    mesh = am.generate(both, lambda x: transform.scale * sizes(np.abs(transform.inverse(x))))
    for again in (False, True):
        if again:
            mesh = am.adapt(mesh, 0.1 * transform.scale)
        mesh.validate().raise_if_invalid()
        for first, second in (("left", "right"), ("top", "bottom")):
            pairs = mesh.periodic_vertices()[first, second]
            for name, column in ((first, 0), (second, 1)):
                assert set(pairs[:, column]) == set(mesh.edges_named(name).ravel().tolist())
            shift = np.ptp(mesh.points[pairs[:, 1]] - mesh.points[pairs[:, 0]], axis=0)
            assert shift.max() < 1e-9 * transform.scale + 8 * np.spacing(np.abs(points).max())


def test_the_motion_found_does_not_depend_on_points_between():
    """As many corners on both sides, at other heights; it was found from their mean."""
    ring = [(0, 0), (1, 0), (1, 0.5), (1, 1), (0, 1), (0, 0.25)]
    domain = am.Domain.polygon(ring, names={"left": [4, 5], "right": [1, 2]})
    pair = domain.with_periodic("left", "right").periodic[0]
    assert pair.motion.shift.tolist() == [1, 0] and len(pair.sides) == 3


def test_a_pair_survives_a_file_though_corners_are_dropped_there(tmp_path):
    ring = [(0, 0), (1, 0), (1, 1), (0, 1), (0, 0.5), (0.5, 0.5)]
    segments = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 0), (4, 5)]
    domain = am.Domain(ring, segments, names={"left": [3, 4], "right": [1]})
    mesh = am.generate(domain.with_periodic("left", "right"), 0.2)
    am.write(tmp_path / "cell.msh", mesh)
    again = am.adapt(am.read(tmp_path / "cell.msh"), 0.1)
    assert_periodic(again, "left", "right", by(1, 0))


def test_thousands_of_pieces_take_time_in_proportion():
    seconds = {}
    for n in (4000, 16000):
        x = np.linspace(0, 1, n)
        ring = np.concatenate([np.c_[x, 0 * x], np.c_[x[::-1], 0 * x + 1]])
        names = {"b": list(range(n - 1)), "t": list(range(n, 2 * n - 1))}
        domain = am.Domain.polygon(ring, names=names)
        start = time.process_time()
        domain.with_periodic("b", "t")
        seconds[n] = time.process_time() - start
    assert seconds[16000] < 10 * max(seconds[4000], 0.1)  # in n squared, 16 times: 100 s
